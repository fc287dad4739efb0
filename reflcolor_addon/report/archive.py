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
from ..files.json_files import read_json
from ..messages import Message
from ..version import __version__
from ..view.colormaps import UNKNOWN
from ..view.preview import GUESS, INFERRED, OBSERVED, TILES
from .provenance import outline, read_report

REPORTS, PAGE, TABLE = "reports", "report.html", "report.csv"
# A browser is slow with more; then there are several pages.
_SCANS_ON_A_PAGE, _OTHER_PAGE = 1000, "report {number}.html"
_IS_OTHER_PAGE = re.compile(r"report [1-9]\d*\.html")
STATE, ITEMS = "batch-state", "items"
"""Where a batch's folder holds the reports, this page, its table, and what became of the items."""
_COLUMNS = (
    "scan",
    "state",
    "rows",
    "columns",
    "returns",
    "colored",
    "confidence",
    "photos",
    "verified_photos",
    "warnings",
    "seconds",
    "note",
)
_LARGEST_PREVIEW, _LARGEST_ITEM = 1 << 22, 1 << 22
_STATES = {
    "done": "colorized",
    "guessed": "colorized from guesses",
    "unshown": "no certain photo",
    "failed": "failed",
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
    entries = _entries(root, session)
    _write_pages(root, entries)
    page, table = root / PAGE, root / TABLE
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, _COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: entry[name] for name in _COLUMNS} for entry in entries)
    with written_atomically(table) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", errors="backslashreplace", newline="")
    return [page, table], [entry["scan"] for entry in entries if entry["state"] == "failed"]


def _write_pages(root, entries):
    parts = [entries[start : start + _SCANS_ON_A_PAGE] for start in range(0, len(entries), _SCANS_ON_A_PAGE)] or [[]]
    names = [PAGE, *(_OTHER_PAGE.format(number=number) for number in range(2, len(parts) + 1))]
    for number, (name, part) in enumerate(zip(names, parts, strict=True)):
        with written_atomically(root / name) as temporary:
            text = _page(root, entries, part, _ways(names, parts, number))
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


def _entries(root, session):
    """The report of each scan, by name."""
    paths = sorted((root / REPORTS).glob("*.json"))
    entries, items = {}, _items(root)
    for number, path in enumerate(paths):
        session.progress(number / len(paths), Message("Writing the report: {name}", name=path.stem))
        try:
            entries[path.stem] = _of_report(path, read_report(path))
        except (ReflcolorError, AttributeError, KeyError, TypeError, ValueError) as error:
            problem = str(error) if isinstance(error, ReflcolorError) else "it lacks a part"
            entries[path.stem] = _entry(path.stem, "failed", note=f"its report cannot be used: {problem}")
    for name, item in items.items():
        left_out = item.get("left_out") or []
        for label in left_out:
            # Older reports may exist from a time when a photo showed it, or scans of its file.
            for older in [older for older in entries if older.startswith(f"{label}+")]:
                del entries[older]
            entries[label] = _entry(
                label, "unshown", note="no photo that was tried shows it for certain, so it has no colors"
            )
        if item.get("outcome") == "failed":
            own = [label for label in entries if label == name or label.startswith(f"{name}+")]
            for label in own or [name]:
                entry = entries.setdefault(label, _entry(label, "failed"))
                entry.update(state="failed", note=str(item.get("error", "")))
    return [entries[name] for name in sorted(entries, key=str.casefold)]


def _items(root):
    """What became of the items of the batch, by name."""
    found = {}
    for path in sorted((root / STATE / ITEMS).glob("*.json")):
        try:
            item = read_json(path, "what became of an item", most=_LARGEST_ITEM)
        except ReflcolorError:
            continue
        if isinstance(item, dict):
            found[path.stem] = item
    return found


def _entry(scan, state, **more):
    return dict.fromkeys(_COLUMNS, "") | {"scan": scan, "state": state, "details": "", "preview": None} | more


def _of_report(path, report):
    scan, result = report["scan"], report["result"]
    photos, warnings = report["photos"], [str(line) for line in report["warnings"]]
    state = "guessed" if result.get("guessed") else "done"
    preview = path.with_suffix(".jpg")
    return _entry(
        path.stem,
        state,
        rows=scan["rows"],
        columns=scan["columns"],
        returns=scan["returns"],
        colored=round(result["colored"] / max(scan["returns"], 1), 4),
        confidence="" if result.get("mean_confidence") is None else round(result["mean_confidence"], 3),
        photos=len(photos),
        verified_photos=sum(bool(photo["verified"]) for photo in photos),
        warnings=len(warnings),
        seconds=round(sum(report.get("times_s", {}).values()), 1),
        note="; ".join(warnings),
        details=_details(report),
        preview=preview if preview.is_file() else None,
    )


