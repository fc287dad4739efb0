"""The first stage of a batch: which of its photos are worth matching with which of its scans."""

from collections import defaultdict
from dataclasses import dataclass, field, replace
from statistics import median_high

from ...files.exif import Moment, moment_of
from ...files.readers.e57_file import acquired_at
from ...messages import Message
from ..paths import scan_files
from .candidates import all_of_them, are_few, for_second_looks, merged, ranks, telling
from .costs import SECONDS_PER_LOOK, SECONDS_PER_LOOK_OF_SCANS, SECONDS_PER_SECOND_LOOK
from .looks import FIRST, OF_SCANS, SECOND
from .options import LOOK, MATCH
from .workers import Task

_SECONDS_PER = {FIRST: SECONDS_PER_LOOK, SECOND: SECONDS_PER_SECOND_LOOK, OF_SCANS: SECONDS_PER_LOOK_OF_SCANS}


@dataclass(kw_only=True)
class Looks:
    """How likely each photo of a batch shows each of its scans, as far as looks tell.

    Parameters
    ----------
    photos, hashes : dict of str to str
        The name and the hash of each photo, by its path.
    moments : dict of str to Moment
        When and where each photo was taken.
    scanned : dict of str to float
        When each item was scanned.
    few : bool
        Whether there are so few pairs that all of them may be matched.
    overlaps : dict of str to list of str
        For the path of each photo those of others that show partly the same, those first that agree best.
    first, ranks : dict of str to list of (str, float)
        See `candidates.ranks`; at the first look, and at the last.
    scores, strengths : dict of str to dict of str to float
        For each item what first looks gave for photos, and what second looks gave.
    usual : dict of str to float
        For each item the usual score at first looks.
    unseen : set of str
        Names of items at which no look could be taken.
    """

    photos: dict[str, str]
    hashes: dict[str, str]
    moments: dict[str, Moment]
    scanned: dict[str, float | None]
    few: bool
    overlaps: dict[str, list[str]] = field(default_factory=dict)
    first: dict[str, list] = field(default_factory=dict)
    ranks: dict[str, list] = field(default_factory=dict)
    scores: dict[str, dict[str, float]] = field(default_factory=dict)
    strengths: dict[str, dict[str, float]] = field(default_factory=dict)
    usual: dict[str, float] = field(default_factory=dict)
    unseen: set[str] = field(default_factory=set)

    def by_item(self):
        """Return the pairs that are worth matching, whatever is found for others: for each item its photos."""
        return all_of_them(self.ranks) if self.few else telling(self.first, self.strengths)

    def strongest(self):
        """Return for the path of each photo the most that second looks gave for it on any item."""
        found = {}
        for own in self.strengths.values():
            for photo, strength in own.items():
                found[photo] = max(found.get(photo, 0.0), strength)
        return found

    def rank(self):
        """Put the items in order by what the looks gave so far."""
        known = self.moments, self.scanned, self.overlaps
        self.first = self.ranks = ranks(self.scores, *known)
        if self.strengths:
            self.ranks = merged(self.first, ranks(self.strengths, *known, second=True))


def first_looks(context, items, known_pairs):
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
    photos = {str(path): context.manifest.name_of(path) for path in context.manifest.photos}
    hashes = {}
    for number, (path, name) in enumerate(photos.items(), 1):
        context.tell(
            Message("Reading photos ({number} of {count}): {name}", number=number, count=len(photos), name=name)
        )
        hashes |= context.hashes([path])
    looks = Looks(
        photos=photos,
        hashes=hashes,
        moments={path: moment_of(path) for path in photos},
        scanned={item.name: _scanned_at(item) for item in items},
        few=are_few(sum(item.offered for item in context.manifest.items), len(photos)),
    )
    unknown = {
        item.name: [path for path, name in photos.items() if known_pairs.get((item.name, name)) is None]
        for item in items
    }
    looks.scores = _look(context, items, unknown, looks, "Looked at photos for")
    looks.usual = {name: median_high(own.values()) for name, own in looks.scores.items() if own}
    looks.rank()
    return looks


def second_looks(context, items, looks):
    """Look again at what is likeliest; the `Looks` rank what was looked at twice.

    Parameters
    ----------
    context, items
        As `first_looks`.
    looks : Looks
    """
    likely = for_second_looks(looks.first)
    looks.strengths = _look(context, items, likely, looks, "Looked again at photos for", SECOND)
    looks.rank()


def looks_of_scans(context, items, pictures, looks):
    """Look for scans of the places that photos were found to show.

    Parameters
    ----------
    context, items, looks
        As `second_looks`.
    pictures : dict of str to str
        For the names of `BatchFolder.sketch` of pictures that `partners.picture_of` made: the item that each shows.

    Returns
    -------
    dict of str to dict of str to float
        For each name what `partners.look` gave for the other items.
    """
    paths = {str(context.folder.sketch(name)): name for name in pictures}
    others = {
        item.name: [path for path, name in paths.items() if pictures[name] != item.name]
        for item in items
        if item.name not in looks.unseen
    }
    found = _look(context, items, others, replace(looks, hashes=paths), "Looked for scans of one place in", OF_SCANS)
    scores = defaultdict(dict)
    for item, own in found.items():
        for path, score in own.items():
            scores[paths[path]][item] = score
    return dict(scores)


def _look(context, items, photos, looks, what, which=FIRST):
    """Scores of photos for items; what is wrong with photos is told."""
    scores, problems = {}, {}

    def looked(task, outcome):
        scores[task.name] = outcome["found"]["scores"]
        problems.update(outcome["found"]["problems"])

    tasks = [_task(context, item, photos[item.name], looks.hashes, which) for item in items if photos.get(item.name)]
    # What is wrong with a scan is told when it is colorized.
    context.work_again(
        LOOK if which != OF_SCANS else MATCH, tasks, looked, lambda task: looks.unseen.add(task.name), what
    )
    for path, problem in problems.items():
        context.tell_problem(path, problem)
    return scores


def _scanned_at(item):
    """When the first scan of an item was taken that tells; None where none does."""
    times = (acquired_at(path) for path in item.plan.scans if path.suffix.lower() == ".e57")
    return next((time for time in times if time is not None), None)


def _task(context, item, photos, hashes, which):
    files = [file for path in item.plan.scans for file in scan_files(path)]
    return Task(
        name=item.name,
        request={
            "do": "look",
            "look": which,
            "folder": str(context.folder.root),
            "scans": [str(path) for path in item.plan.scans],
            "reading": item.plan.reading.as_dict(),
            "photos": photos,
            "hashes": context.hashes(files) | {path: hashes[path] for path in photos},
        },
        memory=context.costs.memory(item.plan.scans),
        cost=_SECONDS_PER[which] * (1 + len(photos)),
        log=context.folder.log(f"{item.name} look"),
    )
