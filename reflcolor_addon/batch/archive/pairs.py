"""The table of photos and the scans that they show: written after a batch, edited by a person, read by the next one."""

import csv
import io
from pathlib import Path

from ...errors import ReflcolorError, UsageError
from ...files.atomic import written_atomically
from ...files.gate import contents

COLUMNS = ("scan", "photo", "shows", "evidence", "note")
YES, NO, UNTESTED, UNTRIED = "yes", "no", "cannot be tested", "not tried"
CONTRADICTION = "contradiction"
"""What the column ``shows`` holds; a contradiction is a photo that was verified, but shows another place."""
_MOST_BYTES = 1 << 28


def read_pairs(path):
    """Read what a person knows of pairs.

    Parameters
    ----------
    path : Path
        A table with the columns ``scan`` (an item's name), ``photo`` (a path, as the manifest's folder sees it) and
        ``shows`` ("yes", "no", or anything else for not known).

    Returns
    -------
    dict of (str, str) to bool

    Raises
    ------
    UsageError
        If it is no such table.
    """
    try:
        text = contents(path, "a table of pairs (.csv)", most=_MOST_BYTES).decode("utf-8-sig")
    except ReflcolorError as error:
        raise UsageError(error.message) from error
    except UnicodeDecodeError as error:
        raise UsageError("{file}: is not UTF-8; save it as UTF-8", file=path) from error
    # A spreadsheet in some countries writes semicolons.
    delimiter = ";" if ";" in text.partition("\n")[0] else ","
    table = csv.DictReader(io.StringIO(text, newline=""), delimiter=delimiter)
    known = {}
    for row in _rows(table, path):
        if any(row.get(name) is None for name in COLUMNS[:3]):
            raise UsageError(
                "{file}: line {line}: expected the columns {columns}",
                file=path,
                line=table.line_num,
                columns=", ".join(COLUMNS[:3]),
            )
        shows = row["shows"].strip().casefold()
        if shows in (YES, NO):
            known[row["scan"].strip(), row["photo"].strip()] = shows == YES
    return known


def _rows(table, path):
    try:
        yield from table
    except csv.Error as error:
        raise UsageError(
            "{file}: line {line}: is no table ({reason}); write it anew, or leave it out",
            file=path,
            line=table.line_num + 1,
            reason=error,
        ) from error


def write_pairs(path, rows):
    """Write the table.

    Parameters
    ----------
    path : Path
    rows : iterable of tuple
        Values of `COLUMNS`.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(rows)
    with written_atomically(Path(path)) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", errors="backslashreplace", newline="")
