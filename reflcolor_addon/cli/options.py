"""Options that several verbs share, and the settings that they make."""

import argparse
from dataclasses import replace
from functools import partial
from pathlib import Path

from ..batch.plan import default_settings
from ..errors import SettingsError, UsageError
from ..files.readers import SCAN_SUFFIXES
from ..files.readers.options import ANGLE, AUTO, RETURNS, STORED, TURNS, UNITS, ReadOptions
from ..settings import DEFAULT_PRESET, MATCHING, PRESETS, PROPAGATION, SETTINGS
from ..view.picture import ARCHIVE, LOOKS

_SCAN_HELP = "which scan of a file of several: its name, its index as info prints it (counted from 1), or all"
_METAVARS = {"pixels": "PIXELS", "share": "SHARE"}


def add_scans(parser):
    """The scan files, and which scan of a single one."""
    parser.add_argument(
        "input",
        metavar="SCAN",
        type=Path,
        nargs="+",
        help=f"scan file: {', '.join(SCAN_SUFFIXES)}; of several, of one site, every scan is taken",
    )
    parser.add_argument("--scan", dest="wanted", metavar="NAME_OR_INDEX", help=_SCAN_HELP)
    add_reading(parser)


def add_reading(parser):
    """How to read a scan file, where the user knows better than the file."""
    group = parser.add_argument_group("reading scans")
    default = ReadOptions()
    group.add_argument(
        "--turn",
        type=int,
        choices=TURNS,
        default=default.turn_deg,
        help="turn the scan's image clockwise by so many degrees (default %(default)s)",
    )
    group.add_argument(
        "--flip",
        choices=("vertical", "horizontal"),
        action="append",
        default=[],
        help="turn the order of its rows, or of its columns, after that; may be given twice",
    )
    group.add_argument(
        "--unit",
        choices=(AUTO, *UNITS),
        default=default.unit,
        help="what the coordinates count (default %(default)s: meters, unless the points tell otherwise)",
    )
    group.add_argument(
        "--step",
        type=int,
        metavar="N",
        default=default.step,
        help="read every N-th row and column only; a large scan then takes 1/N² of the memory (default %(default)s)",
    )
    group.add_argument(
        "--returns",
        choices=RETURNS,
        default=default.returns,
        help="which of several returns of a pixel to take (default %(default)s)",
    )
    group.add_argument(
        "--grid",
        choices=(STORED, ANGLE),
        default=default.grid,
        help="the file's own grid, or one laid over its points by angle (default %(default)s)",
    )
    group.add_argument(
        "--position",
        type=float,
        nargs=3,
        metavar=("X", "Y", "Z"),
        help="where the scanner stood, in the file's coordinates; without this as the file says, or as is found",
    )
    group.add_argument(
        "--outside-files",
        action="store_true",
        help="let a .scan.json name images outside of its own folder; without this none is opened there",
    )


def reading_of(arguments):
    """Return the ReadOptions that the options say."""
    return ReadOptions(
        turn_deg=arguments.turn,
        flip_vertical="vertical" in arguments.flip,
        flip_horizontal="horizontal" in arguments.flip,
        unit=arguments.unit,
        step=arguments.step,
        returns=arguments.returns,
        grid=arguments.grid,
        position=None if arguments.position is None else tuple(arguments.position),
    )


def add_photos(parser, help_text):
    """Photos, any number after one option or after several; an E57 stands for the photos inside."""
    parser.add_argument("--photo", metavar="IMAGE", type=Path, nargs="+", action="extend", default=[], help=help_text)


def add_propagation(parser):
    """How colors spread from the seeds; what is not given is the preset's."""
    parser.add_argument(
        "--preset",
        type=_preset,
        choices=tuple(PRESETS),
        default=DEFAULT_PRESET,
        help="where the settings start from (default %(default)s)",
    )
    _add_settings(parser, PROPAGATION)


def add_matching(parser):
    """How seeds are found in photos."""
    _add_settings(parser.add_argument_group("finding seeds in photos"), MATCHING)


def add_picture(parser):
    """The picture to render, and how it shows the scans."""
    group = parser.add_argument_group("pictures (in Blender)")
    group.add_argument("--render", metavar="PNG", type=Path, help="picture of the colored mesh")
    group.add_argument(
        "--look",
        choices=LOOKS,
        default=ARCHIVE,
        help="archive: colors exactly as they are; lit: in even light (default %(default)s)",
    )
    group.add_argument(
        "--as-measured",
        action="store_true",
        help="show the measured surface alone: no hole is filled, no outline smoothed",
    )
    group.add_argument(
        "--keep-mixed",
        action="store_true",
        help="show returns of a beam that met two surfaces, too",
    )


def _add_settings(parser, group):
    """An option for each setting of a group."""
    default = default_settings(DEFAULT_PRESET).as_dict()
    of_what = DEFAULT_PRESET if group == PROPAGATION else "default"
    for name, setting in SETTINGS.items():
        if setting.group == group:
            text = f"{setting.help[0].lower()}{setting.help[1:]}"
            if setting.kind is bool:
                option = f"--{name.replace('_', '-')}"
                parser.add_argument(option, action=argparse.BooleanOptionalAction, default=argparse.SUPPRESS, help=text)
                continue
            text += f"; {setting.expected(named=True)}"
            parser.add_argument(
                f"--{name.replace('_', '-')}",
                type=partial(_value, setting),
                default=argparse.SUPPRESS,
                metavar=_METAVARS.get(setting.unit, "N") if setting.kind is not None else "NAME",
                help=f"{text} ({of_what}: {setting.name_of(default[name])})".replace("%", "%%"),
            )


def _value(setting, text):
    try:
        return setting.named(text)
    except SettingsError as error:
        raise argparse.ArgumentTypeError(f"expected {setting.expected(named=True)}, found {text}") from error


def settings_of(arguments):
    """Return the Settings that the options say; an option that was not given leaves the preset's value.

    Raises
    ------
    UsageError
        If a value is out of its range.
    """
    given = {name: value for name, value in vars(arguments).items() if name in SETTINGS}
    try:
        return replace(default_settings(getattr(arguments, "preset", DEFAULT_PRESET)), **given)
    except SettingsError as error:
        values = error.message.values
        option = f"--{values['setting'].replace('_', '-')}"
        raise UsageError(error.message.template, **values | {"setting": option}) from error


def _preset(text):
    return next((name for name in PRESETS if name.casefold() == text.casefold()), text)
