"""What a person can choose about a colorization."""

import math
from dataclasses import dataclass, fields, replace
from numbers import Integral, Real

from .errors import SettingsError

COLOR_SPACES = ("ycbcr", "yuv", "lalphabeta", "cielab")
NEIGHBORS = (4, 8)
ALPHA_RANGE = (0.1, 64.0)
BETA_RANGE = (0.0, 1e6)
MATCHINGS = ("verified", "paper")
MAX_NEAREST = 1024
MAX_SMOOTHING = 16.0
TONE_RANGE = (0.2, 5.0)
PRESETS = {"Paper": {}, "Enhanced": {"alpha": 3.0, "nearest": 8, "smoothing": 1.0, "kriging": 0.6}}


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
    smoothing : float, 0 to 16
        Standard deviation, in pixels, of a Gaussian that the reflectance is smoothed by before anything is measured on
        it; the luminance of the result is not smoothed. The paper has none.
    kriging : float, 0 to 1
        Share of kriging (see ``kriging.py``) in the chrominance; the rest is eq. 1. The paper has none.
    tone : float, 0.2 to 5
        Gamma of the luminance of the result: above 1 it is lighter, below 1 darker, 1 is the reflectance as it is. No
        distance and no chrominance depends on it.
    matching : {"verified", "paper"}
        How seeds are found in photos: by a camera that is verified, or as published, by the most similar superpixels.
    slic_segments : int, 1 to 20000
        About how many superpixels the scan, and each photo, is divided into; there is at most one seed in each.
    slic_compactness : float, 0.001 to 100
        Higher makes them squarer.
    slic_sigma : float, 0 to 20
        Pixels by which the image is smoothed before.
    hog_cell, hog_block, hog_orientations, hog_window : int
        Of the descriptor: pixels a cell (2 to 64), cells a block (1 to 8), directions (2 to 36), and pixels of the
        window around a superpixel's center (at least a block, up to 256).

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
    smoothing: float = 0.0
    kriging: float = 0.0
    tone: float = 1.0
    matching: str = "verified"
    slic_segments: int = 500
    slic_compactness: float = 0.1
    slic_sigma: float = 1.0
    hog_cell: int = 8
    hog_block: int = 2
    hog_orientations: int = 9
    hog_window: int = 48

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
        _check_range("smoothing", self.smoothing, (0.0, MAX_SMOOTHING))
        _check_range("kriging", self.kriging, (0.0, 1.0))
        _check_range("tone", self.tone, TONE_RANGE)
        self._check_matching()

    def _check_matching(self):
        if self.matching not in MATCHINGS:
            raise SettingsError(f"matching: expected one of {', '.join(MATCHINGS)}, found {self.matching!r}")
        _check_range("slic_compactness", self.slic_compactness, (0.001, 100.0))
        _check_range("slic_sigma", self.slic_sigma, (0.0, 20.0))
        least_window = self.hog_cell * self.hog_block if _is_whole(self.hog_cell) and _is_whole(self.hog_block) else 2
        for name, low, high in (
            ("slic_segments", 1, 20_000),
            ("hog_cell", 2, 64),
            ("hog_block", 1, 8),
            ("hog_orientations", 2, 36),
            ("hog_window", least_window, 256),
        ):
            value = getattr(self, name)
            if not (_is_whole(value) and low <= value <= high):
                raise SettingsError(f"{name}: expected a whole number from {low} to {high}, found {value!r}")

    @classmethod
    def preset(cls, name, **changes):
        """Return the settings of that name ("Paper" or "Enhanced"), with the given changes.

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


def _is_whole(value):
    return isinstance(value, Integral) and not isinstance(value, bool)
