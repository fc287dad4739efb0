"""One stage of a batch over its items: each is claimed, skipped if it is done, processed, and recorded."""

import time
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import OutputError, ReflcolorError
from ...failures import line_of
from ...messages import Message
from ...report.archive_entries import ITEMS, REPORTS, evidence_text
from .options import DONE, ELSEWHERE, FAILED, KNOWN, OPEN, STAGES, UNSHOWN, State
from .passing import may_pass

# The file of hashes covers the whole archive, so it is not rewritten after every scan.
_SAVE_EVERY_S = 20.0


def work_on(context, stage, pieces, *, done=lambda state, outcome: None):
    """Do a stage for items.

    Parameters
    ----------
    context : Context
    stage : str
    pieces : list of (State, str, Task)
        Items that are to be worked on, each with the key that tells whether it was done, and the work.
    done : callable
        Called as ``done(state, outcome)`` when an item is done, before that is remembered.
    """
    options, states, tasks = context.options, {}, []
    for state, key, task in pieces:
        if options.resume and _is_known(context, stage, state, key):
            continue
        states[task.name] = _Piece(state, key)
        tasks.append(task)
    whole, count = len(tasks), 0

    def begin(task):
        piece = states[task.name]
        _require_folder(context)
        # An item that waits for another try stays locked.
        if piece.claim is None:
            claim = ExitStack()
            if not claim.enter_context(context.folder.claimed(piece.state.item.name)):
                piece.state.outcome = ELSEWHERE
                claim.close()
                return False
            if _is_known(context, stage, piece.state, piece.key, since=None if options.resume else start):
                claim.close()
                return False
            piece.claim = claims.enter_context(claim)
            for later in STAGES[STAGES.index(stage) :]:
                piece.outdated |= context.done.outputs(piece.state.item.name, later)
                context.done.begin(piece.state.item.name, later)
        return True

    def finished(task, outcome):
        nonlocal count
        piece = states[task.name]
        state = piece.state
        state.add_photos(outcome.get("photos") or state.photos)
        if outcome["done"]:
            outcome = outcome | {"photos": state.photos}
            outcome = _kept(context, stage, piece, outcome, done)
        if not outcome["done"] and outcome.get("may_pass") and piece.tries < options.tries:
            piece.tries += 1
            alone = outcome.get("alone", False)
            wait = 0.0 if alone else options.wait_s
            tasks.append(task.again(wait, alone))
            context.session.say(
                Message("{name}: {problem}; trying again", name=state.item.name, problem=_bare(outcome["error"]))
            )
            return False
        count += 1
        state.left_out = outcome.get("left_out") or state.left_out
        state.warnings = outcome.get("warnings") or []
        if outcome["done"]:
            state.outcome = DONE if outcome["written"] or not state.left_out else UNSHOWN
        elif outcome.get("cancelled"):
            state.outcome = OPEN
        else:
            state.outcome, state.error = FAILED, outcome["error"]
        if outcome["done"] and state.left_out:
            _delete_outdated(context, piece, outcome["written"])
        if outcome["done"]:
            context.done.end(state.item.name, stage)
        remember_item(context, state)
        again = {f"{Path(pair['path']).name}: {pair['note']}" for pair in state.matched}
        told = [line for line in outcome.get("lines", []) if line not in again]
        _write_log(task.log, outcome | {"lines": told}, _matched(context, state))
        context.session.say(_line(state, outcome, count, whole))
        piece.claim.close()
        _require_folder(context)
        return state.outcome == FAILED and not options.keep_going

    start = time.time()
    with ExitStack() as claims:
        context.work(stage, tasks, finished, {"color": "Colorized", "render": "Rendered"}[stage], begin, only=True)


@dataclass(eq=False)
class _Piece:
    """An item in progress: its key, the number of tries, what an earlier run has written for it, and the lock that
    keeps other batches away.
    """

    state: State
    key: str
    tries: int = 1
    outdated: dict = field(default_factory=dict)
    claim: ExitStack | None = None


def _delete_outdated(context, piece, written):
    """Delete what an earlier run has colored from photos that turned out not to show an item, and say so."""
    # The outputs of one scan of several begin with its own label.
    beginnings = tuple(f"{label}{then}" for label in piece.state.left_out for then in (".", " render."))
    outdated = {
        path: recorded
        for path, recorded in piece.outdated.items()
        if path not in written and Path(path).name.startswith(beginnings)
    }
    try:
        deleted = context.done.delete(outdated)
    except OutputError as error:
        context.session.warnings.append(error.message)
        return
    if deleted:
        context.session.say(
            Message(
                "{name}: deleted what an earlier run had colored, because no photo shows it for certain any more: "
                "{files}",
                name=piece.state.item.name,
                files=", ".join(Path(path).name for path in deleted),
            )
        )
    # The preview was written anew.
    kept = (Path(path) for path in outdated if path not in deleted)
    if changed := [path.name for path in kept if path.parent.name != REPORTS and path.exists()]:
        context.session.warnings.append(
            Message(
                "{name}: no photo shows it for certain any more, but what was changed since it was written stays: "
                "{files}",
                name=piece.state.item.name,
                files=", ".join(changed),
            )
        )


