"""The flat pictures of the experiments: images of a scan, seeds drawn into them, sheets of several, small JPEGs."""

import cv2
import numpy as np

from reflcolor_addon.scan.normalization import normalize

_GAP = 8
_QUALITIES = range(92, 40, -4)


def reflectance_image(scan):
    """(H, W, 3) uint8: the reflectance as the method sees it; black where there is no return."""
    return _gray(scan.reflectance, scan.valid)


def range_image(scan):
    """(H, W, 3) uint8: the range as the method sees it, near is dark; black where there is no return."""
    return _gray(scan.range, scan.valid)


def seeds_image(scan, seeds, scale=3):
    """The reflectance image, so many times larger, with a disc in its color at each of the Seeds."""
    picture = cv2.resize(reflectance_image(scan), None, fx=scale, fy=scale, interpolation=cv2.INTER_LINEAR)
    for row, col, rgb in zip(seeds.rows.tolist(), seeds.cols.tolist(), seeds.rgb.tolist(), strict=True):
        center = int((col + 0.5) * scale), int((row + 0.5) * scale)
        for radius, color in ((5 * scale, (0, 0, 0)), (5 * scale - 2, (255, 255, 255)), (4 * scale - 1, rgb)):
            cv2.circle(picture, center, radius, color, -1, cv2.LINE_AA)
    return picture


def sheet(rows, width):
    """Pictures in rows, each row as wide as the sheet and its pictures equally high, with white gaps between."""
    lines = []
    for row in rows:
        aspects = [picture.shape[1] / picture.shape[0] for picture in row]
        height = round((width - _GAP * (len(row) - 1)) / sum(aspects))
        cells = [
            cv2.resize(picture, (max(1, round(height * aspect)), height), interpolation=cv2.INTER_AREA)
            for picture, aspect in zip(row, aspects, strict=True)
        ]
        line = _with_gaps(cells, axis=1)[:, :width]
        lines.append(np.pad(line, ((0, 0), (0, width - line.shape[1]), (0, 0)), mode="edge"))
    return _with_gaps(lines, axis=0)


def write_jpeg(path, picture, most_bytes=150_000):
    """Write (H, W, 3) uint8 RGB as the best JPEG that is no larger than so many bytes."""
    for quality in _QUALITIES:
        _done, data = cv2.imencode(".jpg", picture[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
        if len(data) <= most_bytes:
            break
    path.write_bytes(data.tobytes())
    print(f"{path}: {len(data)} bytes", flush=True)


def _gray(values, valid):
    image, _ = normalize(values, valid)
    return np.repeat(np.rint(image).astype(np.uint8)[..., None], 3, axis=-1)


def _with_gaps(pictures, axis):
    shape = list(pictures[0].shape)
    shape[axis] = _GAP
    gap = np.full(shape, 255, np.uint8)
    joined = [part for picture in pictures for part in (gap, picture)]
    return np.concatenate(joined[1:], axis=axis)
