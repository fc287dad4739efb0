"""Small E57 files of every kind that the standard allows, for the tests of the reader."""

import struct
import uuid

import numpy as np

_PAGE, _PAYLOAD = 1024, 1020


class Records(dict):
    """Records beside the points: (N,) arrays of doubles by name, or dicts of them for structures."""


def write_e57(path, *scans, images=()):
    """Write an E57 file.

    Parameters
    ----------
    path : path-like
    *scans : dict
        `fields`: name to (N,) array, floats stored as doubles, whole numbers as integers; the other keys become
        children of the scan: dicts structures, `Records` records, texts strings, numbers as `fields` are.
    images : sequence of dict
        Photos inside: what becomes the children of each, bytes blobs.
    """
    from pye57 import libe57

    file, blobs, records = libe57.ImageFile(str(path), "w"), [], []

    def prototype_of(fields, above=""):
        prototype, columns = libe57.StructureNode(file), {}
        for name, values in fields.items():
            if isinstance(values, dict):
                node, inside = prototype_of(values, f"{above}{name}/")
                columns |= inside
            else:
                node, columns[f"{above}{name}"] = libe57.FloatNode(file, 0.0), np.array(values, np.float64)
            prototype.set(name, node)
        return prototype, columns

    def node_of(value):
        if isinstance(value, Records):
            prototype, columns = prototype_of(value)
            records.append((libe57.CompressedVectorNode(file, prototype, libe57.VectorNode(file, True)), columns))
            return records[-1][0]
        if isinstance(value, dict):
            node = libe57.StructureNode(file)
            for name, child in value.items():
                node.set(name, node_of(child))
            return node
        if isinstance(value, bytes):
            blobs.append((libe57.BlobNode(file, len(value)), value))
            return blobs[-1][0]
        if isinstance(value, str):
            return libe57.StringNode(file, value)
        return libe57.IntegerNode(file, value) if isinstance(value, int) else libe57.FloatNode(file, value)

    root = file.root()
    file.extensionsAdd("", libe57.E57_V1_0_URI)
    for name, value in {
        "formatName": "ASTM E57 3D Imaging Data File",
        "guid": "{" + str(uuid.UUID(int=1)) + "}",
        "versionMajor": 1,
        "versionMinor": 0,
    }.items():
        root.set(name, node_of(value))
    data3d = libe57.VectorNode(file, True)
    root.set("data3D", data3d)
    for scan in scans:
        node = node_of({key: value for key, value in scan.items() if key != "fields"})
        prototype, buffers, kept = libe57.StructureNode(file), libe57.VectorSourceDestBuffer(), []
        for name, values in scan["fields"].items():
            values = np.asarray(values)
            kept.append(values.astype(np.float64))
            if values.dtype.kind == "f":
                prototype.set(name, libe57.FloatNode(file, 0.0))
            else:
                low, high = (int(values.min()), int(values.max())) if values.size else (0, 0)
                prototype.set(name, libe57.IntegerNode(file, low, low, high))
            buffers.append(libe57.SourceDestBuffer(file, name, kept[-1], max(1, values.size), True, True))
        points = libe57.CompressedVectorNode(file, prototype, libe57.VectorNode(file, True))
        node.set("points", points)
        data3d.append(node)
        writer = points.writer(buffers)
        if kept[0].size:
            writer.write(kept[0].size)
        writer.close()
    if images:
        images2d = libe57.VectorNode(file, True)
        root.set("images2D", images2d)
        for image in images:
            images2d.append(node_of(image))
    for node, columns in records:
        buffers = libe57.VectorSourceDestBuffer()
        for name, values in columns.items():
            buffers.append(libe57.SourceDestBuffer(file, name, values, len(values), True, True))
        writer = node.writer(buffers)
        writer.write(len(values))
        writer.close()
    for blob, data in blobs:
        blob.write(np.frombuffer(data, np.uint8), 0, len(data))
    file.close()


def with_valid_checksums(data):
    """The same pages with the checksums that their contents have now: damage that only its meaning gives away."""
    pages = []
    for start in range(0, len(data) - _PAGE + 1, _PAGE):
        payload = data[start : start + _PAYLOAD]
        pages.append(payload + struct.pack(">I", _crc32c(payload)))
    return b"".join(pages)


def _crc32c(data):
    value = 0xFFFFFFFF
    for byte in data:
        value = _TABLE[(value ^ byte) & 0xFF] ^ (value >> 8)
    return value ^ 0xFFFFFFFF


def _table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = (byte >> 1) ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


_TABLE = _table()


def e57_with_photo(path, picture):
    """Write a scan of 3 x 4 pixels, and a pinhole photo (H, W, 3) at 1, 2, 3 that looks straight down; return the path.

    Its focal length is 35 pixels.
    """
    import cv2

    row, col = np.divmod(np.arange(12), 4)
    turn, rise = np.radians(col * 2.0), np.radians(10 - row * 2.0)
    points = {"cartesianX": np.cos(turn), "cartesianY": -np.sin(turn), "cartesianZ": np.tan(rise)}
    image = {
        "guid": "{1}",
        "name": "photo",
        "pose": {
            "rotation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0},
            "translation": {"x": 1.0, "y": 2.0, "z": 3.0},
        },
        "pinholeRepresentation": {
            "pngImage": cv2.imencode(".png", picture[..., ::-1])[1].tobytes(),
            "imageWidth": picture.shape[1],
            "imageHeight": picture.shape[0],
            "focalLength": 0.035,
            "pixelWidth": 0.001,
            "pixelHeight": 0.001,
        },
    }
    scan = {"fields": points | {"intensity": np.linspace(0, 1, 12), "rowIndex": row, "columnIndex": col}}
    write_e57(path, scan, images=[image])
    return path
