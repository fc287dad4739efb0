"""Which name was probably meant by one that does not exist."""

from difflib import SequenceMatcher
from fnmatch import fnmatchcase
from pathlib import PurePosixPath

from ...messages import Message

# How alike two names must be so that one is taken for a slip of the other; and how many are proposed.
_ALIKE, _MOST = 0.75, 3
# By how many letters they may differ in length.
_LONGER = 3


def hint(name, names):
    """Return the end of an error message: the names that were probably meant, empty if none is near.

    Parameters
    ----------
    name : str
        What was written; its folders may be missing, or others. Or a pattern: of that it can be capitals alone.
    names : iterable of str, or dict of str to iterable of str
        All that exist, with ``/`` between folders; with a dictionary also other ways to write each of them.
    """
    ways = names if isinstance(names, dict) else dict.fromkeys(names, ())
    near = [other for other, more in ways.items() if name in more]
    near = near or [other for other, more in ways.items() if any(_last(name) == _last(way) for way in (other, *more))]
    if not near and not set("*?[").isdisjoint(name):
        there = [other for other in ways if fnmatchcase(other.casefold(), name.casefold())]
        return Message("; capitals count: there is {name}", name=there[0]) if there else ""
    if not near:
        alike = sorted((-_likeness(name, other), other) for other in ways if _may_be_meant(name, other))
        near = [other for likeness, other in alike[:1] if -likeness >= _ALIKE]
    return Message("; did you mean {names}?", names=" or ".join(near[:_MOST])) if near else ""


def _last(name):
    """A name without folders and capitals; folders of Windows have backslashes."""
    return name.replace("\\", "/").rpartition("/")[2].casefold()


def _likeness(name, other):
    return SequenceMatcher(None, PurePosixPath(_last(name)).stem, PurePosixPath(_last(other)).stem).ratio()


def _may_be_meant(name, other):
    """Whether two names are about as long and have the same digits: with others it is another file, not a slip."""
    name, other = _last(name), _last(other)
    digits = ("".join(char for char in each if char.isdigit()) for each in (name, other))
    return abs(len(name) - len(other)) <= _LONGER and next(digits) == next(digits)
