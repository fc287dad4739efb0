"""The verb ``info``: what is in a scan file."""

import json
import math
from pathlib import Path

from ...errors import UsageError
from ...files.readers import FORMATS, SCAN_SUFFIXES
from ...files.readers.e57_photos import photos_inside
from ...files.readers.formats import REFUSED
from ..options import add_reading, reading_of

NAME = "info"
HELP = "say what is in a scan file"
FORMAT = "reflcolor-info"
VERSION = 1


def add_arguments(parser):
    """Declare what ``info`` takes."""
    parser.add_argument("input", metavar="SCAN", type=Path, nargs="?", help=f"scan file: {', '.join(SCAN_SUFFIXES)}")
    add_reading(parser)
    parser.add_argument("--json", action="store_true", help="print JSON instead of text")
    parser.add_argument(
        "--formats", action="store_true", help="list the formats that can be read, and the way out of others"
    )


def run(arguments, session):
    """Print a description of every scan in the file, or the formats that can be read."""
    if arguments.formats:
        session.say("\n".join([*map(_format_line, FORMATS), *_refused_lines()]))
        return
    if arguments.input is None:
        raise UsageError("SCAN: name a scan file, or ask for --formats")
    scans = session.read_scans(arguments.input, outside=arguments.outside_files, options=reading_of(arguments))
    descriptions = [describe(index, scan) for index, scan in enumerate(scans, 1)]
    photos = photos_inside(arguments.input)
    if arguments.json:
        document = {"format": FORMAT, "version": VERSION, "file": str(arguments.input), "scans": descriptions}
        document["photos"] = [_photo_entry(photo) for photo in photos]
        session.say(json.dumps(document, indent=2, allow_nan=False))
    else:
        session.say("\n".join([*map(_as_text, descriptions), *_photo_lines(photos, arguments.input)]))
    session.warnings += [warning for scan in scans for warning in scan.warnings]


def _photo_entry(photo):
    size = photo.size or (None, None)
    return {
        "name": photo.name,
        "kind": photo.kind,
        "width": size[0],
        "height": size[1],
        "pose": None if photo.pose is None else photo.pose.tolist(),
        "usable": photo.usable,
    }


def _photo_lines(photos, path):
    """What else is inside an E57, and how to use it."""
    if not photos:
        return []
    count = "1 photo" if len(photos) == 1 else f"{len(photos)} photos"
    lines = [f"{count} inside; take colors from them by --photo {path}"]
    for photo in photos:
        size = "unknown size" if photo.size is None else f"{photo.size[0]} x {photo.size[1]} pixels"
        placed = "no pose" if photo.pose is None else "pose given"
        lines.append(f"   {photo.name}: {photo.kind}, {size}, {placed}{'' if photo.usable else '; cannot be used'}")
    return lines


def _format_line(kind):
    return f"{kind.name:<14} {', '.join(kind.suffixes):<31} {kind.about}"


def _refused_lines():
    """One line for each maker whose formats are not read."""
    makers = {}
    for suffix, way in REFUSED.items():
        makers.setdefault(way, []).append(suffix)
    return [f"{'not read':<14} {', '.join(suffixes):<31} {way}" for way, suffixes in makers.items()]


def describe(index, scan):
    """Return what ``info`` says about a scan, ready for JSON: angles in degrees, lengths in meters.

    Parameters
    ----------
    index : int
        Its place in the file, from 1.
    scan : Scan
    """
    rows, columns = scan.shape
    returns = int(scan.valid.sum())
    vertical, horizontal = (None if math.isnan(step) else step for step in scan.step_deg)
    return {
        "index": index,
        "name": scan.name,
        "rows": rows,
        "columns": columns,
        "returns": returns,
        "returns_share": returns / scan.valid.size,
        "range_m": _limits(scan.range[scan.valid]),
        "reflectance": _limits(scan.reflectance[scan.valid]),
        "step_deg": {"vertical": vertical, "horizontal": horizontal},
        "full_turn": scan.full_turn,
        "color": scan.color is not None,
        "position_m": scan.pose[:3, 3].tolist(),
        "pose": scan.pose.tolist(),
        "warnings": list(scan.warnings),
    }


def _limits(values):
    return [float(values.min()), float(values.max())] if values.size else None


def _as_text(description):
    steps = description["step_deg"]
    lines = {
        "grid": f"{description['rows']} rows x {description['columns']} columns",
        "returns": f"{description['returns']} ({description['returns_share']:.1%} of the pixels)",
        "range": _span(description["range_m"], ".3f", " m"),
        "reflectance": _span(description["reflectance"], ".6g"),
        "step": f"{_degrees(steps['vertical'])} between rows, {_degrees(steps['horizontal'])} between columns",
        "full turn": "yes" if description["full_turn"] else "no",
        "color": "yes" if description["color"] else "no",
        "position": ", ".join(f"{value:.3f}" for value in description["position_m"]) + " m",
    }
    head = f"{description['index']}  {description['name']}"
    return "\n".join([head, *(f"   {name:<12} {text}" for name, text in lines.items())])


def _span(limits, style, unit=""):
    return f"{limits[0]:{style}} to {limits[1]:{style}}{unit}" if limits else "unknown"


def _degrees(angle):
    return "unknown" if angle is None else f"{angle:.4f} deg"
