"""Runs a whole batch: compares photos, colorizes, renders. Finished work is not repeated."""

from contextlib import ExitStack

from ...report.archive import ITEMS
from ...threads import thread_count
from .color_stage import colorize_items
from .context import Context
from .done import Done
from .fingerprints import Fingerprints
from .look_stage import photos_of_items
from .options import COLOR, FAILED, KNOWN, LOOK, RENDERING, STAGES, State
from .render_stage import render_items
from .stage import remember_item
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
        workers = Workers(
            count=options.workers,
            threads=max(1, thread_count() // options.workers),
            memory=options.memory,
            blender=session.blender.command if session.blender else None,
            cancelled=session.cancelled,
        )
        context = Context(
            manifest=manifest,
            options=options,
            costs=costs,
            session=session,
            fingerprints=fingerprints,
            done=Done(manifest.folder, fingerprints),
            workers=stack.enter_context(workers),
        )
        photos = {}
        if LOOK in options.stages or COLOR in options.stages:
            # Which photos suit an item best is known only when all items have been compared.
            items = manifest.items if COLOR in options.stages else [state.item for state in states]
            photos = photos_of_items(context, [item for item in items if item.offered], known_pairs)
        if COLOR in options.stages:
            colorize_items(context, states, photos)
        if RENDERING in options.stages:
            render_items(context, states)
        if set(options.stages) == set(STAGES):
            _correct_items(context, states)
    return states


def _correct_items(context, states):
    """Record that items are done which failed in an earlier run, in a part that is not asked for any more."""
    for state in states:
        known = context.folder.recall(ITEMS, state.item.name) or {}
        if state.outcome == KNOWN and known.get("outcome") == FAILED:
            remember_item(context, state)
