"""The table of photos and the scans that they show: written after a batch, edited by a person, read by the next one."""

import csv
import io
from difflib import get_close_matches
from pathlib import Path

from ...errors import ReflcolorError, UsageError
from ...files.atomic import written_atomically
from ...files.gate import contents
from ...messages import Message

COLUMNS = ("scan", "photo", "shows", "evidence", "note")
YES, NO, UNTESTED, UNTRIED = "yes", "no", "cannot be tested", "not tried"
CONTRADICTION = "contradiction"
"""What the column ``shows`` holds; a contradiction is a photo that was verified, but shows another place."""
_SHOWS = ("", YES, NO, UNTESTED, UNTRIED, CONTRADICTION)
_MOST_BYTES = 1 << 28
# More names that a batch does not have are only counted.
_MOST_NAMES = 5


def read_pairs(path):
    """Read what a person knows of pairs.

    Parameters
    ----------
    path : Path
        A table with the columns ``scan`` (an item's name), ``photo`` (a path, as the manifest's folder sees it) and
        ``shows`` ("yes", "no", or for what is not known nothing, or what a batch wrote there). A "no" with a note
        and evidence of less than 1 is what a batch found, and nobody's word.

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
        if shows not in _SHOWS:
            raise UsageError(
                "{file}: line {line}: shows {found!r}: expected yes or no, or nothing where that is not known",
                file=path,
                line=table.line_num,
                found=row["shows"],
            )
        if shows == YES or (shows == NO and not _is_found(row.get("evidence"), row.get("note"))):
            known[row["scan"].strip(), row["photo"].strip()] = shows == YES
    return known


def _is_found(evidence, note):
    """Whether a batch wrote these, and the evidence is not enough; spreadsheets may write commas."""
    try:
        return bool(note) and float(evidence.replace(",", ".")) < 1
    except (AttributeError, ValueError):
        return False


def unknown_names(path, known, scans, photos):
    """Yield a `Message` for names in a table of pairs that are of no scan or photo of the batch.

    Parameters
    ----------
    path : Path
        Of the table.
    known : dict of (str, str) to bool
        What it says.
    scans, photos : collection of str
        The names that the batch has.
    """
    missing = [(name, Message("no scan of this batch"), scans) for name in dict.fromkeys(scan for scan, _ in known)] + [
        (name, Message("no photo of this batch"), photos) for name in dict.fromkeys(photo for _, photo in known)
    ]
    missing = [(name, what, names) for name, what, names in missing if name not in names]
    for name, what, names in missing[:_MOST_NAMES]:
        near = get_close_matches(name, names, 1)
        hint = Message("; did you mean {name}?", name=near[0]) if near else ""
        yield Message(
            "{file}: {name!r} is {what}, so what is said of it has no effect{hint}",
            file=path,
            name=name,
            what=what,
            hint=hint,
        )
    if len(missing) > _MOST_NAMES:
        yield Message("{file}: {count} more names are of no scan or photo", file=path, count=len(missing) - _MOST_NAMES)


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
