"""Scans into a structured E57 file."""

import hashlib
import uuid
from collections.abc import Iterable
from os import PathLike

import numpy as np

from ...errors import OutputError
from ...scan.rotations import quaternion
from ...scan.scan import Scan
from ..atomic import written_atomically

_MOST_PER_SIDE = 65536
_COLORS = ("colorRed", "colorGreen", "colorBlue")


def write_e57(scans: Scan | Iterable[Scan], path: PathLike | str) -> None:
    """Write scans into an E57: Cartesian points of the returns with row and column, intensity, pose, color if any.

    The same scans give the same bytes: identifiers come from the content and times are zero.

    Parameters
    ----------
    scans : Scan or sequence of Scan
        Points keep double precision, reflectance single, as it is. The pose must be a rotation and a translation.
    path : path-like

    Raises
    ------
    OutputError
        If a pose scales or shears, a grid has more than 65536 rows or columns, a scan has no return, this platform has
        no pye57, or the file cannot be written.

    Examples
    --------
    >>> from reflcolor_addon import read_scans, write_e57
    >>> write_e57(read_scans("garage.ptx"), "garage.e57")
    """
    scans = [scans] if isinstance(scans, Scan) else list(scans)
    for scan in scans:
        _check(scan, path)
    try:
        from pye57 import libe57
    except ModuleNotFoundError:
        raise OutputError(
            "{path}: cannot be written: E57 needs pye57, which is missing; write it as PTX", path=path
        ) from None
    with written_atomically(path) as temporary:
        try:
            image = libe57.ImageFile(str(temporary), "w")
            try:
                document = _Document(libe57, image)
                document.write_root(scans)
                for scan in scans:
                    document.write_scan(scan)
            finally:
                # Closing writes buffered data, so it can fail, too.
                image.close()
        except libe57.E57Exception as error:
            reason = str(error).strip().partition("\n")[0]
            raise OutputError("{file}: cannot be written as E57 ({reason})", file=path, reason=reason) from error


def _check(scan, path):
    if max(scan.shape) > _MOST_PER_SIDE:
        raise OutputError(
            "{path}: {scan} has {rows} x {columns} pixels, E57 readers take at most {most} a side; write it as PTX",
            path=path,
            scan=scan.name,
            rows=scan.shape[0],
            columns=scan.shape[1],
            most=_MOST_PER_SIDE,
        )
    if not scan.valid.any():
        raise OutputError("{path}: {scan} has no return; there is nothing to write", path=path, scan=scan.name)
    rotation = scan.pose[:3, :3]
    rigid = np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6) and np.linalg.det(rotation) > 0
    if not rigid or not np.allclose(scan.pose[3], [0, 0, 0, 1]):
        raise OutputError(
            "{path}: {scan}: its pose is more than a rotation and a translation; write it as PTX",
            path=path,
            scan=scan.name,
        )


class _Document:
    """Nodes of one E57 file."""

    def __init__(self, libe57, image):
        self._lib, self._image, self._root = libe57, image, image.root()

    def write_root(self, scans):
        lib, root = self._lib, self._root
        self._image.extensionsAdd("", lib.E57_V1_0_URI)
        root.set("formatName", self._text("ASTM E57 3D Imaging Data File"))
        root.set("guid", self._text(_identifier("file", *scans)))
        root.set("versionMajor", self._whole(lib.E57_FORMAT_MAJOR))
        root.set("versionMinor", self._whole(lib.E57_FORMAT_MINOR))
        root.set("e57LibraryVersion", self._text(lib.E57_LIBRARY_ID))
        root.set("coordinateMetadata", self._text(""))
        root.set(
            "creationDateTime", self._structure(dateTimeValue=self._real(0.0), isAtomicClockReferenced=self._whole(0))
        )
        self._scans = lib.VectorNode(self._image, True)
        root.set("data3D", self._scans)
        root.set("images2D", lib.VectorNode(self._image, True))

    def write_scan(self, scan):
        lib, image = self._lib, self._image
        rows, columns = np.nonzero(scan.valid)
        points = scan.points[scan.valid]
        values = {f"cartesian{axis}": points[:, i].copy() for i, axis in enumerate("XYZ")}
        values["intensity"] = scan.reflectance[scan.valid]
        values["rowIndex"], values["columnIndex"] = rows.astype(np.uint16), columns.astype(np.uint16)
        if scan.color is not None:
            values |= {name: scan.color[scan.valid][:, i].copy() for i, name in enumerate(_COLORS)}

        node = self._structure(guid=self._text(_identifier("scan", scan)), name=self._text(scan.name))
        self._scans.append(node)
        height, width = scan.shape
        node.set(
            "indexBounds",
            self._structure(
                rowMinimum=self._whole(0),
                rowMaximum=self._whole(height - 1),
                columnMinimum=self._whole(0),
                columnMaximum=self._whole(width - 1),
                returnMinimum=self._whole(0),
                returnMaximum=self._whole(0),
            ),
        )
        low, high = float(values["intensity"].min()), float(values["intensity"].max())
        node.set(
            "intensityLimits", self._structure(intensityMinimum=self._real(low), intensityMaximum=self._real(high))
        )
        if scan.color is not None:
            ends = (("Minimum", 0), ("Maximum", 255))
            limits = {f"{name}{end}": self._whole(value) for name in _COLORS for end, value in ends}
            node.set("colorLimits", self._structure(**limits))
        node.set("pose", self._pose(scan.pose))

        prototype = lib.StructureNode(image)
        precision = {"d": lib.E57_DOUBLE, "f": lib.E57_SINGLE}
        greatest = {"rowIndex": height - 1, "columnIndex": width - 1} | dict.fromkeys(_COLORS, 255)
        buffers = lib.VectorSourceDestBuffer()
        for name, array in values.items():
            kind = precision.get(array.dtype.char)
            whole = kind is None
            prototype.set(
                name, lib.IntegerNode(image, 0, 0, greatest[name]) if whole else lib.FloatNode(image, 0.0, kind)
            )
            buffers.append(lib.SourceDestBuffer(image, name, array, array.size, True, False))
        cloud = lib.CompressedVectorNode(image, prototype, lib.VectorNode(image, True))
        node.set("points", cloud)
        writer = cloud.writer(buffers)
        writer.write(rows.size)
        writer.close()

    def _pose(self, pose):
        rotation = dict(zip("wxyz", map(self._real, quaternion(pose[:3, :3])), strict=True))
        translation = dict(zip("xyz", map(self._real, pose[:3, 3]), strict=True))
        return self._structure(rotation=self._structure(**rotation), translation=self._structure(**translation))

    def _structure(self, **children):
        node = self._lib.StructureNode(self._image)
        for name, child in children.items():
            node.set(name, child)
        return node

    def _text(self, value):
        return self._lib.StringNode(self._image, value)

    def _whole(self, value):
        return self._lib.IntegerNode(self._image, int(value))

    def _real(self, value):
        return self._lib.FloatNode(self._image, float(value))


def _identifier(kind, *scans):
    digest = hashlib.sha256(kind.encode())
    for scan in scans:
        for array in (scan.points, scan.reflectance, scan.valid, scan.pose):
            digest.update(array.tobytes())
        digest.update(scan.name.encode())
    return f"{{{uuid.UUID(bytes=digest.digest()[:16])}}}"
