"""The verb ``seeds``: find seeds in photos."""

from pathlib import Path

from ...batch.inputs import scan_files
from ...batch.outputs import check_outputs, tracked
from ...batch.site import (
    PLACEHOLDER,
    check_choice,
    check_place,
    check_placeholder,
    filled_for_all,
    known_beforehand,
    match_places,
    read_site,
)
from ...errors import SeedsError, UsageError
from ...files.images import write_png
from ...seeds.seeds import Seeds
from ..options import add_matching, add_photos, add_scans, settings_of

NAME = "seeds"
HELP = "find seeds in photos"


def add_arguments(parser):
    """Declare what ``seeds`` takes."""
    add_scans(parser)
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
    """Find seeds of a scan, or of all scans of a site alike, in photos and write them; say what became of every photo.

    Of several scans each has files of its own: {scan} in the path of -o, --matches and --hand stands for its name.
    """
    from ...matching import draw_matches

    settings = settings_of(arguments)
    photos = arguments.photo
    if not photos:
        raise UsageError("--photo: give at least one photo to take colors from")
    if arguments.output.suffix.lower() != ".json":
        raise UsageError(f"-o {arguments.output}: expected a file that ends in .json")
    if arguments.matches is not None and arguments.matches.suffix.lower() != ".png":
        raise UsageError(f"--matches {arguments.matches}: expected a file that ends in .png")
    check_choice(arguments.input, arguments.wanted)
    named = [("-o", arguments.output), ("--matches", arguments.matches), ("--hand", arguments.hand)]
    named = [(option, path) for option, path in named if path is not None]
    outputs = [(option, path) for option, path in named if option != "--hand"]
    check_placeholder(named, len(arguments.input))
    inputs = [file for path in arguments.input for file in scan_files(path)] + photos
    check_outputs(known_beforehand(outputs), [*inputs, *filter(None, [arguments.hand])])
    hand = None
    if arguments.hand is not None and PLACEHOLDER not in str(arguments.hand):
        hand = [Seeds.load(arguments.hand, photos)]

    places = read_site(arguments.input, arguments.wanted, session)
    check_placeholder(named, len(places))
    hand_paths = [place.filled(arguments.hand) for place in places] if arguments.hand is not None else []
    check_outputs(filled_for_all(outputs, places), [*inputs, *hand_paths])
    if arguments.hand is not None:
        hand = hand or _picked(hand_paths, arguments, session)
        for seeds, path, place in zip(hand, hand_paths, places, strict=True):
            if seeds is not None and len(seeds):
                check_place(seeds, path, place.scan)
    session.warnings += [warning for place in places for warning in place.scan.warnings]
    found = match_places(places, photos, settings, session, hand)
    lines = [line for _, notes in found for line in notes]
    with tracked([path for _, path in filled_for_all(outputs, places)], session.written):
        for place, (matching, _) in zip(places, found, strict=True):
            path = place.filled(arguments.output)
            matching.seeds.save(path)
            lines.append(f"wrote {path}: {len(matching.seeds)} seeds")
            if arguments.matches is not None:
                path = place.filled(arguments.matches)
                session.progress(1.0, f"Writing {path.name}")
                write_png(path, draw_matches(place.scan, photos, matching.seeds))
                lines.append(f"wrote {path}")
    for line in lines:
        session.console.print(line)


def _picked(paths, arguments, session):
    """Seeds picked by hand for each scan, None where the scan has no file; that one has is enough."""
    if not any(path.is_file() for path in paths):
        raise SeedsError(f"--hand {arguments.hand}: no scan has such a file; expected {' or '.join(map(str, paths))}")
    session.warnings += [
        f"{path}: no such file; nothing is picked by hand there" for path in paths if not path.is_file()
    ]
    return [Seeds.load(path, arguments.photo) if path.is_file() else None for path in paths]
