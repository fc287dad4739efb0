"""Runs a whole batch: compares photos, colorizes, renders. Finished work is not repeated."""

from contextlib import ExitStack

from ...errors import Cancelled
from ...messages import Message
from ...report.archive_entries import ITEMS, PHOTOS, SCANS
from ...threads import thread_count
from .color_stage import colorize_items
from .context import Context, hashed
from .done import Done
from .duplicates import duplicates
from .estimate import expected
from .fingerprints import Fingerprints
from .look_stage import first_looks
from .match_stage import Matched, match_items
from .options import COLOR, DUPLICATE, FAILED, KNOWN, LOOK, MATCH, RENDERING, STAGES, State
from .pairs_table import write_table
from .progress_lines import WholeProgress
from .render_stage import render_items
from .stage import fail, remember_item
from .workers import Workers


def run_batch(manifest, options, costs, known_pairs, session):
    """Work on a batch.

    Parameters
    ----------
    manifest : Manifest
        One that nothing is wrong with.
    options : Options
    costs : Costs
        From `check_files`.
    known_pairs : dict of (str, str) to bool
        From `pairs.read_pairs`.
    session : Session

    Returns
    -------
    list of State
        What became of each item.

    Raises
    ------
    Cancelled
        If ``session.cancelled()`` returned True. What was finished is remembered.
    ReflcolorError
        If the batch's folder cannot be written to, or no process can be started.
    """
    manifest.folder.make()
    states = [State(item) for item in options.chosen(manifest.items)]
    with ExitStack() as stack:
        fingerprints = Fingerprints(manifest.folder)
        stack.callback(fingerprints.save)
        same = same_files(manifest, fingerprints, session)
        photos = [path for path in manifest.photos if path not in same.photos]
        workers = Workers(
            count=options.workers,
            threads=max(1, thread_count() // options.workers),
            memory=options.memory,
            blender=session.blender.command if session.blender else None,
            cancelled=session.cancelled,
        )
        context = Context(
            manifest=manifest.with_photos(photos),
            options=options,
            costs=costs,
            session=session,
            fingerprints=fingerprints,
            done=Done(manifest.folder, fingerprints),
            workers=stack.enter_context(workers),
            same=same,
            whole=WholeProgress(expected(manifest.with_photos(photos), options, costs), options.workers),
        )
        _remember_scans(context)
        for line in same.told(manifest.name_of):
            session.say(line)
        _work(context, states, known_pairs)
        context.whole.end()
        context.tell(Message("All scans are done"))
        if set(options.stages) == set(STAGES):
            _correct_items(context, states)
    return states


def same_files(manifest, fingerprints, session):
    """Return the `Duplicates` of a manifest; files of one size are read for that."""
    session.progress(0.0, Message("Looking for files that are the same"))
    return duplicates(manifest, lambda path: hashed(fingerprints, path, session.cancelled))


def _work(context, states, known_pairs):
    """Do the stages that are asked for."""
    stages, matched = context.options.stages, Matched()
    own = []
    for state in states:
        if (problem := _unusable(context, state.item)) is not None:
            if COLOR in stages:
                fail(context, state, problem)
        elif state.item.name in context.same.items:
            state.outcome, state.same_as = DUPLICATE, context.same.items[state.item.name]
            remember_item(context, state)
        else:
            own.append(state)
    if LOOK in stages or MATCH in stages or COLOR in stages:
        _find_photos(context, own, known_pairs, matched)
    if COLOR in stages:
        colorize_items(context, own, matched)
    if RENDERING in stages:
        render_items(context, own)


def _find_photos(context, states, known_pairs, matched):
    """Find out which photos show which items, as far as the stages that are asked for need it."""
    stages, own = context.options.stages, [state.item for state in states]
    # Which photos suit an item best is known only when all items have been compared.
    items = own if stages == (LOOK,) else context.manifest.items
    items = [item for item in items if item.offered and item.name not in context.same.items]
    items = [item for item in items if _unusable(context, item) is None]
    try:
        looks = first_looks(context, items, known_pairs)
        # Each was made small for that; the report shows them so.
        small = {name: context.folder.sketch(looks.hashes[path]).name for path, name in looks.photos.items()}
        context.folder.remember("", PHOTOS, {"small": small})
        if MATCH in stages or COLOR in stages:
            match_items(context, items, {item.name for item in own}, looks, known_pairs, matched)
    except Cancelled:
        if COLOR in stages:
            write_table(context, matched)
        raise


def _unusable(context, item):
    """Why an item cannot be worked on, as far as the headers of its scans show it; None where it can."""
    return next((context.costs.unusable[path] for path in item.plan.scans if path in context.costs.unusable), None)


def _remember_scans(context):
    """Record which scans and photos the batch has, so that its report names those, too, that nothing was done with."""
    name_of = context.manifest.name_of
    scans = {item.name: [name_of(path) for path in item.plan.scans] for item in context.manifest.items}
    photos = [name_of(path) for path in context.manifest.photos]
    same = {name_of(path): name_of(first) for path, first in context.same.photos.items()}
    context.folder.remember("", SCANS, {"scans": scans, "photos": photos, "same_photos": same})


def _correct_items(context, states):
    """Record that items are done which failed in an earlier run, in a part that is not asked for any more, or were
    duplicates then."""
    for state in states:
        known = context.folder.recall(ITEMS, state.item.name) or {}
        if state.outcome == KNOWN and known.get("outcome") in (FAILED, DUPLICATE):
            remember_item(context, state)
