"""Lines of a large text file, in blocks, with their numbers."""

from ...errors import Cancelled, ScanError
from ..gate import size_of

_BLOCK = 1 << 24
_LONGEST_LINE = 1 << 16
_WIDE_MARKS = (b"\xff\xfe", b"\xfe\xff")


class TextLines:
    """Hands out the lines of an open binary file: one by one for headers, many at once for bodies.

    Lines end in LF, CRLF or CR; a UTF-8 byte order mark is skipped.

    Parameters
    ----------
    file : binary file
    path : Path
        For messages.
    progress, cancelled : callable, optional
        As in `read_scans`; asked once per block.
    """

    def __init__(self, file, path, *, progress=None, cancelled=None):
        self.path, self.size = path, size_of(file)
        self.number = 0
        """Number of the last line handed out, from 1."""
        self._file, self._progress, self._cancelled = file, progress, cancelled
        self._lines, self._at, self._waiting = [], 0, 0
        self._rest, self._ended = b"", False

    def next_line(self):
        """The next line that is not blank, stripped; None at the end of the file."""
        while self._filled():
            line = self._handed_out(1)[0].strip()
            if line:
                return line
        return None

    def take(self, limit):
        """Up to `limit` lines as they are, blank ones among them, as many as one block has; empty at the end."""
        if not self._filled():
            return []
        return self._handed_out(limit)

    def bytes_left(self):
        """How many bytes of text have not been handed out yet; at most, for line ends may take two."""
        return self.size - self._file.tell() + len(self._rest) + self._waiting

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
        return ScanError("{file}: line {line}: " + template, **place, **values)

    def _handed_out(self, limit):
        lines = self._lines[self._at : self._at + limit]
        self._at += len(lines)
        self.number += len(lines)
        self._waiting -= sum(map(len, lines)) + len(lines)
        return lines

    def _filled(self):
        """Make sure that there is a line to hand out; False at the end of the file."""
        while self._at == len(self._lines):
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
        # A CR in the last place may be the first half of a CRLF: it waits for the next block.
        cut = len(data) if self._ended else max(data.rfind(b"\n"), data.rfind(b"\r", 0, -1)) + 1
        data, self._rest = data[:cut], data[cut:]
        if len(self._rest) > _LONGEST_LINE:
            raise self.error("longer than any line of numbers; not a text file", number=self.number + 1)
        if b"\r" in data:
            data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        self._lines, self._at = data.decode("latin-1").split("\n"), 0
        if self._lines[-1] == "":
            del self._lines[-1]
        # Every line counts with the end that it has, or could have.
        self._waiting = len(data) + (not data.endswith(b"\n"))
        if self._progress and self.size:
            self._progress(min(1.0, self._file.tell() / self.size), f"Reading {self.path.name}")
