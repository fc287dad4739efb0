"""The verb ``colorize``: from scans and seeds, or photos, to colored files."""

from pathlib import Path

from ...batch.inputs import photo_files, scan_files
from ...batch.outputs import IMAGE_SUFFIXES, SCENE_SUFFIXES, check_outputs, scene_outputs
from ...batch.results import Job, is_scene, timed, write_results
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
from ...files.images import read_image
from ...seeds.seeds import Seeds
from ..options import add_matching, add_photos, add_propagation, add_scans, settings_of

NAME = "colorize"
HELP = "color scans from seeds or photos"


def add_arguments(parser):
    """Declare what ``colorize`` takes."""
    add_scans(parser)
    parser.add_argument(
        "--seeds",
        metavar="SEEDS.json",
        type=Path,
        help="pixels whose color is known; without this they are found in the photos, as the verb seeds does it",
    )
    add_photos(parser, "photos that the seeds name (else looked for beside the seeds' file), or to find seeds in")
    add_propagation(parser)
    add_matching(parser)
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        type=Path,
        action="append",
        required=True,
        help=f"file to write, once for each: {', '.join(IMAGE_SUFFIXES)} (colorized reflectance image), "
        f"or in Blender {', '.join(SCENE_SUFFIXES)}",
    )
    parser.add_argument("--render", metavar="PNG", type=Path, help="picture of the colored mesh (in Blender)")
    parser.add_argument("--report", metavar="JSON", type=Path, help="what was done, and a hash of every input")


def run(arguments, session):
    """Colorize a scan, or all scans of a site alike, and write every output; all that can be checked beforehand is.

    Of several scans each has files of its own: {scan} in the path of --seeds, --report and -o OUT.png stands for its
    name. Scenes and --render hold all scans; with {scan} in the path there is one for each.
    """
    settings = settings_of(arguments)
    if arguments.seeds is None and not arguments.photo:
        raise UsageError("--seeds or --photo: give seeds, or photos to find them in")
    check_choice(arguments.input, arguments.wanted)
    scene_outputs(arguments.output, arguments.render, session.blender)
    outputs = [("-o", path) for path in arguments.output]
    outputs += [(f"--{name}", path) for name in ("render", "report") if (path := getattr(arguments, name)) is not None]
    times = {}
    jobs = _jobs(arguments, outputs, settings, session, times)
    write_results(jobs, outputs, settings, session, times)


def _jobs(arguments, outputs, settings, session, times):
    """Every scan with its seeds; after this only memory and the disk can fail."""
    photos = arguments.photo
    of_each = [output for output in outputs if not is_scene(*output)]
    of_each += [("--seeds", path) for path in filter(None, [arguments.seeds])]
    check_placeholder(of_each, len(arguments.input))
    given = None
    with timed(times, "seeds"):
        if arguments.seeds is not None and PLACEHOLDER not in str(arguments.seeds):
            given = [_load_seeds(arguments.seeds, photos, session)]
            _check_photos(photos, given, session)
    inputs = _inputs(arguments.input, photos, arguments.seeds, given and given[0])
    check_outputs(known_beforehand(outputs), [path for _, path in inputs])

    with timed(times, "read"):
        places = read_site(arguments.input, arguments.wanted, session)
    check_placeholder(of_each, len(places))
    paths = [arguments.seeds and place.filled(arguments.seeds) for place in places]
    if arguments.seeds is not None:
        with timed(times, "seeds"):
            given = given or _seeds_of_each(places, paths, photos, session)
        for place, path, seeds in zip(places, paths, given, strict=True):
            check_place(seeds, path, place.scan)
    inputs = [
        _inputs([place.path], photos, path, seeds)
        for place, path, seeds in zip(places, paths, given or paths, strict=True)
    ]
    check_outputs(filled_for_all(outputs, places), [path for own in inputs for _, path in own])
    if given is not None:
        return [Job(*job) for job in zip(places, given, inputs, strict=True)]
    with timed(times, "match"):
        found = match_places(places, photos, settings, session)
    for _, lines in found:
        for line in lines:
            session.console.print(line)
    return [
        Job(place, matching.seeds, own, matching.photos)
        for place, (matching, _), own in zip(places, found, inputs, strict=True)
    ]


def _seeds_of_each(places, paths, photos, session):
    for place, path in zip(places, paths, strict=True):
        if not path.is_file():
            raise SeedsError(f"{path}: no such file; expected the seeds of the scan {place.scan.name}")
    given = [_load_seeds(path, photos, session) for path in paths]
    _check_photos(photos, given, session)
    return given


def _load_seeds(path, photos, session):
    seeds = Seeds.load(path, photos)
    if len(seeds) == 0:
        raise SeedsError(f"{path}: holds no seeds; give at least one pixel with a color")
    if all(reason == "appearance" for reason in seeds.reason):
        session.warnings.append(f"{path}: every color is a guess by likeness; none was seen or picked")
    return seeds


def _check_photos(photos, given, session):
    """Every photo that was given must be an image, and one that serves nothing is told."""
    named = {Path(name).name for seeds in given for name in seeds.photos if name}
    for path in photos:
        read_image(path)
        if path.name not in named:
            session.warnings.append(f"{path}: no seed names this photo")


def _inputs(scan_paths, photos, seeds_path, seeds):
    """(role, path) of every file that colors are from; ``seeds`` is None where they are not known."""
    inputs = [("scan", file) for path in scan_paths for file in scan_files(path)]
    if seeds is None:
        return inputs + [("photo", path) for path in dict.fromkeys(photos)]
    return [*inputs, ("seeds", seeds_path), *(("photo", path) for path in photo_files(seeds, seeds_path, photos))]
