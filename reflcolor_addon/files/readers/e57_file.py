"""What an E57 file says of itself, before native code sees it: its header and its XML section."""

from pathlib import Path

from ...errors import ReflcolorError, ScanError
from ...messages import one_line
from ...scan.limits import LONGEST_NAME
from ..e57_pages import HEADER, PAGE, PAYLOAD, contents, first_bad_page
from ..gate import opened, size_of
from .e57_xml import parse_xml

_GPS_BEGAN_S = 315_964_800.0


def read_structure(file, path, cancelled=None):
    """Check the header and the XML section of an E57 file.

    Parameters
    ----------
    file : binary file
    path : Path
        Its name, for messages.
    cancelled : callable, optional

    Returns
    -------
    root : Node
    xml_size : int
        Bytes of the XML section.

    Raises
    ------
    ScanError
        In one line.
    Cancelled
        If ``cancelled()`` returned True.
    """
    size = size_of(file)
    start, length = _xml_place(file.read(HEADER.size), size, path.name)
    first = start // PAGE
    last = (start % PAGE + length) // PAYLOAD + first
    try:
        if first_bad_page(file, first, min(last + 1, size // PAGE) - first) is not None:
            raise ScanError(
                "{file}: a checksum does not match: the file is damaged; copy or export it again", file=path.name
            )
        text = contents(file, start, length)
    except EOFError:
        raise ScanError(
            "{file}: its XML section lies outside of the file; the file is damaged", file=path.name
        ) from None
    return parse_xml(text, path.name, size, cancelled), length


def _xml_place(start, size, name):
    """Where the XML section begins, and how many bytes it has, by the file's header."""
    if not start.startswith(b"ASTM-E57"):
        raise ScanError("{file}: not an E57 file (it does not begin with ASTM-E57)", file=name)
    if len(start) < HEADER.size:
        raise ScanError(
            "{file}: cut short: {size} bytes, and an E57 header alone has {expected}",
            file=name,
            size=size,
            expected=HEADER.size,
        )
    _, major, minor, length, xml_at, xml_length, page = HEADER.unpack(start)
    if major != 1:
        raise ScanError("{file}: E57 version {major}.{minor}, expected 1.0", file=name, major=major, minor=minor)
    if page != PAGE:
        raise ScanError(
            "{file}: its header says pages of {page} bytes, expected {expected}; the file is damaged",
            file=name,
            page=page,
            expected=PAGE,
        )
    if size < length:
        raise ScanError(
            "{file}: cut short: {size} of {length} bytes; copy or export it again", file=name, size=size, length=length
        )
    if size != length or length % PAGE:
        raise ScanError(
            "{file}: {size} bytes long, but its header says {length}; the file is damaged",
            file=name,
            size=size,
            length=length,
        )
    if xml_length > length // PAGE * PAYLOAD or not HEADER.size <= xml_at < length:
        raise ScanError("{file}: its XML section lies outside of the file; the file is damaged", file=name)
    return xml_at, xml_length


def scan_nodes(root, path):
    """Return the node of every scan.

    Raises
    ------
    ScanError
        If there is none, or one is no structure.
    """
    data3d = root.child("data3D")
    if data3d is None or not data3d.children:
        raise ScanError("{file}: holds no scan", file=path.name)
    if data3d.kind != "Vector" or any(node.kind != "Structure" for node in data3d.children):
        raise ScanError("{file}: data3D is not a list of scans; export it again", file=path.name)
    return data3d.children


def scan_name(node, path, index, count):
    """The name that a scan has in the file, in one line; else that of the file, numbered where it holds several."""
    stored = node.child("name")
    text = " ".join(stored.text.split()) if stored is not None and stored.kind == "String" else ""
    text = "".join(letter for letter in text[: 4 * LONGEST_NAME] if letter.isprintable())
    return one_line(text, LONGEST_NAME) or (path.stem if count == 1 else f"{path.stem} {index + 1}")


def acquired_at(path):
    """Return when the first scan of an E57 file began that tells, in seconds since 1970; None where none does.

    A file that cannot be read tells nothing: its reader says why.
    """
    path = Path(path)
    try:
        with opened(path, "a scan") as file:
            root, _ = read_structure(file, path)
            times = (node.number("acquisitionStart", "dateTimeValue") for node in scan_nodes(root, path))
            # GPS time began in 1980; its leap seconds do not matter here.
            return next((_GPS_BEGAN_S + time for time in times if time), None)
    except ReflcolorError:
        return None
