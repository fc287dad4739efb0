"""The verb ``colorize``: from scans and seeds, or photos, to colored files."""

import argparse
from functools import partial
from pathlib import Path

from ...batch.pipeline import run_plan
from ...batch.plan import IMAGE, MESH, RENDER, REPORT, RESULT_SUFFIXES, SCANS, SCENE, Output, Plan, result_output
from ...errors import UsageError
from ...matching import LARGEST
from ...view.fewer_faces import FEWEST_FACES, MOST_FACES
from ...view.picture import Picture
from ..options import add_matching, add_photos, add_picture, add_propagation, add_scans, reading_of, settings_of

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
    images, meshes, scans, scenes = (
        ", ".join(suffix for suffix, kind in RESULT_SUFFIXES.items() if kind == wanted)
        for wanted in (IMAGE, MESH, SCANS, SCENE)
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        type=Path,
        action="append",
        required=True,
        help=f"file to write, once for each: {images} (colorized reflectance image), {meshes} (colored mesh), "
        f"{scans} (the scans with colors, a copy of a file of that kind), or in Blender {scenes}",
    )
    parser.add_argument(
        "--texture",
        metavar="PIXELS",
        type=partial(_whole, 1, LARGEST),
        help="an image of so many pixels along its longer side with the detail of the photos: "
        "a .png has that size, a .glb and a .blend show it instead of colors at the vertices",
    )
    parser.add_argument(
        "--faces",
        metavar="N",
        type=partial(_whole, FEWEST_FACES, MOST_FACES),
        help="a light mesh of so many triangles at most for each scan, made in Blender, for a .blend, .glb, .usd, .ply "
        "or picture; its colors are an image that a .glb and a .blend show, of the scan's pixels or of --texture",
    )
    add_picture(parser)
    parser.add_argument("--report", metavar="JSON", type=Path, help="what was done, and a hash of every input")


def _whole(least, most, text):
    if not text.isdecimal() or not least <= int(text) <= most:
        raise argparse.ArgumentTypeError(f"expected a whole number from {least} to {most}, found {text}")
    return int(text)


def run(arguments, session):
    """Colorize a scan, or all scans of a site alike, and write every output; all that can be checked beforehand is.

    Of several scans each has files of its own: {scan} in the path of --seeds, --report and -o OUT.png stands for its
    name. Scenes and --render hold all scans; with {scan} in the path there is one for each.
    """
    outputs = [result_output(path) for path in arguments.output]
    if arguments.render is not None:
        if arguments.render.suffix.lower() != ".png":
            raise UsageError("--render {path}: expected a file that ends in .png", path=arguments.render)
        outputs.append(Output("--render", arguments.render, RENDER))
    if arguments.report is not None:
        outputs.append(Output("--report", arguments.report, REPORT))
    plan = Plan(
        scans=tuple(arguments.input),
        wanted=arguments.wanted,
        outside_files=arguments.outside_files,
        reading=reading_of(arguments),
        seeds=arguments.seeds,
        photos=tuple(arguments.photo),
        settings=settings_of(arguments),
        outputs=tuple(outputs),
        texture=arguments.texture,
        faces=arguments.faces,
        picture=Picture(look=arguments.look, filled=not arguments.as_measured, drop_mixed=not arguments.keep_mixed),
    )
    run_plan(plan, session)
