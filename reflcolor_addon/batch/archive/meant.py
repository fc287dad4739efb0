"""Which name was probably meant by one that does not exist."""

from difflib import get_close_matches
from fnmatch import fnmatchcase

from ...messages import Message


def hint(name, names):
    """Return the end of an error message: the name that was probably meant, empty if none is near.

    Parameters
    ----------
    name : str
        What was written; its folders may be missing, or others. Or a pattern: of that it can be capitals alone.
    names : iterable of str
        All that exist, with ``/`` between folders.
    """
    names, last = list(names), _last(name)
    if set("*?[") & set(name):
        near = [other for other in names if fnmatchcase(other.casefold(), name.casefold())]
    else:
        near = [other for other in names if _last(other) == last] or get_close_matches(name, names, 1)
    return Message("; did you mean {name}?", name=near[0]) if near else ""


def _last(name):
    """A name without folders; those of Windows have backslashes."""
    return name.replace("\\", "/").rpartition("/")[2].casefold()
