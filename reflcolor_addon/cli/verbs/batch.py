"""The verb ``batch``: colorize all scans that a manifest names."""

import argparse
import re
import sys
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

from ...batch.archive.check import check_manifest
from ...batch.archive.check_files import check_files
from ...batch.archive.estimate import estimate
from ...batch.archive.fingerprints import Fingerprints
from ...batch.archive.manifest_file import load_manifest
from ...batch.archive.options import DONE, DUPLICATE, ELSEWHERE, FAILED, KNOWN, OPEN, STAGES, UNSHOWN, Options
from ...batch.archive.pairs import read_pairs, unknown_names
from ...batch.archive.run import run_batch, same_files
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
_LINE_EVERY_S, _PERCENT_EVERY_S = 5.0, 60.0


def add_arguments(parser):
    """Declare what ``batch`` takes."""
    parser.add_argument("input", metavar="MANIFEST.toml", type=Path, help="what manifest drafts, or a person wrote")
    parser.add_argument(
        "--check", action="store_true", help="only say what is wrong, how long the batch takes, and how much memory"
    )
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

    Everything that is wrong with the manifest, and with the files that it names, is said before the work begins; with
    --keep-going files that cannot be used are left out. A scan that fails never costs another. What was matched is
    remembered; with --resume what was colorized is, too.
    """
    if not (arguments.openjd or sys.stderr.isatty()):
        session.show = _plain_lines(session)
    faults, unusable = [], []
    manifest = load_manifest(arguments.input, faults.append)
    if manifest is not None:
        options = _options(arguments, manifest)
        check_manifest(manifest, session.blender, faults.append)
        known = _known_pairs(manifest, session, faults.append)
        items = options.chosen(manifest.items)
        costs = check_files(manifest, items, unusable.append, decode=arguments.check, progress=session.progress)
    for fault in sorted((*faults, *unusable), key=_line_of):
        session.complain(str(fault))
    if faults or (unusable and not arguments.keep_going):
        raise UsageError(_summary(arguments, len(faults), len(unusable)))
    if any(item.offered for item in items):
        manifest = manifest.with_photos([path for path in manifest.photos if path in costs.photos])
    for line in estimate(manifest, options, costs):
        session.say(line)
    if unusable and arguments.check:
        raise UsageError(_summary(arguments, 0, len(unusable)))
    if arguments.check:
        for line in same_files(manifest, Fingerprints(manifest.folder), session).told(manifest.name_of):
            session.say(line)
        told = "no error was found, but look at the warnings" if session.warnings else "nothing wrong was found"
        session.say(Message("{file}: {told}", file=arguments.input, told=Message(told)))
        return
    if arguments.openjd:
        session.show = _openjd(session)
    whole = options.first is None and len(options.stages) == len(STAGES)
    try:
        states = run_batch(manifest, options, costs, known, session)
    except Cancelled:
        if whole:
            # Of what is done so far; this is not interrupted by the same signal.
            _write_page(manifest.folder.root, [], replace(session, cancelled=bool))
        raise Cancelled(
            Message("{file}: interrupted; to go on, run the same command with --resume", file=arguments.input)
        ) from None
    if whole:
        _write_page(manifest.folder.root, states, session)
    _report_states(states, arguments, session)


def _options(arguments, manifest):
    first, last = arguments.index or (None, None)
    if last is not None and last > len(manifest.items):
        raise UsageError(
            "--index {index}: the manifest names {count} scans", index=_text(first, last), count=len(manifest.items)
        )
    free = available_bytes()
    return Options(
        stages=tuple(arguments.stage or STAGES),
        first=first,
        last=last,
        resume=arguments.resume,
        keep_going=arguments.keep_going,
        workers=arguments.jobs or thread_count(),
        memory=arguments.memory or int((free or 4 * _GIGABYTE) * _SHARE),
    )


def _known_pairs(manifest, session, refuse):
    """What a person knows of pairs of a scan and a photo; names that the batch does not have are warned of."""
    if manifest.pairs is None or not manifest.pairs.is_file():  # then that was told
        return {}
    lines, name_of = {}, manifest.name_of
    known = read_pairs(manifest.pairs, refuse, lines)
    scans = {
        item.name: [way for path in item.plan.scans for way in (name_of(path), path.name, path.stem)]
        for item in manifest.items
    }
    paths = [*manifest.photos, *(path for item in manifest.items for path in item.plan.photos)]
    session.warnings += unknown_names(manifest.pairs, lines, scans, dict.fromkeys(map(name_of, paths), ()))
    return known


def _line_of(fault):
    """Where a fault stands, for their order; what is in no line comes first."""
    values = fault.message.values
    return str(values.get("file")), values.get("line", 0)


def _summary(arguments, faults, unusable):
    """The last line where a batch is not begun."""
    count = (
        Message("1 thing is wrong")
        if faults + unusable == 1
        else Message("{count} things are wrong", count=faults + unusable)
    )
    if faults or arguments.keep_going:
        return Message("{file}: {count}, see above", file=arguments.input, count=count)
    return Message(
        "{file}: {count}, see above; mend these files or take them out, or go on without them by --keep-going",
        file=arguments.input,
        count=count,
    )


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
    if count[DUPLICATE]:
        session.say(Message("{count} the same as another", count=count[DUPLICATE]))
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


def _plain_lines(session, now=time.monotonic):
    """Progress where there is no terminal: a line for each tenth, unless they follow each other at once; where one
    takes long, for each percent, but at most one a minute."""
    printed, last = 0, now()

    def show(fraction, text):
        nonlocal printed, last
        percent, waited = int(100 * fraction), now() - last
        is_new = percent // 10 > printed // 10 or (percent > printed and waited >= _PERCENT_EVERY_S)
        if is_new and waited < _LINE_EVERY_S:
            return
        if is_new:
            session.say(f"{percent:3d}%  {text}")
            last = now()
        if is_new or percent < printed:
            printed = percent

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
