"""The gate that every input file passes: it must be an ordinary file, not empty, of plausible size, and is opened once.

Anything else is refused before it is opened: a pipe or a device may block forever, never end, or act on being opened.
"""

import os
import stat
from contextlib import contextmanager
from pathlib import Path, PurePosixPath, PureWindowsPath

from ..errors import Cancelled, ReflcolorError
from ..messages import Message
from .memory import readable, require_memory
from .refusals import unreadable

_CHUNK = 1 << 24


@contextmanager
def opened(path, expected, *, error=ReflcolorError, most=None, may_be_empty=False):
    """Open an input file for reading, as a binary file.

    Parameters
    ----------
    path : path-like
    expected : str
        What it should be, for messages: "a scan file".
    error : type
        The ReflcolorError to raise.
    most : int, optional
        Bytes that it may have at most.
    may_be_empty : bool

    Raises
    ------
    ReflcolorError
        In one line, if it is not there, no ordinary file, empty, too large, or cannot be read; OSErrors within the
        block, too.
    """
    path = Path(path)
    try:
        _require_ordinary(path.stat(), path, expected, error)
        # A pipe may have replaced the file meanwhile: opening it must not block.
        number = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NONBLOCK", 0))
        with os.fdopen(number, "rb") as file:
            found = os.fstat(number)
            _require_ordinary(found, path, expected, error)
            if not found.st_size and not may_be_empty:
                raise error("{file}: is empty, expected {expected}", file=path, expected=expected)
            if most is not None and found.st_size > most:
                raise error(
                    "{file}: has {size}, expected {expected} of at most {most}",
                    file=path,
                    size=readable(found.st_size),
                    expected=expected,
                    most=readable(most),
                )
            yield file
    except FileNotFoundError as missing:
        raise error("{file}: no such file, expected {expected}", file=path, expected=expected) from missing
    except OSError as failed:
        raise unreadable(path, failed, error) from failed
    except ValueError as failed:
        if isinstance(failed, ReflcolorError) or "null" not in str(failed):
            raise
        raise unreadable(path, failed, error) from failed


def size_of(file):
    """Return how many bytes an open file has."""
    return os.fstat(file.fileno()).st_size


def contents(path, expected, *, error=ReflcolorError, most=None, cancelled=None):
    """Return all bytes of an input file, as a bytearray; what it grows by meanwhile is left out.

    Parameters are those of `opened`; ``cancelled`` is asked between its parts.

    Raises
    ------
    ReflcolorError
        As `opened`, or if it does not fit into memory.
    Cancelled
        If ``cancelled()`` returned True.
    """
    with opened(path, expected, error=error, most=most) as file:
        size = size_of(file)
        require_memory(size, Path(path).name, error=error)
        data = bytearray(size)
        at = 0
        with memoryview(data) as view:
            while at < size and (done := file.readinto(view[at : at + _CHUNK])):
                at += done
                if cancelled is not None and cancelled():
                    raise Cancelled
        del data[at:]
        return data


def beside(path, name, *, outside=False):
    """Return the path of a file that a side file names; None where it may not name it.

    It may name what lies in its own folder or below, by a relative path: who sends somebody a side file could otherwise
    have any file of that person's read and copied into a result.

    Parameters
    ----------
    path : Path
        The side file.
    name : str
    outside : bool
        Let it name any file.
    """
    if outside:
        return path.parent / name
    # Names are checked by the rules of every platform: a folder on one may be part of a name on another.
    for kind in (PurePosixPath, PureWindowsPath):
        way = kind(name)
        if way.is_absolute() or way.anchor or ".." in way.parts:
            return None
    try:
        folder, target = (Path(os.path.realpath(place)) for place in (path.parent, path.parent / name))
    except (OSError, ValueError):
        return None
    return path.parent / name if target.is_relative_to(folder) else None


def _require_ordinary(found, path, expected, error):
    if stat.S_ISREG(found.st_mode):
        return
    kind = next((name for test, name in _KINDS if test(found.st_mode)), Message("not an ordinary file"))
    raise error("{file}: is {kind}, expected {expected}", file=path, kind=kind, expected=expected)


_KINDS = (
    (stat.S_ISDIR, Message("a directory")),
    (stat.S_ISFIFO, Message("a pipe")),
    (stat.S_ISSOCK, Message("a socket")),
    (stat.S_ISCHR, Message("a device")),
    (stat.S_ISBLK, Message("a device")),
)
