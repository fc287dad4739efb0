"""The verb ``info``: what is in a scan file."""

import json
import math
from pathlib import Path

from ..options import add_outside_files

NAME = "info"
HELP = "say what is in a scan file"
FORMAT = "reflcolor-info"
VERSION = 1


def add_arguments(parser):
    """Declare what ``info`` takes."""
    parser.add_argument("input", metavar="SCAN", type=Path, help="scan file: .ptx, .e57 or .scan.json")
    add_outside_files(parser)
    parser.add_argument("--json", action="store_true", help="print JSON instead of text")


def run(arguments, session):
    """Print a description of every scan in the file."""
    scans = session.read_scans(arguments.input, outside=arguments.outside_files)
    descriptions = [describe(index, scan) for index, scan in enumerate(scans, 1)]
    if arguments.json:
        document = {"format": FORMAT, "version": VERSION, "file": str(arguments.input), "scans": descriptions}
        session.say(json.dumps(document, indent=2, allow_nan=False))
    else:
        session.say("\n".join(_as_text(description) for description in descriptions))
    session.warnings += [warning for scan in scans for warning in scan.warnings]


def describe(index, scan):
    """Return what ``info`` says about a scan, ready for JSON: angles in degrees, lengths in metres.

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
