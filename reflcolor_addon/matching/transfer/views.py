"""What an accepted photo shows of the scan: which pixels it really saw, their colors, and how well it saw them."""

from dataclasses import dataclass

import numpy as np

from ..photo_image import depth_buffer, spacing, visible
from .unknown_space import hidden_by_unknown

_JUMP = 0.04
# Pixels of the scan to jump edges; and cells of the depth buffer to outlines, where a camera slightly off sees more.
_MARGIN, _OUTLINE = 2, 3
_GRAZING = 0.2
_BORDER_SHARE = 0.005
_BEHIND = 0.1
_FARTHER = 0.1
# From behind and from this far above or below, sine of the angle, another part of the thing is seen than its back.
_LEVEL = 0.2
# A pixel that is this dark carries no color; files hold black where they have nothing.
_DARKEST = 6
_PATCH = 3


@dataclass(frozen=True, eq=False)
class View:
    """One photo on the pixels of a `ScanImage`.

    usable : (h, w) bool
        Seen, away from jump edges and hidden parts, not at a grazing angle.
    behind : (h, w) bool
        Usable, but the camera was behind the surface: it saw the other side of the same thing, which is most often of
        the same color. Of low quality, for where nothing better is.
    rgb : (h, w, 3) float32
        sRGB, 0..255, the mean of the photo over a pixel of the scan and its neighbors of the same surface.
    quality : (h, w) float32
        Cosine of the viewing angle times pixels of the photo per pixel of the scan (at most 1), times the sharpness.
    xy : (h, w, 2) float64
        Pixels of the photo.
    """

    usable: np.ndarray
    behind: np.ndarray
    rgb: np.ndarray
    quality: np.ndarray
    xy: np.ndarray


def seen_by(photo, model, image):
    """Return the `View` of a photo with an accepted model on a `ScanImage`."""
    import cv2

    sites = model.sites(image)
    xy, depth = model.project(sites)
    seen = visible(model, image.valid, xy, depth, panes=image.panes)
    border = _BORDER_SHARE * max(model.width, model.height)
    inside = (xy >= border).all(axis=-1) & (np.nan_to_num(xy) <= [model.width - border, model.height - border]).all(
        axis=-1
    )
    cosine = _cosine(model, image)
    solid = _opened(seen & ~jumps(image), image.valid)
    usable = solid & inside & (np.abs(cosine) > _GRAZING)
    behind = cosine < 0
    if model.kind == "pose":
        usable &= ~_at_outline(model, xy, depth, seen)
        usable &= ~hidden_by_unknown(image, model.center, usable, behind)
        usable &= ~(behind & (_slope(model, image) > _LEVEL))
    behind &= usable
    detail = spacing(xy, seen)
    rgb = _sampled_rgb(photo, xy, usable, detail)
    usable &= rgb.max(axis=-1) >= _DARKEST
    weight = usable.astype(np.float32)
    share = np.maximum(cv2.blur(weight, (_PATCH, _PATCH)), 1e-6)
    rgb = cv2.blur(rgb * weight[..., None], (_PATCH, _PATCH)) / share[..., None]
    quality = np.abs(cosine) * np.where(behind, _BEHIND, 1.0) * min(detail, 1.0) * _sharpness(photo, detail)
    return View(usable, behind & usable, rgb, np.where(usable, quality, 0).astype(np.float32), xy)


def jumps(image):
    """(h, w) bool: where the range of a `ScanImage` jumps between neighbors."""
    logarithm = np.log(np.maximum(image.range, 1e-6))
    edge = np.zeros(image.shape, bool)
    for axis in (0, 1):
        # A steady slope is no jump: what counts is by how much the step differs from its neighbors.
        step = np.diff(logarithm, axis=axis)
        both = np.take(image.valid, range(1, image.shape[axis]), axis) & np.take(
            image.valid, range(image.shape[axis] - 1), axis
        )
        step = np.where(both, step, 0)
        usual = np.abs(np.stack([np.roll(step, 1, axis), np.roll(step, -1, axis)])).min(axis=0)
        jump = np.abs(step) > _JUMP + 2 * usual
        before, after = [slice(None)] * 2, [slice(None)] * 2
        before[axis], after[axis] = slice(0, -1), slice(1, None)
        edge[tuple(before)] |= jump
        edge[tuple(after)] |= jump
    return edge


def _at_outline(model, xy, depth, seen):
    """(h, w) bool: next to what lies farther or is unknown in the photo, where a camera slightly off sees that."""
    import cv2

    result = np.zeros(seen.shape, bool)
    if seen.any():
        nearest, place = depth_buffer(model, xy, depth, seen)
        size = 2 * _OUTLINE + 1
        # Beyond the photo's border nothing is known to be farther.
        farthest = cv2.dilate(nearest, np.ones((size, size)), borderType=cv2.BORDER_REPLICATE)
        result[seen] = farthest[place] > depth[seen] * (1 + _FARTHER)
    return result


def _opened(good, valid):
    """Pixels whose valid neighborhood, a margin wide, is good; few bad ones in it are noise and forgiven."""
    import cv2

    size = (2 * _MARGIN + 1, 2 * _MARGIN + 1)
    bad = cv2.blur((valid & ~good).astype(np.float32), size)
    return good & (bad < 0.2)


def _cosine(model, image):
    """(h, w): cosine between the surface's normal and the way to the camera; 1 where no camera is known.

    The normal points to the scanner, so that it is negative where the camera was on the other side.
    """
    if model.kind == "homography":
        return np.ones(image.shape)
    way = model.center - image.points
    way /= np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-12)
    to_scanner = np.where((image.normals * image.points).sum(axis=-1) <= 0, 1.0, -1.0)
    cosine = (image.normals * way).sum(axis=-1) * to_scanner
    # At the rim of a thing a neighbor is missing and the normal unknown: the margins take care of rims.
    return np.where(image.normals.any(axis=-1), cosine, 0.5)


def _slope(model, image):
    """(h, w): sine of the angle by which the way to the camera rises or falls."""
    way = model.center - image.points
    return np.abs(way[..., 2]) / np.maximum(np.linalg.norm(way, axis=-1), 1e-12)


def _sampled_rgb(photo, xy, usable, detail):
    import cv2

    level = max(0, int(np.floor(np.log2(max(detail, 1.0)))))
    image = photo.rgb
    # Halved a few times rather than blurred with a wide kernel: the same average for a fraction of the time.
    for _ in range(level):
        if min(image.shape[:2]) < 2:
            break
        image = cv2.resize(image, (image.shape[1] // 2 or 1, image.shape[0] // 2 or 1), interpolation=cv2.INTER_AREA)
    scale = [photo.width / image.shape[1], photo.height / image.shape[0]]
    x, y = (np.where(usable, xy[..., axis] / scale[axis] - 0.5, -2).astype(np.float32) for axis in (0, 1))
    return cv2.remap(image, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)


def _sharpness(photo, detail):
    """How sharp a photo is at the scan's detail: a blurred one has no finer contrast than coarse."""
    import cv2

    image, _ = photo.level(detail)
    fine = np.abs(image - cv2.GaussianBlur(image, (0, 0), 1.0)).mean()
    coarse = np.abs(image - cv2.GaussianBlur(image, (0, 0), 3.0)).mean()
    return float(fine / coarse) if coarse > 0 else 1.0
