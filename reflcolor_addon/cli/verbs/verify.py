"""The verb ``verify``: whether the outputs of a run are whole and belong together."""

import json
from pathlib import Path

from ...errors import ReflcolorError
from ...report.provenance import read_report
from ...report.verification import WHOLE, verify_outputs

NAME = "verify"
HELP = "see whether the outputs that a report names are whole and of one run"
FORMAT = "reflcolor-verification"
VERSION = 1


def add_arguments(parser):
    """Declare what ``verify`` takes."""
    parser.add_argument("input", metavar="REPORT.json", type=Path, nargs="+", help="what colorize --report wrote")
    parser.add_argument("--json", action="store_true", help="print JSON instead of text")


def run(arguments, session):
    """Print what became of every output that the reports name; fails unless all are as their run wrote them.

    Outputs are looked for from the report's folder, so that a folder of results can be moved.
    """
    found = []
    for path in arguments.input:
        session.progress(len(found) / len(arguments.input), f"Verifying {path.name}")
        found.append((path, verify_outputs(read_report(path), path, session.cancelled)))
    outputs = [output for _, outputs in found for output in outputs]
    if arguments.json:
        reports = [
            {"file": str(path), "outputs": [{"path": str(o.path), "state": o.state, "note": o.note} for o in outputs]}
            for path, outputs in found
        ]
        session.say(json.dumps({"format": FORMAT, "version": VERSION, "reports": reports}, indent=2))
    else:
        for output in outputs:
            session.say(f"{output.state:<8} {output.path}{f': {output.note}' if output.note else ''}")
    wrong = sum(output.state != WHOLE for output in outputs)
    if wrong:
        raise ReflcolorError(
            "{file}: {wrong} of {count} outputs are not as the run wrote them",
            file=", ".join(map(str, arguments.input)),
            wrong=wrong,
            count=len(outputs),
        )
