"""What an E57 file says about a scan before its points are read."""

import math
from dataclasses import dataclass, field

import numpy as np

from ...messages import Message
from .grid import UnusableScan
from .options import BY_ANGLE

CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
COLOR = ("colorRed", "colorGreen", "colorBlue")
INDEX = ("rowIndex", "columnIndex")
CARTESIAN_STATE, SPHERICAL_STATE = "cartesianInvalidState", "sphericalInvalidState"
_FLAGS = ("isIntensityInvalid", "isColorInvalid", CARTESIAN_STATE, SPHERICAL_STATE, "returnIndex")
_STRENGTHS = ("reflectance", "intensity", "amplitude")
"""Names of manufacturers' own fields for the strength of a return, the best first."""

GROUPS = ("pointGroupingSchemes", "groupingByLine", "groups")
GROUP = ("idElementValue", "startPointIndex", "pointCount")
# More returns for one pixel than any scanner distinguishes.
_MOST_RETURNS = 64
_BITS_OF_A_TEXT = 8


@dataclass(eq=False, kw_only=True)
class ScanHeader:
    """What a scan says about itself; all but its points is optional.

    Parameters
    ----------
    file_name, name : str
        Of the file and the scan, for messages.
    count : int
        Points that it announces.
    fields : tuple of str
        What is to be read of each.
    strength : str or None
        The field that holds the strength of a return.
    limits : dict of str to (low, high)
        That the file states for colors and indices, each may be None.
    quaternion : (4,) float64
    translation : (3,) float64
    grouped_by : str or None
        ``"rowIndex"`` or ``"columnIndex"``, where the points are grouped in lines by it.
    group_count : int
    groups : dict of (G,) float64
        Of the lines: ``idElementValue``, ``startPointIndex`` and ``pointCount``; to be filled by whoever reads them.
    """

    file_name: str
    name: str
    count: int
    fields: tuple
    strength: str | None
    limits: dict
    quaternion: np.ndarray
    translation: np.ndarray
    grouped_by: str | None = None
    group_count: int = 0
    groups: dict = field(default_factory=dict)

    @property
    def place(self):
        """Values of messages."""
        return {"file": self.file_name, "scan": self.name}

    def has(self, names):
        """Whether the points have all of some fields."""
        return set(self.fields).issuperset(names)


def scan_header(node, file_name, file_size, name):
    """Return the ScanHeader of a scan's node.

    Raises
    ------
    UnusableScan
        If it has no points, no coordinates, or announces more points than the file can hold.
    """

    def unusable(template, **values):
        problem = Message(template, **values)
        return UnusableScan("{file}: scan '{scan}' {problem}", file=file_name, scan=name, problem=problem)

    points = node.child("points")
    if points is not None and points.kind != "CompressedVector":
        raise unusable("has points of the type {kind}, which hold no records; export it again", kind=points.kind)
    count = 0 if points is None else int(points.attributes["recordCount"])
    if count == 0:
        raise unusable("has no points")
    present = {child.name: child for child in points.child("prototype").children}
    axes = [axis for kind in (CARTESIAN, SPHERICAL) if present.keys() >= set(kind) for axis in kind]
    if not axes:
        raise unusable("has no known coordinates, expected cartesianX, Y, Z or sphericalRange, Azimuth, Elevation")
    if count * sum(map(_bits, present.values())) > 8 * file_size or (
        present.keys() >= set(INDEX)
        and math.log2(count / _MOST_RETURNS) > sum(_bits(present[field]) for field in INDEX)
    ):
        raise unusable("announces {count:,} points, more than the file can hold; it is damaged", count=count)
    strength = "intensity" if "intensity" in present else _own_strength(present)
    color = COLOR if present.keys() >= set(COLOR) else ()
    fields = dict.fromkeys([*axes, *color, *filter(None, [strength, _own_strength(present)])])
    fields |= dict.fromkeys(flag for flag in (*INDEX, *_FLAGS) if flag in present)
    if any(present[field].kind == "String" for field in fields):
        raise unusable("has texts where numbers are expected; export it again")
    grouped_by, group_count = _groups(node, file_size)
    return ScanHeader(
        file_name=file_name,
        name=name,
        count=count,
        fields=tuple(fields),
        strength=strength,
        limits={field: _limits(node, present, field) for field in (*COLOR, *INDEX)},
        quaternion=_numbers_at(node, "rotation", {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}),
        translation=_numbers_at(node, "translation", {"x": 0.0, "y": 0.0, "z": 0.0}),
        grouped_by=grouped_by,
        group_count=group_count,
    )


def require_structure(header):
    """Raise UnusableScan where a ScanHeader already tells that its points have neither rows and columns nor lines."""
    if header.grouped_by is None and not any(header.has([name]) for name in INDEX):
        raise unstructured(header)


def unstructured(header):
    """Return the UnusableScan for a scan without rows and columns."""
    return UnusableScan(
        "{file}: scan '{scan}' is unstructured (its points have no rowIndex and columnIndex); export it as PTX "
        "or as a structured (gridded) E57, or {way}",
        way=BY_ANGLE,
        **header.place,
    )


def _groups(node, file_size):
    """The index that lines of points have in common, and how many lines there are; (None, 0) where there are none."""
    groups, named = node.child(*GROUPS), node.child(*GROUPS[:2], "idElementName")
    if groups is None or groups.kind != "CompressedVector" or named is None or named.text not in INDEX:
        return None, 0
    present = {child.name: child for child in groups.child("prototype").children}
    count = int(groups.attributes["recordCount"])
    if not present.keys() >= set(GROUP) or not 0 < count * sum(map(_bits, present.values())) <= 8 * file_size:
        return None, 0
    return named.text, count


def _own_strength(present):
    """A manufacturer's own field for the strength of a return, such as ``rlms:reflectance``."""
    own = {name.partition(":")[2].lower(): name for name in present if ":" in name}
    return next((own[name] for name in _STRENGTHS if name in own), None)


def _bits(node):
    """How many bits of the file a field takes in every record."""
    if node.kind == "Structure":
        return sum(map(_bits, node.children))
    if node.kind == "Float":
        return 32 if node.attributes.get("precision") == "single" else 64
    if node.kind == "String":
        return _BITS_OF_A_TEXT
    low, high = node.attribute("minimum", -(2.0**63)), node.attribute("maximum", 2.0**63)
    if low is None or high is None or not high - low < 2.0**64:
        return 64
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
