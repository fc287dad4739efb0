"""The verb ``colorize``: from a scan and seeds to colored files."""

import json
import time
from contextlib import contextmanager
from pathlib import Path

from ..atomic import written_atomically
from ..colorize import colorize
from ..image_files import read_image, write_png
from ..inputs import photo_files, scan_files
from ..outputs import IMAGE_SUFFIXES, SCENE_SUFFIXES, check_outputs, scene_outputs, tracked
from ..report import build_report
from ..seeds import Seeds
from ..settings import ALPHA_RANGE, BETA_RANGE, COLOR_SPACES, NEIGHBORS, Settings
from .session import choose_scan

NAME = "colorize"
HELP = "color a scan from seeds"


def add_arguments(parser):
    """Declare what ``colorize`` takes."""
    default = Settings()
    parser.add_argument("scan", metavar="SCAN", type=Path, help="scan file: .ptx, .e57 or .scan.json")
    parser.add_argument("--seeds", metavar="SEEDS.json", type=Path, required=True, help="pixels whose color is known")
    parser.add_argument(
        "--photo",
        metavar="IMAGE",
        type=Path,
        nargs="+",
        action="extend",
        default=[],
        help="photos that the seeds name; without this they are looked for beside the seeds' file",
    )
    parser.add_argument(
        "--alpha",
        type=float,
        default=default.alpha,
        help="gain of the weights, {:g} to {:g} (default %(default)g)".format(*ALPHA_RANGE),
    )
    parser.add_argument(
        "--beta",
        type=float,
        default=default.beta,
        help="gain of the range, {:g} to {:g}; 0 leaves the range out (default %(default)g)".format(*BETA_RANGE),
    )
    parser.add_argument(
        "--color-space",
        choices=COLOR_SPACES,
        default=default.color_space,
        help="where colors are blended (default %(default)s)",
    )
    parser.add_argument(
        "--neighbors",
        type=int,
        choices=NEIGHBORS,
        default=default.neighbors,
        help="pixels that a path may step to (default %(default)s)",
    )
    parser.add_argument(
        "--nearest",
        type=_nearest,
        default="auto",
        metavar="K",
        help='seeds that color a pixel: "all", a number for its nearest ones, or "auto": all where that takes about two '
        "seconds, else as many as it takes to be close to that (default auto)",
    )
    parser.add_argument(
        "--scan",
        dest="wanted",
        metavar="NAME_OR_INDEX",
        help="which scan of the file: its name, or its index as info prints it, counted from 1",
    )
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
    settings = Settings(
        alpha=arguments.alpha,
        beta=arguments.beta,
        color_space=arguments.color_space,
        neighbors=arguments.neighbors,
        nearest=arguments.nearest,
    )
    scene_paths = scene_outputs(arguments.output, arguments.render, session.scene_writer)
    times = {}
    with _timed(times, "seeds"):
        seeds = _load_seeds(arguments, session)
    inputs = [
        *(("scan", path) for path in scan_files(arguments.scan)),
        ("seeds", arguments.seeds),
        *(("photo", path) for path in photo_files(seeds, arguments.seeds, arguments.photo)),
    ]
    outputs = [("-o", path) for path in arguments.output]
    outputs += [(f"--{name}", path) for name in ("render", "report") if (path := getattr(arguments, name)) is not None]
    check_outputs(outputs, [path for _, path in inputs])

    with _timed(times, "read"):
        index, scan = choose_scan(session.read_scans(arguments.scan), arguments.wanted, arguments.scan)
    with _timed(times, "colorize"):
        colorization = colorize(scan, seeds, settings, progress=session.progress, cancelled=session.cancelled)
    session.warnings += [*scan.warnings, *colorization.warnings]
    report = None
    if scene_paths or arguments.render or arguments.report:
        report = build_report(
            scan,
            colorization,
            settings,
            index=index,
            given_seeds=seeds,
            inputs=inputs,
            outputs=outputs,
            blender=session.blender,
        )

    images = [path for path in arguments.output if path not in scene_paths]
    with tracked([path for _, path in outputs], session.written):
        with _timed(times, "write"):
            if scene_paths or arguments.render:
                session.scene_writer(scan, colorization, scene_paths, arguments.render, session.progress, report)
            for path in images:
                session.progress(1.0, f"Writing {path.name}")
                write_png(path, colorization.rgb)
        if arguments.report:
            session.progress(1.0, f"Writing {arguments.report.name}")
            _write_json(arguments.report, report | {"times_s": times})
    for _, path in outputs:
        session.console.print(f"wrote {path}")


def _nearest(text):
    """What follows --nearest, as a setting."""
    return {"all": None, "auto": "auto"}[text] if text in ("all", "auto") else int(text)


def _load_seeds(arguments, session):
    """The seeds; every photo that was given must be an image, and one that serves nothing is told."""
    seeds = Seeds.load(arguments.seeds, arguments.photo)
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
