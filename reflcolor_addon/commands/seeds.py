"""The verb ``seeds``: find seeds of a scan in photos."""

from pathlib import Path

from ..errors import UsageError
from ..image_files import write_png
from ..inputs import scan_files
from ..outputs import check_outputs, tracked
from ..seeds import Seeds
from .options import add_matching, add_photos, add_scan, settings_of
from .session import choose_scan

NAME = "seeds"
HELP = "find seeds in photos"


def add_arguments(parser):
    """Declare what ``seeds`` takes."""
    add_scan(parser)
    add_photos(parser, "photos to take colors from; any camera, any place")
    parser.add_argument(
        "--hand",
        metavar="SEEDS.json",
        type=Path,
        help="seeds picked by hand, to keep; four to six with a point of a photo give its camera",
    )
    parser.add_argument("-o", "--output", metavar="SEEDS.json", type=Path, required=True, help="file to write")
    parser.add_argument("--matches", metavar="PNG", type=Path, help="picture of where each seed's color comes from")
    add_matching(parser)


def run(arguments, session):
    """Find seeds and write them; say of every photo what became of it."""
    from ..matching import draw_matches, match_photos

    settings = settings_of(arguments)
    if not arguments.photo:
        raise UsageError("--photo: give at least one photo to take colors from")
    if arguments.matches is not None and arguments.matches.suffix.lower() != ".png":
        raise UsageError(f"--matches {arguments.matches}: expected a file that ends in .png")
    inputs = [*scan_files(arguments.input), *arguments.photo, *filter(None, [arguments.hand])]
    outputs = [("-o", arguments.output), *(("--matches", path) for path in filter(None, [arguments.matches]))]
    check_outputs(outputs, inputs)
    hand = Seeds.load(arguments.hand, arguments.photo) if arguments.hand else None
    _, scan = choose_scan(session.read_scans(arguments.input), arguments.wanted, arguments.input)
    matching = match_photos(
        scan, arguments.photo, settings, hand=hand, progress=session.progress, cancelled=session.cancelled
    )
    session.warnings += [*scan.warnings, *matching.warnings]
    with tracked([path for _, path in outputs], session.written):
        matching.seeds.save(arguments.output)
        if arguments.matches is not None:
            write_png(arguments.matches, draw_matches(scan, arguments.photo, matching.seeds))
    for photo in matching.photos:
        session.console.print(f"{photo.name}: {photo.note}")
    session.console.print(f"wrote {arguments.output}: {len(matching.seeds)} seeds")
    if arguments.matches is not None:
        session.console.print(f"wrote {arguments.matches}")
