"""Writes colors into a copy of the PTX that a scan came from; every other number stays as it is written."""

from pathlib import Path

from ...errors import ScanError
from ...messages import Message
from ..atomic import written_atomically
from ..gate import opened
from ..readers.options import AS_IT_IS
from ..readers.ptx import each_scan
from ..readers.ptx_points import END_MARKS, ptx_lines
from .point_colors import colors_of_points

_HEADER_LINES = 10
_LINES = 1 << 18
_COLORS = slice(4, 7)
# Lines without an intensity, and what programs that know none write there.
_BARE, _UNKNOWN = (3, 6), "0.500000"


def write_ptx_colors(source, colors, path, *, options=AS_IT_IS, progress=None, cancelled=None):
    """Write a copy of a PTX whose lines end with the colors that their scans were given.

    Headers, coordinates and intensities are copied word by word, in the order of the file. Parameters and errors are
    those of `write_e57_colors`; a scan that was given none keeps what it has.

    Returns
    -------
    list of Message
        What was left out: lines behind the last whole scan or column of a file that is cut short.
    """
    source, path = Path(source), Path(path)
    with opened(source, Message("a PTX file"), error=ScanError) as file:
        half = None if progress is None else (lambda fraction, text: progress(fraction / 2, text))
        words = _words_of_lines(file, source, colors, path, options, half, cancelled)
        file.seek(0)
        half = (
            None
            if progress is None
            else (lambda fraction, _: progress(0.5 + fraction / 2, Message("Writing {name}", name=path.name)))
        )
        lines = ptx_lines(file, source, progress=half, cancelled=cancelled)
        with (
            written_atomically(path) as temporary,
            temporary.open("w", encoding="latin-1", newline="\n") as made,
        ):
            for rgb in words:
                _copy_scan(lines, made, rgb)
            cut = _rest(lines)
    if not cut:
        return []
    return [
        Message(
            "{file}: {count} lines at the end of {source} are not a complete scan or column; they were left out",
            file=path.name,
            count=cut,
            source=source.name,
        )
    ]


def _rest(lines):
    """How many lines that are not blank are left."""
    count = 0
    while (line := lines.next_line()) is not None:
        count += bool(line.strip(END_MARKS))
    return count


def _words_of_lines(file, source, colors, path, options, progress, cancelled):
    """For every scan of the file (N, 3) uint8 of its lines; the number of them for one that keeps its own colors."""
    count = 0

    def counted():
        nonlocal count
        for scan in each_scan(file, source, options=options, progress=progress, cancelled=cancelled):
            count += 1
            yield scan

    found = {index: rgb for index, _, rgb, _ in colors_of_points(counted(), colors, path, source)}
    return [found.get(index) for index in range(count)]


def _copy_scan(lines, made, rgb):
    """Copy a header and the lines of points behind it."""
    header = []
    while len(header) < _HEADER_LINES:
        line = lines.next_line()
        if line is None:
            return
        if header or line.strip(END_MARKS):
            header.append(line)
    columns, rows = (int(float(word)) for word in header[:2])
    if rgb is not None and len(rgb) < columns * rows:
        # The complete columns of a file that is cut short.
        columns = len(rgb) // rows
        header[0] = str(columns)
    made.write("\n".join(header) + "\n")
    count, at = columns * rows, 0
    while at < count and (chunk := lines.take(min(_LINES, count - at))):
        chunk = [line for line in chunk if line and not line.isspace()]
        if rgb is None:
            made.writelines(f"{line.strip()}\n" for line in chunk)
        else:
            made.writelines(map(_colored, chunk, rgb[at : at + len(chunk)].tolist()))
        at += len(chunk)


def _colored(line, rgb):
    words = line.split()
    if len(words) in _BARE:
        words.insert(3, _UNKNOWN)
    words[_COLORS] = map(str, rgb)
    return " ".join(words) + "\n"