def _is_known(context, stage, state, key, since=None):
    """Whether an item is already done; with ``since``, whether another batch has done it since then."""
    record = context.done.recall(state.item.name, stage, key, since)
    if record is not None:
        state.outcome, state.left_out = KNOWN, record["left_out"] or []
        state.warnings = record["warnings"] or []
        state.add_photos(record["photos"] or [])
    return record is not None


def _kept(context, stage, piece, outcome, done):
    """Record that an item is done; return its outcome, which becomes a failure if that cannot be recorded."""
    try:
        done(piece.state, outcome)
        context.done.record(piece.state.item.name, stage, piece.key, outcome)
        context.fingerprints.save(_SAVE_EVERY_S)
    except (ReflcolorError, OSError) as error:
        return outcome | {"done": False, "error": str(line_of(error)), "may_pass": may_pass(error)}
    return outcome


def _require_folder(context):
    """Raise OutputError if the output folder is gone: no further result could be written."""
    if not context.folder.root.is_dir():
        raise OutputError(
            "{folder}: the output folder is gone; bring it back, and run the batch again with --resume",
            folder=context.folder.root,
        )


def remember_item(context, state):
    """Record the outcome of an item, for the report of the whole batch; if that fails, the others go on."""
    photos = [pair | {"photo": context.manifest.name_of(pair["path"])} for pair in state.photos]
    document = {"outcome": state.outcome, "error": state.error, "left_out": state.left_out}
    document |= {"photos": photos, "same_as": state.same_as, "warnings": state.warnings, "effects": state.effects}
    try:
        context.folder.remember(ITEMS, state.item.name, document)
    except OutputError as error:
        context.session.warnings.append(error.message)


def fail(context, state, problem):
    """Record that an item fails before anything is done for it, and say so."""
    state.outcome, state.error = FAILED, str(problem)
    remember_item(context, state)
    _write_log(context.folder.log(state.item.name), {"done": False, "error": state.error}, (), mode="w")
    context.session.say(Message("{name}: failed: {problem}", name=state.item.name, problem=_bare(state.error)))


def log_unshown(context, state):
    """Write the log of an item anew that no photo shows, as in an earlier run: others may have been tried since."""
    _write_log(
        context.folder.log(state.item.name),
        {"done": True, "warnings": state.warnings},
        _matched(context, state),
        mode="w",
    )


def _line(state, outcome, count, whole):
    said = {
        DONE: Message("done in {seconds:.0f} s", seconds=outcome.get("seconds", 0)),
        UNSHOWN: _unshown(state.photos),
        FAILED: Message("failed: {problem}", problem=_bare(state.error)),
        OPEN: Message("interrupted"),
    }[state.outcome]
    if state.warnings:
        warned = Message("1 warning") if len(state.warnings) == 1 else Message("{n} warnings", n=len(state.warnings))
        said = Message("{said}, {warned} (see the report)", said=said, warned=warned)
    values = {"name": state.item.name, "said": said, "count": count, "whole": whole}
    return Message("{name}: {said} (scan {count} of {whole})", **values)


def _unshown(photos):
    tried = len({pair["path"] for pair in photos})
    if any(pair["verified"] for pair in photos):
        return Message("a photo seems to show it, but other things contradict that; the report says more")
    if tried == 0:
        return Message("no photo was tried on it; pairs.csv says why")
    if tried == 1:
        return Message("the photo tried does not show it for certain")
    return Message("none of {tried} photos tried shows it for certain", tried=tried)


def _bare(text):
    """An error as part of a line: all of it, since its own parts are short enough."""
    return Message(text.rstrip("."))


def _matched(context, state):
    """What was found before the item was colorized, one line for each photo, the likeliest first, and what may help."""
    lines = [
        f"{context.manifest.name_of(pair['path'])}: {pair['note']} (evidence {evidence_text(pair)})"
        for pair in sorted(state.matched, key=lambda pair: -pair["evidence"])
    ]
    if state.outcome == UNSHOWN and state.matched:
        lines.append("no photo shows it for certain; if you know one that does, pick four to six pairs by hand")
    return lines


def _write_log(path, outcome, before, mode="a"):
    """Append the messages about an item to its log; a log that cannot be written does not stop the batch."""
    lines = [*before, *outcome.get("lines", []), *(f"warning: {line}" for line in outcome.get("warnings", []))]
    if not outcome["done"]:
        lines.append(f"error: {outcome['error']}")
    if not lines:
        return
    try:
        with path.open(mode, encoding="utf-8", errors="backslashreplace") as file:
            file.writelines(f"{line}\n" for line in lines)
    except OSError:
        return
