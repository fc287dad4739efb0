"""The declaration of a setting, used by the settings themselves, the panel, the command line and the docs."""

import math
from dataclasses import dataclass, field, fields
from numbers import Integral, Real

from .errors import SettingsError
from .messages import Message

_YES_NO = {"yes": True, "no": False}


@dataclass(frozen=True)
class Choice:
    """One of the values that a setting can be chosen from.

    Parameters
    ----------
    value : object
        What the setting holds.
    label, help : str
        Its name and tooltip in the window: Title Case, and a sentence without a full stop.
    name : str, optional
        What a person types on the command line; by default the value itself.
    """

    value: object
    label: str
    help: str
    name: str = ""

    def __post_init__(self):
        if not self.name:
            object.__setattr__(self, "name", str(self.value))


@dataclass(frozen=True, kw_only=True)
class Setting:
    """Everything about one setting except its value.

    A setting is a number in a range, one of several choices, either of these, or yes or no.

    Parameters
    ----------
    name : str
        The field that holds it.
    default : object
    label, help : str
        Its name and tooltip in the window: Title Case, and a sentence without a full stop.
    group : str
        What it is a setting of, such as "propagation" or "matching".
    kind : type or None
        ``float``, ``int`` (whole numbers only) or ``bool``; None where only the choices are allowed.
    low, high : float
        The range of numbers, ends included.
    unit : str
        What the number counts: "pixels", "share" (of 1), or nothing.
    choices : tuple of Choice
    slider_high : float, optional
        Where a slider ends by default; a larger number has to be typed.
    slider_step : float, optional
        What a drag of the mouse changes.
    decimals : int, optional
        Decimal places shown.
    in_presets : bool
        Whether presets set it. What suits one scan and not another is left as it is.
    """

    name: str
    default: object
    label: str
    help: str
    group: str
    kind: type | None = None
    low: float = 0.0
    high: float = 0.0
    unit: str = ""
    choices: tuple[Choice, ...] = ()
    slider_high: float | None = None
    slider_step: float | None = None
    decimals: int | None = None
    in_presets: bool = True

    def check(self, value):
        """Raise SettingsError, with the values ``setting`` and ``found``, unless the setting may have this value."""
        chosen = isinstance(value, str | Integral | None) and any(value == choice.value for choice in self.choices)
        if not chosen and not (self.kind is not None and self._is_in_range(value)):
            raise SettingsError(
                "{setting}: expected {expected}, found {found!r}",
                setting=self.name,
                expected=self.expected(),
                found=value,
            )

    def named(self, name):
        """Return the value that a person means by a choice's name or by a number.

        Raises
        ------
        SettingsError
            If it is neither.
        """
        for choice in self.choices:
            if choice.name == name:
                return choice.value
        try:
            value = _YES_NO[name] if self.kind is bool else self.kind(name) if self.kind is not None else name
        except (ValueError, KeyError):
            value = name
        self.check(value)
        return value

    def name_of(self, value):
        """Return what a person types for a value."""
        if self.kind is bool:
            return next(name for name, meant in _YES_NO.items() if meant == value)
        names = [choice.name for choice in self.choices if choice.value == value]
        return names[0] if names else f"{value:g}" if isinstance(value, float) else str(value)

    def expected(self, *, named=False):
        """Return what values it can have, as a Message: "a number from 0.1 to 64".

        Parameters
        ----------
        named : bool
            Give the choices the names that a person types, not their Python values.
        """
        if self.kind is bool:
            return Message("yes or no")
        choices = ", ".join(choice.name if named else repr(choice.value) for choice in self.choices)
        if self.kind is None:
            return Message("one of {choices}", choices=choices)
        template = (
            "a whole number from {low:.7g} to {high:.7g}" if self.kind is int else "a number from {low:g} to {high:g}"
        )
        number = Message(template, low=self.low, high=self.high)
        return Message("{number}, or one of {choices}", number=number, choices=choices) if choices else number

    def _is_in_range(self, value):
        if self.kind is bool:
            return isinstance(value, bool)
        number = isinstance(value, Integral if self.kind is int else Real) and not isinstance(value, bool)
        # Compared first: a whole number of hundreds of digits cannot be asked whether it is finite.
        return number and self.low <= value <= self.high and math.isfinite(value)


def setting(default, **known):
    """Return the field of a dataclass that holds a setting; the parameters are those of `Setting` but its name."""
    return field(default=default, metadata={"setting": known})


def settings_of(cls):
    """Return the declarations of a dataclass, by name, in order."""
    return {
        entry.name: Setting(name=entry.name, default=entry.default, **entry.metadata["setting"])
        for entry in fields(cls)
        if "setting" in entry.metadata
    }


def parameter_lines(settings):
    """Return the declarations as the section "Parameters" of a docstring."""
    lines = []
    for declared in settings:
        number = declared.kind.__name__ if declared.kind else ""
        parts = [number] if number else []
        parts += [repr(choice.value) for choice in declared.choices]
        span = f", {declared.low:.7g} to {declared.high:.7g}" if declared.kind in (float, int) else ""
        unit = f" {declared.unit}" if declared.unit in {"pixels", "meters", "degrees"} else ""
        lines += [
            f"{declared.name} : {' or '.join(parts)}{span}{unit}, default {declared.default!r}",
            f"    {declared.help}.",
        ]
    return "\n".join(lines)
