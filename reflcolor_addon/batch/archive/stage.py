"""One stage of a batch over its items: each is claimed, skipped if it is done, processed, and recorded."""

import time
from contextlib import ExitStack
from dataclasses import replace

from ...messages import Message
from ...report.archive import ITEMS
from .options import DONE, ELSEWHERE, FAILED, KNOWN, OPEN, STAGES, UNSHOWN


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
    options, states = context.options, {}
    with ExitStack() as claims:
        tasks = []
        for state, key, task in pieces:
            if not claims.enter_context(context.folder.claimed(state.item.name)):
                state.outcome = ELSEWHERE
            elif options.resume and (record := context.done.recall(state.item.name, stage, key)) is not None:
                state.outcome, state.left_out = KNOWN, record["left_out"] or []
            else:
                for later in STAGES[STAGES.index(stage) :]:
                    context.done.forget(state.item.name, later)
                states[task.name] = [state, key, 1]
                tasks.append(task)
        whole = len(tasks)
        count = 0

        def finished(task, outcome):
            nonlocal count
            state, key, tries = states[task.name]
            if not outcome["done"] and outcome.get("may_pass") and tries < options.tries:
                states[task.name][2] += 1
                tasks.append(replace(task, not_before=time.monotonic() + options.wait_s))
                context.session.say(
                    Message("{name}: {problem}; trying again", name=state.item.name, problem=_bare(outcome["error"]))
                )
                return False
            count += 1
            state.left_out = outcome.get("left_out", [])
            if outcome["done"]:
                done(state, outcome)
                context.done.record(state.item.name, stage, key, outcome)
                context.fingerprints.save()
                state.outcome = DONE if outcome["written"] or not state.left_out else UNSHOWN
            elif not outcome.get("cancelled"):
                state.outcome, state.error = FAILED, outcome["error"]
            remember_item(context, state)
            _write_log(task, outcome)
            context.session.say(_line(state, outcome, count, whole))
            return state.outcome == FAILED and not options.keep_going

        context.work(tasks, finished, {"color": "Colorized", "render": "Rendered"}[stage])
    for state, _, _ in states.values():
        if state.outcome == FAILED:
            context.session.warnings.append(
                Message("{name}: {problem}", name=state.item.name, problem=_bare(state.error))
            )


def remember_item(context, state):
    """Record the outcome of an item, for the report of the whole batch."""
    document = {"outcome": state.outcome, "error": state.error, "left_out": state.left_out}
    context.folder.remember(ITEMS, state.item.name, document)


def _line(state, outcome, count, whole):
    said = {
        DONE: Message("done in {seconds:.0f} s", seconds=outcome.get("seconds", 0)),
        UNSHOWN: Message("no photo shows it"),
        FAILED: Message("failed: {problem}", problem=_bare(state.error)),
        OPEN: Message("interrupted"),
    }[state.outcome]
    return Message("{name}: {said} ({count} of {whole})", name=state.item.name, said=said, count=count, whole=whole)


def _bare(text):
    """An error as part of a line."""
    return text.rstrip(".")


def _write_log(task, outcome):
    """Append the messages about an item to its log; a log that cannot be written does not stop the batch."""
    lines = [*outcome.get("lines", []), *(f"warning: {line}" for line in outcome.get("warnings", []))]
    if not outcome["done"]:
        lines.append(f"error: {outcome['error']}")
    try:
        with task.log.open("a", encoding="utf-8", errors="backslashreplace") as file:
            file.writelines(f"{line}\n" for line in lines)
    except OSError:
        return
