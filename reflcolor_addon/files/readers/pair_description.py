"""Describes two or three images picked together: which is which, the sensor model, and the resulting scene.

Anything not specified is guessed from the shape of the images, their bits and their values. The dialog shows the size
that the scene would have, and warns about implausible values.
"""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...errors import ImageError, ScanError
from ...messages import Message
from ..images import image_size, read_measured
from .image_pair import full_code
from .scan_json import check_description, write_scan_json

_RANGE_WORDS = ("depth", "range", "dist")
_COLOR_WORDS = ("rgb", "color", "colour", "texture")

_PANORAMA = 1.9
"""From this width to height on an image is a full turn; a camera's is less."""

_SPHERE = 2.6
"""And up to this one from the zenith to the nadir; wider ones are cut off above and below."""

_FOCAL = 0.8
"""Focal length of a depth camera, in widths of its image: 64 degrees across."""

_MILLIMETERS, _FULL_SCALE_M = 0.001, 10.0
_NEAREST_M, _FARTHEST_M, _SMALLEST_ROOM_M = 0.02, 2000.0, 0.5
_SEAM = 0.5
"""How far the left and right edge of a full turn may be apart, as a share of what any two columns are."""

_STRETCHED = 8.0
_LOOKED_AT = 512


@dataclass(frozen=True, kw_only=True)
class Pair:
    """What a person says of images picked together; None where it is to be guessed.

    Parameters
    ----------
    images : tuple of Path
        A range and a reflectance image, and an image of colors if there is one, in any order, in one folder.
    model : dict, optional
        The sensor model as it stands in a `.scan.json`.
    range_scale : float, optional
        Meters for one unit of the range image.
    range_table : tuple of (float, float), optional
        Instead of the scale: values and the meters that they stand for.
    color_order : {"rgb", "bgr"}
    swap : bool
        Take the other one as the range image.
    """

    images: tuple[Path, ...]
    model: dict | None = None
    range_scale: float | None = None
    range_table: tuple[tuple[float, float], ...] | None = None
    color_order: str = "rgb"
    swap: bool = False


@dataclass(frozen=True, kw_only=True)
class PairPreview:
    """What would come of a `Pair`.

    Parameters
    ----------
    content : dict
        Keyword arguments of `write_scan_json`.
    said : tuple of Message
        Which image is the range, the sensor, and the size of the scene.
    doubts : tuple of Message
        What makes no sense.
    """

    content: dict
    said: tuple[Message, ...]
    doubts: tuple[Message, ...]


def table_of(text):
    """Return the pairs of a range table that was typed as ``value meters, value meters ...``; None for an empty text.

    Raises
    ------
    ScanError
        If it is none.
    """
    rows = [row.split() for row in text.replace(";", ",").split(",") if row.strip()]
    try:
        table = tuple((float(value), float(meters)) for value, meters in rows)
    except ValueError:
        raise ScanError('range table: expected pairs such as "0 0.5, 255 12", found {found}', found=text) from None
    return table or None


def pair_and_photos(images):
    """Tell the images of a pair, which are of one size, from photos that were picked with them.

    Parameters
    ----------
    images : sequence of Path

    Returns
    -------
    pair, photos : tuple of Path
        Where no two or three images stand out as a pair, all are in ``pair``.

    Raises
    ------
    ImageError
        If one cannot be read.
    """
    of_size = {}
    for image in images:
        of_size.setdefault(image_size(image), []).append(image)
    groups = [group for group in of_size.values() if len(group) in (2, 3)]
    if len(groups) > 1:
        # Photos of one camera are of one size, too, but all of them have colors.
        groups = [group for group in groups if sum(map(_has_colors, group)) <= len(group) - 2]
    if len(groups) != 1:
        return tuple(images), ()
    return tuple(groups[0]), tuple(image for image in images if image not in groups[0])


