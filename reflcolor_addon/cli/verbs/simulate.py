"""The verb ``simulate``: from a scene of Blender to a scan of it, with photos and the truth."""

from pathlib import Path

from ...batch.blender_tasks import require_blender
from ...batch.paths import check_outputs
from ...errors import ReflcolorError, SettingsError, UsageError
from ...simulation.request import SimulationRequest
from ...simulation.virtual_scanner import ScannerModel

NAME = "simulate"
HELP = "scan a scene with a virtual scanner (in Blender)"
_SUFFIXES = (".ptx", ".e57", ".scan.json")
_PHOTO_SAMPLES = 32
_OPTIONS = {
    "rows and columns": "--rows and --columns",
    "rows x columns": "--rows x --columns",
    "elevation_deg": "--elevation-deg",
    "range_limits_m": "--greatest-range",
    "range_noise_m": "--range-noise",
    "reflectance_noise": "--reflectance-noise",
    "beam_deg": "--beam-deg",
    "dropout_rate": "--dropouts",
    "seed": "--seed",
}
"""The option that sets what a message of the scanner begins with."""


def add_arguments(parser):
    """Declare what ``simulate`` takes."""
    default = ScannerModel()
    parser.add_argument("input", metavar="SCENE.blend", type=Path, help="the scene")
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        type=Path,
        required=True,
        help=f"scan to write: {', '.join(_SUFFIXES)}; what else is written goes beside it, named after it",
    )
    station = parser.add_mutually_exclusive_group()
    station.add_argument(
        "--camera",
        metavar="NAME",
        help="the scanner stands at this camera, leveled, and looks as that does; by default the scene's",
    )
    station.add_argument(
        "--object", metavar="NAME", help="the scanner stands at this object and looks along its Y axis"
    )
    width = parser.add_mutually_exclusive_group()
    width.add_argument("--full-turn", action="store_true", help="scan all around")
    left, right = default.azimuth_deg
    width.add_argument(
        "--width-deg", type=float, default=right - left, metavar="W", help="width of the scan (default %(default)g)"
    )
    parser.add_argument(
        "--elevation-deg",
        type=float,
        nargs=2,
        default=default.elevation_deg,
        metavar=("LO", "HI"),
        help="bottom and top edge, up from the horizon (default {:g} {:g})".format(*default.elevation_deg),
    )
    for option, kind, value, text in (
        ("--rows", int, default.rows, "pixels from top to bottom"),
        ("--columns", int, default.columns, "pixels from left to right"),
        ("--greatest-range", float, default.range_limits_m[1], "nothing is measured beyond, meters"),
        ("--range-noise", float, default.range_noise_m, "standard deviation of the range of a bright surface, meters"),
        (
            "--reflectance-noise",
            float,
            default.reflectance_noise,
            "standard deviation of the reflectance, relative to it",
        ),
        ("--beam-deg", float, default.beam_deg, "width of the laser beam, which mixes surfaces at edges"),
        ("--dropouts", float, default.dropout_rate, "share of the pixels that give no return for no reason"),
        ("--seed", int, default.seed, "start of the random numbers; the same start gives the same scan"),
    ):
        parser.add_argument(option, type=kind, default=value, metavar="N", help=f"{text} (default %(default)g)")
    parser.add_argument("--truth", action="store_true", help="write the true color of every pixel of the scan")
    parser.add_argument("--photos", action="store_true", help="take a photo from every other camera of the scene")
    parser.add_argument(
        "--photo-samples",
        type=int,
        metavar="N",
        help=f"light paths for each pixel of a photo (default {_PHOTO_SAMPLES})",
    )
    parser.add_argument(
        "--plain-photos",
        action="store_true",
        help="photos without an exposure, white balance, lens distortion and noise of their own",
    )


def run(arguments, session):
    """Scan a scene with the virtual scanner and write the scan; if asked for, photos and the truth."""
    require_blender(session.blender, NAME)
    if not arguments.output.name.lower().endswith(_SUFFIXES):
        raise UsageError(
            "-o {output}: the suffix tells what to write; expected one of {choices}",
            output=arguments.output,
            choices=", ".join(_SUFFIXES),
        )
    for option, value in (("--photo-samples", arguments.photo_samples), ("--plain-photos", arguments.plain_photos)):
        if value and not arguments.photos:
            raise UsageError("{option} applies to photos; give --photos, too", option=option)
    if not arguments.input.is_file():
        raise ReflcolorError("{input}: no such file; expected a scene saved by Blender", input=arguments.input)
    request = SimulationRequest(
        scene=arguments.input,
        output=arguments.output,
        model=_scanner(arguments),
        camera=arguments.camera,
        item=arguments.object,
        truth=arguments.truth,
        photos=arguments.photos,
        photo_samples=_PHOTO_SAMPLES if arguments.photo_samples is None else arguments.photo_samples,
        own_look=not arguments.plain_photos,
    )
    if request.photo_samples < 1:
        raise UsageError(
            "--photo-samples: expected 1 or more, found {photo_samples}", photo_samples=request.photo_samples
        )
    check_outputs([("-o", arguments.output)], [arguments.input])
    session.blender.simulate(request, session.progress, session.written)
    for path in session.written:
        session.say(f"wrote {path}")


def _scanner(arguments):
    width = 360.0 if arguments.full_turn else arguments.width_deg
    if not 0 < width <= 360:
        raise UsageError("--width-deg: expected more than 0 and at most 360 degrees, found {width:g}", width=width)
    try:
        return ScannerModel(
            rows=arguments.rows,
            columns=arguments.columns,
            azimuth_deg=(-width / 2, width / 2),
            elevation_deg=tuple(arguments.elevation_deg),
            range_limits_m=(ScannerModel().range_limits_m[0], arguments.greatest_range),
            range_noise_m=arguments.range_noise,
            reflectance_noise=arguments.reflectance_noise,
            beam_deg=arguments.beam_deg,
            dropout_rate=arguments.dropouts,
            seed=arguments.seed,
        )
    except SettingsError as error:
        name, _, expected = str(error).partition(":")
        raise UsageError("{name}:{expected}", name=_OPTIONS.get(name, name), expected=expected) from error
