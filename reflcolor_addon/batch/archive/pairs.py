"""The table of photos and the scans that they show: written after a batch, edited by a person, read by the next one."""

import csv
import io
from pathlib import Path

from ...errors import ReflcolorError, UsageError
from ...files.atomic import written_atomically
from ...files.gate import contents
from ...messages import Message
from .meant import hint

COLUMNS = ("scan", "photo", "shows", "evidence", "note")
YES, NO, UNTESTED, UNTRIED = "yes", "no", "cannot be tested", "not tried"
CONTRADICTION = "contradiction"
"""What the column ``shows`` holds; a contradiction is a photo that was verified, but shows another place."""
_SHOWS = ("", YES, NO, UNTESTED, UNTRIED, CONTRADICTION)
_MOST_BYTES = 1 << 28
# More faults, and more names that a batch does not have, are only counted.
_MOST_NAMES = 20


def _raise(error):
    raise error


def read_pairs(path, refuse=_raise, lines=None):
    """Read what a person knows of pairs.

    Parameters
    ----------
    path : Path
        A table with the columns ``scan`` (an item's name), ``photo`` (a path, as the manifest's folder sees it) and
        ``shows`` ("yes", "no", or for what is not known nothing, or what a batch wrote there). A "no" with a note
        and evidence of less than 1 is what a batch found, and nobody's word.
    refuse : callable, optional
        Given a UsageError for each thing that is wrong; by default the first one is raised.
    lines : dict, optional
        The line of each pair is put into it.

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
        refuse(UsageError(error.message))
        return {}
    except UnicodeDecodeError:
        refuse(UsageError("{file}: is not UTF-8; save it as UTF-8", file=path))
        return {}
    known, lines, faults = {}, {} if lines is None else lines, []
    for line, scan, photo, shows in _rows(text, path, faults.append):
        if known.setdefault((scan, photo), shows) != shows:
            faults.append(
                UsageError(
                    "{file}: line {line}: says {shows} of {scan} and {photo}, but line {other} says {otherwise}; "
                    "leave one of them out",
                    file=path,
                    line=line,
                    shows=YES if shows else NO,
                    scan=scan,
                    photo=photo,
                    other=lines[scan, photo],
                    otherwise=NO if shows else YES,
                )
            )
        lines.setdefault((scan, photo), line)
    for fault in faults[:_MOST_NAMES]:
        refuse(fault)
    if len(faults) > _MOST_NAMES:
        refuse(UsageError("{file}: {count} more lines are wrong", file=path, count=len(faults) - _MOST_NAMES))
    return known


def _rows(text, path, refuse):
    """Yield the lines in which a person says whether a scan is shown: (line, scan, photo, whether it is)."""

    def wrong(line, template, /, **values):
        refuse(UsageError("{file}: line {line}: " + template, file=path, line=line, **values))

    # A spreadsheet in some countries writes semicolons, and some write tabs.
    head = text.partition("\n")[0]
    table = csv.DictReader(io.StringIO(text, newline=""), delimiter=max(",;\t", key=head.count))
    try:
        if not set(COLUMNS[:3]).issubset(table.fieldnames or ()):
            columns, found = ", ".join(COLUMNS[:3]), ", ".join(table.fieldnames or ()) or "nothing"
            wrong(1, "expected the columns {columns}, found {found}", columns=columns, found=found)
            return
        for row in table:
            shows = (row["shows"] or "").strip().casefold()
            if any(row[name] is None for name in COLUMNS[:3]):
                wrong(
                    table.line_num, "expected a value in each of the columns {columns}", columns=", ".join(COLUMNS[:3])
                )
            elif shows not in _SHOWS:
                wrong(
                    table.line_num,
                    "shows {found!r}: expected yes or no, or nothing where that is not known",
                    found=row["shows"],
                )
            elif shows == YES or (shows == NO and not _is_found(row.get("evidence"), row.get("note"))):
                yield table.line_num, row["scan"].strip(), row["photo"].strip(), shows == YES
    except csv.Error as error:
        wrong(table.line_num + 1, "is no table ({reason}); write it anew, or leave it out", reason=error)


def _is_found(evidence, note):
    """Whether a batch wrote these, and the evidence is not enough; spreadsheets may write commas."""
    try:
        return bool(note) and float(evidence.replace(",", ".")) < 1
    except (AttributeError, ValueError):
        return False


def unknown_names(path, lines, scans, photos):
    """Yield a `Message` for names in a table of pairs that are of no scan or photo of the batch.

    Parameters
    ----------
    path : Path
        Of the table.
    lines : dict of (str, str) to int
        The line of each pair.
    scans, photos : dict of str to iterable of str
        The names that the batch has, and other ways to write each of them.
    """
    missing = {}
    for (scan, photo), line in lines.items():
        if scan not in scans:
            missing.setdefault(scan, (line, Message("no scan of this batch"), scans))
        if photo not in photos:
            missing.setdefault(photo, (line, Message("no photo of this batch"), photos))
    for name, (line, what, names) in list(missing.items())[:_MOST_NAMES]:
        yield Message(
            "{file}: line {line}: {name!r} is {what}, so what is said of it has no effect{hint}",
            file=path,
            line=line,
            name=name,
            what=what,
            hint=hint(name, names),
        )
    if len(missing) > _MOST_NAMES:
        yield Message("{file}: {count} more names are of no scan or photo", file=path, count=len(missing) - _MOST_NAMES)


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
