"""The verb ``batch``: colorize all scans that a manifest names."""

import argparse
import re
from collections import Counter
from pathlib import Path

from ...batch.archive.check import check_manifest
from ...batch.archive.estimate import estimate
from ...batch.archive.manifest_file import load_manifest
from ...batch.archive.options import DONE, ELSEWHERE, FAILED, KNOWN, OPEN, STAGES, UNSHOWN, Options
from ...batch.archive.pairs import read_pairs
from ...batch.archive.run import run_batch
from ...errors import Cancelled, OutputError, ReflcolorError, UsageError
from ...files.memory import available_bytes
from ...messages import Message
from ...report.archive import write_page
from ...threads import thread_count

NAME = "batch"
HELP = "color all scans of an archive, as a manifest says"
_GIGABYTE = 1 << 30
# Share of the free memory that a batch takes by default.
_SHARE = 0.8


def add_arguments(parser):
    """Declare what ``batch`` takes."""
    parser.add_argument("input", metavar="MANIFEST.toml", type=Path, help="what manifest drafts, or a person wrote")
    parser.add_argument("--check", action="store_true", help="only say what is wrong, how long it takes, and how much")
    parser.add_argument("--resume", action="store_true", help="leave out what was done before and did not change")
    parser.add_argument("--keep-going", action="store_true", help="go on with the other scans after one has failed")
    parser.add_argument(
        "--index", type=_index, metavar="I-J", help="only these scans of the manifest, counted from 1: 5 or 5-9"
    )
    parser.add_argument(
        "--stage",
        choices=STAGES,
        action="append",
        help="only this stage, once for each; by default all, in their order",
    )
    parser.add_argument("--jobs", type=_count, metavar="N", help="processes at once (default: one per processor)")
    parser.add_argument(
        "--memory", type=_gigabytes, metavar="GB", help="of all processes (default: most of what is free)"
    )
    parser.add_argument(
        "--fail-in-report",
        action="store_true",
        help="end with 0 although scans failed; report --fail tells of them after all tasks of a farm are done",
    )
    parser.add_argument(
        "--openjd", action="store_true", help="tell progress and failure as Open Job Description has it"
    )


def run(arguments, session):
    """Colorize all scans that a manifest names, several at once, and write a report of it.

    Everything that is wrong with the manifest is said before the work begins. A scan that fails never costs another.
    What was matched is remembered; with --resume what was colorized is, too.
    """
    faults = []
    manifest = load_manifest(arguments.input, faults.append)
    if manifest is not None:
        check_manifest(manifest, session.blender, faults.append)
    if faults:
        for fault in faults:
            session.complain(str(fault))
        raise UsageError("{file}: {count} things are wrong, see above", file=arguments.input, count=len(faults))
    first, last = arguments.index or (None, None)
    if last is not None and last > len(manifest.items):
        raise UsageError(
            "--index {index}: the manifest names {count} scans", index=_text(first, last), count=len(manifest.items)
        )
    free = available_bytes()
    options = Options(
        stages=tuple(arguments.stage or STAGES),
        first=first,
        last=last,
        resume=arguments.resume,
        keep_going=arguments.keep_going,
        workers=arguments.jobs or thread_count(),
        memory=arguments.memory or int((free or 4 * _GIGABYTE) * _SHARE),
    )
    for line in estimate(manifest, options):
        session.say(line)
    if arguments.check:
        return
    show = _openjd(session) if arguments.openjd else None
    if show is not None:
        session.show = show
    known = {} if manifest.pairs is None else read_pairs(manifest.pairs)
    try:
        states = run_batch(manifest, options, known, session)
    except Cancelled:
        session.complain(f"{arguments.input}: interrupted; run it again with --resume to go on")
        raise
    if first is None and len(options.stages) == len(STAGES):
        _write_page(manifest.folder.root, states, session)
    _report_states(states, arguments, session)


def _write_page(root, states, session):
    """Write the page; where scans have failed, that they did is told first."""
    try:
        for path in write_page(root, session)[0]:
            session.say(Message("wrote {path}", path=path))
    except OutputError as error:
        if not any(state.outcome == FAILED for state in states):
            raise
        session.complain(str(error))


def _report_states(states, arguments, session):
    count = Counter(state.outcome for state in states)
    session.say(
        Message(
            "{done} done, {known} done before, {failed} failed, {unshown} without a certain photo, {rest} not begun",
            done=count[DONE],
            known=count[KNOWN],
            failed=count[FAILED],
            unshown=count[UNSHOWN],
            rest=count[OPEN],
        )
    )
    elsewhere = [state.item.name for state in states if state.outcome == ELSEWHERE]
    if elsewhere:
        session.warnings.append(
            Message("another batch is at work on {names}; they were left to it", names=", ".join(elsewhere))
        )
    failed = [state for state in states if state.outcome == FAILED]
    if failed:
        message = Message(
            "{file}: {count} of {whole} failed: {names}; see the lines above and the folder logs, mend what they name, "
            "and run the batch again with --resume",
            file=arguments.input,
            count=len(failed),
            whole=len(states),
            names=", ".join(state.item.name for state in failed),
        )
        if arguments.fail_in_report:
            session.warnings.append(message)
            return
        if arguments.openjd:
            session.say(f"openjd_fail: {message}")
        raise ReflcolorError(message)


def _openjd(session):
    """Progress as the engine of a render farm reads it from standard output; once for each whole percent."""
    printed = -1

    def show(fraction, text):
        nonlocal printed
        percent = int(100 * fraction)
        if percent > printed:
            printed = percent
            session.say(f"openjd_progress: {percent}")
            session.say(f"openjd_status: {text}")

    return show


def _index(text):
    found = re.fullmatch(r"(\d{1,9})(?:-(\d{1,9}))?", text.strip())
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (0, 0)
    if not 1 <= first <= last:
        raise argparse.ArgumentTypeError(f"expected a number, or two as in 5-9, counted from 1, found {text}")
    return first, last


def _text(first, last):
    return str(first) if first == last else f"{first}-{last}"


def _count(text):
    if not text.isdecimal() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"expected a whole number from 1 to 1024, found {text}")
    return int(text)


def _gigabytes(text):
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.1 <= number <= 1e5:
        raise argparse.ArgumentTypeError(f"expected a number of gigabytes from 0.1 to 100000, found {text}")
    return int(number * _GIGABYTE)
