"""What the report of a batch shows of every scan: from the reports, and from what the batch recorded."""

from collections import defaultdict
from html import escape
from pathlib import Path

from ..errors import ReflcolorError
from ..files.json_files import read_json
from ..messages import Message
from ..view.preview import TILES
from .provenance import outline, read_report

REPORTS, STATE, ITEMS, SCANS, PHOTOS, LOOKS = "reports", "batch-state", "items", "scans", "photos", "looks"
"""Where a batch's folder holds the reports, its records, what became of the items, which there are, which photos, and
these made small."""
PAIRS = "pairs.csv"
"""The table of pairs of a scan and a photo, in the batch's folder."""
COLUMNS = (
    "scan",
    "file",
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
"""What the table of figures tells of a scan; ``photos`` counts those that were tried, ``verified_photos`` those of them
that color it."""
_LARGEST_ITEM = 1 << 24
# More of what a person's word leads to is told among the details.
_MOST_TOLD = 3
_PAIR = {"scan", "photo", "note", "verified", "evidence"}


def entries_of(root, session):
    """Return what the report of a batch shows of every scan, in the order of their names.

    Parameters
    ----------
    root : Path
        The batch's folder.
    session : object
        With ``progress(fraction, text)``.

    Returns
    -------
    list of dict
        `COLUMNS`, and ``details``, ``tried`` (HTML), ``preview`` (a path or None) and ``tiles`` (what it shows).
    """
    paths = sorted((root / REPORTS).glob("*.json"))
    entries, duplicates, items = {}, {}, _items(root)
    for number, path in enumerate(paths):
        session.progress(number / len(paths), Message("Writing the report: {name}", name=path.stem))
        try:
            entries[path.stem] = _of_report(path, read_report(path))
        except (ReflcolorError, AttributeError, KeyError, TypeError, ValueError) as error:
            problem = str(error) if isinstance(error, ReflcolorError) else "it lacks a part"
            entries[path.stem] = _entry(path.stem, "failed", note=f"its report cannot be used: {problem}")
    for name, item in items.items():
        for label in item.get("left_out") or []:
            # Older reports may exist from a time when a photo showed it, or scans of its file.
            for older in [older for older in entries if older.startswith(f"{label}+")]:
                del entries[older]
            entries[label] = _uncolored(root, label, item)
        if item.get("outcome") == "failed":
            own = [label for label in entries if label == name or label.startswith(f"{name}+")]
            for label in own or _pictured(root, name) or [name]:
                entry = entries.setdefault(label, _entry(label, "failed", **_one_picture(root, label)))
                entry.update(state="failed", note=str(item.get("error", "")))
        if item.get("outcome") == "duplicate":
            note = f"the same as {item.get('same_as', 'another scan')}, whose results are its own, too"
            entries[name] = _entry(name, "duplicate", note=note)
            duplicates[name] = str(item.get("same_as", ""))
        _add_tried(entries, _pairs(item))
        _add_effects(entries, name, _effects(item))
    for name, same in duplicates.items():
        first = entries.get(same, entries[name])
        entries[name] |= {"preview": first["preview"], "tiles": first["tiles"]}
    _add_scans(entries, _read_item(root / STATE / f"{SCANS}.json").get("scans"))
    return [entries[name] for name in sorted(entries, key=str.casefold)]


def _uncolored(root, label, item):
    """The entry of a scan that no photo shows."""
    tried = [pair for pair in _pairs(item) if pair["scan"] == label]
    note = (
        "no photo that was tried shows it for certain, so it has no colors; if you know one that does, four to six "
        "pairs picked by hand place it (hand = ... below its [[scan]] in the manifest)"
        if tried
        else f"no photo was tried on it, so it has no colors; {PAIRS} says why"
    )
    counts = {"verified_photos": 0 if tried else ""}
    warnings = [str(line) for line in item.get("warnings") or []]
    if warnings:
        counts |= {"warnings": len(warnings), "details": "<p>Warnings</p>" + _list(warnings)}
        note = "; ".join((note, *warnings))
    return _entry(label, "unshown", note=note, **counts, **_one_picture(root, label))


def _one_picture(root, label):
    """The preview of a scan without colors, where there is one."""
    preview = root / REPORTS / f"{label}.jpg"
    return {"preview": preview if preview.is_file() else None, "tiles": TILES[:1]}


def photos_of(root):
    """Return what the report of a batch shows of every photo, in the order of their names.

    Parameters
    ----------
    root : Path
        The batch's folder.

    Returns
    -------
    list of dict
        ``photo``, its name; ``small``, the path of a small picture of it, or None; ``shows``, the names of the scans
        that have its colors; ``evidence``, the most that was found for it on one of these, or else on any scan, ""
        where nothing is recorded: it was not tried, a person decided, or the batch was interrupted; and ``note``.
    """
    batch = _read_item(root / STATE / f"{SCANS}.json")
    recorded, same = batch.get("photos"), batch.get("same_photos")
    found = {str(name): [] for name in recorded} if isinstance(recorded, list) else {}
    told = defaultdict(list)
    for name, first in same.items() if isinstance(same, dict) else ():
        found[name] = []
        told[name].append(f"the same file as {first}")
    small = _read_item(root / STATE / f"{PHOTOS}.json").get("small")
    for scan, item in _items(root).items():
        for pair in _pairs(item):
            found.setdefault(pair["photo"], []).append(pair)
        for photo, effect in _effects(item):
            told[photo].append(f"{scan}: {effect}")
    small = small if isinstance(small, dict) else {}
    places = {name: root / STATE / LOOKS / Path(str(file)).name for name, file in small.items()}
    return [_photo(name, found[name], places.get(name), told[name]) for name in sorted(found, key=str.casefold)]


def _photo(name, pairs, small, told):
    """What is told of one photo."""
    # Scans with photos of their own have no verdict of the batch.
    shown = [pair for pair in pairs if pair["verified"] and pair.get("shows", True)]
    best = max(shown or pairs, key=lambda pair: pair["evidence"], default=None)
    doubts = [f"{pair['scan']}: {pair['doubt']}" for pair in pairs if pair.get("doubt")] + told
    if best is None and not told:
        doubts = [f"no match is recorded here; {PAIRS} says why"]
    return {
        "photo": name,
        "small": small,
        "shows": sorted({pair["scan"] for pair in shown}, key=str.casefold),
        "evidence": "" if best is None else evidence_text(best),
        "note": "; ".join(doubts),
    }


def evidence_text(pair):
    """The evidence of a pair as it is written: less than 1, which is enough, for what is not verified."""
    evidence = round(pair["evidence"], 2)
    return f"{evidence if pair['verified'] else min(evidence, 0.99):.2f}"


def _pictured(root, name):
    """The labels of a file's scans that have a preview, where it holds several."""
    return sorted(path.stem for path in (root / REPORTS).glob("*.jpg") if path.stem.startswith(f"{name}+"))


def _pairs(item):
    """What was found for each scan and photo of an item, as far as its record is whole."""
    found = item.get("photos")
    return [pair for pair in found or [] if isinstance(pair, dict) and pair.keys() >= _PAIR]


def _add_tried(entries, pairs):
    """List below each scan the photos that it was matched with, the likeliest first."""
    for label in dict.fromkeys(pair["scan"] for pair in pairs):
        own = sorted(
            (pair for pair in pairs if pair["scan"] == label),
            key=lambda pair: (not pair["verified"], -pair["evidence"]),
        )
        if label in entries:
            entries[label]["photos"] = len(own)
            lines = (f"{pair['photo']}: {pair['note']} (evidence {evidence_text(pair)})" for pair in own)
            entries[label]["tried"] = "<p>Photos tried; evidence of 1 or more is enough</p>" + _list(lines)
            _add_doubts(entries[label], [f"{pair['photo']}: {pair['doubt']}" for pair in own if pair.get("doubt")])


def _add_doubts(entry, doubts):
    """Warn of photos that contradict each other, or seem to show several places."""
    if doubts:
        entry["warnings"] = (entry["warnings"] or 0) + len(doubts)
        entry["note"] = "; ".join(filter(None, (entry["note"], *doubts)))
        entry["details"] = "<p>Contradictions</p>" + _list(doubts) + entry["details"]


def _effects(item):
    """What became of a person's word on photos of an item, as far as its record is whole."""
    found = item.get("effects")
    found = found if isinstance(found, list) else []
    whole = [effect for effect in found if isinstance(effect, dict) and effect.keys() >= {"photo", "told"}]
    return [(str(effect["photo"]), str(effect["told"])) for effect in whole]


def _add_effects(entries, name, effects):
    """Tell below a scan where a person's word takes its colors away, or gives it none."""
    lines = [f"{photo}: {told}" for photo, told in effects]
    for label in [label for label in entries if lines and (label == name or label.startswith(f"{name}+"))]:
        more = [f"{len(lines) - _MOST_TOLD} more as the table of pairs says"] if len(lines) > _MOST_TOLD else []
        entries[label]["note"] = "; ".join(filter(None, (*lines[:_MOST_TOLD], *more, entries[label]["note"])))
        if more:
            entries[label]["details"] += "<p>What the table of pairs changes</p>" + _list(lines)


def _add_scans(entries, scans):
    """Name the file of every scan of the batch, and list those that were not begun."""
    for name, paths in scans.items() if isinstance(scans, dict) else ():
        labels = [label for label in entries if label == name or label.startswith(f"{name}+")]
        for label in labels or [name]:
            entry = entries.setdefault(label, _entry(label, "open"))
            entry["file"] = ", ".join(map(str, paths))


def _items(root):
    """What became of the items of the batch, by name."""
    found = {}
    for path in sorted((root / STATE / ITEMS).glob("*.json")):
        if item := _read_item(path):
            found[path.stem] = item
    return found


def _read_item(path):
    """What a batch recorded; empty where that cannot be read."""
    try:
        item = read_json(path, "what became of an item", most=_LARGEST_ITEM)
    except ReflcolorError:
        return {}
    return item if isinstance(item, dict) else {}


def _entry(scan, state, **more):
    extra = {"details": "", "tried": "", "preview": None, "tiles": TILES}
    return dict.fromkeys(COLUMNS, "") | {"scan": scan, "state": state} | extra | more


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
        tried="<p>Photos</p>" + _list(f"{photo['name']}: {photo['note']}" for photo in photos) if photos else "",
        preview=preview if preview.is_file() else None,
    )


def _details(report):
    """What unfolds below a scan; raises what a report that lacks a part lets it raise."""
    summary = outline(report)
    parts = []
    if report["warnings"]:
        parts.append("<p>Warnings</p>" + _list(map(str, report["warnings"])))
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
    return "".join(parts)


def _list(lines):
    return f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"
