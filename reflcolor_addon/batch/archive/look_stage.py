"""The first stage of a batch: which of its photos are worth matching with which of its scans."""

from dataclasses import dataclass

from ...files.exif import moment_of
from ...files.readers.e57_file import acquired_at
from ...messages import Message
from ..paths import scan_files
from .candidates import are_few, chosen, ranks
from .workers import Task


@dataclass(frozen=True, kw_only=True)
class Looks:
    """How likely each photo of a batch shows each of its scans, as far as looks tell.

    Parameters
    ----------
    photos, hashes : dict of str to str
        The name and the hash of each photo, by its path.
    ranks : dict of str to list of (str, float)
        See `candidates.ranks`.
    few : bool
        Whether there are so few pairs that all of them are matched.
    unseen : set of str
        Names of items at which no look could be taken.
    """

    photos: dict[str, str]
    hashes: dict[str, str]
    ranks: dict[str, list]
    few: bool
    unseen: set[str]

    def by_item(self):
        """Return the pairs that are worth matching, whatever is found for others: for each item its photos."""
        return chosen(self.ranks, all_of_them=self.few)


def looks_at_items(context, items, known_pairs):
    """Look at all photos of a batch for some of its items.

    Parameters
    ----------
    context : Context
    items : list of Item
        Those that are offered the photos of the whole batch.
    known_pairs : dict of (str, str) to bool
        What a person says of an item's name and a photo's; see `pairs.read_pairs`.

    Returns
    -------
    Looks
    """
    scores, problems, unseen = {}, {}, set()
    photos = {str(path): context.manifest.name_of(path) for path in context.manifest.photos}
    hashes = {}
    for number, (path, name) in enumerate(photos.items()):
        context.session.progress(number / len(photos), Message("Reading photos: {name}", name=name))
        hashes |= context.hashes([path])

    def looked(task, outcome):
        scores[task.name] = outcome["found"]["scores"]
        problems.update(outcome["found"]["problems"])

    tasks = []
    for item in items:
        unknown = [path for path, name in photos.items() if known_pairs.get((item.name, name)) is None]
        tasks += [_task(context, item, unknown, hashes)] if unknown else []
    # What is wrong is told when the item is colorized.
    context.work_again(tasks, looked, lambda task: unseen.add(task.name), "Looked at photos for")
    for path, problem in problems.items():
        context.tell_problem(path, problem)
    moments = {path: moment_of(path) for path in photos}
    return Looks(
        photos=photos,
        hashes=hashes,
        ranks=ranks(scores, moments, {item.name: _scanned_at(item) for item in items}),
        few=are_few(sum(item.offered for item in context.manifest.items), len(photos)),
        unseen=unseen,
    )


def _scanned_at(item):
    """When the first scan of an item was taken that tells; None where none does."""
    times = (acquired_at(path) for path in item.plan.scans if path.suffix.lower() == ".e57")
    return next((time for time in times if time is not None), None)


def _task(context, item, photos, hashes):
    files = [file for path in item.plan.scans for file in scan_files(path)]
    return Task(
        name=item.name,
        request={
            "do": "look",
            "folder": str(context.folder.root),
            "scans": [str(path) for path in item.plan.scans],
            "reading": item.plan.reading.as_dict(),
            "photos": photos,
            "hashes": context.hashes(files) | {path: hashes[path] for path in photos},
        },
        memory=context.costs.memory(item.plan.scans),
        cost=1.0 + len(photos),
        log=context.folder.log(f"{item.name} look"),
    )