def previewed(pair):
    """Return the `PairPreview` of images, everything guessed that is not said.

    Raises
    ------
    ScanError
        If the images cannot be told apart, or what is said of them is not valid.
    ImageError
        If one cannot be read.
    """
    range_image, reflectance_image, color_image = _told_apart(pair)
    values, opaque = read_measured(range_image)
    there = np.isfinite(values) & (values != 0 if opaque is None else opaque)
    if full := full_code(values, there):
        there &= values != full
    model = pair.model or _guessed_model(values.shape)
    # Blender's properties are float32: what was typed as 0.001 is 0.0010000000474974513.
    model = {key: _as_typed(value) for key, value in model.items()}
    content = {
        "range_image": range_image,
        "reflectance_image": reflectance_image,
        "color_image": color_image,
        "model": model,
        "color_order": None if pair.color_order == "rgb" else pair.color_order,
    }
    if pair.range_table is not None:
        content["range_table"] = [list(map(_as_typed, row)) for row in pair.range_table]
    else:
        scale = _guessed_scale(values, there) if pair.range_scale is None else pair.range_scale
        content["range_scale"] = _as_typed(scale)
    said = [
        Message("range: {image}, {bits} bits", image=range_image.name, bits=8 * values.dtype.itemsize),
        Message("reflectance: {image}", image=reflectance_image.name),
    ]
    if color_image is not None:
        said.append(Message("color: {image}", image=color_image.name))
    said.append(_sensor_said(model))
    size, doubts = _looked_at(content, values, there)
    if values.dtype == np.uint8 and pair.range_scale is None and pair.range_table is None:
        guess = (
            "8 bits do not give their scale; {most:g} m is a guess for the brightest value: give a scale, or a table"
        )
        doubts = [Message(guess, most=_FULL_SCALE_M), *doubts]
    return PairPreview(content=content, said=tuple(said + size), doubts=tuple(doubts))


def describe_pair(pair):
    """Write the ``.scan.json`` of a `Pair` beside its images.

    Returns
    -------
    path : Path
        The file written: named after both images, so that the same pair is described anew and no other file is lost.
    doubts : tuple of Message
        What makes no sense.

    Raises
    ------
    ScanError, ImageError
        As `previewed`.
    OutputError
        If the folder cannot be written to.
    """
    preview = previewed(pair)
    range_image, reflectance_image = preview.content["range_image"], preview.content["reflectance_image"]
    path = reflectance_image.with_name(f"{reflectance_image.stem}+{range_image.stem}.scan.json")
    write_scan_json(path, **preview.content)
    return path, preview.doubts


def _told_apart(pair):
    """(range, reflectance, color or None): by the names, else by colors that differ and by the bits."""
    images, color = [Path(image) for image in pair.images], None
    if len(images) == 3:
        named = [path for path in images if any(word in path.stem.lower() for word in _COLOR_WORDS)]
        color = named[0] if len(named) == 1 else next((path for path in images if _has_colors(path)), None)
        if color is None:
            raise ScanError(
                '{first}: one of three images has to hold the colors; put "rgb" into its name', first=images[0]
            )
        images.remove(color)
    if len(images) != 2:
        raise ScanError("{first}: pick a range and a reflectance image together", first=images[0].name)
    named = [any(word in path.stem.lower() for word in _RANGE_WORDS) for path in images]
    if named[0] == named[1]:
        depths = [read_measured(path)[0].dtype.itemsize for path in images]
        if depths[0] == depths[1]:
            raise ScanError(
                '{first}, {second}: cannot tell which is the range image; put "depth" or "range" into its file name',
                first=images[0].name,
                second=images[1].name,
            )
        named = [depths[0] > depths[1], depths[1] > depths[0]]
    return (*(images if named[0] != pair.swap else images[::-1]), color)


def _has_colors(path):
    """Whether its channels differ."""
    try:
        read_measured(path)
    except ImageError:
        return True
    return False


def _guessed_model(shape):
    """The sensor that images of this shape most likely come from."""
    height, width = shape
    if width < _PANORAMA * height:
        focal = _FOCAL * width
        return {"type": "pinhole", "fx": focal, "fy": focal, "cx": (width - 1) / 2, "cy": (height - 1) / 2}
    # For a full turn with square pixels.
    half = 90.0 if width < _SPHERE * height else min(90.0, 180.0 * height / width)
    return {"type": "spherical", "azimuth_deg": (-180.0, 180.0), "elevation_deg": (-half, half)}


