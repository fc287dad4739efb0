"""The verb ``colorize``: from a scan and seeds, or photos, to colored files."""

import json
import time
from contextlib import contextmanager
from pathlib import Path

from ..atomic import written_atomically
from ..colorize import colorize
from ..errors import SeedsError, UsageError
from ..image_files import read_image, write_png
from ..inputs import photo_files, scan_files
from ..outputs import IMAGE_SUFFIXES, SCENE_SUFFIXES, check_outputs, scene_outputs, tracked
from ..report import build_report, input_entry, photo_entry, scan_entry, stamped
from ..seeds import Seeds
from .options import add_matching, add_photos, add_propagation, add_scan, settings_of
from .session import choose_scan

NAME = "colorize"
HELP = "color a scan from seeds or photos"


def add_arguments(parser):
    """Declare what ``colorize`` takes."""
    add_scan(parser)
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
    """Colorize one scan and write every output; all that can be checked beforehand is."""
    settings = settings_of(arguments)
    if arguments.seeds is None and not arguments.photo:
        raise UsageError("--seeds or --photo: give seeds, or photos to find them in")
    scene_paths = scene_outputs(arguments.output, arguments.render, session.blender)
    times = {}
    with _timed(times, "seeds"):
        seeds = _load_seeds(arguments, session) if arguments.seeds is not None else None
    inputs = [("scan", path) for path in scan_files(arguments.input)]
    if seeds is not None:
        inputs.append(("seeds", arguments.seeds))
        inputs += [("photo", path) for path in photo_files(seeds, arguments.seeds, arguments.photo)]
    else:
        inputs += [("photo", path) for path in dict.fromkeys(arguments.photo)]
    outputs = [("-o", path) for path in arguments.output]
    outputs += [(f"--{name}", path) for name in ("render", "report") if (path := getattr(arguments, name)) is not None]
    check_outputs(outputs, [path for _, path in inputs])

    with _timed(times, "read"):
        index, scan = choose_scan(session.read_scans(arguments.input), arguments.wanted, arguments.input)
    found_in = ()
    if seeds is None:
        with _timed(times, "match"):
            seeds, found_in = _found_seeds(scan, arguments.photo, settings, session)
    with _timed(times, "colorize"):
        colorization = colorize(scan, seeds, settings, progress=session.progress, cancelled=session.cancelled)
    session.warnings += [*scan.warnings, *colorization.warnings]
    report = None
    if scene_paths or arguments.render or arguments.report:
        report = build_report(
            scan_entry(scan, index),
            colorization,
            settings,
            given_seeds=seeds,
            photos=[photo_entry(photo) for photo in found_in],
            inputs=[input_entry(role, path, session.cancelled) for role, path in inputs],
            outputs=outputs,
            noticed=scan.warnings,
            blender=session.blender_version,
        )
        report = stamped(report)

    images = [path for path in arguments.output if path not in scene_paths]
    with tracked([path for _, path in outputs], session.written):
        with _timed(times, "write"):
            if scene_paths or arguments.render:
                session.blender.write_scene(scan, colorization, scene_paths, arguments.render, session.progress, report)
            for path in images:
                session.progress(1.0, f"Writing {path.name}")
                write_png(path, colorization.rgb)
        if arguments.report:
            session.progress(1.0, f"Writing {arguments.report.name}")
            _write_json(arguments.report, report | {"times_s": times})
    for _, path in outputs:
        session.console.print(f"wrote {path}")


def _found_seeds(scan, photos, settings, session):
    """Seeds found in photos, and what became of each photo."""
    from ..matching import match_photos

    matching = match_photos(scan, photos, settings, progress=session.progress, cancelled=session.cancelled)
    session.warnings += matching.warnings
    for photo in matching.photos:
        session.console.print(f"{photo.name}: {photo.note}")
    return matching.seeds, matching.photos


def _load_seeds(arguments, session):
    """The seeds; every photo that was given must be an image, and one that serves nothing is told."""
    seeds = Seeds.load(arguments.seeds, arguments.photo)
    if len(seeds) == 0:
        raise SeedsError(f"{arguments.seeds}: holds no seeds; give at least one pixel with a color")
    if all(reason == "appearance" for reason in seeds.reason):
        session.warnings.append(f"{arguments.seeds}: every color is a guess by likeness; none was seen or picked")
    for path in arguments.photo:
        read_image(path)
        if path.name not in {Path(name).name for name in seeds.photos if name}:
            session.warnings.append(f"{path}: no seed names this photo")
    return seeds


@contextmanager
def _timed(times, name):
    start = time.perf_counter()
    yield
    times[name] = round(time.perf_counter() - start, 3)


def _write_json(path, document):
    text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    with written_atomically(path) as temporary:
        # A file name that is no text comes out as JSON's own escapes.
        temporary.write_bytes(text.encode("utf-8", "backslashreplace"))
