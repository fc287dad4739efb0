"""The core's settings as Blender's properties, made from their declarations, and back."""

import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...reflcolor_addon.settings import DEFAULT_PRESET, MATCHING, PRESETS, PROPAGATION, SETTINGS, Settings

_SUBTYPES = {"share": "FACTOR"}
# The setting "nearest" is a number or one of two choices, which takes two properties: "blend" chooses between them.
_NUMBER = "nearest"
_BLEND = {
    "name": "Blend",
    "description": "Which seeds color a pixel",
    "items": (
        *((choice.name, choice.label, choice.help) for choice in SETTINGS["nearest"].choices),
        (_NUMBER, "Nearest", "Only a pixel's nearest seeds color it; quick with very many seeds"),
    ),
    "default": _NUMBER if isinstance(Settings.preset(DEFAULT_PRESET).nearest, int) else "auto",
}
# The property's initial number where the default is a choice.
_NEAREST = 8


def _property(setting, default, options):
    common = {"name": setting.label, "description": setting.help, "options": options}
    if setting.kind is None:
        items = tuple((choice.name, choice.label, choice.help) for choice in setting.choices)
        return EnumProperty(**common, items=items, default=setting.name_of(default))
    if setting.kind is bool:
        return BoolProperty(**common, default=default)
    common |= {"min": setting.low, "max": setting.high}
    common |= {"soft_max": setting.slider_high} if setting.slider_high is not None else {}
    if setting.kind is int:
        return IntProperty(**common, default=default if isinstance(default, int) else _NEAREST)
    # Blender counts the step in hundredths.
    common |= {"step": round(100 * setting.slider_step)} if setting.slider_step is not None else {}
    common |= {"precision": setting.decimals} if setting.decimals is not None else {}
    return FloatProperty(**common, default=default, subtype=_SUBTYPES.get(setting.unit, "NONE"))


def _properties(group, options=frozenset()):
    found, defaults = {}, Settings.preset(DEFAULT_PRESET)
    for name, setting in SETTINGS.items():
        if setting.group == group:
            if name == "nearest":
                found["blend"] = EnumProperty(**_BLEND, options=set(options))
            found[name] = _property(setting, getattr(defaults, name), set(options))
    return found


class ColorizeSettings:
    """The settings of a colorization, as properties of whatever holds them."""

    __annotations__ = _properties(PROPAGATION)


class MatchSettings:
    """The settings of the search for seeds in photos, as properties of whatever holds them."""

    __annotations__ = _properties(MATCHING)


class ColorizeArguments:
    """The settings of a colorization, as properties of an operator, which forgets them when it is called anew."""

    __annotations__ = _properties(PROPAGATION, {"SKIP_SAVE"})


class MatchArguments:
    """The settings of the search for seeds in photos, as properties of an operator, as above."""

    __annotations__ = _properties(MATCHING, {"SKIP_SAVE"})


COLORIZE_NAMES = tuple(ColorizeSettings.__annotations__)
MATCH_NAMES = tuple(MatchSettings.__annotations__)


def core_settings(operator, scene, names):
    """Return the core's Settings from the properties of an operator.

    What is not set there is taken over from the scene: the redo panel shows what was used.
    """
    for name in names:
        if not operator.properties.is_property_set(name):
            setattr(operator, name, getattr(scene.reflcolor, name))
    return _settings({name: getattr(operator, name) for name in names})


def keep_used_settings(operator, scene, names):
    """Have the scene's settings say what an operator used, which may have been changed in its redo panel."""
    for name in names:
        if getattr(scene.reflcolor, name) != getattr(operator, name):
            setattr(scene.reflcolor, name, getattr(operator, name))


def scene_settings(scene, names):
    """Return the core's Settings from the properties of a scene."""
    return _settings({name: getattr(scene.reflcolor, name) for name in names})


def _settings(chosen):
    if "blend" in chosen:
        blend = chosen.pop("blend")
        chosen["nearest"] = chosen["nearest"] if blend == _NUMBER else SETTINGS["nearest"].named(blend)
    return Settings(**{name: _core_value(SETTINGS[name], value) for name, value in chosen.items()})


def _core_value(setting, value):
    if not setting.kind:
        return setting.named(value)
    # Blender stores 0.6 in single precision; the shortest number with the same single-precision value is the intended
    # one.
    return float(str(np.float32(value))) if setting.kind is float else value


def take_over(holder, chosen, *, unset_only=False):
    """Set the properties that presets set to the core's Settings; with ``unset_only`` those that have no value yet.

    The paper's exact blending becomes Automatic, which is exact where that is quick.
    """
    for name, value in _properties_of(chosen).items():
        if not (unset_only and holder.is_property_set(name)):
            setattr(holder, name, value)


def active_preset(holder):
    """Return the name of the preset whose values the properties have; None where it is none's."""
    for name in PRESETS:
        values = _properties_of(Settings.preset(name))
        if all(_alike(getattr(holder, prop), value) for prop, value in values.items()):
            return name
    return None


def _alike(value, other):
    return np.float32(value) == np.float32(other) if isinstance(other, float) else value == other


def _properties_of(chosen):
    found = {}
    for name, setting in SETTINGS.items():
        value = getattr(chosen, name)
        if setting.group != PROPAGATION or not setting.in_presets:
            continue
        if name == "nearest":
            found["blend"] = _NUMBER if isinstance(value, int) else "auto"
            if not isinstance(value, int):
                continue
        found[name] = value if setting.kind else setting.name_of(value)
    return found
