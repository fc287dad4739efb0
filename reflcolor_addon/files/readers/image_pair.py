"""Image pairs: a range and a reflectance image, aligned pixel by pixel, that a `.scan.json` describes."""

from contextlib import contextmanager

import numpy as np

from ...errors import Cancelled, ImageError, ScanError
from ...messages import Message, of_scan
from ...scan.limits import FARTHEST_M, STRONGEST
from ...scan.orientation import flipped, thinned
from ...scan.scan import Scan
from ..gate import beside
from ..images import image_size, read_image, read_measured
from ..json_files import parse_json
from ..memory import require_memory
from .formats import Format
from .grid import BYTES_PER_PIXEL
from .numpy_arrays import array_of, array_shape
from .options import AS_IT_IS, pixels_kept
from .reflectance import told_apart
from .scan_json import EXPECTED, LARGEST_FILE, check_description, file_and_array
from .settle import scaled_by_pose

_FULL = 65535
_GAP, _NEAR = 655, 100
_NOTHING_HIT_M = 1e6
"""Renderers write 1e10, or the largest float, where a ray hits nothing."""


def read_image_pair(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read the scan that a `.scan.json` describes.

    No return is where the range is 0, not finite, beyond all reason, or transparent where the image has an alpha
    channel (there, and only there, a value of 0 may be a range).

    Parameters
    ----------
    file : binary file
    path : Path
        Its place; images are looked for from there.
    outside : bool
        Let it name images outside of its own folder, too.
    progress, cancelled : callable, optional

    Errors are those of `read_scans`.
    """
    description = check_description(parse_json(file, path, EXPECTED, error=ScanError, most=LARGEST_FILE), path.name)
    warnings = []
    image_of = _Images(path, outside, warnings, cancelled)

    def report(fraction, file_name):
        if cancelled and cancelled():
            raise Cancelled
        if progress:
            progress(fraction, Message("Reading {file}", file=file_name))

    report(0.0, description.range)
    values, opaque = image_of("range", description.range, read_measured)
    if values.dtype.kind in "ui" and description.range_scale is None and description.range_table is None:
        raise ScanError(
            "{file}: range_scale: missing; {image} holds whole numbers: give the meters per unit (0.001 for "
            "millimeters)",
            file=path.name,
            image=description.range,
        )
    shape = values.shape
    require_memory(
        values.size * BYTES_PER_PIXEL,
        Message("{file}: {rows} x {columns} pixels", file=path.name, rows=shape[0], columns=shape[1]),
        error=ScanError,
    )
    valid = np.isfinite(values) & (values != 0 if opaque is None else opaque)
    name = description.name or path.name[: -len(".scan.json")] or path.name

    def warn(template, **values):
        warnings.append(of_scan(name, template, **values))

    if full := full_code(values, valid):
        valid &= values != full
        warn(
            "{image} holds {code} in {count:,} pixels, far from all others: they were taken as no return",
            image=description.range,
            code=full,
            count=np.count_nonzero(values == full),
        )
    distance = np.where(valid, description.meters(values), 0.0)
    valid &= (distance > 0) & (distance < _NOTHING_HIT_M)

    report(0.4, description.reflectance)
    reflectance, _ = image_of("reflectance", description.reflectance, read_measured)
    _require_same_size(path, "reflectance", description.reflectance, reflectance.shape, shape)
    reflectance = reflectance.astype(np.float32)
    valid &= np.abs(reflectance) < STRONGEST

    color = None
    if description.color is not None:
        report(0.6, description.color)
        color = image_of("color", description.color, read_image)
        _require_same_size(path, "color", description.color, color.shape[:2], shape)
        color = color[..., ::-1] if description.color_order == "bgr" else color
    report(0.8, path.name)
    if valid.any():
        reflectance, color = told_apart(reflectance, color, valid, warn)
    try:
        points = description.model.points(np.where(valid, distance, 0.0), description.range_type)
    except ValueError as beams:
        raise ScanError(
            "{file}: model.elevation_deg: has {count} numbers, expected {rows}, one for each row of {image}",
            file=path.name,
            count=beams.args[0],
            rows=shape[0],
            image=description.range,
        ) from None
    pose = np.eye(4) if description.pose is None else description.pose
    points, pose = scaled_by_pose(points, pose, valid, warn)
    valid &= (np.abs(points) < FARTHEST_M).all(axis=-1)
    if not valid.any():
        raise ScanError(
            "{file}: {image} has no pixel with a return; there is nothing to import",
            file=path.name,
            image=description.range,
        )
    scan = Scan(
        name=name,
        points=points,
        reflectance=np.where(valid, reflectance, np.float32(0)),
        valid=valid,
        color=color,
        pose=pose,
        source=path,
        warnings=tuple(warnings),
    )
    vertical, horizontal = description.model.mirrored
    upright = flipped(scan, vertical=vertical, horizontal=horizontal)
    flips = {"vertical": options.flip_vertical, "horizontal": options.flip_horizontal}
    return [thinned(flipped(upright, turn_deg=options.turn_deg, **flips), options.step)]


def image_pair_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return the pixels of the scan that a `.scan.json` describes, whose images have one size; see `scan_pixels`."""
    description = check_description(parse_json(file, path, EXPECTED, error=ScanError, most=LARGEST_FILE), path.name)
    images = _Images(path, outside, [], None)
    shape = images.size("range", description.range)
    for key in ("reflectance", "color"):
        image = getattr(description, key)
        size = shape if image is None else images.size(key, image)
        # A photo may be stored lying on its side.
        if key != "color" or size[::-1] != shape:
            _require_same_size(path, key, image, size, shape)
    return pixels_kept([shape[0] * shape[1]], options)


def full_code(values, valid):
    """Return the greatest number that a 16-bit image can hold where it means no return; None where it does not.

    It does where it is far from the next smaller value, or far more frequent: the sensor saw too far, or nothing.
    """
    if values.dtype != np.uint16:
        return None
    counts = np.bincount(values[valid], minlength=_FULL + 1)
    others = np.flatnonzero(counts[:_FULL])
    if not counts[_FULL] or not others.size:
        return None
    usual = np.median(counts[others[-_NEAR:]])
    return _FULL if others[-1] < _FULL - _GAP or counts[_FULL] > max(10, 20 * usual) else None


class _Images:
    """Opens images that a description names; errors are reported with the description's name and key."""

    def __init__(self, path, outside, warnings, cancelled):
        self._path, self._outside, self._warnings, self._cancelled = path, outside, warnings, cancelled

    def __call__(self, key, image, read):
        place, member = self._found(key, image)
        if member is not None:
            return _as_image(array_of(place, member), key, self._path)
        with self._named(key):
            return read(place, self._warnings, cancelled=self._cancelled)

    def size(self, key, image):
        """Rows and columns, as the file's header says them."""
        place, member = self._found(key, image)
        if member is not None:
            return array_shape(place, member)[:2]
        with self._named(key):
            return image_size(place)

    def _found(self, key, image):
        """The path of an image, and the name of its array or None."""
        name, member = file_and_array(image)
        place = beside(self._path, name, outside=self._outside)
        if place is None:
            raise ScanError(
                "{file}: {key}: {image} lies outside of the folder of {file}; put it there, or allow outside files",
                file=self._path.name,
                key=key,
                image=image,
            )
        return place, member

    @contextmanager
    def _named(self, key):
        try:
            yield
        except ImageError as error:
            raise ScanError("{file}: {key}: {problem}", file=self._path.name, key=key, problem=error.message) from None


def _as_image(array, key, path):
    """An array as what an image of that kind is read to."""
    if key == "color" and array.ndim == 3 and array.shape[2] == 3 and array.dtype == np.uint8:
        return array
    if key == "color" or array.ndim != 2:
        raise ScanError(
            "{file}: {key}: expected an array of rows x columns, for colors of rows x columns x 3 of 8 bits",
            file=path.name,
            key=key,
        )
    return array, None


def _require_same_size(path, key, image, shape, expected):
    if shape != expected:
        raise ScanError(
            "{file}: {key}: {image} has {rows} rows x {columns} columns, expected {expected_rows} x {expected_columns} "
            "as the range image has",
            file=path.name,
            key=key,
            image=image,
            rows=shape[0],
            columns=shape[1],
            expected_rows=expected[0],
            expected_columns=expected[1],
        )


FORMAT = Format(
    name="image pair",
    suffixes=(".scan.json",),
    read=read_image_pair,
    pixels=image_pair_pixels,
    sniff=lambda start: start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"),
    about="a range and a reflectance image (PNG, TIFF, EXR) and what describes their sensor",
)
