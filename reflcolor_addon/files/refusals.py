"""What the operating system refuses about a file, as an error that says what to do."""

import errno

from ..errors import OutputError, ReflcolorError
from ..messages import Message

_NO_ROOM = Message("make room on the disk, or choose another")
_NO_RIGHT = Message("choose a folder that you may write to")
_TOO_LARGE = Message("files may not be larger here: raise the limit (ulimit -f), or choose another disk")
_TO_WRITE = {
    errno.EFBIG: _TOO_LARGE,
    errno.ENAMETOOLONG: Message("choose a shorter name"),
    errno.ENOSPC: _NO_ROOM,
    getattr(errno, "EDQUOT", errno.ENOSPC): _NO_ROOM,
    errno.EACCES: _NO_RIGHT,
    errno.EPERM: _NO_RIGHT,
    errno.EROFS: _NO_RIGHT,
}
_NO_MEMORY = Message("close other programs")
_NO_RIGHT_TO_READ = Message("ask its owner for the right to read it")
_TO_READ = {
    # An E57 is handed over by a file of its points.
    errno.EFBIG: _TOO_LARGE,
    errno.ENAMETOOLONG: Message("no file has so long a name; check how it is spelled"),
    errno.ENOMEM: _NO_MEMORY,
    errno.ENOSPC: _NO_ROOM,
    errno.ELOOP: Message("its links lead in a circle; name the file itself"),
    errno.ENOTDIR: Message("a part of its path is no folder; check how it is spelled"),
    errno.EACCES: _NO_RIGHT_TO_READ,
    errno.EPERM: _NO_RIGHT_TO_READ,
}


def unwritable(path, failure):
    """Return the OutputError for an OSError, or a ValueError about the name, met while a file was written."""
    way = _TO_WRITE.get(getattr(failure, "errno", None), Message("choose another folder"))
    return OutputError("{file}: cannot be written ({reason}); {way}", file=path, reason=_reason(failure), way=way)


def unreadable(path, failure, error=ReflcolorError):
    """Return an error of this type for an OSError, or a ValueError about the name, met while a file was read."""
    way = _TO_READ.get(getattr(failure, "errno", None), Message("copy it to another folder, and name the copy"))
    return error("{file}: cannot be read ({reason}); {way}", file=path, reason=_reason(failure), way=way)


def _reason(failure):
    return getattr(failure, "strerror", None) or failure