def _guessed_scale(values, there):
    """Meters for one unit: floating point holds meters, unless they are thousands; whole numbers millimeters."""
    seen = values[there]
    if values.dtype == np.uint8:
        # Eight bits cannot hold millimeters; the largest value is assumed to be the far side of a large room.
        return _FULL_SCALE_M / 255
    if values.dtype.kind == "f":
        return _MILLIMETERS if seen.size and np.median(seen) > _FARTHEST_M / 10 else 1.0
    return _MILLIMETERS


def _sensor_said(model):
    if model["type"] == "pinhole":
        return Message("pinhole, focal length {focal:.0f} pixels", focal=model["fx"])
    left, right = model["azimuth_deg"]
    bottom, top = model["elevation_deg"]
    return Message(
        "spherical, {across:.0f} degrees across, from {bottom:.0f} to {top:.0f} degrees up",
        across=abs(right - left),
        bottom=bottom,
        top=top,
    )


def _looked_at(content, values, there):
    """What a person should see of the result, and what makes no sense of it."""
    written = {
        "format": "reflcolor-scan",
        "version": 1,
        **{key: value for key, value in content.items() if value is not None and not key.endswith("_image")},
        "range": content["range_image"].name,
        "reflectance": content["reflectance_image"].name,
    }
    written["model"] = {k: list(v) if isinstance(v, tuple) else v for k, v in written["model"].items()}
    description = check_description(written, content["range_image"].name)
    distance = np.where(there, description.meters(np.where(there, values, 0)), 0.0)
    there = there & (distance > 0)
    if not there.any():
        return [], [Message("no pixel has a range")]
    points = description.model.points(distance, description.range_type)
    some = tuple(slice(None, None, max(1, size // _LOOKED_AT)) for size in there.shape)
    seen = points[some][there[some]]
    seen = seen if len(seen) else points[there]
    away = np.sqrt((seen**2).sum(axis=-1))
    width, depth, height = np.ptp(seen, axis=0)
    size = [
        Message("mesh: {width:.2f} x {depth:.2f} x {height:.2f} m", width=width, depth=depth, height=height),
        Message("{near:.2f} to {far:.2f} m away", near=away.min(), far=away.max()),
    ]
    return size, _doubts(content["model"], distance, there, float(np.median(away)))


def _doubts(model, distance, there, usual):
    """What makes no sense of a scene at a usual distance, in meters."""
    if not _NEAREST_M < usual < _FARTHEST_M:
        yield Message("its points are {usual:.3g} m away; check the range's scale", usual=usual)
    if model["type"] != "spherical":
        return
    across = abs(model["azimuth_deg"][1] - model["azimuth_deg"][0])
    up = abs(model["elevation_deg"][1] - model["elevation_deg"][0])
    height, width = there.shape
    shape = across / width / (up / height)
    if not 1 / _STRETCHED < shape < _STRETCHED:
        yield Message("its pixels would be {shape:.2g} times as wide as high; check the angles", shape=shape)
    if across < 350:
        return
    if usual < _SMALLEST_ROOM_M:
        yield Message(
            "all around, its points are {usual:.2f} m away, as in a bowl; check the sensor and the range's scale",
            usual=usual,
        )
    if _seam(distance, there) > _SEAM:
        yield Message(
            "its left and right edges do not meet, as they would in a full turn; it may be a camera's image: "
            "choose Pinhole"
        )


def _seam(distance, there):
    """How far the first and last column are apart, as a share of what any two columns are; 0 where too few tell."""

    def apart(one, other):
        both = there[:, one] & there[:, other]
        return np.median(np.abs(np.log(distance[both, one] / distance[both, other]))) if both.sum() > 8 else math.nan

    width = there.shape[1]
    any_two = [apart(col, (col + width // 2) % width) for col in range(0, width, max(1, width // 16))]
    usual = np.nanmedian(any_two) if not np.isnan(any_two).all() else 0.0
    seam = apart(0, width - 1)
    return float(seam / usual) if usual > 0 and np.isfinite(seam) else 0.0


def _as_typed(value):
    """The number of six digits that a float32 stands for; sequences by their parts, anything else as it is."""
    if isinstance(value, tuple | list):
        return [_as_typed(part) for part in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value
