"""What an E57 file says of itself, before native code sees it: its header, its XML section, and each scan in that."""

import math
from dataclasses import dataclass

import numpy as np

from ...errors import ScanError
from ...messages import one_line
from ...scan.limits import LONGEST_NAME
from ..e57_pages import HEADER, PAGE, PAYLOAD, contents, first_bad_page
from ..gate import size_of
from .e57_xml import parse_xml
from .grid import UnusableScan

CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
COLOR = ("colorRed", "colorGreen", "colorBlue")
INDEX = ("rowIndex", "columnIndex")
# More returns for one pixel than any scanner tells apart.
_MOST_RETURNS = 64
_BITS_OF_A_TEXT = 8


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
        raise ScanError("{file}: data3D is no list of scans; export it again", file=path.name)
    return data3d.children


def scan_name(node, path, index, count):
    """The name that a scan has in the file, in one line; else that of the file, numbered where it holds several."""
    stored = node.child("name")
    text = " ".join(stored.text.split()) if stored is not None and stored.kind == "String" else ""
    text = "".join(letter for letter in text[: 4 * LONGEST_NAME] if letter.isprintable())
    return one_line(text, LONGEST_NAME) or (path.stem if count == 1 else f"{path.stem} {index + 1}")


@dataclass(frozen=True, eq=False, kw_only=True)
class ScanHeader:
    """What a scan says about itself; all but the points and their rows and columns is optional.

    Parameters
    ----------
    count : int
        Points that it announces.
    fields : tuple of str
        What is to be read of each.
    axes : tuple of str
        ``CARTESIAN`` or ``SPHERICAL``.
    color : bool
    state : str
        The field that tells whether a point is a return.
    limits : dict of str to (low, high)
        That the file states for colors and indices, each may be None.
    quaternion : (4,) float64
    translation : (3,) float64
    """

    count: int
    fields: tuple
    axes: tuple
    color: bool
    state: str
    limits: dict
    quaternion: np.ndarray
    translation: np.ndarray


def scan_header(node, file_name, file_size, name):
    """Return the ScanHeader of a scan's node.

    Raises
    ------
    UnusableScan
        If it has no points, no grid, no coordinates, or announces more points than the file can hold.
    """

    def unusable(template, **values):
        return UnusableScan("{file}: scan '{scan}' " + template, file=file_name, scan=name, **values)

    points = node.child("points")
    if points is not None and points.kind != "CompressedVector":
        raise unusable("has points of the type {kind}, which hold no records; export it again", kind=points.kind)
    count = 0 if points is None else int(points.attributes["recordCount"])
    if count == 0:
        raise unusable("has no points")
    prototype = points.child("prototype")
    present = {child.name: child for child in prototype.children}
    if not present.keys() >= set(INDEX):
        raise unusable(
            "is unstructured (its points have no rowIndex and columnIndex); export it as PTX or as a structured "
            "(gridded) E57"
        )
    axes = next((axes for axes in (CARTESIAN, SPHERICAL) if present.keys() >= set(axes)), None)
    if axes is None:
        raise unusable(
            "has no coordinates that are known, expected cartesianX, Y, Z or sphericalRange, Azimuth, Elevation"
        )
    if count * sum(map(_bits, present.values())) > 8 * file_size or math.log2(count / _MOST_RETURNS) > sum(
        _bits(present[field]) for field in INDEX
    ):
        raise unusable("announces {count:,} points, more than the file can hold; it is damaged", count=count)
    state = "sphericalInvalidState" if axes is SPHERICAL else "cartesianInvalidState"
    color = present.keys() >= set(COLOR)
    optional = present.keys() & {"intensity", "isIntensityInvalid", "isColorInvalid", state}
    fields = (*INDEX, *axes, *(COLOR if color else ()), *sorted(optional))
    if any(present[field].kind == "String" for field in fields):
        raise unusable("has texts where numbers are expected; export it again")
    return ScanHeader(
        count=count,
        fields=fields,
        axes=axes,
        color=color,
        state=state,
        limits={field: _limits(node, present, field) for field in (*COLOR, *INDEX)},
        quaternion=_numbers_at(node, "rotation", {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}),
        translation=_numbers_at(node, "translation", {"x": 0.0, "y": 0.0, "z": 0.0}),
    )


def _bits(node):
    """How many bits of the file a field takes in every record."""
    if node.kind == "Float":
        return 32 if node.attributes.get("precision") == "single" else 64
    if node.kind == "String":
        return _BITS_OF_A_TEXT
    low, high = node.attribute("minimum", -(2.0**63)), node.attribute("maximum", 2.0**63)
    return math.ceil(math.log2(high - low + 1)) if high > low else 0


def _limits(node, present, field):
    """(low, high) that a file states for a field, each None where it states none."""
    if field in INDEX:
        kind = field.removesuffix("Index")
        return tuple(node.number("indexBounds", f"{kind}{end}") for end in ("Minimum", "Maximum"))
    stated = tuple(node.number("colorLimits", f"{field}{end}") for end in ("Minimum", "Maximum"))
    if None not in stated or field not in present:
        return stated
    element = present[field]
    ends = (element.attribute("minimum"), element.attribute("maximum"))
    if None in ends or element.kind != "ScaledInteger":
        return ends
    return tuple(end * element.attribute("scale", 1.0) + element.attribute("offset", 0.0) for end in ends)


def _numbers_at(node, part, defaults):
    """float64 array of a part of the pose, with the default for every number that it does not state."""
    stated = [node.number("pose", part, axis) for axis in defaults]
    return np.array(
        [default if value is None else value for value, default in zip(stated, defaults.values(), strict=True)]
    )
