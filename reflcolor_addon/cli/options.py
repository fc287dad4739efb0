"""Options that several verbs share, and the settings that they make."""

import argparse
from dataclasses import replace
from pathlib import Path

from ..errors import SettingsError, UsageError
from ..settings import (
    ALPHA_RANGE,
    BETA_RANGE,
    COLOR_SPACES,
    MATCHINGS,
    MAX_NEAREST,
    NEIGHBORS,
    PRESETS,
    TONE_RANGE,
    Settings,
)

_SCAN_HELP = "which scan of a file of several: its name, its index as info prints it (counted from 1), or all"
_PROPAGATION = ("alpha", "beta", "color_space", "neighbors", "nearest", "smoothing", "kriging", "tone")
_MATCHING = (
    ("slic_segments", int, "superpixels that the scan, and each photo, is divided into"),
    ("slic_compactness", float, "of the superpixels; higher makes them squarer"),
    ("slic_sigma", float, "pixels by which the image is smoothed before it is divided"),
    ("hog_cell", int, "pixels of a cell of the descriptor"),
    ("hog_block", int, "cells of a block of the descriptor"),
    ("hog_orientations", int, "directions of the descriptor"),
    ("hog_window", int, "pixels of the descriptor's window"),
)
_ALL = "all"


def add_scans(parser):
    """The scan files, and which scan of a single one."""
    parser.add_argument(
        "input",
        metavar="SCAN",
        type=Path,
        nargs="+",
        help="scan file: .ptx, .e57 or .scan.json; of several, of one site, every scan is taken",
    )
    parser.add_argument("--scan", dest="wanted", metavar="NAME_OR_INDEX", help=_SCAN_HELP)


def add_photos(parser, help_text):
    """Photos, any number after one option or after several."""
    parser.add_argument("--photo", metavar="IMAGE", type=Path, nargs="+", action="extend", default=[], help=help_text)


def add_propagation(parser):
    """How colors spread from the seeds; what is not given is the preset's."""
    default = Settings()
    parser.add_argument(
        "--preset",
        type=_preset,
        choices=tuple(PRESETS),
        default="Paper",
        help="where the settings start from (default %(default)s)",
    )
    parser.add_argument(
        "--alpha",
        type=float,
        help="gain of the weights, {:g} to {:g} (Paper: {:g})".format(*ALPHA_RANGE, default.alpha),
    )
    parser.add_argument(
        "--beta",
        type=float,
        help="gain of the range, {:g} to {:g}; 0 leaves the range out (Paper: {:g})".format(*BETA_RANGE, default.beta),
    )
    parser.add_argument(
        "--color-space", choices=COLOR_SPACES, help=f"where colors are blended (Paper: {default.color_space})"
    )
    parser.add_argument(
        "--neighbors",
        type=int,
        choices=NEIGHBORS,
        help=f"pixels that a path may step to (Paper: {default.neighbors})",
    )
    parser.add_argument(
        "--nearest",
        type=_nearest,
        metavar="K",
        help='seeds that color a pixel: "all", a number for its nearest ones, or "auto": all where that is quick, '
        "else as many as it takes to be close to that (Paper: auto)",
    )
    parser.add_argument("--smoothing", type=float, metavar="PIXELS", help="of the reflectance (Paper: 0)")
    parser.add_argument("--kriging", type=float, metavar="SHARE", help="of kriging in the colors, 0 to 1 (Paper: 0)")
    parser.add_argument(
        "--tone",
        type=float,
        metavar="GAMMA",
        help="above 1 the colors are lighter, below 1 darker, {:g} to {:g} (default {:g})".format(
            *TONE_RANGE, default.tone
        ),
    )


def add_matching(parser):
    """How seeds are found in photos."""
    default = Settings()
    parser.add_argument(
        "--matching",
        choices=MATCHINGS,
        help=f"by a camera that is verified, or as the paper does it (default {default.matching})",
    )
    group = parser.add_argument_group("superpixels and descriptors")
    for name, kind, help_text in _MATCHING:
        option = f"--{name.replace('_', '-')}"
        group.add_argument(option, type=kind, metavar="N", help=f"{help_text} (default {getattr(default, name):g})")


def settings_of(arguments):
    """Return the Settings that the options say; an option that was not given leaves the preset's value.

    Raises
    ------
    UsageError
        If a value is out of its range.
    """
    preset = getattr(arguments, "preset", "Paper")
    settings = Settings.preset(preset)
    if settings.nearest is None:
        # All seeds of a large scan can take minutes, so here the paper's exactness has to be asked for.
        settings = replace(settings, nearest="auto")
    names = (*_PROPAGATION, "matching", *(name for name, _, _ in _MATCHING))
    given = {name: value for name in names if (value := getattr(arguments, name, None)) is not None}
    if given.get("nearest") == _ALL:
        given["nearest"] = None
    try:
        return replace(settings, **given)
    except SettingsError as error:
        name, _, expected = str(error).partition(":")
        raise UsageError(f"--{name.replace('_', '-')}:{expected}") from error


def _preset(text):
    return next((name for name in PRESETS if name.casefold() == text.casefold()), text)


def _nearest(text):
    if text in (_ALL, "auto"):
        return text
    try:
        number = int(text)
    except ValueError:
        number = 0
    if not 1 <= number <= MAX_NEAREST:
        raise argparse.ArgumentTypeError(
            f'expected "{_ALL}", "auto" or a whole number from 1 to {MAX_NEAREST}, found {text}'
        )
    return number
