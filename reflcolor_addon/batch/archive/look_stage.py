"""The first stage of a batch: which of its photos are worth matching with which of its scans."""

from ...files.exif import moment_of
from ...files.readers.e57_file import acquired_at
from ...messages import Message
from .candidates import are_few, candidates, ranked
from .workers import Task


def photos_of_items(context, items, known_pairs):
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
    dict of str to list of str
        For each item's name the paths of its photos: those that a person names, then what looks best. Where no look
        could be taken, all of them: what is wrong is found out when the item is colorized.
    """
    scores, problems, unseen = {}, {}, set()
    photos = {str(path): context.manifest.name_of(path) for path in context.manifest.photos}
    hashes = {}
    for number, (path, name) in enumerate(photos.items()):
        context.session.progress(number / len(photos), Message("Reading photos: {name}", name=name))
        hashes |= context.hashes([path])

    def known(item, shows):
        return [path for path, name in photos.items() if known_pairs.get((item.name, name)) is shows]

    def finished(task, outcome):
        if not outcome["done"]:
            if outcome.get("may_pass") and tries[task.name] < context.options.tries:
                tries[task.name] += 1
                alone = outcome.get("alone", False)
                tasks.append(task.again(0.0 if alone else context.options.wait_s, alone))
                return
            # What is wrong is told when the item is colorized.
            unseen.add(task.name)
            return
        scores[task.name] = outcome["found"]["scores"]
        problems.update(outcome["found"]["problems"])

    tasks = [_task(context, item, known(item, None), hashes) for item in items]
    tasks = [task for task in tasks if task.request["photos"]]
    tries = dict.fromkeys((task.name for task in tasks), 1)
    context.work(tasks, finished, "Looked at photos for")
    for path, problem in problems.items():
        context.problems[path] = problem
        context.session.warnings.append(
            Message("{photo}: {problem}", photo=photos[path], problem=context.problems[path])
        )
    if are_few(sum(item.offered for item in context.manifest.items), len(photos)):
        chosen = ranked(scores)
    else:
        moments = {path: moment_of(path) for path in photos}
        chosen = candidates(scores, moments, {item.name: _scanned_at(item) for item in items})
    return {
        item.name: [*known(item, True), *(known(item, None) if item.name in unseen else chosen.get(item.name, []))]
        for item in items
    }


def _scanned_at(item):
    """When the first scan of an item was taken that tells; None where none does."""
    times = (acquired_at(path) for path in item.plan.scans if path.suffix.lower() == ".e57")
    return next((time for time in times if time is not None), None)


def _task(context, item, photos, hashes):
    scans = [str(path) for path in item.plan.scans]
    return Task(
        name=item.name,
        request={
            "do": "look",
            "folder": str(context.folder.root),
            "scans": scans,
            "reading": item.plan.reading.as_dict(),
            "photos": photos,
            "hashes": context.hashes(scans) | {path: hashes[path] for path in photos},
        },
        memory=context.costs.memory(item.plan.scans),
        cost=1.0 + len(photos),
        log=context.folder.log(f"{item.name} look"),
    )
