"""The verb ``evaluate``: how far a result's colors are from the true ones."""

import json
import math
from pathlib import Path

from ...batch.read import choose_scan
from ...color.evaluation import evaluate
from ...errors import ImageError, ScanError
from ...files.images import read_image
from ...files.readers import SCAN_SUFFIXES
from ..options import add_reading, reading_of

NAME = "evaluate"
HELP = "measure colors against the true ones"
FORMAT = "reflcolor-evaluation"
VERSION = 1
_TITLES = {"as_is": "as is", "after_gain": "exposed alike", "color_alone": "color alone"}


def add_arguments(parser):
    """Declare what ``evaluate`` takes."""
    parser.add_argument("input", metavar="SCAN", type=Path, help=f"scan file: {', '.join(SCAN_SUFFIXES)}")
    parser.add_argument("result", metavar="RESULT.png", type=Path, help="colorized image, of the size of the grid")
    parser.add_argument(
        "--truth", metavar="IMAGE", type=Path, help="true colors, of the same size; by default the scan's own"
    )
    parser.add_argument(
        "--scan",
        dest="wanted",
        metavar="NAME_OR_INDEX",
        help="which scan of the file: its name, or its index as info prints it, counted from 1",
    )
    add_reading(parser)
    parser.add_argument("--json", action="store_true", help="print JSON instead of text")


def run(arguments, session):
    """Print how far the colors of a result are from the true ones, over the pixels that have both."""
    scans = session.read_scans(arguments.input, outside=arguments.outside_files, options=reading_of(arguments))
    index, scan = choose_scan(scans, arguments.wanted, arguments.input)
    session.warnings += scan.warnings
    rgb = _image_of(scan, arguments.result, session.warnings)
    if arguments.truth is not None:
        truth, compared = _image_of(scan, arguments.truth, session.warnings), scan.valid
    elif scan.color is not None:
        # Scanners write black where they saw no color.
        truth, compared = scan.color, scan.valid & scan.color.any(axis=-1)
    else:
        raise ScanError(
            "{input}: the scan {scan} has no colors of its own; give --truth IMAGE",
            input=arguments.input,
            scan=scan.name,
        )
    session.progress(0.5, f"Comparing {arguments.result.name}")
    figures = evaluate(rgb, truth, compared)
    if arguments.json:
        document = {"format": FORMAT, "version": VERSION, "scan": {"name": scan.name, "index": index}, **figures}
        session.say(json.dumps(_finite(document), indent=2, allow_nan=False))
    else:
        session.say(_as_text(figures))


def _image_of(scan, path, warnings):
    image = read_image(path, warnings)
    if image.shape[:2] != scan.shape:
        (rows, columns), (height, width) = scan.shape, image.shape[:2]
        raise ImageError(
            "{path}: is {width} x {height} pixels, but the scan {scan} has {columns} columns x {rows} rows; "
            "they must be the same",
            path=path,
            width=width,
            height=height,
            scan=scan.name,
            columns=columns,
            rows=rows,
        )
    return image


def _as_text(figures):
    lines = [f"{figures['pixels']} pixels compared", "CIEDE2000         mean    95 %   chrominance PSNR"]
    for name, title in _TITLES.items():
        found = figures[name]
        lines.append(
            f"{title:<14}{found['ciede2000_mean']:>8.2f}{found['ciede2000_p95']:>8.2f}   "
            f"{found['chrominance_psnr_db']:.2f} dB"
        )
    similarity = figures["structural_similarity"]
    text = "no window of 7 x 7 pixels is whole" if similarity is None else f"{similarity:.2f}"
    return "\n".join([*lines, f"structural similarity of the luminance: {text}"])


def _finite(document):
    """The document with None for what is infinite, which JSON has no word for."""
    if isinstance(document, dict):
        return {key: _finite(value) for key, value in document.items()}
    return None if isinstance(document, float) and not math.isfinite(document) else document
