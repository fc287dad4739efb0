"""What the package raises when the person who called it can do something about it.

Every message is one line: the file or thing, the place in it, what was found, what was expected, what to do.
Anything that is not one of these is a defect of the package and surfaces with its traceback.
"""


class ReflcolorError(ValueError):
    """Base of everything that bad input can cause."""


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
    """A command was given in a way that cannot mean anything."""
