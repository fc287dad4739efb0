"""Values of a batch's manifest that several tables may state: the last one counts; what is wrong is said with its line.

``chain`` are the tables of an item, that of all scans first.
"""

from dataclasses import replace
from difflib import get_close_matches

from ...errors import SettingsError, UsageError
from ...files.readers.options import AS_IT_IS, with_option
from ...matching import LARGEST
from ...messages import Message
from ...settings import DEFAULT_PRESET, PRESETS, SETTINGS
from ...view.fewer_faces import FEWEST_FACES, MOST_FACES
from ..plan import default_settings
from .manifest_table import last_value


def faces_of(chain):
    """How many triangles a light mesh has at most; None where none is asked for."""
    return _whole(chain, "faces", FEWEST_FACES, MOST_FACES)


def texture_of(chain):
    """How many texels an image of the photos' resolution has along its longer side; None where none is asked for."""
    return _whole(chain, "texture", 1, LARGEST)


def _whole(chain, key, least, most):
    found = last_value(chain, key, int, None)
    if found is None or least <= found <= most:
        return found
    table = next(table for table in reversed(chain) if key in table)
    template = "{key} {found}: expected a whole number from {least} to {most}"
    table.refuse(key, template, key=key, found=found, least=least, most=most)
    return None


def settings_of(chain):
    """The settings: of the preset, then table by table."""
    preset = last_value(chain, "preset", str, DEFAULT_PRESET)
    name = next((name for name in PRESETS if name.casefold() == preset.casefold()), None)
    if name is None:
        table = next(table for table in reversed(chain) if "preset" in table)
        table.refuse("preset", "preset {found!r}: expected one of {known}", found=preset, known=", ".join(PRESETS))
    settings = default_settings(name or DEFAULT_PRESET)
    for table in chain:
        for key, value in table.get("settings", dict, {}).items():
            settings = _with_setting(table, settings, key, value)
    return settings


def reading_of(chain):
    """How the scans of an item are read."""
    options = AS_IT_IS
    for table in chain:
        for key, value in table.get("reading", dict, {}).items():
            try:
                options = with_option(options, key, value)
            except UsageError as error:
                table.refuse(("reading", key), "reading: {problem}", problem=error.message)
    return options


def _with_setting(table, settings, key, value):
    if key not in SETTINGS:
        near = get_close_matches(key, SETTINGS, 1)
        hint = Message("; did you mean {name}?", name=near[0]) if near else ""
        table.refuse(("settings", key), "unknown setting {key!r}{hint}", key=key, hint=hint)
        return settings
    try:
        value = SETTINGS[key].named(value) if isinstance(value, str) else value
        return replace(settings, **{key: value})
    except SettingsError as error:
        table.refuse(("settings", key), "{problem}", problem=error.message)
        return settings
