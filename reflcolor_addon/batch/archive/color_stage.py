"""The stage of a batch that colorizes its items and writes all but rendered pictures."""

from dataclasses import replace
from pathlib import Path

from ...errors import Cancelled, OutputError
from ...messages import Message
from ...seeds.seeds_file import photos_named
from ..check import inputs_of
from ..paths import files_of_each
from ..plan import IMAGE, PLACEHOLDER, RENDER, Output
from ..plan_document import as_document
from .options import COLOR, FAILED, KNOWN, UNSHOWN
from .pairs_table import write_table
from .stage import log_unshown, remember_item, work_on
from .workers import Task


def colorize_items(context, states, matched):
    """Colorize items.

    Parameters
    ----------
    context : Context
    states : list of State
    matched : Matched
        Which photos of the whole batch show the items that are offered these.
    """
    pieces = []
    for state in states:
        context.tell(Message("Looking for changes: {name}", name=state.item.name))
        plan = color_plan(context, state.item, matched)
        state.matched, state.effects = matched.told(state.item.name), matched.effects[state.item.name]
        state.refused = {path for (name, path), shows in matched.said.items() if name == state.item.name and not shows}
        inputs = [path for _, path in inputs_of(plan, plan.scans)]
        for given in filter(None, (plan.seeds, plan.hand)):
            for path in files_of_each(given, plan.name):
                inputs += [path, *photos_named(path, plan.photos)]
        hashes = context.hashes(inputs)
        placed_by = matched.placed_by(state.item.name, map(str, plan.photos)) if state.item.offered else {}
        task = Task(
            name=state.item.name,
            request={
                "do": "run",
                "plan": as_document(plan),
                "folder": str(context.folder.root),
                "hashes": hashes,
                "placed_by": placed_by,
            },
            needs_blender=plan.needs_blender,
            memory=context.costs.memory(plan.scans, () if plan.seeds else plan.photos),
            # Photos of the whole batch were matched before, so that they cost nothing here.
            cost=context.costs.seconds(plan.scans, 0 if plan.seeds or state.item.offered else len(plan.photos)),
            log=context.folder.log(state.item.name),
        )
        pieces.append((state, context.done.key(COLOR, plan, hashes, placed_by), task))
    try:
        work_on(context, COLOR, pieces)
    except Cancelled:
        # What was found so far is worth reading.
        write_table(context, matched)
        raise
    for state in states:
        if state.outcome == KNOWN and state.left_out and not _written(context, state):
            state.outcome = UNSHOWN
            log_unshown(context, state)
        if state.outcome in (KNOWN, UNSHOWN):
            # Other photos may have been tried since it was done.
            remember_item(context, state)
    try:
        write_table(context, matched)
    except OutputError as error:
        # A full disk costs scans, too, and these are told last.
        if not any(state.outcome == FAILED for state in states):
            raise
        context.session.complain(str(error))


def color_plan(context, item, matched):
    """Return the plan of an item with the photos that show it, and without pictures to render.

    A picture is rendered from the colorized image, so that this is written, too.
    """
    plan = item.plan
    if item.offered:
        photos = list(map(Path, matched.photos(item)))
        for path in files_of_each(plan.hand, plan.name) if plan.hand else ():
            # A person knows that these show it.
            photos += [photo for photo in photos_named(path, plan.photos) if photo in plan.photos]
        plan = replace(plan, photos=tuple(dict.fromkeys(photos)))
    elif plan.seeds is not None:
        # Of a whole archive's photos only those that its seeds name are opened.
        named = {photo for path in files_of_each(plan.seeds, plan.name) for photo in photos_named(path, plan.photos)}
        plan = replace(plan, photos=tuple(photo for photo in plan.photos if photo in named))
    outputs = [output for output in plan.outputs if output.kind != RENDER]
    if len(outputs) < len(plan.outputs) and not any(output.kind == IMAGE for output in outputs):
        outputs.insert(0, Output("write", context.folder.result(PLACEHOLDER, ".png"), IMAGE))
    plan = replace(plan, outputs=tuple(outputs), skip_unshown=True)
    return plan if plan.needs_light_mesh else replace(plan, faces=None)


def _written(context, state):
    record = context.done.recall(state.item.name, COLOR)
    return bool(record and record["outputs"])
