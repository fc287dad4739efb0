"""The small file beside a range and a reflectance image that says what they are: `garage.scan.json`."""

import json
import math
import os
from dataclasses import dataclass
from numbers import Real
from pathlib import Path

import numpy as np

from ...errors import OutputError, ScanError
from ...messages import Message, one_line
from ...scan.limits import FARTHEST_M, STRONGEST
from ...scan.scan import is_plausible
from ..atomic import written_atomically
from ..json_files import read_json
from .sensor_models import DEPTH, RAY, Beams, Pinhole, Spherical

FORMAT = "reflcolor-scan"
VERSION = 1
EXPECTED = Message("a JSON description of a scan")
LARGEST_FILE = 1 << 22
_TEXTS = ("range", "reflectance", "color", "name", "range_type", "color_order")
_KEYS = ("format", "version", *_TEXTS, "range_scale", "range_offset", "range_table", "model", "pose")
_LONGEST_QUOTE = 60
# What a sensor can plausibly be: meters of one unit, focal lengths and center in pixels, coefficients of a lens.
_SCALES = (1e-12, 1e6)
_CAMERA = {"fx": (1e-3, 1e7), "fy": (1e-3, 1e7), "cx": (-1e7, 1e7), "cy": (-1e7, 1e7)}
_BENT = 1e6
_NARROWEST_DEG = 1e-6
_MOST_BEAMS = 65536
_REQUIRED = ("range", "reflectance", "model")


@dataclass(frozen=True, kw_only=True)
class Description:
    """What a `.scan.json` says, checked.

    Parameters
    ----------
    range, reflectance : str
        Image files, relative to the description.
    color : str, optional
    model : Pinhole, Spherical or Beams
    range_scale, range_offset : float
        Meters = value * scale + offset. The scale may be missing where the image holds meters as floating point.
    range_table : (N, 2) float64, optional
        Instead of scale and offset, for images whose values are no linear measure (equalized, companded): values, and
        the meters that they stand for, linear in between.
    range_type : "depth" or "ray"
        Along the viewing axis, or along the ray of the pixel.
    color_order : "rgb" or "bgr"
        "bgr" for color images whose red and blue are swapped.
    name : str, optional
    pose : (4, 4) float64
        Scanner to world, column-vector convention.
    """

    range: str
    reflectance: str
    model: Pinhole | Spherical | Beams
    range_type: str
    color: str | None = None
    range_scale: float | None = None
    range_offset: float = 0.0
    range_table: np.ndarray | None = None
    color_order: str = "rgb"
    name: str | None = None
    pose: np.ndarray | None = None

    @property
    def files(self):
        """Names of the files that it names, each once; of an array in a file that of the file."""
        named = filter(None, (self.range, self.reflectance, self.color))
        return list(dict.fromkeys(file_and_array(name)[0] for name in named))

    def meters(self, values):
        """(H, W) float64 of (H, W) pixel values."""
        if self.range_table is not None:
            return np.interp(values, *self.range_table.T)
        return values.astype(np.float64) * (self.range_scale or 1.0) + self.range_offset


def file_and_array(name):
    """Return (file, array) of a name: ``frame.npz#range`` names an array in a file, any other a file alone."""
    file, mark, array = name.partition("#")
    return (file, array) if file.lower().endswith((".npz", ".npy")) and (mark or file == name) else (name, None)


def load_description(path):
    """Read and check a `.scan.json`.

    Raises
    ------
    ScanError
        One line that names the key.
    """
    return check_description(read_json(path, EXPECTED, error=ScanError, most=LARGEST_FILE), path.name)


