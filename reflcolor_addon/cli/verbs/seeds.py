"""The verb ``seeds``: find seeds in photos."""

import argparse
from pathlib import Path

from ...batch.pipeline import run_plan
from ...batch.plan import MATCHES, SEEDS, Output, Plan
from ...errors import UsageError
from ...seeds.scan_colors import MOST_SEEDS
from ..options import add_matching, add_photos, add_scans, reading_of, settings_of

NAME = "seeds"
HELP = "find seeds in photos, or take them from the scan's own colors"


def add_arguments(parser):
    """Declare what ``seeds`` takes."""
    add_scans(parser)
    add_photos(parser, "photos to take colors from; any camera, any place")
    parser.add_argument(
        "--from-color",
        metavar="N",
        type=_count,
        help="take N seeds, evenly spread, from the colors that came with the scan instead",
    )
    parser.add_argument(
        "--hand",
        metavar="SEEDS.json",
        type=Path,
        help="seeds picked by hand, to keep; four to six with a point of a photo give its camera",
    )
    parser.add_argument("-o", "--output", metavar="SEEDS.json", type=Path, required=True, help="file to write")
    parser.add_argument("--matches", metavar="PNG", type=Path, help="picture of where each seed's color comes from")
    add_matching(parser)


def _count(text):
    count = int(text) if text.isdecimal() else 0
    if not 1 <= count <= MOST_SEEDS:
        raise argparse.ArgumentTypeError(f"expected a whole number from 1 to {MOST_SEEDS}, found {text}")
    return count


def run(arguments, session):
    """Find seeds of a scan, or of all scans of a site alike, in photos and write them; say what became of every photo.

    Of several scans each has files of its own: {scan} in the path of -o, --matches and --hand stands for its name.
    """
    of_photos = {"--photo": arguments.photo, "--hand": arguments.hand, "--matches": arguments.matches}
    if arguments.from_color is None and not arguments.photo:
        raise UsageError("--photo: give at least one photo to take colors from, or --from-color")
    for option in (option for option, given in of_photos.items() if given and arguments.from_color is not None):
        raise UsageError("{option}: does not apply to seeds from the scan's own colors (--from-color)", option=option)
    outputs = []
    for option, path, suffix, kind in (
        ("-o", arguments.output, ".json", SEEDS),
        ("--matches", arguments.matches, ".png", MATCHES),
    ):
        if path is not None and path.suffix.lower() != suffix:
            raise UsageError(
                "{option} {path}: expected a file that ends in {suffix}", option=option, path=path, suffix=suffix
            )
        if path is not None:
            outputs.append(Output(option, path, kind))
    plan = Plan(
        scans=tuple(arguments.input),
        wanted=arguments.wanted,
        outside_files=arguments.outside_files,
        reading=reading_of(arguments),
        hand=arguments.hand,
        from_color=arguments.from_color,
        photos=tuple(arguments.photo),
        settings=settings_of(arguments),
        outputs=tuple(outputs),
    )
    run_plan(plan, session)
