"""Reads a TOML file, and tells in plain words where it is none."""

import tomllib

from ...errors import UsageError
from ...files.gate import contents
from ...messages import Message
from .toml_lines import TomlLines

_MOST_BYTES = 64 << 20
_LARGEST = 1 << 63
_ONCE = "a name may stand only once, for a key or a table; [[scan]] begins the table of one scan"
_SLASHES = "write / between folders"
_WAYS = {
    "Unescaped": _SLASHES,
    "hex value": _SLASHES,
    r"'\n'": "a closing quote is missing",
    "overwrite a value": _ONCE,
    "twice": _ONCE,
    "immutable namespace": _ONCE,
    "Invalid value": "a text needs quotes, a number a point and no comma, and true and false small letters",
    "after a key": "expected key = value; a number needs a point, not a comma",
}
"""What helps, by a part of what Python says."""


def read_toml(path, refuse):
    """Read a TOML file.

    Parameters
    ----------
    path : Path
    refuse : callable
        Given a UsageError for what is wrong.

    Returns
    -------
    (dict, TomlLines) or None
        None where it cannot be used.
    """
    try:
        text = contents(path, "a manifest (.toml)", error=UsageError, most=_MOST_BYTES).decode("utf-8-sig")
        document = tomllib.loads(text)
    except UsageError as error:
        refuse(error)
        return None
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        refuse(UsageError("{file}: line {line}: is not UTF-8; save it as UTF-8", file=path, line=line))
        return None
    except (ValueError, RecursionError) as error:  # not TOML, or numbers of thousands of digits
        ways = [Message("; {way}", way=Message(way)) for word, way in _WAYS.items() if word in str(error)]
        values = {"reason": str(error), "way": ways[0] if ways else ""}
        refuse(UsageError("{file}: is not TOML: {reason}{way}", file=path, **values))
        return None
    lines, too_large = TomlLines(text), list(_too_large(document, ()))
    for at in too_large:
        refuse(UsageError("{file}: line {line}: a number is too large", file=path, line=lines.of(*at)))
    return None if too_large else (document, lines)


def _too_large(value, at):
    """Yield the places of whole numbers that need more than 64 bits."""
    if isinstance(value, dict | list):
        for key, own in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _too_large(own, (*at, key))
    elif isinstance(value, int) and not -_LARGEST <= value < _LARGEST:
        yield at
