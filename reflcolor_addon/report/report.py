"""The report of a run: inputs, settings and outputs, complete enough to repeat it."""

import functools
import hashlib
import importlib.metadata
import json
import math
import os
import platform
from datetime import UTC, datetime
from pathlib import Path

from ..errors import Cancelled
from ..files.atomic import written_atomically
from ..files.gate import opened, size_of
from ..files.readers.options import AS_IT_IS
from ..messages import Message
from ..scan.normalization import PERCENTILES
from ..version import __version__

FORMAT = "reflcolor-report"
VERSION = 1
REPORT_OPTION = "--report"
"""The option of a report among its own outputs; it tells no hash of itself."""
# Packages that a result depends on.
_PACKAGES = ("numpy", "scipy", "scikit-image", "opencv-python-headless", "pye57")
_CHUNK_BYTES = 1 << 20


def build_report(
    scan,
    colorization,
    settings,
    *,
    given_seeds,
    inputs,
    outputs=(),
    photos=(),
    noticed=(),
    light=None,
    blender=None,
):
    """Describe a colorization; the same work on the same machine gives the same report.

    Parameters
    ----------
    scan : dict
        From `scan_entry`.
    colorization : Colorization
    settings : Settings
    given_seeds : Seeds
        The seeds before any was moved.
    inputs : list of dict
        From `input_entry`.
    outputs : sequence of (str, Path)
        The option that asked for it, and the file.
    photos : sequence of dict
        From `photo_entry`: what became of each photo that seeds were looked for in. The attribute ``photo`` of a mesh
        counts them from 0; ``observed`` tells how many pixels have their color from each.
    noticed : sequence of str
        Warnings from before the colorization.
    light : LightMesh, optional
        What meshes show instead of the scan's own.
    blender : str, optional
        Blender's version.

    Returns
    -------
    dict
        Ready for JSON, with no number that is not finite.
    """
    colored = int(((colorization.nearest_seed >= 0) | (colorization.observed > 0)).sum())
    return {
        "format": FORMAT,
        "version": VERSION,
        "scan": scan,
        "settings": settings.as_dict(),
        "seeds": seed_entries(colorization.seeds, given_seeds),
        "photos": [entry | {"observed": _led(colorization, number)} for number, entry in enumerate(photos)],
        "normalization": {
            "percentiles": list(PERCENTILES),
            "reflectance": list(colorization.normalization["reflectance"]),
            "range_m": list(colorization.normalization["range"]),
        },
        "result": {
            "colored": colored,
            "unreached": scan["returns"] - colored,
            "observed": int((colorization.photo >= 0).sum()),
            "guessed": colorization.seeds.all_guessed,
            "mean_confidence": round(float(colorization.confidence.sum()) / max(scan["returns"], 1), 4),
        },
        **({} if light is None else {"mesh": {"faces": len(light.triangles), "faces_before": light.whole}}),
        "method": colorization.method,
        "warnings": [*noticed, *colorization.warnings],
        "inputs": list(inputs),
        "outputs": [{"option": option, "path": str(path)} for option, path in outputs],
        "versions": versions(blender),
    }


def _led(colorization, number):
    return int((colorization.photo == number).sum())


def stamped(report):
    """Return the report with the time that it is now, as ``created``, in UTC."""
    return report | {"created": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")}


def scan_entry(scan, index, reading=AS_IT_IS):
    """Return what a report says of a scan.

    Parameters
    ----------
    scan : Scan
    index : int
        The scan's place in its file, from 1.
    reading : ReadOptions
        How its file was read.
    """
    rows, columns = scan.shape
    flips = {"vertical": reading.flip_vertical, "horizontal": reading.flip_horizontal}
    read_as = {name: value for name, value in reading.as_dict().items() if not name.startswith("flip_")}
    return {
        "name": scan.name,
        "index": index,
        "rows": rows,
        "columns": columns,
        "returns": int(scan.valid.sum()),
        "full_turn": scan.full_turn,
        "flipped": [name for name, chosen in flips.items() if chosen],
    } | ({"reading": read_as} if read_as else {})


def input_entry(role, path, cancelled=None):
    """Return what a report says of an input: what it is for ("scan", "seeds", "photo"), where it is, size and hash.

    Raises
    ------
    ReflcolorError
        If it cannot be read.
    Cancelled
        If ``cancelled()`` returned True.
    """
    return {"role": role, "path": str(path)} | fingerprint(path, cancelled)


def write_report(path, report):
    """Write a report as JSON; the file is whole or not there.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    text = json.dumps(report, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    with written_atomically(path) as temporary:
        # A file name that is no text comes out as JSON's own escapes.
        temporary.write_bytes(text.encode("utf-8", "backslashreplace"))


def output_entry(option, path, report_path, cancelled=None):
    """Return what a report says of an output that is there: size and hash, and where it is.

    Parameters
    ----------
    option : str
        What asked for it.
    path : Path
    report_path : Path
        Where the report goes. ``from_report`` is the way from its folder to the output, with slashes, so that a folder
        of results can be moved; where there is no such way, between drives, it is the whole path.
    cancelled : callable, optional

    Raises
    ------
    ReflcolorError
        If it cannot be read.
    Cancelled
        If ``cancelled()`` returned True.
    """
    try:
        way = os.path.relpath(path, report_path.parent)
    except ValueError:
        way = path.absolute()
    entry = {"option": option, "path": str(path), "from_report": Path(way).as_posix()}
    return entry | fingerprint(path, cancelled)


def photo_entry(photo):
    """Return what a report says of a PhotoMatch."""
    names = ("name", "verified", "tested", "reason", "note")
    return {name: getattr(photo, name) for name in names}


def seed_entries(seeds, given):
    """Return one dictionary for each seed as it was used.

    ``photo``, ``x``, ``y`` tell where its color is from (None: given directly), ``moved_from`` the pixel that was asked
    for where that had no return (None: not moved).
    """
    entries = []
    for index, photo in enumerate(seeds.photos):
        used, asked = ({"row": int(those.rows[index]), "col": int(those.cols[index])} for those in (seeds, given))
        x, y = (None if math.isnan(value) else value for value in seeds.photo_xy[index].tolist())
        color = {"rgb": seeds.rgb[index].tolist(), "photo": photo, "x": x, "y": y}
        confidence = seeds.confidence[index].item()
        found = {"confidence": None if math.isnan(confidence) else confidence, "reason": seeds.reason[index]}
        entries.append(used | color | found | {"moved_from": None if asked == used else asked})
    return entries


def fingerprint(path, cancelled=None):
    """Return the size and the SHA-256 of a file, as ``{"bytes": ..., "sha256": ...}``; raises as `input_entry`."""
    digest = hashlib.sha256()
    with opened(path, Message("an ordinary file"), may_be_empty=True) as file:
        size = left = size_of(file)
        while left and (chunk := file.read(min(left, _CHUNK_BYTES))):
            if cancelled is not None and cancelled():
                raise Cancelled
            digest.update(chunk)
            left -= len(chunk)
    return {"bytes": size - left, "sha256": digest.hexdigest()}


def versions(blender=None):
    """Return the versions of everything that a result depends on; None for what is not installed."""
    return {
        "reflcolor": __version__,
        "blender": blender,
        "python": platform.python_version(),
        "platform": platform.platform(),
        **{name: _package_version(name) for name in _PACKAGES},
    }


@functools.cache
def _package_version(name):
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None