def write_scan_json(
    path,
    *,
    range_image,
    reflectance_image,
    model,
    range_scale=None,
    color_image=None,
    range_offset=None,
    range_table=None,
    range_type=None,
    color_order=None,
    name=None,
    pose=None,
):
    """Write the description of an image pair, so that it opens by one path.

    Parameters
    ----------
    path : path-like
        Ends in ``.scan.json``. The images are named relative to it where they share a drive.
    range_image, reflectance_image, color_image : path-like
    model : dict
        ``{"type": "pinhole", "fx", "fy", "cx", "cy"}`` in pixels, or
        ``{"type": "spherical", "azimuth_deg": [left, right], "elevation_deg": [bottom, top]}``, or
        ``{"type": "beams", "azimuth_deg": [left, right], "elevation_deg": [of each row], "azimuth_offset_deg": [of
        each row]}``.
    range_scale, range_offset, range_table, range_type, color_order, name, pose : optional
        As in `Description`.

    Raises
    ------
    ScanError
        If the description would not be accepted when read.
    OutputError
        If it cannot be written.
    """
    path = Path(path)
    if not path.name.lower().endswith(".scan.json"):
        raise OutputError("{file}: expected a name that ends in .scan.json", file=path)
    content = {
        "format": FORMAT,
        "version": VERSION,
        "name": name,
        "range": _relative(range_image, path),
        "range_scale": range_scale,
        "range_offset": range_offset,
        "range_table": None if range_table is None else np.asarray(range_table, np.float64).tolist(),
        "range_type": range_type,
        "reflectance": _relative(reflectance_image, path),
        "color": None if color_image is None else _relative(color_image, path),
        "color_order": color_order,
        "model": model,
        "pose": None if pose is None else np.asarray(pose, np.float64).tolist(),
    }
    content = {key: value for key, value in content.items() if value is not None}
    check_description(content, path.name)
    with written_atomically(path) as temporary:
        temporary.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", "utf-8")


def check_description(content, file_name):
    """Make a Description of the parsed JSON; ScanError in one line that names the key if it is none."""
    check = _Check(file_name)
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ScanError('{file}: expected a JSON object with "format": "{format}"', file=file_name, format=FORMAT)
    if content.get("version") != VERSION or isinstance(content["version"], bool):
        expected = Message("{version} (this file needs a newer release)", version=VERSION)
        check.fail("version", expected, content.get("version"))
    check.keys(content, _KEYS, _REQUIRED)
    texts = {key: check.text(key, content[key]) for key in _TEXTS if key in content}
    model = check.model(content["model"])
    choices = (DEPTH, RAY) if isinstance(model, Pinhole) else (RAY,)
    texts["range_type"] = check.choice("range_type", texts.get("range_type", model.default_range_type), choices)
    check.choice("color_order", texts.get("color_order", "rgb"), ("rgb", "bgr"))
    numbers = {}
    if "range_table" in content:
        if "range_scale" in content or "range_offset" in content:
            raise ScanError(
                "{file}: range_table: replaces range_scale and range_offset; give one or the other",
                file=file_name,
            )
        numbers["range_table"] = check.table(content["range_table"])
    if "range_scale" in content:
        numbers["range_scale"] = check.number("range_scale", content["range_scale"], *_SCALES)
    if "range_offset" in content:
        numbers["range_offset"] = check.number("range_offset", content["range_offset"])
    if "pose" in content:
        numbers["pose"] = check.pose(content["pose"])
    return Description(model=model, **texts, **numbers)


