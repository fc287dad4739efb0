"""The stage of a batch that renders pictures of colorized items, in Blender."""

from dataclasses import replace
from pathlib import Path

from ...report.amended import add_output
from ...report.archive_entries import ITEMS
from ..plan import PLACEHOLDER, RENDER
from ..plan_document import as_document
from .costs import SECONDS_TO_RENDER
from .options import COLOR, FAILED, RENDERING, UNSHOWN
from .stage import work_on
from .workers import Task


def render_items(context, states):
    """Render the items whose plans ask for it, and that are colorized.

    Parameters
    ----------
    context : Context
    states : list of State
    """
    pieces = []
    for state in states:
        colored = context.done.recall(state.item.name, COLOR)
        if colored is None or state.outcome in (FAILED, UNSHOWN):
            continue
        state.photos = colored["photos"] or []
        state.effects = state.effects or (context.folder.recall(ITEMS, state.item.name) or {}).get("effects") or []
        plan = render_plan(context, state.item, colored["left_out"] or [])
        if plan is None:
            continue
        images = [path for path in colored["outputs"] if path.endswith(".png")]
        if not images:
            continue
        hashes = context.hashes([*plan.scans, *images])
        task = Task(
            name=state.item.name,
            request={"do": "run", "plan": as_document(plan), "folder": str(context.folder.root), "hashes": hashes},
            needs_blender=True,
            memory=context.costs.memory(plan.scans),
            cost=SECONDS_TO_RENDER,
            log=context.folder.log(f"{state.item.name} render"),
        )
        pieces.append((state, context.done.key(RENDERING, plan, hashes), task))

    def rendered(state, outcome):
        for path in map(Path, outcome["written"]):
            label = path.name.removesuffix(context.folder.render("").name)
            report = context.folder.records(label)[1].path
            if report.is_file():
                add_output(report, "--render", path)
                context.done.amend(state.item.name, COLOR, report)

    work_on(context, RENDERING, pieces, done=rendered)


def render_plan(context, item, left_out):
    """Return the plan that renders an item from its colorized images; None where nothing is to be rendered.

    ``left_out`` names scans of it that have no colors.
    """
    outputs = tuple(output for output in item.plan.outputs if output.kind == RENDER)
    if not outputs:
        return None
    colors = context.folder.result(PLACEHOLDER, ".png")
    return replace(
        item.plan, outputs=outputs, seeds=None, hand=None, photos=(), colors=colors, left_out=tuple(left_out)
    )
