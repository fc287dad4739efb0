"""How to read a scan file, where the user knows better than the file."""

from dataclasses import asdict, dataclass, fields, replace

from ...errors import UsageError
from ...messages import Message

UNITS = {"m": 1.0, "mm": 0.001, "cm": 0.01, "ft": 0.3048, "in": 0.0254}
"""Meters per unit."""

AUTO = "auto"
TURNS = (0, 90, 180, 270)
RETURNS = ("first", "strongest", "last")
STORED, ANGLE = "stored", "angle"
LIGHTER = Message("read every second row and column only: --step 2, or Every in the import dialog")
"""What to do where memory does not suffice."""
BY_ANGLE = Message("have a grid laid over its points: --grid angle, or Grid by Angle in the import dialog")
"""What to do where points are on no grid."""
_KINDS = {int: Message("a whole number"), bool: Message("true or false"), str: Message("a text in quotes")}


@dataclass(frozen=True, kw_only=True)
class ReadOptions:
    """How to read a scan file.

    Parameters
    ----------
    turn_deg : {0, 90, 180, 270}
        Turn the image clockwise, after it was brought upright as far as its points tell.
    flip_vertical, flip_horizontal : bool
        Turn the order of its rows, of its columns, after that.
    unit : str
        What the coordinates count: "m", "mm", "cm", "ft", "in"; "auto" is meters unless the points tell otherwise.
    step : int
        Keep every so many rows and columns, counted from the first of the file. The others are left out while reading,
        so that a scan takes the memory of what is kept (not with a grid by angle, and not for images, compressed or
        text files other than PTX, which are read whole first).
    returns : {"first", "strongest", "last"}
        Which of several returns of a pixel to take.
    grid : {"stored", "angle"}
        The file's own grid, or one that is laid over its points by the angles at which the scanner saw them.
    position : (x, y, z) of float, optional
        Where the scanner stood, in the file's coordinates and unit; None: as the file says, or as is found.

    Raises
    ------
    UsageError
        If a value is none of these.

    Examples
    --------
    >>> from reflcolor_addon import ReadOptions, read_scans
    >>> read_scans("garage.ptx", options=ReadOptions(step=2))[0].shape
    (10, 15)
    """

    turn_deg: int = 0
    flip_vertical: bool = False
    flip_horizontal: bool = False
    unit: str = AUTO
    step: int = 1
    returns: str = "first"
    grid: str = STORED
    position: tuple[float, float, float] | None = None

    def __post_init__(self):
        for name, choices in {
            "turn_deg": TURNS,
            "unit": (AUTO, *UNITS),
            "returns": RETURNS,
            "grid": (STORED, ANGLE),
        }.items():
            if getattr(self, name) not in choices:
                raise UsageError(
                    "{name}: expected one of {choices}, found {found}",
                    name=name,
                    choices=", ".join(map(str, choices)),
                    found=str(getattr(self, name)),
                )
        if self.step < 1:
            raise UsageError("step: expected a whole number of at least 1, found {found}", found=self.step)

    def as_dict(self):
        """Return what is not as it would be anyway, ready for JSON."""
        return {
            field.name: asdict(self)[field.name] for field in fields(self) if getattr(self, field.name) != field.default
        }


AS_IT_IS = ReadOptions()


def with_option(options, name, value):
    """Return `ReadOptions` with one option of another value, as a file of text states it.

    Raises
    ------
    UsageError
        If there is no such option, or the value is none of it.
    """
    kinds = {field.name: type(field.default) for field in fields(options)}
    if name not in kinds:
        raise UsageError("unknown option {name}; expected one of {known}", name=name, known=", ".join(kinds))
    if name == "position":
        numbers = value if isinstance(value, list) else []
        if len(numbers) != 3 or not all(isinstance(each, int | float) and abs(each) < 1e9 for each in numbers):
            raise UsageError("position: expected three numbers, found {found}", found=str(value))
        value = tuple(map(float, numbers))
    elif type(value) is not kinds[name]:
        raise UsageError(
            "{name}: expected {expected}, found {found}", name=name, expected=_KINDS[kinds[name]], found=repr(value)
        )
    return replace(options, **{name: value})


def pixels_kept(pixels, options):
    """Return how many pixels are left of scans with so many; a grid by angle has about one for each point."""
    return [max(1, count // (1 if options.grid == ANGLE else options.step**2)) for count in pixels]
