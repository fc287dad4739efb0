"""Whether a scan's file is whole."""

from ..e57_pages import HEADER, PAGE, first_bad_page
from .fault import Fault, exactly, require_end

_CHUNK = 1 << 20
# Lines between the grid's size and the points of a PTX scan: the scanner's position and axes, and the matrix.
_HEADER_LINES = 8


def check_ptx(file, size):
    """A PTX with as many lines of points as each of its scans announces."""
    while columns := file.readline(_CHUNK):
        missing = _skip_lines(file, _HEADER_LINES + int(columns) * int(file.readline(_CHUNK)))
        if missing:
            raise Fault("{count:,} lines of points are missing", count=missing)


def _skip_lines(file, count):
    """Go on by so many lines; return how many there were too few."""
    while count:
        chunk = file.read(_CHUNK)
        if not chunk:
            return count
        found = chunk.count(b"\n")
        if found > count:
            at = 0
            for _ in range(count):
                at = chunk.index(b"\n", at) + 1
            file.seek(at - len(chunk), 1)
            return 0
        count -= found
    file.seek(chunk.rindex(b"\n") + 1 - len(chunk), 1)
    return 0


def check_e57(file, size):
    """An E57 as long as its header says, with every page's checksum right."""
    signature, _, _, length, xml_at, xml_length, page = HEADER.unpack(exactly(file, HEADER.size))
    if signature != b"ASTM-E57" or page != PAGE:
        raise Fault("it is not an E57")
    require_end(length, size)
    if length % PAGE or not HEADER.size <= xml_at < length or not xml_length:
        raise Fault("it has no description of what is in it")
    if first_bad_page(file, 0, length // PAGE) is not None:
        raise Fault("a checksum in it is wrong")
