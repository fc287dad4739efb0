"""The child process that writes a copy of an E57 with colors: run as a program, with what to do on its standard input.

It imports nothing of the package, and needs nothing but this folder and the library. One line of JSON comes in (see
`main`); lines of JSON go out. Everything of the file is copied node by node, records as the file stores them; only the
colors of the points are put in anew.
"""

import json
import sys
from pathlib import Path

_RECORDS = 1 << 16
"""Records that are copied at a time."""

_PIECE = 1 << 20
_COLORS = ("colorRed", "colorGreen", "colorBlue")
_INVALID = "isColorInvalid"


def main(lines, answer):
    """Copy a file.

    Parameters
    ----------
    lines : iterable of str
        One: ``{"library": path, "folders": [of DLLs], "file": [number or null, path], "columns": [number or null,
        path], "output": path, "scans": {index: [first byte of its colors, records, whether some have none]}, "memory":
        bytes, "written": bytes, "seconds": number}``. Colors are four columns of bytes: red, green, blue, and 1 where
        there is none.
    answer : callable
        Called with each answer: ``{"at": thousandths}``, ``{"lost": name}``, ``{"done": 0}``, or ``{"error": text}``.
    """
    from confinement import confine, reopened
    from program import library_at, shared_memory

    request = json.loads(next(iter(lines)))
    columns = shared_memory(*request["columns"])
    library = library_at("libe57", request["library"], request["folders"])
    # This is the last file that is opened for writing.
    made = library.ImageFile(request["output"], "w")
    confine(**{key: request[key] for key in ("memory", "written", "seconds")})
    answer({"ready": True})
    try:
        source = library.ImageFile(reopened(*request["file"]), "r")
        colored = {int(index): place for index, place in request["scans"].items()}
        _Copy(library, source, made, columns, colored, answer).run()
        made.close()
        answer({"done": 0})
    except MemoryError:
        answer({"error": "ErrorMemory"})
    except Exception as error:  # native code raises errors of any type: only their text is usable
        answer({"error": str(error)[:10_000]})


