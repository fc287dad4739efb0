"""The core's settings as Blender's properties, made from their declarations, and back."""

import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...reflcolor_addon.settings import DEFAULT_PRESET, MATCHING, PROPAGATION, SETTINGS, Settings

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
# The number that the property starts from, where the default is a choice.
_NEAREST = 8


def _property(setting, default):
    common = {"name": setting.label, "description": setting.help}
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


def _properties(group):
    found, defaults = {}, Settings.preset(DEFAULT_PRESET)
    for name, setting in SETTINGS.items():
        if setting.group == group:
            if name == "nearest":
                found["blend"] = EnumProperty(**_BLEND)
            found[name] = _property(setting, getattr(defaults, name))
    return found


class ColorizeSettings:
    """The settings of a colorization, as properties of whatever holds them."""

    __annotations__ = _properties(PROPAGATION)


class MatchSettings:
    """The settings of the search for seeds in photos, as properties of whatever holds them."""

    __annotations__ = _properties(MATCHING)


COLORIZE_NAMES = tuple(ColorizeSettings.__annotations__)
MATCH_NAMES = tuple(MatchSettings.__annotations__)


def core_settings(holder, fallback, names):
    """Return the core's Settings from properties; what is not set on the operator is taken from ``fallback``."""
    return _settings(
        {name: getattr(holder if holder.properties.is_property_set(name) else fallback, name) for name in names}
    )


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
    # Blender holds 0.6 in single precision; the shortest number that is stored so is the one that was meant.
    return float(str(np.float32(value))) if setting.kind is float else value


def take_over(holder, chosen, *, unset_only=False):
    """Set the properties that presets set to the core's Settings; with ``unset_only`` those that have no value yet.

    The paper's exact blending becomes Automatic, which is exact where that is quick.
    """
    for name, value in _properties_of(chosen).items():
        if not (unset_only and holder.is_property_set(name)):
            setattr(holder, name, value)


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
