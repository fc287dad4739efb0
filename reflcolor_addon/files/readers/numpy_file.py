"""Arrays in .npy and .npz files, read row by row; of large grids only those rows and columns that are wanted."""

import math
import struct
import tokenize
import zipfile
import zlib
from contextlib import contextmanager

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message
from ...scan.limits import MOST_PIXELS
from ..gate import size_of
from .cloud import check_size

MAGIC, ZIP = b"\x93NUMPY", b"PK\x03\x04"
_MOST_MEMBERS = 256
_PACKED_AT_MOST = 1100
_PACKED_BY = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_DAMAGED = (
    *(ValueError, KeyError, TypeError, EOFError, NotImplementedError),
    *(SyntaxError, tokenize.TokenError, struct.error, zlib.error, zipfile.BadZipFile),
)
"""What NumPy and zipfile raise where bytes of a file were changed or are missing, as the fuzz tests show: a header that
is no Python literal, or one without its keys; a member whose table, version or stream is damaged. The user gets one
line for all of them. A failing disk is an OSError, which the gate reports."""
_ENCRYPTED = 1
_BLOCK = 1 << 20


class NumpyFile:
    """A .npy or .npz file.

    Parameters
    ----------
    file : binary file
    path : Path
        For messages.
    progress, cancelled : callable, optional
    """

    def __init__(self, file, path, progress=None, cancelled=None):
        self._file, self._path, self._progress, self._cancelled = file, path, progress, cancelled

    def arrays(self, wanted=None):
        """Return arrays by name, in lower case; a .npy's has none. Sizes are held against the file before they are
        read.

        Parameters
        ----------
        wanted : callable, optional
            Called with the shape of every array by its name before any is read; returns for each name a tuple of
            slices, which of it to read, or nothing for all.

        Raises
        ------
        ScanError
            In one line.
        Cancelled
            If ``cancelled()`` returned True.
        """
        wanted = wanted or _all
        with self._damage_reported():
            if self._is_one_array():
                shape, *_ = _header(self._file, size_of(self._file), self._path)
                self._file.seek(0)
                whole = size_of(self._file)
                return _named(self._array(self._file, whole, wanted({"": shape}).get(""), 0, whole))
            with zipfile.ZipFile(self._file) as archive:
                return self._members(archive, wanted)

    def shapes(self):
        """Return the shapes of the arrays by name; nothing else of them is read. Errors are those of `arrays`."""
        with self._damage_reported():
            if self._is_one_array():
                shape, _, dtype = _header(self._file, size_of(self._file), self._path)
                return dict.fromkeys(map(str.lower, dtype.names or [""]), shape)
            with zipfile.ZipFile(self._file) as archive:
                return self._shapes(archive, self._listed(archive))

    def _is_one_array(self):
        start = self._file.read(len(MAGIC))
        self._file.seek(0)
        return start == MAGIC

    @contextmanager
    def _damage_reported(self):
        try:
            yield
        except ScanError:
            raise
        except _DAMAGED as error:
            # Their texts are about Python, and quote the file at length.
            raise ScanError(
                "{file}: it is damaged or cut short, or holds something other than arrays of numbers",
                file=self._path.name,
            ) from error

    def _listed(self, archive):
        """The arrays of a .npz, which its size can hold."""
        members = [member for member in archive.infolist() if member.filename.endswith(".npy")]
        if len(members) > _MOST_MEMBERS:
            raise ScanError("{file}: holds {count:,} arrays", file=self._path.name, count=len(members))
        if sum(member.file_size for member in members) > _PACKED_AT_MOST * size_of(self._file):
            raise ScanError("{file}: claims to hold more than a file of its size can", file=self._path.name)
        if any(member.flag_bits & _ENCRYPTED for member in members):
            raise ScanError("{file}: is encrypted; save it without a password", file=self._path.name)
        if any(member.compress_type not in _PACKED_BY for member in members):
            raise ScanError("{file}: uses a compression that NumPy does not write", file=self._path.name)
        return members

    def _shapes(self, archive, members):
        shapes = {}
        for member in members:
            with archive.open(member) as data:
                shapes[_name(member)] = _header(data, member.file_size, self._path)[0]
        return shapes

    def _members(self, archive, wanted):
        members = self._listed(archive)
        shapes = self._shapes(archive, members)
        parts = wanted(shapes)
        found, done, whole = {}, 0, sum(member.file_size for member in members)
        for member in members:
            name = _name(member)
            if len(shapes[name]) in (1, 2, 3):
                with archive.open(member) as data:
                    found[name] = self._array(data, member.file_size, parts.get(name), done, whole)
            done += member.file_size
        return found

    def _array(self, data, size, part, done, whole):
        """Read one array, or a part of it by steps: only that takes memory, unless it is stored column by column."""
        shape, fortran, dtype = _header(data, size, self._path)
        kept = math.prod(len(range(length)[every]) for length, every in zip(shape, part or (), strict=False))
        check_size(self._path, kept * math.prod(shape[len(part or ()) :]) // 3, 3)
        if part and not fortran and len(shape) > 1:
            rows, line = range(shape[0])[part[0]], np.empty(shape[1:], dtype)
            first = line[part[1:]]
            found = np.empty((len(rows), *first.shape), dtype)
            for row in range(shape[0]):
                self._fill(data, line)
                if row in rows:
                    found[rows.index(row)] = line[part[1:]]
                self._report(done + row * line.nbytes, whole)
            return found
        found = np.empty(shape[::-1] if fortran else shape, dtype)
        self._fill(data, found, done, whole)
        found = found.T if fortran else found
        return found[part].copy() if part else found

    def _fill(self, data, array, done=0, whole=0):
        room = memoryview(array.reshape(-1).view(np.uint8)) if array.size and array.dtype.itemsize else b""
        for first in range(0, len(room), _BLOCK):
            piece = room[first : first + _BLOCK]
            if data.readinto(piece) != len(piece):
                raise EOFError
            if whole:
                self._report(done + first, whole)

    def _report(self, done, whole):
        if self._cancelled and self._cancelled():
            raise Cancelled
        if self._progress:
            self._progress(min(1.0, done / whole), Message("Reading {file}", file=self._path.name))


def _all(_shapes):
    return {}


def _name(member):
    return member.filename.removesuffix(".npy").lower()


def _named(array):
    """An array as a dictionary: the fields of a table under their names."""
    if array.dtype.names:
        return {name.lower(): array[name] for name in array.dtype.names}
    return {"": array}


def _header(data, size, path):
    """(shape, whether column by column, dtype) of an array, which its file can hold; leaves the file behind it."""
    version = np.lib.format.read_magic(data)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, fortran, dtype = read(data)
    count = int(np.prod(shape, dtype=object))
    if dtype.hasobject or count * dtype.itemsize > size or count > 4 * MOST_PIXELS:
        raise ScanError("{file}: one of its arrays claims more data than the file can hold", file=path.name)
    return shape, fortran, dtype