class _Check:
    """Values of one JSON file; every failure is one line with the file, the key, what was expected and found."""

    def __init__(self, file_name):
        self._file_name = file_name

    def fail(self, key, expected, found):
        raise ScanError(
            "{file}: {key}: expected {expected}, found {found}",
            file=self._file_name,
            key=key,
            expected=expected,
            found=one_line(json.dumps(found), _LONGEST_QUOTE),
        )

    def keys(self, content, known, required, prefix=""):
        for key in content:
            if key not in known:
                raise ScanError(
                    "{file}: {key}: unknown key, expected one of {known}",
                    file=self._file_name,
                    key=prefix + one_line(key, _LONGEST_QUOTE),
                    known=", ".join(known),
                )
        for key in required:
            if key not in content:
                raise ScanError("{file}: {key}: is missing", file=self._file_name, key=prefix + key)

    def text(self, key, value):
        if not isinstance(value, str) or not value.strip() or not value.isprintable():
            self.fail(key, Message("a text in one line"), value)
        return value

    def choice(self, key, value, choices):
        if value not in choices:
            self.fail(key, " or ".join(f'"{choice}"' for choice in choices), value)
        return value

    def number(self, key, value, low=-FARTHEST_M, high=FARTHEST_M):
        number = math.nan
        if isinstance(value, Real) and not isinstance(value, bool) and abs(value) < 1e300:
            number = float(value)
        if not low <= number <= high:
            self.fail(key, Message("a number from {low:,.12g} to {high:,.12g}", low=low, high=high), value)
        return number

    def span(self, key, value, low, high, widest):
        if not isinstance(value, list) or len(value) != 2:
            self.fail(key, Message("two numbers in degrees"), value)
        first, last = (self.number(key, end, low, high) for end in value)
        if not _NARROWEST_DEG <= abs(last - first) <= widest:
            self.fail(key, Message("two numbers 0.000001 to {widest} degrees apart", widest=widest), value)
        return first, last

    def model(self, value):
        if not isinstance(value, dict):
            self.fail("model", Message("an object with a type"), value)
        kind = self.choice("model.type", value.get("type"), ("pinhole", "spherical", "beams"))
        if kind == "beams":
            return self.beams(value)
        if kind == "spherical":
            names = ("azimuth_deg", "elevation_deg")
            self.keys(value, ("type", *names), names, "model.")
            return Spherical(
                azimuth_deg=self.span("model.azimuth_deg", value["azimuth_deg"], -720, 720, 360),
                elevation_deg=self.span("model.elevation_deg", value["elevation_deg"], -90, 90, 180),
            )
        names = tuple(_CAMERA)
        self.keys(value, ("type", *names, "distortion"), names, "model.")
        lens = value.get("distortion", [])
        if not isinstance(lens, list) or len(lens) not in (0, 4, 5, 8):
            self.fail("model.distortion", Message("4, 5 or 8 numbers: k1, k2, p1, p2, k3, k4, k5, k6"), lens)
        return Pinhole(
            **{key: self.number(f"model.{key}", value[key], *_CAMERA[key]) for key in names},
            distortion=tuple(self.number("model.distortion", number, -_BENT, _BENT) for number in lens),
        )

    def beams(self, value):
        names = ("azimuth_deg", "elevation_deg")
        self.keys(value, ("type", *names, "azimuth_offset_deg"), names, "model.")
        elevation = self.angles("model.elevation_deg", value["elevation_deg"], 90)
        offset = self.angles("model.azimuth_offset_deg", value.get("azimuth_offset_deg", []), 180)
        if not elevation or len(offset) not in (0, len(elevation)):
            self.fail("model.azimuth_offset_deg", Message("as many numbers as elevation_deg has"), len(offset))
        return Beams(
            azimuth_deg=self.span("model.azimuth_deg", value["azimuth_deg"], -720, 720, 360),
            elevation_deg=elevation,
            azimuth_offset_deg=offset,
        )

    def angles(self, key, value, most):
        """A tuple of degrees, one for each row."""
        if not isinstance(value, list) or len(value) > _MOST_BEAMS:
            self.fail(key, Message("a list of degrees, one for each row"), value)
        return tuple(self.number(key, number, -most, most) for number in value)

    def table(self, value):
        expected = Message("a list of at least two [value, meters] with growing values")
        if not isinstance(value, list) or len(value) < 2 or not all(isinstance(p, list) and len(p) == 2 for p in value):
            self.fail("range_table", expected, value)
        key = "range_table"
        table = np.array(
            [(self.number(key, stored, -STRONGEST, STRONGEST), self.number(key, meters)) for stored, meters in value]
        )
        if (np.diff(table[:, 0]) <= 0).any():
            self.fail("range_table", expected, value)
        return table

    def pose(self, value):
        if not isinstance(value, list) or [len(row) if isinstance(row, list) else 0 for row in value] != [4] * 4:
            self.fail("pose", Message("4 rows of 4 numbers"), value)
        pose = np.array([[self.number("pose", number) for number in row] for row in value])
        if (pose[3] != [0, 0, 0, 1]).any() or not is_plausible(pose):
            self.fail(
                "pose",
                Message(
                    "a matrix that can be inverted, with 0 0 0 1 as its last row and at most {most:g} m",
                    most=FARTHEST_M,
                ),
                value,
            )
        return pose


def _relative(image, path):
    """POSIX style relative to the folder of `path`; absolute where there is no such way, between drives."""
    try:
        return Path(os.path.relpath(Path(image).absolute(), path.absolute().parent)).as_posix()
    except ValueError:
        return Path(image).absolute().as_posix()
