"""Image pairs: a range and a reflectance image, aligned pixel by pixel, that a `.scan.json` describes."""

import numpy as np

from ...errors import Cancelled, ImageError, ScanError
from ...scan.orientation import flipped
from ...scan.scan import Scan
from ..images import read_image, read_measured
from ..memory import require_memory
from .grid import BYTES_PER_PIXEL, gray_is_no_color
from .scan_json import load_description

_NOTHING_HIT_M = 1e6
"""Renderers write 1e10, or the largest number there is, where a ray meets nothing."""


def read_image_pair(path, *, progress=None, cancelled=None):
    """Read the scan that a `.scan.json` describes.

    No return is where the range is 0, not finite, beyond all reason, or transparent where the image has an alpha
    channel (there, and only there, a value of 0 may be a range).

    Parameters and errors are those of `read_scans`.
    """
    description = load_description(path)

    def tell(fraction, file_name):
        if cancelled and cancelled():
            raise Cancelled
        if progress:
            progress(fraction, f"Reading {file_name}")

    tell(0.0, description.range)
    values, opaque = _measured(path, "range", description.range)
    if values.dtype.kind in "ui" and description.range_scale is None and description.range_table is None:
        raise ScanError(
            f"{path.name}: range_scale: missing; {description.range} holds whole numbers, say how many metres one is "
            "(0.001 for millimetres)"
        )
    shape = values.shape
    require_memory(values.size * BYTES_PER_PIXEL, f"{path.name}: {shape[0]} x {shape[1]} pixels", error=ScanError)
    valid = np.isfinite(values) & (values != 0 if opaque is None else opaque)
    distance = np.where(valid, description.metres(values), 0.0)
    valid &= (distance > 0) & (distance < _NOTHING_HIT_M)

    tell(0.4, description.reflectance)
    reflectance, _ = _measured(path, "reflectance", description.reflectance)
    _require_same_size(path, "reflectance", description.reflectance, reflectance.shape, shape)
    reflectance = reflectance.astype(np.float32)
    valid &= np.isfinite(reflectance)

    color, warnings = None, []
    name = description.name or path.name[: -len(".scan.json")] or path.name
    if description.color is not None:
        tell(0.6, description.color)
        color = _opened(path, "color", description.color, read_image)
        _require_same_size(path, "color", description.color, color.shape[:2], shape)
        color = color[..., ::-1] if description.color_order == "bgr" else color
        if gray_is_no_color(color, valid):
            warnings.append(f"scan '{name}': its colors are gray (red = green = blue); taken as a scan without color")
            color = None
    tell(0.8, path.name)
    points = description.model.points(np.where(valid, distance, 0.0), description.range_type)
    valid &= np.isfinite(points).all(axis=-1)
    if not valid.any():
        raise ScanError(f"{path.name}: {description.range} has no pixel with a return; there is nothing to import")
    scan = Scan(
        name=name,
        points=points,
        reflectance=np.where(valid, reflectance, np.float32(0)),
        valid=valid,
        color=color,
        pose=np.eye(4) if description.pose is None else description.pose,
        source=path,
        warnings=tuple(warnings),
    )
    vertical, horizontal = description.model.mirrored
    return [flipped(scan, vertical=vertical, horizontal=horizontal)]


def _measured(path, key, image):
    return _opened(path, key, image, read_measured)


def _opened(path, key, image, read):
    """An image that the description names; what is wrong with it is told under the description's name and key."""
    try:
        return read(path.parent / image)
    except ImageError as error:
        raise ScanError(f"{path.name}: {key}: {error}") from None


def _require_same_size(path, key, image, shape, expected):
    if shape != expected:
        raise ScanError(
            f"{path.name}: {key}: {image} has {shape[0]} rows x {shape[1]} columns, expected {expected[0]} x "
            f"{expected[1]} as the range image has"
        )