class _Copy:
    def __init__(self, library, source, made, columns, colored, answer):
        self._lib, self._source, self._made = library, source, made
        self._columns, self._colored, self._answer = columns, colored, answer
        self._copiers = {
            library.E57_STRUCTURE: self._structure,
            library.E57_VECTOR: self._vector,
            library.E57_INTEGER: self._integer,
            library.E57_SCALED_INTEGER: self._scaled,
            library.E57_FLOAT: self._float,
            library.E57_STRING: self._text,
            library.E57_BLOB: self._blob,
        }
        self._tasks = []

    def run(self):
        source, made = self._source, self._made
        known = set()
        for index in range(source.extensionsCount()):
            known.add(source.extensionsPrefix(index))
            made.extensionsAdd(source.extensionsPrefix(index), source.extensionsUri(index))
        if "" not in known:
            made.extensionsAdd("", self._lib.E57_V1_0_URI)
        self._children(source.root(), made.root(), "/")
        for index, task in enumerate(self._tasks):
            task(index / len(self._tasks), 1 / len(self._tasks))

    def _children(self, old, new, path):
        scan = self._scan_at(path)
        for place in range(old.childCount()):
            child = old.get(place)
            name = child.elementName()
            if scan is not None and name == "colorLimits":
                continue
            self._copy(child, lambda node, name=name: new.set(name, node), f"{path}{name}/")
        if scan is not None:
            limits = self._lib.StructureNode(self._made)
            new.set("colorLimits", limits)
            for color in _COLORS:
                limits.set(f"{color}Minimum", self._lib.IntegerNode(self._made, 0))
                limits.set(f"{color}Maximum", self._lib.IntegerNode(self._made, 255))

    def _scan_at(self, path):
        """The place of the colors of the scan that is a path; None for anything else."""
        parts = path.strip("/").split("/")
        return self._colored.get(int(parts[1])) if len(parts) == 2 and parts[0] == "data3D" else None

    def _copy(self, node, attach, path):
        kind = node.type()
        if kind == self._lib.E57_COMPRESSED_VECTOR:
            self._records(self._lib.CompressedVectorNode(node), attach, path)
        else:
            self._copiers[kind](node, attach, path)

    def _structure(self, node, attach, path):
        new = self._lib.StructureNode(self._made)
        attach(new)
        self._children(self._lib.StructureNode(node), new, path)

    def _vector(self, node, attach, path):
        old = self._lib.VectorNode(node)
        new = self._lib.VectorNode(self._made, old.allowHeteroChildren())
        attach(new)
        for place in range(old.childCount()):
            self._copy(old.get(place), new.append, f"{path}{place}/")

    def _integer(self, node, attach, _path):
        old = self._lib.IntegerNode(node)
        attach(self._lib.IntegerNode(self._made, old.value(), old.minimum(), old.maximum()))

    def _scaled(self, node, attach, _path):
        old = self._lib.ScaledIntegerNode(node)
        range_ = (old.minimum(), old.maximum(), old.scale(), old.offset())
        attach(self._lib.ScaledIntegerNode(self._made, old.rawValue(), *range_))

    def _float(self, node, attach, _path):
        old = self._lib.FloatNode(node)
        attach(self._lib.FloatNode(self._made, old.value(), old.precision(), old.minimum(), old.maximum()))

    def _text(self, node, attach, _path):
        attach(self._lib.StringNode(self._made, self._lib.StringNode(node).value()))

    def _blob(self, node, attach, _path):
        old = self._lib.BlobNode(node)
        new = self._lib.BlobNode(self._made, old.byteCount())
        attach(new)

        def copy(_start, _share):
            for at in range(0, old.byteCount(), _PIECE):
                piece = bytearray(min(_PIECE, old.byteCount() - at))
                old.read(piece, at, len(piece))
                new.write(piece, at, len(piece))

        self._tasks.append(copy)

    def _records(self, old, attach, path):
        scan = self._scan_at(path.rstrip("/").rpartition("/")[0]) if path.endswith("/points/") else None
        prototype = self._lib.StructureNode(self._made)
        old_prototype = self._lib.StructureNode(old.prototype())
        fields = self._fields(old_prototype, prototype, () if scan is None else (*_COLORS, _INVALID))
        added = () if scan is None else _COLORS + (_INVALID,) * (scan[2] or old_prototype.isDefined(_INVALID))
        for name in added:
            prototype.set(name, self._lib.IntegerNode(self._made, 0, 0, 1 if name == _INVALID else 255))
        codecs = self._lib.VectorNode(self._made, True)
        new = self._lib.CompressedVectorNode(self._made, prototype, codecs)
        attach(new)
        count = old.childCount()
        if count and fields:
            self._tasks.append(
                lambda start, share: self._copy_records(old, new, fields, count, scan, added, start, share)
            )

    def _fields(self, old, new, left_out=(), above=""):
        """Copy the fields of a prototype, or of a structure in it; return the path of each, and its type in memory."""
        lib, fields = self._lib, []
        for place in range(old.childCount()):
            child = old.get(place)
            name, kind = child.elementName(), child.type()
            if name in left_out:
                continue
            if kind == lib.E57_STRING:
                self._answer({"lost": name[:100]})
                continue
            if kind == lib.E57_STRUCTURE:
                inside = lib.StructureNode(self._made)
                new.set(name, inside)
                fields += self._fields(lib.StructureNode(child), inside, above=f"{above}{name}/")
                continue
            self._copiers[kind](child, lambda node, name=name: new.set(name, node), "")
            single = kind == lib.E57_FLOAT and lib.FloatNode(child).precision() == lib.E57_SINGLE
            fields.append((f"{above}{name}", "q" if kind != lib.E57_FLOAT else "f" if single else "d"))
        return fields

    def _copy_records(self, old, new, fields, count, scan, added, start, share):
        read, write = self._lib.VectorSourceDestBuffer(), self._lib.VectorSourceDestBuffer()
        kept = []
        for name, code in fields:
            buffer = memoryview(bytearray(_RECORDS * (4 if code == "f" else 8))).cast(code)
            kept.append(buffer)
            read.append(self._lib.SourceDestBuffer(self._source, name, buffer, _RECORDS, False, False))
            write.append(self._lib.SourceDestBuffer(self._made, name, buffer, _RECORDS, False, False))
        colors = []
        for name in added:
            buffer = memoryview(bytearray(_RECORDS))
            colors.append(buffer)
            write.append(self._lib.SourceDestBuffer(self._made, name, buffer, _RECORDS, True, False))
        reader, writer = old.reader(read), new.writer(write)
        at = 0
        while done := reader.read():
            for place, buffer in enumerate(colors):
                first = scan[0] + place * scan[1] + at
                buffer[:done] = self._columns[first : first + done]
            writer.write(done)
            at += done
            self._answer({"at": int(1000 * (start + share * at / count))})
        reader.close()
        writer.close()


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    from program import send

    main(sys.stdin, send)
