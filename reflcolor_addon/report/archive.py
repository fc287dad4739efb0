"""The report of a whole batch: one page that needs nothing but a browser, and one table."""

import base64
import csv
import io
import re
from html import escape
from importlib.resources import files
from string import Template

from ..errors import OutputError, ReflcolorError
from ..files.atomic import written_atomically
from ..files.gate import contents
from ..version import __version__
from ..view.colormaps import UNKNOWN
from ..view.preview import GUESS, INFERRED, OBSERVED
from .archive_entries import COLUMNS, PAIRS, entries_of, photos_of

PAGE, TABLE = "report.html", "report.csv"
# A browser is slow with more; then there are several pages.
_SCANS_ON_A_PAGE, _OTHER_PAGE = 1000, "report {number}.html"
_IS_OTHER_PAGE = re.compile(r"report [1-9]\d*\.html")
_LARGEST_PREVIEW = 1 << 22
# Of more photos no pictures are shown: a browser would be slow.
_MOST_SMALL, _SMALL_SIDE = 1000, 128
_STATES = {
    "done": "colorized",
    "guessed": "colorized from guesses",
    "unshown": "no certain photo",
    "failed": "failed",
    "duplicate": "duplicate",
    "open": "not begun",
}


def write_page(root, session):
    """Merge the reports in the folder of a batch.

    Parameters
    ----------
    root : Path
        The folder; ``reports`` in it holds a report of each scan and its preview.
    session : object
        With ``progress(fraction, text)`` and ``warnings``, as of the pipeline.

    Returns
    -------
    paths : list of Path
        The page and the table; of several pages the first, which leads to the others.
    failed : list of str
        The names of the scans that failed.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    entries = entries_of(root, session)
    _write_pages(root, entries)
    page, table = root / PAGE, root / TABLE
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: entry[name] for name in COLUMNS} for entry in entries)
    with written_atomically(table) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", errors="backslashreplace", newline="")
    return [page, table], [entry["scan"] for entry in entries if entry["state"] == "failed"]


def _write_pages(root, entries):
    parts = [entries[start : start + _SCANS_ON_A_PAGE] for start in range(0, len(entries), _SCANS_ON_A_PAGE)] or [[]]
    names = [PAGE, *(_OTHER_PAGE.format(number=number) for number in range(2, len(parts) + 1))]
    for number, (name, part) in enumerate(zip(names, parts, strict=True)):
        with written_atomically(root / name) as temporary:
            # What is told of photos stands on the first page.
            photos = "" if number else _photos(photos_of(root), (root / PAIRS).is_file())
            text = _page(root, entries, part, _ways(names, parts, number), photos)
            temporary.write_text(text, encoding="utf-8", errors="xmlcharrefreplace")
    for path in root.iterdir():
        # Of an earlier time, when there were more.
        if _IS_OTHER_PAGE.fullmatch(path.name) and path.name not in names:
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                raise OutputError(
                    "{file}: is of an earlier report, and cannot be deleted ({reason})",
                    file=path,
                    reason=error.strerror,
                ) from error


def _ways(names, parts, own):
    """What leads from one page to the others; nothing where it is the only one."""
    if len(names) == 1:
        return ""
    links = []
    for number, (name, part) in enumerate(zip(names, parts, strict=True)):
        here = ' aria-current="page"' if number == own else ""
        links.append(f'<a href="{escape(name)}"{here}>{escape(part[0]["scan"])} to {escape(part[-1]["scan"])}</a>')
    return (
        f'<nav aria-label="Pages"><p>{" · ".join(links)}</p><p class="soft">Searching and sorting act on one page; '
        f"{TABLE} holds all scans.</p></nav>"
    )


def _scans(count):
    return "1 scan" if count == 1 else f"{count} scans"


def _page(root, entries, part, ways, photos):
    template = Template(files(__package__).joinpath("page.html").read_text(encoding="utf-8"))
    count = {state: sum(entry["state"] == state for entry in entries) for state in _STATES}
    parts = [f"{number} {_STATES[state]}" for state, number in count.items() if number]
    colors = {"observed": OBSERVED, "inferred": INFERRED, "guess": GUESS, "unknown": UNKNOWN}
    return template.substitute(
        title=escape(f"Colorized scans in {root.absolute().name}"),
        summary=escape(f"{_scans(len(entries))}: {', '.join(parts)}." if entries else "No scan was worked on yet."),
        ways=ways,
        photos=photos,
        to_photos='<a href="#photos">Which photo shows which scan</a>' if photos else "",
        rows="\n".join(map(_row, part)),
        version=escape(__version__),
        **{name: "#{:02x}{:02x}{:02x}".format(*rgb) for name, rgb in colors.items()},
    )


def _photos(found, has_pairs):
    """The table of photos; nothing where there are none."""
    if not found:
        return ""
    used = sum(bool(photo["shows"]) for photo in found)
    rows = []
    for photo in found:
        shows = escape(", ".join(photo["shows"])) or '<span class="soft">no scan for certain</span>'
        cells = [
            f'<td data-label="">{_small(photo["small"]) if len(found) <= _MOST_SMALL else ""}</td>',
            f'<th scope="row">{escape(photo["photo"])}</th>',
            f'<td data-label="Shows">{shows}</td>',
            _number("Evidence", photo["evidence"], photo["evidence"]),
            f'<td data-label="Note">{escape(photo["note"])}</td>',
        ]
        rows.append(f"<tr>{''.join(cells)}</tr>")
    told = (
        f' The table <a href="{PAIRS}">{PAIRS}</a> beside this page holds every pair of a scan and a photo; to correct '
        "it, edit a copy and name that in the manifest."
        if has_pairs
        else ""
    )
    names = ("Picture", "Photo", "Shows", "Evidence", "Note")
    heads = "".join(f'<th scope="col"><span>{name}</span></th>' for name in names)
    return (
        f'<section id="photos"><h2>Photos</h2><p class="soft">{used} of {len(found)} show a scan for certain. Evidence '
        f"of 1 or more is enough.{told}</p>"
        f"<table><thead><tr>{heads}</tr></thead><tbody>{chr(10).join(rows)}</tbody></table></section>"
    )


def _small(path):
    """A photo, small, as an image; nothing where it cannot be read."""
    _, picture = _picture(path)
    if picture is None:
        return ""
    import cv2

    scale = _SMALL_SIDE / max(picture.shape[:2])
    size = [max(1, round(side * scale)) for side in picture.shape[1::-1]]
    picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    encoded = base64.b64encode(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 75])[1]).decode("ascii")
    return f'<img alt="" width="{size[0]}" height="{size[1]}" src="data:image/jpeg;base64,{encoded}">'


def _picture(path):
    """The bytes of a file and the picture that they hold; None where there is none, or none that can be read."""
    try:
        data = None if path is None else contents(path, "a preview", most=_LARGEST_PREVIEW)
    except ReflcolorError:
        data = None
    if not data:
        return None, None
    import cv2
    import numpy as np

    return data, cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)


def _row(entry):
    states = [entry["state"], "warned" if entry["warnings"] else ""]
    states.append("done" if entry["state"] == "guessed" else "")
    colored = "" if entry["colored"] == "" else f"{entry['colored']:.1%}"
    state = f'<span class="status {entry["state"]}">{escape(_STATES[entry["state"]])}</span>'
    cells = [
        f'<td data-label="">{_tiles(entry)}</td>',
        f'<th scope="row" data-value="{escape(entry["scan"])}">{escape(entry["scan"])}{_file_of(entry)}</th>',
        f'<td data-label="State" data-value="{escape(_STATES[entry["state"]])}">{state}</td>',
        _number("Returns", entry["returns"], "" if entry["returns"] == "" else f"{entry['returns']:,}"),
        _number("Colored", entry["colored"], colored),
        _number("Confidence", entry["confidence"], "" if entry["confidence"] == "" else f"{entry['confidence']:.2f}"),
        _number("Photos used", entry["verified_photos"], str(entry["verified_photos"])),
        _number("Warnings", entry["warnings"], str(entry["warnings"])),
        _number("Seconds", entry["seconds"], str(entry["seconds"])),
        f'<td data-label="Details">{_details_of(entry)}</td>',
    ]
    return f'<tr data-state="{" ".join(filter(None, states))}">{"".join(cells)}</tr>'


def _number(label, value, text):
    return f'<td class="number" data-label="{label}" data-value="{value}">{escape(text)}</td>'


def _tiles(entry):
    """The preview; one picture, shown in four places by style alone."""
    data, picture = _picture(entry["preview"])
    if picture is None:
        return '<span class="soft">no preview</span>'
    height, width = picture.shape[:2]
    encoded = base64.b64encode(data).decode("ascii")
    count = len(entry["tiles"])
    style = f"--picture: url(data:image/jpeg;base64,{encoded}); --aspect: {width / count:.0f} / {height}"
    tiles = "".join(
        f'<div role="img" aria-label="{escape(entry["scan"])}, {name}"><span aria-hidden="true">{name}</span></div>'
        for name in entry["tiles"]
    )
    return f'<div class="tiles of-{count}" style="{style}">{tiles}</div>'


def _details_of(entry):
    # Warnings about colors are among the details.
    told = entry["warnings"] and entry["state"] in ("done", "guessed")
    note = f"<p>{escape(entry['note'])}</p>" if entry["note"] and not told else ""
    inside = entry["details"] + entry["tried"]
    return note + (f"<details><summary>Details</summary>{inside}</details>" if inside else "")


def _file_of(entry):
    """The scan's file, as the manifest names it."""
    return f'<span class="file">{escape(entry["file"])}</span>' if entry["file"] else ""
