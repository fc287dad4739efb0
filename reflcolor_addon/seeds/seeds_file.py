"""The JSON file of seeds: reading it, with colors from the photos that it names, and writing it."""

import json
import math
import reprlib
from numbers import Integral, Real
from pathlib import Path

import numpy as np

from ..errors import SeedsError
from ..files.atomic import written_atomically
from ..files.gate import beside
from ..files.images import read_image
from ..files.json_files import read_json
from ..messages import Message
from .sources import SOURCES

FORMAT = "reflcolor-seeds"
VERSION = 1
_LARGEST_FILE = 1 << 28
_KEYS = ("row", "col", "rgb", "photo", "x", "y", "confidence", "reason", "locked")


def read_columns(path, photos):
    """Return what a file of seeds holds, by the names of the parameters of `Seeds`.

    Parameters and errors are those of `Seeds.load`.
    """
    return _SeedsFile(path, photos).columns()


def photos_named(path, photos):
    """Return the paths of the photos that a file of seeds names, as far as they are there; none if it cannot be read.

    Parameters are those of `read_columns`; the photos are not opened.
    """
    file = _SeedsFile(path, photos)
    try:
        names = [entry.get("photo") for entry in file.document()["seeds"] if isinstance(entry, dict)]
        found = [find_photo(name, path, photos) for name in dict.fromkeys(names) if isinstance(name, str) and name]
    except SeedsError:
        return []
    return [photo for photo in found if photo is not None]


