"""PTX: text, one or several scans one after another, each a header and its points column by column."""

import re
from dataclasses import replace
from functools import partial

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message, of_scan
from ...scan.limits import MOST_PIXELS
from ..memory import require_memory
from .angle import gridded_by_angle
from .cloud import Place
from .formats import Format
from .grid import BYTES_PER_PIXEL, UnusableScan, finish_grid, with_problems
from .options import ANGLE, AS_IT_IS, LIGHTER, pixels_kept
from .poses import ptx_pose
from .ptx_points import END_MARKS, PointLines, number_of, ptx_lines, shortened, shown

_SHORTEST_LINE = len("0 0 0 0\n")
# Lines whose mean length tells how many there are, and which share of a scan more than the first one is another scan.
_LINES_TO_MEASURE, _ANOTHER = 4096, 0.05
_COUNT = re.compile(r"\d{1,18}(\.0*)?")


def read_ptx(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read every scan of a PTX file.

    A scan is: columns, rows; the scanner's position and its three axes (4 lines of 3); a 4 x 4 matrix in row-vector
    convention; then columns x rows lines ``x y z [intensity] [red green blue]`` in the scanner's own frame, column by
    column. ``0 0 0`` is no return, and so is what is no number. CRLF, tabs, blank lines, commas, a byte order mark and
    what old programs put at the end of a file are fine. Of a file that is cut short what is whole is kept.

    Parameters
    ----------
    file : binary file
    path : Path
        Its name, for messages.
    options : ReadOptions
    progress, cancelled : callable, optional

    Errors are those of `read_scans`.
    """
    read = [scan for scan, *_ in each_scan(file, path, options=options, progress=progress, cancelled=cancelled)]
    finished = [scan for scan in read if not isinstance(scan, UnusableScan)]
    return with_problems(finished, [scan for scan in read if isinstance(scan, UnusableScan)], len(read), path)


def each_scan(file, path, *, options=AS_IT_IS, progress=None, cancelled=None):
    """Yield for every scan of a PTX file, in its order, (scan, order, cells), as the one of E57 does.

    ``cells()`` has one number for each line of points of the scan.
    """
    stored = _stored_scans(file, path, options, progress, cancelled)
    while stored:
        if cancelled and cancelled():
            raise Cancelled
        scan = stored.pop(0)
        cells = scan.pop("cells")
        try:
            if options.grid == ANGLE:
                by_angle = _by_angle(scan, cells(), path, options)
                cells = partial(np.asarray, by_angle)
            yield (*finish_grid(source=path, **scan), cells)
        except UnusableScan as error:
            yield error, None, None


def _by_angle(stored, cells, path, options):
    """Put the points of stored grids onto one by angle; return where each line of the file goes then."""
    place = Place(file_name=path.name, name=stored["name"])

    def warn(template, **values):
        stored["warnings"].append(of_scan(place.name, template, **values))

    def flat(grid):
        return None if grid is None else grid.reshape(-1, *grid.shape[2:])[np.maximum(cells, 0)]

    points, named = flat(stored["points"]), [np.zeros(3), *stored["places"].values()]
    valid = (cells >= 0) & (points != 0).any(axis=-1)
    strength, color = flat(stored["reflectance"]), flat(stored["color"])
    arrays, cells = gridded_by_angle(place, points, valid, strength, color, named, options, warn)
    stored.update(arrays)
    return cells


def _stored_scans(file, path, options, progress, cancelled):
    """Keyword arguments of `finish_grid` for every scan, and ``cells``."""
    stored = []
    lines = ptx_lines(file, path, progress=progress, cancelled=cancelled)
    rest = None
    while rest is None and (line := lines.next_line()) is not None:
        lines.check_cancelled()
        if not line.strip(END_MARKS):
            continue
        if stored and not _COUNT.fullmatch(line):
            rest = Message(
                "line {line}: what follows its last scan is not a scan and was left out: '{found}'",
                line=lines.number,
                found=shortened(line),
            )
            break
        try:
            stored.append(_read_scan(lines, line, after=bool(stored), options=options))
        except _CutShort as cut:
            if not stored:
                raise cut.error from None
            rest = Message("its scan {number} was left out: {reason}", number=len(stored) + 1, reason=cut.error.message)
    if not stored:
        raise ScanError("{file}: holds no text, expected the header of a PTX scan", file=path.name)
    for index, scan in enumerate(stored):
        scan["name"] = path.stem if len(stored) == 1 else f"{path.stem} {index + 1}"
        position, axes, matrix = scan.pop("placed")
        scan["pose"], notes = ptx_pose(position, axes, matrix, scan["name"])
        scan["places"] = {
            name: place for name, place in (("matrix", matrix[3, :3]), ("position", position)) if place.any()
        }
        if np.array_equal(matrix[3, :3], position):
            scan["places"].pop("position", None)
        scan["options"] = replace(options, step=scan.pop("step"))
        scan["warnings"] = notes + [
            Message("scan '{scan}': {note}", scan=scan["name"], note=note) for note in scan["warnings"]
        ]
    if rest is not None:
        stored[-1]["warnings"].append(Message("scan '{scan}': {note}", scan=stored[-1]["name"], note=rest))
    return stored


class _CutShort(Exception):
    """A scan ends before it is whole."""

    def __init__(self, error):
        self.error = error
        super().__init__(str(error))


def ptx_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return the pixels of the first scan of a PTX and, where the rest of the file has room for more, those of the
    others together, by the length of the first lines; see `scan_pixels`."""
    lines = ptx_lines(file, path)
    while (line := lines.next_line()) is not None and not line.strip(END_MARKS):
        continue
    if line is None:
        raise ScanError("{file}: holds no text, expected the header of a PTX scan", file=path.name)
    try:
        columns, rows, *_ = _read_header(lines, line, after=False)
    except _CutShort as cut:
        raise cut.error from None
    count, left = columns * rows, lines.bytes_left()
    some = lines.take(min(count, _LINES_TO_MEASURE))
    others = round(left * len(some) / max(sum(len(line) + 1 for line in some), 1)) - count
    pixels = [count, others] if others > count * _ANOTHER else [count]
    return pixels_kept(pixels, options)


def _read_scan(lines, first, *, after, options):
    columns, rows, count, placed = _read_header(lines, first, after=after)
    step = 1 if options.grid == ANGLE else options.step
    require_memory(
        count // step**2 * BYTES_PER_PIXEL,
        Message("{file}: {columns} columns x {rows} rows", file=lines.path.name, columns=columns, rows=rows),
        way=LIGHTER,
        error=ScanError,
    )
    body = PointLines(lines, count, (rows, columns), step)
    found = body.read()
    notes = body.notes()
    if found < columns * rows:
        ended = lines.error(
            "the file ends after {at} of {count} points ({columns} columns x {rows} rows); it is cut short",
            at=found,
            count=columns * rows,
            columns=columns,
            rows=rows,
        )
        # If there is only one scan, its complete columns are better than nothing.
        if after or found < 2 * rows:
            raise _CutShort(ended)
        notes.append(Message("{reason}; its complete columns were read", reason=ended.message))
    grids = body.grids(found, notes)
    return {**grids, "step": options.step // step, "placed": placed, "warnings": notes}


def _read_header(lines, first, *, after):
    """Columns, rows, the points that the rest of the file has room for, and (position, axes, matrix) of a scan."""
    try:
        columns = _count(lines, first, Message("columns"), after)
        header = lines.number
        rows = _count(lines, _header_line(lines, Message("the number of rows")), Message("rows"), False)
        position = _numbers(lines, 3, Message("the scanner's position"))
        axes = np.array([_numbers(lines, 3, Message("a scanner axis")) for _ in range(3)])
        matrix = np.array([_numbers(lines, 4, Message("a row of the matrix")) for _ in range(4)])
    except ScanError as error:
        if lines.at_end():
            raise _CutShort(error) from None
        raise
    count, left = columns * rows, lines.bytes_left()
    room = (left + 1) // _SHORTEST_LINE
    short = count > room and (after or count > MOST_PIXELS or room < 2 * rows)
    if short:
        announced = lines.error(
            "{columns} columns x {rows} rows announced, but the rest of the file ({left} bytes) has room for at most "
            "{most} points; it is cut short, or its header is wrong",
            number=header,
            columns=columns,
            rows=rows,
            left=left,
            most=room,
        )
        raise _CutShort(announced)
    return columns, rows, min(count, room), (position, axes, matrix)


def _header_line(lines, what):
    line = lines.next_line()
    if line is None:
        raise lines.error("the file ends where {what} was expected; it is cut short", what=what)
    return line


def _count(lines, line, what, after):
    if _COUNT.fullmatch(line) and (value := int(line.partition(".")[0])) > 0:
        return value
    found = shortened(line)
    if after:
        raise lines.error(
            "expected the end of the file or the number of columns of the next scan, found '{found}'", found=found
        )
    raise lines.error("expected the number of {what} (a whole number above 0), found '{found}'", what=what, found=found)


def _numbers(lines, count, what):
    words = _header_line(lines, what).split()
    if len(words) != count:
        raise lines.error(
            "expected {what} ({count} numbers), found {found}", what=what, count=count, found=shown(words)
        )
    return np.array([number_of(lines, word, lines.number) for word in words])


def _is_ptx(start):
    text = start.removeprefix(b"\xef\xbb\xbf").split()
    return len(text) > 2 and text[0].isdigit() and text[1].isdigit() and len(start.splitlines()[0].split()) == 1


FORMAT = Format(
    name="PTX",
    suffixes=(".ptx",),
    read=read_ptx,
    pixels=ptx_pixels,
    sniff=_is_ptx,
    about="one or several scans, in any order of rows and columns",
)
