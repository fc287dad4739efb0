"""Lines of a large text file, in blocks, with their numbers."""

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message
from ...native import library
from ...native.numbers import read_numbers
from ..gate import size_of

# Large enough to be read efficiently, small enough to stay in the cache until it is parsed.
_BLOCK = 1 << 20
_LONGEST_LINE = 1 << 16
# Of lines of numbers.
_BEGINNINGS = tuple(bytes([mark]) for mark in b"+-.,0123456789")
_WIDE_MARKS = (b"\xff\xfe", b"\xfe\xff")


class TextLines:
    """Hands out the lines of an open binary file: one by one for headers, many at once for bodies.

    Lines end in LF, CRLF or CR; a UTF-8 byte order mark is skipped.

    Parameters
    ----------
    file : binary file
    path : Path
        For messages.
    telling : slice, optional
        Those of the lines that are not blank which show how numbers are written: if commas or semicolons part them, or
        if they have a decimal comma, all lines are handed out with blanks and points instead.
    progress, cancelled : callable, optional
        As in `read_scans`; asked once per block.
    """

    def __init__(self, file, path, *, telling=None, progress=None, cancelled=None):
        self.path, self.size = path, size_of(file)
        self.number = 0
        """Number of the last line handed out, from 1."""
        self._file, self._progress, self._cancelled = file, progress, cancelled
        self._telling, self._others = telling, None
        # The current block: lines that end in LF, and where the next one begins.
        self._data, self._at = b"", 0
        self._rest, self._ended = b"", False
        self._room = None

    def next_line(self):
        """The next line that is not blank, stripped; None at the end of the file."""
        while self._filled():
            line = self._data[self._at : self._end_of_line(self._at)]
            self._hand_out(self._at + len(line) + 1, 1)
            if text := line.decode("latin-1").strip():
                return text
        return None

    def take(self, limit):
        """Up to `limit` lines as they are, blank ones among them, as many as one block has; empty at the end."""
        if not self._filled():
            return []
        lines = self._data[self._at :].split(b"\n", limit)
        left = lines.pop()
        if left and len(lines) < limit:
            # The last line of the file may lack its line end.
            lines.append(left)
            left = b""
        self._hand_out(len(self._data) - len(left), len(lines))
        return b"\n".join(lines).decode("latin-1").split("\n")

    def take_numbers(self, limit, widths):
        """Numbers of up to `limit` lines, as many as one block has of the same make, or None where others come next.

        Parameters
        ----------
        limit : int
        widths : collection of int
            How many numbers a line may have; the first one's number of them holds for all.

        Returns
        -------
        (n, width) float64 or None
            Overwritten by the next ones. None as well where the kernel is missing, or at the end.
        """
        if not library.available() or not self._filled():
            return None
        width = 0
        start = self._at
        while start < len(self._data) and not width:
            end = self._end_of_line(start)
            width, start = len(self._data[start:end].split()), end + 1
        if width not in widths:
            return None
        if self._room is None:
            # No number is shorter than a digit and what parts it from the next.
            self._room = np.empty(_BLOCK // 2)
        values, lines, end = read_numbers(self._data, self._at, limit, width, self._room)
        self._hand_out(end, lines)
        return values if lines else None

    def bytes_left(self):
        """How many bytes of text have not been handed out yet; at most, for line ends may take two."""
        # Every line counts with its line end, whether or not the last one has one.
        here = len(self._data) - self._at + (self._at < len(self._data) and not self._data.endswith(b"\n"))
        return self.size - self._file.tell() + len(self._rest) + here

    def at_end(self):
        """Whether no line is left."""
        return not self._filled()

    def check_cancelled(self):
        """Raise Cancelled if the reading is to stop; asked for every block, so only for what may have many of them."""
        if self._cancelled and self._cancelled():
            raise Cancelled

    def error(self, template, *, number=None, **values):
        """A ScanError that names the file and a line, the last one handed out unless another is given."""
        place = {"file": self.path.name, "line": self.number if number is None else number}
        return ScanError("{file}: line {line}: {problem}", **place, problem=Message(template, **values))

    def _end_of_line(self, start):
        end = self._data.find(b"\n", start)
        return len(self._data) if end < 0 else end

    def _hand_out(self, end, lines):
        self._at = min(end, len(self._data))
        self.number += lines

    def _filled(self):
        """Make sure that there is a line to hand out; False at the end of the file."""
        while self._at == len(self._data):
            if self._ended:
                return False
            self._read_block()
        return True

    def _read_block(self):
        self.check_cancelled()
        first = self._file.tell() == 0
        block = self._file.read(_BLOCK)
        if first:
            if block.startswith(_WIDE_MARKS):
                raise ScanError(
                    "{file}: is UTF-16 text, expected plain text: save it as ASCII or UTF-8", file=self.path.name
                )
            block = block.removeprefix(b"\xef\xbb\xbf")
        self._ended = not block
        data = self._rest + block
        returns = b"\r" in data
        # A CR in the last place may be the first half of a CRLF: it waits for the next block.
        cut = max(data.rfind(b"\n"), data.rfind(b"\r", 0, -1) if returns else -1) + 1
        cut = len(data) if self._ended else cut
        data, self._rest = data[:cut], data[cut:]
        if len(self._rest) > _LONGEST_LINE:
            raise self.error("longer than any line of numbers; not a text file", number=self.number + 1)
        if returns:
            data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        if first and self._telling is not None:
            self._others = _other_marks([line for line in data.split(b"\n") if line.strip()][self._telling])
        self._data, self._at = data if self._others is None else data.translate(self._others), 0
        if self._progress and self.size:
            self._progress(min(1.0, self._file.tell() / self.size), Message("Reading {file}", file=self.path.name))


def _other_marks(lines):
    """A table for `bytes.translate` that makes numbers of some lines ordinary; None where they are."""
    lines = [line for line in lines if line.lstrip()[:1] in _BEGINNINGS]
    text = b"\n".join(lines)
    if b";" in text:
        return bytes.maketrans(b";,", b" .")
    if b"," not in text:
        return None
    # With points as well, or without blanks, commas part the numbers.
    parts = b"." in text or not any(b"," in word for line in lines for word in line.split()[1:])
    return bytes.maketrans(b",", b" " if parts else b".")
