"""The verb ``provenance``: where the colors of a .blend are from."""

import json
from pathlib import Path

from ...batch.blender_tasks import require_blender
from ...errors import ReflcolorError, UsageError
from ...report.provenance import outline, parse_provenance
from ...seeds.sources import EVIDENCE

NAME = "provenance"
HELP = "say where the colors in a .blend are from (in Blender)"
FORMAT = "reflcolor-provenance"
VERSION = 1
_NONE = "has no provenance: it was not colorized, or before provenance was kept, or somebody removed it"


def add_arguments(parser):
    """Declare what ``provenance`` takes."""
    parser.add_argument("input", metavar="FILE.blend", type=Path, help="a file saved by Blender")
    parser.add_argument("--object", metavar="NAME", help="one object; by default all that are scans")
    parser.add_argument("--json", action="store_true", help="print all that is kept, with every seed, as JSON")


def run(arguments, session):
    """Print from what inputs, seeds and settings the scans of a .blend were colorized."""
    require_blender(session.blender, NAME)
    if not arguments.input.is_file():
        raise ReflcolorError("{input}: no such file; expected a file saved by Blender", input=arguments.input)
    found = dict(session.blender.read_provenance(arguments.input))
    if not found:
        raise ReflcolorError("{input}: holds no scan", input=arguments.input)
    if arguments.object is not None:
        if arguments.object not in found:
            raise UsageError(
                "--object {object}: not one of the scans {choices}", object=arguments.object, choices=", ".join(found)
            )
        found = {arguments.object: found[arguments.object]}
    if not any(found.values()):
        raise ReflcolorError(
            "{input}: {objects} {problem}", input=arguments.input, objects=", ".join(found), problem=_NONE
        )
    reports, summaries = {}, []
    for name, text in found.items():
        try:
            reports[name] = parse_provenance(text) if text else None
            if text and not arguments.json:
                summaries.append(_summary(name, reports[name]))
        except ReflcolorError as error:
            raise ReflcolorError("{input}: {name}: {error}", input=arguments.input, name=name, error=error) from error
        if not text:
            session.warnings.append(f"{name} {_NONE}")
    if arguments.json:
        objects = [{"name": name, "provenance": report} for name, report in reports.items()]
        document = {"format": FORMAT, "version": VERSION, "file": str(arguments.input), "objects": objects}
        session.say(json.dumps(document, indent=2))
    else:
        session.say("\n\n".join(summaries))


def _summary(name, report):
    """A report for reading: what each line is about, at the left, once."""
    found = outline(report)
    try:
        entries = _entries(report, found)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise ReflcolorError("the provenance is incomplete") from error
    lines = [name]
    for title, values in entries:
        lines += [f"   {title if not place else '':<13} {value}" for place, value in enumerate(values)]
    return "\n".join(lines)


def _entries(report, found):
    scan, limits = report["scan"], report["normalization"]
    place = "" if scan["index"] is None else f", scan {scan['index']} of its file"
    low, high = limits["percentiles"]
    inputs = []
    for entry in report["inputs"]:
        size = "" if entry["bytes"] is None else f", {entry['bytes']} bytes"
        inputs += [f"{entry['role']} {entry['path']}{size}", f"   SHA-256 {entry['sha256'] or 'not kept'}"]
    return [
        ("colorized", [found.created.replace("T", " ").replace("Z", " UTC")] if found.created else []),
        ("scan", [f"{scan['name']}{place}", _size(scan)]),
        (
            "result",
            [
                f"{report['result']['colored']} pixels colored, {found.unreached} left gray",
                *(["all colors are guesses"] if found.guessed else []),
            ],
        ),
        ("seeds", [f"{count} {source}: {EVIDENCE[source].said}" for source, count in found.sources.items()]),
        ("photos", [f"{photo['name']}: {photo['note']}" for photo in report["photos"]]),
        ("settings", [f"{name} {'all' if value is None else value}" for name, value in report["settings"].items()]),
        (
            "normalization",
            [
                f"reflectance {_span(limits['reflectance'])}",
                f"range {_span(limits['range_m'])} m",
                f"at the percentiles {low:g} and {high:g}",
            ],
        ),
        ("versions", [f"{name} {version}" for name, version in report["versions"].items() if version is not None]),
        ("inputs", inputs),
        ("warnings", list(report["warnings"])),
    ]


def _size(scan):
    turned = f", flipped {' and '.join(scan['flipped'])}" if scan["flipped"] else ""
    around = ", all around" if scan["full_turn"] else ""
    return f"{scan['rows']} rows x {scan['columns']} columns, {scan['returns']} returns{around}{turned}"


def _span(limits):
    return "{:.6g} to {:.6g}".format(*limits)