def _scans(count):
    return "1 scan" if count == 1 else f"{count} scans"


def _page(root, entries, part, ways):
    template = Template(files(__package__).joinpath("page.html").read_text(encoding="utf-8"))
    count = {state: sum(entry["state"] == state for entry in entries) for state in _STATES}
    parts = [f"{number} {_STATES[state]}" for state, number in count.items() if number]
    colors = {"observed": OBSERVED, "inferred": INFERRED, "guess": GUESS, "unknown": UNKNOWN}
    return template.substitute(
        title=escape(f"Colorized scans in {root.absolute().name}"),
        summary=escape(f"{_scans(len(entries))}: {', '.join(parts)}." if entries else "No scan was worked on yet."),
        ways=ways,
        rows="\n".join(map(_row, part)),
        version=escape(__version__),
        **{name: "#{:02x}{:02x}{:02x}".format(*rgb) for name, rgb in colors.items()},
    )


def _row(entry):
    states = [entry["state"], "warned" if entry["warnings"] else ""]
    states.append("done" if entry["state"] == "guessed" else "")
    colored = "" if entry["colored"] == "" else f"{entry['colored']:.1%}"
    photos = "" if entry["photos"] == "" else f"{entry['verified_photos']} of {entry['photos']}"
    state = f'<span class="status {entry["state"]}">{escape(_STATES[entry["state"]])}</span>'
    cells = [
        f'<td data-label="">{_tiles(entry)}</td>',
        f'<th scope="row" data-value="{escape(entry["scan"])}">{escape(entry["scan"])}</th>',
        f'<td data-label="State" data-value="{escape(_STATES[entry["state"]])}">{state}</td>',
        _number("Returns", entry["returns"], "" if entry["returns"] == "" else f"{entry['returns']:,}"),
        _number("Colored", entry["colored"], colored),
        _number("Confidence", entry["confidence"], str(entry["confidence"])),
        _number("Photos", entry["verified_photos"], photos),
        _number("Warnings", entry["warnings"], str(entry["warnings"])),
        _number("Seconds", entry["seconds"], str(entry["seconds"])),
        f'<td data-label="Details">{_details_of(entry)}</td>',
    ]
    return f'<tr data-state="{" ".join(filter(None, states))}">{"".join(cells)}</tr>'


def _number(label, value, text):
    return f'<td class="number" data-label="{label}" data-value="{value}">{escape(text)}</td>'


def _tiles(entry):
    """The preview; one picture, shown in four places by style alone."""
    path = entry["preview"]
    try:
        data = None if path is None else contents(path, "a preview", most=_LARGEST_PREVIEW)
    except ReflcolorError:
        data = None
    if not data:
        return '<span class="soft">no preview</span>'
    import cv2
    import numpy as np

    picture = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    if picture is None:
        return '<span class="soft">no preview</span>'
    height, width = picture.shape[:2]
    encoded = base64.b64encode(data).decode("ascii")
    style = f"--picture: url(data:image/jpeg;base64,{encoded}); --aspect: {width / len(TILES):.0f} / {height}"
    tiles = "".join(
        f'<div role="img" aria-label="{escape(entry["scan"])}, {name}"><span aria-hidden="true">{name}</span></div>'
        for name in TILES
    )
    return f'<div class="tiles" style="{style}">{tiles}</div>'


def _details_of(entry):
    note = f"<p>{escape(entry['note'])}</p>" if entry["note"] and not entry["warnings"] else ""
    return note + entry["details"]


def _details(report):
    """What unfolds below a scan; raises what a report that lacks a part lets it raise."""
    summary = outline(report)
    parts = []
    if report["warnings"]:
        parts.append("<p>Warnings</p>" + _list(map(str, report["warnings"])))
    if report["photos"]:
        parts.append("<p>Photos</p>" + _list(f"{photo['name']}: {photo['note']}" for photo in report["photos"]))
    facts = {
        "Grid": f"{report['scan']['columns']} x {report['scan']['rows']} pixels",
        "Seeds": ", ".join(f"{count} {source}" for source, count in summary.sources.items()),
        "Settings": ", ".join(f"{name} {value}" for name, value in report["settings"].items()),
        "Inputs": "; ".join(f"{role} {path} (SHA-256 {sha256})" for role, path, sha256 in summary.inputs),
        "Outputs": "; ".join(output["path"] for output in report["outputs"]),
        "Made": summary.created,
        "Versions": ", ".join(f"{name} {value}" for name, value in report["versions"].items() if value),
    }
    lines = "".join(f"<dt>{escape(name)}</dt><dd>{escape(text)}</dd>" for name, text in facts.items() if text)
    parts.append(f"<dl>{lines}</dl>")
    return f"<details><summary>Details</summary>{''.join(parts)}</details>"


def _list(lines):
    return f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"
