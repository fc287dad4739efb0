"""A part of the first stage of a batch: which of its photos overlap, and so are of one place."""

from collections import defaultdict

from .costs import SECONDS_PER_COMPARISON
from .options import LOOK
from .workers import Task

# With how many of those that come before it, and after it, each photo is compared at most, for each scan: then it takes
# no more than about a third of what first looks take, however many photos there are.
MOST_COMPARED = 10
# Photos are described once for each block that theirs is compared with; that takes as long as comparing each with 12.
_LARGEST_BLOCK, _DESCRIBING = 100, 12
# So many of those that overlap a photo tell all there is to know: what is found for others is passed on by these.
_MOST_OVERLAPS = 12


def overlapping(context, looks, scans):
    """Find out which photos of a batch overlap.

    Parameters
    ----------
    context : Context
    looks : Looks
        From `look_stage.first_looks`.
    scans : int
        How many items the photos are offered to.

    Returns
    -------
    dict of str to list of str
        For the path of each photo the paths of others, those that agree best.
    """
    paths = [path for path in looks.photos if looks.hashes[path] and path not in context.problems]
    if len(paths) < 2:
        return {}
    size = max(1, min(_LARGEST_BLOCK, -(-len(paths) // 2)))
    blocks = [paths[first : first + size] for first in range(0, len(paths), size)]
    reach = -(-MOST_COMPARED * scans // size)
    tasks = [
        _task(context, number, later, blocks, looks.hashes)
        for number in range(len(blocks))
        for later in range(number, min(number + reach + 1, len(blocks)))
    ]
    found = defaultdict(list)

    def compared(task, outcome):
        for one, other, agreed in outcome["found"]["overlaps"]:
            found[one].append((-agreed, other))
            found[other].append((-agreed, one))

    # Without it, the order in which pairs are tried is not as good; nothing else is lost.
    context.work_again(LOOK, tasks, compared, lambda task: None, "Compared groups of photos")
    return {photo: [other for _, other in sorted(own)[:_MOST_OVERLAPS]] for photo, own in found.items()}


def _task(context, number, later, blocks, hashes):
    own, others = blocks[number], blocks[later]
    pairs = len(own) * (len(own) - 1) / 2 if number == later else len(own) * len(others)
    name = f"photos {number + 1} and {later + 1}"
    return Task(
        name=name,
        request={
            "do": "overlap",
            "folder": str(context.folder.root),
            "photos": own,
            "others": others,
            "hashes": {path: hashes[path] for path in own + others},
        },
        memory=context.costs.memory(()),
        cost=SECONDS_PER_COMPARISON * (pairs + _DESCRIBING * (len(own) + len(others) * (number != later))),
        log=context.folder.log(name),
    )
