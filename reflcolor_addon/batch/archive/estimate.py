"""Estimates how long a batch will take, and how much memory, before it begins."""

import math

from ...files.memory import readable
from ...messages import Message
from ..plan import RENDER
from .candidates import LIKELIEST, SECOND_LOOKS, are_few
from .costs import (
    SECONDS_PER_COMPARISON,
    SECONDS_PER_LOOK,
    SECONDS_PER_LOOK_OF_SCANS,
    SECONDS_PER_PAIR,
    SECONDS_PER_SECOND_LOOK,
    SECONDS_TO_RENDER,
)
from .options import COLOR, LOOK, MATCH, RENDERING
from .overlap_stage import MOST_COMPARED
from .progress_lines import duration
from .tries import MOST_PAIRS, MOST_SCANS

# A photo colors one place; some places have so many times as many photos as usual.
_MORE_THAN_USUAL = 3.0


def estimate(manifest, options, costs):
    """Return what is to be expected, one line each.

    Parameters
    ----------
    manifest : Manifest
    options : Options
    costs : Costs

    Returns
    -------
    list of Message
    """
    items = _usable(manifest, options, costs)
    pixels = sum(costs.pixels(item.plan.scans) for item in items)
    lines = [
        Message(
            "scans: {count}, about {pixels:.1f} megapixels together; photos: {photos}",
            count=sum(len(item.plan.scans) for item in items),
            pixels=pixels / 1e6,
            photos=len({path for item in items for path in item.plan.photos}),
        )
    ]
    if not items:
        return lines
    seconds = sum(expected(manifest, options, costs).values())
    offered = sum(item.offered for item in manifest.items)
    needs = sorted(
        (costs.memory(item.plan.scans, _open_together(item, offered, costs)) for item in items), reverse=True
    )
    lines.append(
        Message(
            "about {time} if nothing else runs (processes: {workers}), and about {memory} of memory",
            time=duration(seconds / options.workers),
            workers=options.workers,
            memory=readable(min(sum(needs[: options.workers]), max(options.memory, needs[0]))),
        )
    )
    if options.resume:
        lines.append(Message("this does not leave out what an earlier run has done"))
    if needs[0] > options.memory:
        lines.append(
            Message(
                "one scan alone needs about {need}, more than the {memory} that may be taken; it runs alone",
                need=readable(needs[0]),
                memory=readable(options.memory),
            )
        )
    return lines


def expected(manifest, options, costs):
    """Return how long each stage of a batch will probably take.

    Parameters
    ----------
    manifest : Manifest
    options : Options
    costs : Costs

    Returns
    -------
    dict of str to float
        Seconds of one processor for each stage that is asked for or needed by one, in their order.
    """
    items = _usable(manifest, options, costs)
    offered = sum(item.offered for item in manifest.items)
    own, photos = sum(item.offered for item in items), len(manifest.photos)
    pairs, looks, looks_of_scans = photos, SECONDS_PER_LOOK * photos, 0.0
    asked = set(options.stages)
    if own == offered and asked & {MATCH, COLOR}:
        # Photos are compared with each other.
        looks += SECONDS_PER_COMPARISON * photos * min(photos / 2, MOST_COMPARED * offered) / max(offered, 1)
    if own and asked & {MATCH, COLOR} and not are_few(offered, photos):
        # Each photo is matched with few scans, and looked at again for some, whatever the number of scans. Then what
        # was measured where it was found is looked for in all of them.
        looks += SECONDS_PER_SECOND_LOOK * photos * min(SECOND_LOOKS, offered) / offered
        looks_of_scans = SECONDS_PER_LOOK_OF_SCANS * photos
        # A part of a batch tries more, as it does not wait for what the others find.
        least = 1 if own == offered else LIKELIEST
        pairs = photos * min(MOST_SCANS, max(least, MOST_PAIRS * offered)) / offered
    of_stages = {
        LOOK: own * looks,
        MATCH: own * (looks_of_scans + SECONDS_PER_PAIR * pairs),
        COLOR: sum(
            costs.seconds(item.plan.scans, 0 if item.offered or item.plan.seeds else len(item.plan.photos))
            for item in items
        ),
        RENDERING: SECONDS_TO_RENDER
        * sum(any(output.kind == RENDER for output in item.plan.outputs) for item in items),
    }
    needed = {LOOK: {LOOK, MATCH, COLOR}, MATCH: {MATCH, COLOR}}
    return {stage: seconds for stage, seconds in of_stages.items() if asked & needed.get(stage, {stage})}


def _usable(manifest, options, costs):
    return [item for item in options.chosen(manifest.items) if costs.unusable.keys().isdisjoint(item.plan.scans)]


def _open_together(item, offered, costs):
    """The photos that are open at the same time, at the worst: of the whole batch's those that color an item, the
    largest. Those that are tried are opened one after the other."""
    if item.plan.seeds is not None:
        return ()
    if not item.offered:
        return item.plan.photos
    largest = sorted(item.plan.photos, key=lambda path: -costs.photos.get(path, 0))
    return largest[: math.ceil(_MORE_THAN_USUAL * len(largest) / offered)]
