"""JSON files, read through the gate."""

import json
from pathlib import Path

from ..errors import ReflcolorError
from .gate import contents, size_of
from .memory import require_memory

_MEMORY_PER_BYTE = 12
"""Memory that a short number or name in a JSON text takes as a Python object, in addition to the text."""


def read_json(path, expected, *, error=ReflcolorError, most):
    """Read and parse a JSON file in UTF-8; parameters and errors are those of `gate.contents`."""
    return _parsed(contents(path, expected, error=error, most=most), Path(path), expected, error)


def parse_json(file, path, expected, *, error=ReflcolorError, most):
    """Parse what an open file holds; it was opened through the gate, so that only its size is looked at here."""
    if size_of(file) > most:
        raise error("{file}: is too large, expected {expected}", file=path.name, expected=expected)
    return _parsed(file.read(most), path, expected, error)


def _parsed(data, path, expected, error):
    require_memory(len(data) * _MEMORY_PER_BYTE, path.name, error=error)
    try:
        return json.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as wrong:
        raise error(
            "{file}: expected {expected}, found bytes that are not text", file=path, expected=expected
        ) from wrong
    except json.JSONDecodeError as wrong:
        raise error(
            "{file}: line {line}, column {column}: expected {expected} ({problem})",
            file=path,
            line=wrong.lineno,
            column=wrong.colno,
            expected=expected,
            problem=wrong.msg,
        ) from wrong
    except (ValueError, RecursionError) as wrong:  # a number with thousands of digits, brackets nested too deeply
        raise error(
            "{file}: expected {expected}, found values that JSON cannot hold", file=path, expected=expected
        ) from wrong
