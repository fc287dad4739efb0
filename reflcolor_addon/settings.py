"""What a person can choose about a colorization."""

import math
from dataclasses import dataclass, fields, replace
from numbers import Integral, Real

from .errors import SettingsError

COLOR_SPACES = ("ycbcr", "yuv", "lalphabeta", "cielab")
NEIGHBORS = (4, 8)
ALPHA_RANGE = (0.1, 64.0)
BETA_RANGE = (0.0, 1e6)
MAX_NEAREST = 1024
PRESETS = {"Paper": {}}


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the colorization; the defaults are the paper's.

    Parameters
    ----------
    alpha : float, 0.1 to 64
        Gain of the weights, w = r^-alpha (eq. 2): higher means sharper borders between seeds.
    beta : float, 0 to 1e6
        Gain of the range image in a step (eq. 6); 0 leaves the range out (Yatziv's method, eq. 4).
    color_space : {"ycbcr", "yuv", "lalphabeta", "cielab"}
        Where the two chrominance channels are blended.
    neighbors : {4, 8}
        Which pixels a path may step to.
    nearest : int, "auto" or None
        How many of its nearest seeds color a pixel; None: all of them, as eq. 1 has it; "auto": all of them where
        that is quick, else as many as it takes to be close to that (see ``Colorization.method``).

    Raises
    ------
    SettingsError
        If a value is out of its range.
    """

    alpha: float = 6.0
    beta: float = 1.0
    color_space: str = "ycbcr"
    neighbors: int = 8
    nearest: int | str | None = None

    def __post_init__(self):
        _check_range("alpha", self.alpha, ALPHA_RANGE)
        _check_range("beta", self.beta, BETA_RANGE)
        if self.color_space not in COLOR_SPACES:
            raise SettingsError(f"color_space: expected one of {', '.join(COLOR_SPACES)}, found {self.color_space!r}")
        if self.neighbors not in NEIGHBORS:
            raise SettingsError(f"neighbors: expected 4 or 8, found {self.neighbors!r}")
        whole = isinstance(self.nearest, Integral) and not isinstance(self.nearest, bool)
        if self.nearest not in (None, "auto") and not (whole and 1 <= self.nearest <= MAX_NEAREST):
            raise SettingsError(
                f'nearest: expected a whole number from 1 to {MAX_NEAREST}, "auto", or None for all, '
                f"found {self.nearest!r}"
            )

    @classmethod
    def preset(cls, name, **changes):
        """Return the settings of that name ("Paper"), with the given changes.

        Raises
        ------
        SettingsError
            If there is no preset of that name.
        """
        if name not in PRESETS:
            raise SettingsError(f"preset: expected one of {', '.join(PRESETS)}, found {name!r}")
        return replace(cls(**PRESETS[name]), **changes)

    def as_dict(self):
        """Return name and value of every setting, in order, as they go into a report."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def _check_range(name, value, bounds):
    low, high = bounds
    number = isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)
    if not number or not low <= value <= high:
        raise SettingsError(f"{name}: expected a number from {low:g} to {high:g}, found {value!r}")
