"""What is safe to ask of an E57 file: its header checked first, and native errors brought into the family."""

import contextlib
import re
import struct

from ...errors import ScanError
from ..native_noise import quiet_on_failure

_HEADER = struct.Struct("<8sIIQQQQ")
_PAGE = 1024
_CHECKSUM = 4

_REASONS = {
    "ErrorBadChecksum": "a checksum does not match: the file is damaged; copy or export it again",
    "ErrorBadXMLFormat": "its XML section is damaged; copy or export it again",
    "ErrorXMLParser": "its XML section is damaged; copy or export it again",
    "ErrorBadCVHeader": "its point section is damaged; copy or export it again",
    "ErrorBadCVPacket": "its point section is damaged; copy or export it again",
    "ErrorBadFileLength": "its length is not what its header says; copy or export it again",
    "ErrorReadFailed": "it ends too early; copy or export it again",
}


def check_header(path):
    """Refuse what is no whole E57 file before native code sees it.

    Raises
    ------
    ScanError
        In one line.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        start = file.read(_HEADER.size)
    if not start.startswith(b"ASTM-E57"):
        raise ScanError(f"{path.name}: not an E57 file (it does not begin with ASTM-E57)")
    if len(start) < _HEADER.size:
        raise ScanError(f"{path.name}: cut short: {size} bytes, and an E57 header alone has {_HEADER.size}")
    _, major, minor, length, xml_at, xml_length, page = _HEADER.unpack(start)
    if major != 1:
        raise ScanError(f"{path.name}: E57 version {major}.{minor}, expected 1.0")
    if page != _PAGE:
        raise ScanError(f"{path.name}: its header says pages of {page} bytes, expected {_PAGE}; the file is damaged")
    if size < length:
        raise ScanError(f"{path.name}: cut short: {size} of {length} bytes; copy or export it again")
    if size != length or length % _PAGE:
        raise ScanError(f"{path.name}: {size} bytes long, but its header says {length}; the file is damaged")
    logical = length // _PAGE * (_PAGE - _CHECKSUM)
    if xml_length > logical or not _HEADER.size <= xml_at < length:
        raise ScanError(f"{path.name}: its XML section lies outside of the file; the file is damaged")


@contextlib.contextmanager
def native_errors(path):
    """Turn whatever libE57 raises in this block into one ScanError, and keep it from printing."""
    from pye57 import libe57

    try:
        with quiet_on_failure():
            yield
    except ScanError:
        raise
    except MemoryError:
        raise ScanError(f"{path.name}: does not fit into memory") from None
    except (libe57.E57Exception, RuntimeError, ValueError, IndexError, OverflowError, TypeError) as error:
        # libE57 tells its code in the first line, and where in its own source in the others.
        first = str(error).strip().partition("\n")[0]
        code = re.search(r"\((Error\w+)\)", first)
        reason = _REASONS.get(code[1]) if code else None
        raise ScanError(f"{path.name}: {reason or f'cannot be read as E57 ({first})'}") from None


def number_at(node, *names):
    """The number at a path below a node; None where a part of the path is missing or it is no number."""
    value = _value_at(node, names)
    return value if isinstance(value, int | float) else None


def text_at(node, *names):
    """The text at a path below a node; empty where a part of the path is missing or it is no text."""
    value = _value_at(node, names)
    return value if isinstance(value, str) else ""


def _value_at(node, names):
    for name in names:
        if not hasattr(node, "isDefined") or not node.isDefined(name):
            return None
        node = node[name]
    getter = next((getter for getter in ("scaledValue", "value") if hasattr(node, getter)), None)
    return None if getter is None else getattr(node, getter)()