def write_seeds(seeds, path):
    """Write seeds; the file is whole or not there.

    Parameters
    ----------
    seeds : Seeds
    path : path

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    entries = []
    columns = (seeds.rows, seeds.cols, seeds.rgb, seeds.photo_xy, seeds.confidence, seeds.locked)
    for row, col, rgb, (x, y), confidence, locked, photo, reason in zip(
        *(column.tolist() for column in columns), seeds.photos, seeds.reason, strict=True
    ):
        entry = {"row": row, "col": col, "rgb": rgb}
        if photo is not None and not math.isnan(x):
            entry |= {"photo": photo, "x": x, "y": y}
        if not math.isnan(confidence):
            entry["confidence"] = round(confidence, 3)
        if reason is not None:
            entry["reason"] = reason
        if locked:
            entry["locked"] = True
        entries.append(entry)
    lines = ",\n".join(f"  {json.dumps(entry, ensure_ascii=False)}" for entry in entries)
    text = f'{{"format": "{FORMAT}", "version": {VERSION}, "seeds": [\n{lines}\n]}}\n'
    with written_atomically(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def find_photo(name, seeds_path, photos):
    """Return the path of the photo that a file of seeds names; None where there is none.

    Parameters
    ----------
    name : str
    seeds_path : Path
        The file of seeds.
    photos : sequence of paths
        Photos that were given. Only their file names count, and as many folders as the name tells; they go before what
        is beside the file of seeds, in its folder or below; nothing else is opened because a file of seeds names it.

    Raises
    ------
    SeedsError
        If several of the given photos have that name.
    """
    given = sorted({Path(photo) for photo in photos if Path(photo).name == Path(name).name})
    tail = Path(name).parts
    given = [path for path in given if path.absolute().parts[-len(tail) :] == tail] or given
    if len(given) > 1:
        raise SeedsError(
            "{file}: photo {name} may be {one} or {other}; give them different names",
            file=seeds_path,
            name=name,
            one=given[0],
            other=given[1],
        )
    path = given[0] if given else beside(seeds_path, name)
    try:
        return path if path is not None and path.is_file() else None
    except (OSError, ValueError):  # a name that is too long to be a file's
        return None


def sample_photo(photo, x, y):
    """Return the (3,) uint8 color of the pixel of a photo that contains the point.

    Parameters
    ----------
    photo : (H, W, 3) uint8
    x, y : float
        Pixels from the top left corner.

    Raises
    ------
    SeedsError
        If the point is outside the photo.
    """
    height, width = photo.shape[:2]
    if not (0 <= x <= width and 0 <= y <= height):
        raise SeedsError(
            "point {x:g}, {y:g} is outside the photo ({width} x {height} pixels)", x=x, y=y, width=width, height=height
        )
    return photo[min(int(y), height - 1), min(int(x), width - 1)]


class _SeedsFile:
    """One reading of a JSON file of seeds."""

    def __init__(self, path, photos):
        self._path = path
        self._photos = photos
        self._images = {}

    def columns(self):
        document = self.document()
        entries = [self._entry(place, entry) for place, entry in enumerate(document["seeds"], 1)]
        rows, cols, rgb, photos, xy, confidence, reason, locked = zip(*entries, strict=True) if entries else ((),) * 8
        return {
            "rows": rows,
            "cols": cols,
            "rgb": rgb,
            "photos": photos,
            "photo_xy": np.array(xy, np.float64).reshape(-1, 2),
            "confidence": np.array(confidence),
            "reason": reason,
            "locked": np.array(locked, bool),
        }

    def document(self):
        """The document, with its outer form checked."""
        document = read_json(self._path, Message("a JSON file of seeds"), error=SeedsError, most=_LARGEST_FILE)
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise SeedsError('{file}: expected a JSON object with "format": "{format}"', file=self._path, format=FORMAT)
        if document.get("version") != VERSION:
            found = reprlib.repr(document.get("version"))
            raise SeedsError(
                '{path}: "version": expected {expected}, found {found}', path=self._path, expected=VERSION, found=found
            )
        if not isinstance(document.get("seeds"), list):
            raise SeedsError(
                '{path}: "seeds": expected a list, found {value}',
                path=self._path,
                value=reprlib.repr(document.get("seeds")),
            )
        return document

    def _entry(self, place, entry):
        where = f"{self._path}: seed {place}"
        if not isinstance(entry, dict):
            raise SeedsError(
                "{where}: expected an object with row, col and a color, found {entry}",
                where=where,
                entry=reprlib.repr(entry),
            )
        unknown = sorted(set(entry) - set(_KEYS))
        if unknown:
            raise SeedsError(
                "{where}: {key}: not a key of a seed; known are {choices}",
                where=where,
                key=unknown[0],
                choices=", ".join(_KEYS),
            )
        row, col = (self._number(where, entry, key, Integral) for key in ("row", "col"))
        photo, xy = None, (math.nan, math.nan)
        if "photo" in entry:
            photo = entry["photo"]
            if not isinstance(photo, str) or not photo:
                raise SeedsError(
                    "{where}: photo: expected a file name, found {photo}", where=where, photo=reprlib.repr(photo)
                )
            xy = tuple(float(self._number(where, entry, key, Real)) for key in ("x", "y"))
        if "rgb" in entry:
            rgb = entry["rgb"]
            whole = isinstance(rgb, list) and all(type(value) is int and 0 <= value <= 255 for value in rgb)
            if not whole or len(rgb) != 3:
                raise SeedsError(
                    "{where}: rgb: expected three whole numbers from 0 to 255, found {rgb}",
                    where=where,
                    rgb=reprlib.repr(rgb),
                )
        elif photo is not None:
            image = self._image(photo, where)
            try:
                rgb = sample_photo(image, *xy)
            except SeedsError as error:
                raise SeedsError("{where}: {photo}: {error}", where=where, photo=photo, error=error) from error
        else:
            raise SeedsError("{where}: expected a color: either rgb, or photo with x and y", where=where)
        confidence = float(self._number(where, entry, "confidence", Real)) if "confidence" in entry else math.nan
        reason = entry.get("reason")
        if reason is not None and reason not in SOURCES:
            raise SeedsError(
                "{where}: reason: expected one of {choices}, found {reason}",
                where=where,
                choices=", ".join(SOURCES),
                reason=reprlib.repr(reason),
            )
        locked = entry.get("locked", False)
        if not isinstance(locked, bool):
            raise SeedsError(
                "{where}: locked: expected true or false, found {found}", where=where, found=reprlib.repr(locked)
            )
        return row, col, rgb, photo, xy, confidence, reason, locked

    def _number(self, where, entry, key, kind):
        value = entry.get(key)
        if isinstance(value, bool) or not isinstance(value, kind) or not abs(value) < 1e9:
            expected = Message("a whole number" if kind is Integral else "a number")
            raise SeedsError(
                "{where}: {key}: expected {expected}, found {value}",
                where=where,
                key=key,
                expected=expected,
                value=reprlib.repr(value),
            )
        return value

    def _image(self, name, where):
        if name not in self._images:
            path = find_photo(name, self._path, self._photos)
            if path is None:
                raise SeedsError(
                    "{where}: photo {name} was not given and is not beside the seeds' file", where=where, name=name
                )
            self._images[name] = read_image(path)
        return self._images[name]
