"""The errors that a caller can do something about.

Every message is one line: the file or thing, the place in it, what was found, what was expected, what to do.
Anything that is not one of these is a defect of the package and surfaces with its traceback.

    raise ScanError("{file}: line {line}: expected 4 or 7 values, found {count}", file=path.name, line=12, count=5)
"""

from .messages import LONGEST_LINE, Message, one_line


class ReflcolorError(ValueError):
    """Base of everything that bad input can cause.

    Parameters
    ----------
    template : str
        English, with named places for the values; see `Message`.
    **values

    Attributes
    ----------
    message : Message
    """

    def __init__(self, template="", /, **values):
        self.message = _message(template, values)
        super().__init__(self.message)


class ScanError(ReflcolorError):
    """A scan, or a file that should hold one, cannot be used."""


class ImageError(ReflcolorError):
    """An image file cannot be read."""


class SeedsError(ReflcolorError):
    """Seeds, or a file that should hold them, cannot be used."""


class SettingsError(ReflcolorError):
    """A setting is out of its range."""


class OutputError(ReflcolorError):
    """A result cannot be written where it was asked for."""


class Cancelled(Exception):
    """The caller's ``cancelled()`` returned True; nothing was changed."""


class UsageError(Exception):
    """A command was given in a way that cannot mean anything; takes what `ReflcolorError` takes."""

    def __init__(self, template="", /, **values):
        self.message = _message(template, values)
        super().__init__(self.message)


def require_kind(argument, kind, name, way, error=ReflcolorError):
    """Raise an error where an argument is of another type than expected; ``way`` says how to make a right one."""
    if not isinstance(argument, kind):
        raise error(
            "{name}: expected {kind}, found {found}; {way}",
            name=name,
            kind=kind.__name__,
            found=type(argument).__name__,
            way=way,
        )


def _message(template, values):
    if values:
        return Message(template, **values)
    return template if isinstance(template, Message) else Message(one_line(template, LONGEST_LINE))
