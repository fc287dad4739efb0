"""The settings of a colorization: each is declared here, and nowhere else.

The panel, the command line and docs/settings.md are made from these declarations.
"""

from dataclasses import dataclass, fields, replace
from inspect import cleandoc

from .declaration import Choice, parameter_lines, setting, settings_of
from .errors import SettingsError, require_kind
from .messages import Message

PROPAGATION, MATCHING = "propagation", "matching"


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the colorization; the defaults are the paper's.

    Parameters
    ----------
    {parameters}

    Raises
    ------
    SettingsError
        If a value is out of its range.

    Examples
    --------
    >>> from reflcolor_addon import Settings
    >>> Settings(alpha=4).alpha, Settings.preset("Enhanced", tone=1.2).nearest
    (4, 8)
    >>> Settings(alpha=0)
    Traceback (most recent call last):
    ...
    reflcolor_addon.errors.SettingsError: alpha: expected a number from 0.1 to 64, found 0
    """

    alpha: float = setting(
        6.0,
        group=PROPAGATION,
        kind=float,
        low=0.1,
        high=64,
        slider_high=12,
        label="Alpha",
        help="How fast a seed's influence falls with the geodesic distance; higher makes borders sharper",
    )
    beta: float = setting(
        1.0,
        group=PROPAGATION,
        kind=float,
        low=0,
        high=1e6,
        slider_high=10,
        label="Beta",
        help="How strongly steps in range hold colors back; 0 looks at the reflectance alone (Yatziv)",
    )
    color_space: str = setting(
        "ycbcr",
        group=PROPAGATION,
        label="Color Space",
        help="Where the two chrominance channels are blended",
        choices=(
            Choice("ycbcr", "YCbCr", "Luminance and two color differences, ITU-R BT.601; the paper's choice"),
            Choice("yuv", "YUV", "Luminance and two color differences, as in analog television"),
            Choice("lalphabeta", "L-Alpha-Beta", "Logarithms of cone responses, decorrelated over natural images"),
            Choice("cielab", "CIELAB", "Perceptual lightness and two opponent colors"),
        ),
    )
    neighbors: int = setting(
        8,
        group=PROPAGATION,
        label="Neighbors",
        help="Which pixels a path may step to",
        choices=(
            Choice(4, "4", "Paths step to the pixels above, below, left and right"),
            Choice(8, "8", "Paths step diagonally too"),
        ),
    )
    nearest: int | str | None = setting(
        None,
        group=PROPAGATION,
        kind=int,
        low=1,
        high=1024,
        slider_high=64,
        label="Nearest Seeds",
        help="How many of its nearest seeds color a pixel",
        choices=(
            Choice(
                "auto",
                "Automatic",
                "All seeds where that takes about two seconds, else as many as it takes to be close to that",
            ),
            Choice(None, "All Seeds", "Every seed colors every pixel, as the paper has it", name="all"),
        ),
    )
    smoothing: float = setting(
        0.0,
        group=PROPAGATION,
        kind=float,
        low=0,
        high=16,
        slider_high=4,
        unit="pixels",
        label="Smoothing",
        help="Pixels by which the reflectance is smoothed before distances are measured on it; not in the paper",
    )
    kriging: float = setting(
        0.0,
        group=PROPAGATION,
        kind=float,
        low=0,
        high=1,
        unit="share",
        label="Kriging",
        help="Share of a statistical estimate from position, surface and reflectance; not in the paper",
    )
    light: float = setting(
        0.0,
        group=PROPAGATION,
        kind=float,
        low=0,
        high=1,
        unit="share",
        label="Light from Photo",
        help="Where light and dark come from: 0 the reflectance, which has no shadows; 1 the photo and picked colors",
    )
    photo_colors: bool = setting(
        False,
        group=PROPAGATION,
        kind=bool,
        label="Photo Colors",
        help="Take the color of every pixel that a verified photo saw from the photo; else from seeds alone",
    )
    tone: float = setting(
        1.0,
        group=PROPAGATION,
        kind=float,
        low=0.2,
        high=5,
        slider_step=0.1,
        label="Tone",
        help="Above 1 the colors are lighter, below 1 darker, whatever the light comes from; 1 changes nothing",
        # The tone depends on the scan, not on the method, so presets leave it alone.
        in_presets=False,
    )
    matching: str = setting(
        "verified",
        group=MATCHING,
        label="Matching",
        help="How seeds are found in photos",
        choices=(
            Choice("verified", "Verified", "By each photo's camera, accepted only if it passes a test"),
            Choice("paper", "Paper", "By the most similar superpixels, as published; often wrong on real scans"),
        ),
    )
    guess: bool = setting(
        False,
        group=MATCHING,
        kind=bool,
        label="Guess Colors",
        help="Take guessed colors from photos that could not be verified; they may be those of another place",
    )
    slic_segments: int = setting(
        500,
        group=MATCHING,
        kind=int,
        low=1,
        high=20_000,
        slider_high=2000,
        label="Superpixels",
        help="Superpixels that the scan, and each photo, is divided into; there is one seed in each at most",
    )
    slic_compactness: float = setting(
        0.1,
        group=MATCHING,
        kind=float,
        low=0.001,
        high=100,
        decimals=3,
        label="Compactness",
        help="How square superpixels are; less lets them follow edges",
    )
    slic_sigma: float = setting(
        1.0,
        group=MATCHING,
        kind=float,
        low=0,
        high=20,
        unit="pixels",
        label="Sigma",
        help="Pixels by which the image is smoothed before it is divided",
    )
    hog_cell: int = setting(
        8,
        group=MATCHING,
        kind=int,
        low=2,
        high=64,
        unit="pixels",
        label="Cell",
        help="Pixels of a cell of the descriptor",
    )
    hog_block: int = setting(
        2, group=MATCHING, kind=int, low=1, high=8, label="Block", help="Cells of a block of the descriptor"
    )
    hog_orientations: int = setting(
        9,
        group=MATCHING,
        kind=int,
        low=2,
        high=36,
        label="Orientations",
        help="Directions that the descriptor tells apart",
    )
    hog_window: int = setting(
        48,
        group=MATCHING,
        kind=int,
        low=2,
        high=256,
        unit="pixels",
        label="Window",
        help="Pixels of the descriptor's window around a superpixel's center",
    )

    def __post_init__(self):
        for name, declared in SETTINGS.items():
            declared.check(getattr(self, name))
        least = self.hog_cell * self.hog_block
        if self.hog_window < least:
            raise SettingsError(
                "{setting}: expected at least a block, which is hog_cell x hog_block = {least} pixels, found {found}",
                setting="hog_window",
                least=least,
                found=self.hog_window,
            )

    @classmethod
    def preset(cls, name: str, **changes) -> "Settings":
        """Return the settings of that name, one of `PRESETS`, with the given changes.

        Raises
        ------
        SettingsError
            If there is no preset of that name.
        """
        if name not in PRESETS:
            raise SettingsError(
                "{setting}: expected {expected}, found {found!r}",
                setting="preset",
                expected=Message("one of {choices}", choices=", ".join(PRESETS)),
                found=name,
            )
        return replace(cls(**PRESETS[name].values), **changes)

    def as_dict(self) -> dict:
        """Return name and value of every setting, in order, as they go into a report."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def settings_or_default(settings):
    """Return settings, the paper's where there are none; raises a SettingsError where they are something else."""
    settings = Settings() if settings is None else settings
    require_kind(settings, Settings, "settings", "write Settings(alpha=6) or Settings.preset(name)", SettingsError)
    return settings


SETTINGS = settings_of(Settings)
if Settings.__doc__:  # not with python -OO
    Settings.__doc__ = cleandoc(Settings.__doc__).replace("{parameters}", parameter_lines(SETTINGS.values()))


@dataclass(frozen=True)
class Preset:
    """Settings under a name.

    Parameters
    ----------
    help : str
        What they are for, as a tooltip.
    values : dict
        What is not the default.
    """

    help: str
    values: dict


_ENHANCED = {"alpha": 3.0, "nearest": 8, "smoothing": 1.0, "kriging": 0.6}
PRESETS = {
    "Natural": Preset(
        "The photo's own colors where a verified one saw the scan; elsewhere as Enhanced, and as light as the photo",
        _ENHANCED | {"light": 1.0, "photo_colors": True},
    ),
    "Enhanced": Preset(
        "What measured best on real scans: smoothed reflectance, fewer seeds per pixel, kriging",
        _ENHANCED,
    ),
    "Paper": Preset("The method as published", {}),
}
DEFAULT_PRESET = "Natural"
"""Where the window and the command line start from."""
FORMER_DEFAULT_PRESET = "Paper"
"""Where they started from before there was Natural; files of that time keep it."""
