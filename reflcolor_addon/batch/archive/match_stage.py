"""The second stage of a batch: photos are matched with scans, and it is decided which they show."""

from collections import defaultdict
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...messages import Message
from ..paths import scan_files
from ..plan_document import as_document
from .claims import Claim, Verdict
from .costs import SECONDS_PER_PAIR
from .fingerprints import digest_of, program_digest
from .look_stage import looks_of_scans, second_looks
from .options import MATCH
from .overlap_stage import overlapping
from .partners import partners
from .tries import MOST_HELPERS, Tries
from .verdicts import Verdicts
from .workers import Task

KIND = "pairs"


@dataclass(kw_only=True)
class Matched:
    """What was found of the items that are offered the photos of the whole batch.

    Parameters
    ----------
    pairs : dict of str to dict of str to list of dict
        For each item and the path of each photo that was tried on it what `matches.match_at` found.
    verdicts : dict of str to Verdict
        For the path of each photo that is verified anywhere which items it shows.
    helpers : dict of str to dict of str to list of str
        For each item, by the path of each photo that was placed with the help of others, the paths of those.
    hashes : dict of str to str
        The hash of each photo, by its path.
    by_likeness : dict of str to list of str
        For items that could not be matched here the photos that look best.
    said : dict of (str, str) to bool
        What a person says of an item and the path of a photo.
    earlier : dict of str to dict of str to list of dict
        As ``pairs``, of pairs that an earlier run has matched and this one did not need; nothing depends on these.
    effects : dict of str to list of dict
        For items what became of a person's word where it takes colors away or gives none: ``photo``, and ``told``.
    decided : bool
        Whether all of it was found.
    """

    pairs: dict[str, dict[str, list]] = field(default_factory=lambda: defaultdict(dict))
    helpers: dict[str, dict[str, list]] = field(default_factory=lambda: defaultdict(dict))
    hashes: dict[str, str] = field(default_factory=dict)
    verdicts: dict[str, Verdict] = field(default_factory=dict)
    by_likeness: dict[str, list[str]] = field(default_factory=dict)
    said: dict[tuple[str, str], bool] = field(default_factory=dict)
    earlier: dict[str, dict[str, list]] = field(default_factory=dict)
    effects: dict[str, list[dict]] = field(default_factory=lambda: defaultdict(list))
    decided: bool = False

    def photos(self, item):
        """Return the photos that an item is colored from."""
        if item.name in self.by_likeness:
            return self.by_likeness[item.name]
        # In the order of the manifest, whatever was found first.
        paths, found = list(map(str, item.plan.photos)), self.pairs.get(item.name, {})
        shown = [path for path in paths if item.name in self.verdicts.get(path, Verdict()).shown]
        if item.plan.settings.guess:
            # Guesses take their colors from photos that look like the scan, too.
            shown += [path for path in paths if path in found and path not in self.verdicts]
        return shown

    def placed_by(self, name, photos):
        """Return the hashes of those that helped to place these photos on an item, by the photos' paths."""
        helpers = self.helpers.get(name, {})
        return {path: [self.hashes[other] for other in helpers[path]] for path in photos if path in helpers}

    def told(self, name):
        """Return what was found for an item, for its record: one dictionary for each scan and photo."""
        found = []
        for path, pairs in self.pairs.get(name, {}).items():
            verdict = self.verdicts.get(path, Verdict())
            said = {"path": path, "doubt": str(verdict.doubt(name)), "shows": name in verdict.shown}
            kept = ("scan", "verified", "tested", "evidence", "note")
            found += [{key: pair[key] for key in kept} | said for pair in pairs]
        return found


def match_items(context, items, own, looks, known_pairs, matched):
    """Match photos with items, the likeliest pairs first.

    Parameters
    ----------
    context : Context
    items : list of Item
        All that are offered the photos of the whole batch.
    own : set of str
        The names of those to work on; what is known already counts for the others.
    looks : Looks
        From `look_stage.first_looks`.
    known_pairs : dict of (str, str) to bool
        As there.
    matched : Matched
        What is found is added to it, little by little.
    """
    whole = own >= {item.name for item in items}
    if whole:
        looks.overlaps = overlapping(context, looks, len(items))
        looks.rank()
    if not looks.few:
        # A part of a batch does not look again at what other parts have.
        second_looks(context, [item for item in items if item.name in own], looks)
    rounds = _Rounds(context, items, own, looks, known_pairs, matched)
    rounds.match(rounds.given())
    if whole:
        tries = Tries(looks.ranks, looks.first, looks.few, looks.overlaps, looks.strongest())
        while pairs := tries.next(verdicts := rounds.verdicts(), rounds.same_place(verdicts)):
            rounds.match(pairs)
    else:
        # A part of a batch does not wait for what the others find, but takes what they have found.
        rounds.match(_by_themselves(looks.by_item()))
        rounds.recall_others()
    rounds.decide()
    rounds.recall_earlier()


def _by_themselves(pairs):
    """Pairs (for each item its photos) that are matched without the help of other photos."""
    return {name: dict.fromkeys(paths, ()) for name, paths in pairs.items()}


class _Rounds:
    def __init__(self, context, items, own, looks, known_pairs, matched):
        self._context, self._looks = context, looks
        self._items = {item.name: item for item in items}
        self._own = own
        names = {name: path for path, name in looks.photos.items()}
        self._said = {
            (item, names[photo]): shows
            for (item, photo), shows in known_pairs.items()
            if item in self._items and photo in names
        }
        self._found, matched.said, matched.hashes = matched, self._said, looks.hashes
        # What is wrong is told when the item is colorized.
        self._found.by_likeness |= {name: list(looks.photos) for name in looks.unseen}
        self._table = context.manifest.pairs and context.manifest.pairs.name
        self._number = 0
        # Made once: what is compared is kept by them.
        self._claims, self._compared = {}, {}
        # For each picture of a scan how well it fits the others, and which of them are probably of the same place.
        self._fits, self._partners = {}, {}

    def given(self):
        """The pairs that a person names."""
        pairs = defaultdict(list)
        for (name, path), shows in self._said.items():
            if shows:
                pairs[name].append(path)
        return _by_themselves(pairs)

    def recall_others(self):
        """Take what other parts of the batch have found for their items."""
        for name in self._items.keys() - self._own:
            self._found.pairs[name] |= self._matched_before(name)

    def recall_earlier(self):
        """Note what earlier runs have found and this one did not need."""
        for name in self._items:
            found = self._found.pairs[name]
            before = self._matched_before(name).items()
            self._found.earlier[name] = {path: pairs for path, pairs in before if path not in found}

    def _matched_before(self, name):
        """What was found for an item at any time, of each photo by itself."""
        known = self._recalled(self._key(self._items[name]))
        hashes = self._looks.hashes.items()
        return {path: known[key] for path, key in hashes if key in known and self._may_show(name, path)}

    def match(self, pairs):
        """Match pairs that are not known yet, and keep what was found.

        Parameters
        ----------
        pairs : dict of str to dict of str to sequence of str
            For each item the paths of photos, and for each of these those of others that help to place it, or none.
        """
        tasks, keys = [], {}
        for name, wanted in pairs.items():
            item, found = self._items[name], self._found.pairs[name]
            wanted = {
                path: list(helpers)
                for path, helpers in wanted.items()
                if (helpers or path not in found) and self._may_show(name, path)
            }
            if item.plan.settings.matching == "paper" or name in self._found.by_likeness:
                self._found.by_likeness.setdefault(name, []).extend(path for path in wanted if path not in found)
                continue
            keys[name] = self._key(item)
            known = self._recalled(keys[name])
            missing = {}
            for path, helpers in wanted.items():
                if (kept := known.get(self._kept_as(path, helpers))) is not None:
                    self._take(name, path, helpers, kept)
                    self._context.whole.expect_less(MATCH, SECONDS_PER_PAIR)
                else:
                    missing[path] = helpers
            if missing and name in self._own:
                tasks.append(self._task(item, missing))
        if not tasks:
            return
        # What takes longest begins first, so that no processor is left alone with it at the end.
        tasks.sort(key=lambda task: (-task.cost, task.name))
        self._number += 1

        def done(task, outcome):
            self._keep(task.name, keys[task.name], outcome["found"], task.request["helpers"])

        def failed(task):
            # What is wrong is told when the item is colorized.
            self._found.by_likeness[task.name] = task.request["plan"]["photos"]

        self._context.work_again(MATCH, tasks, done, failed, f"Matching photos (round {self._number}), scan")

    def _may_show(self, name, path):
        return self._said.get((name, path)) is not False and path not in self._context.problems

    def _keep(self, name, key, found, helpers):
        known = self._recalled(key)
        for path, problem in found["problems"].items():
            self._context.tell_problem(path, problem)
        for path, pairs in found["pairs"].items():
            self._take(name, path, helpers.get(path, []), pairs)
            if kept_as := self._kept_as(path, helpers.get(path, [])):
                known[kept_as] = pairs
        if key:
            self._context.folder.remember(KIND, key, known)

    def _kept_as(self, path, helpers):
        """What is found for a photo, with these photos' help, is kept by this; by None if their hashes are unknown."""
        hashes = [self._looks.hashes[other] for other in (path, *helpers)]
        return " ".join(hashes) if all(hashes) else None

    def _take(self, name, path, helpers, pairs):
        """Take what was found for a pair; it replaces what was found without help."""
        self._found.pairs[name][path] = pairs
        if any(pair["by_others"] for pair in pairs):
            self._found.helpers[name][path] = helpers
        self._claims.pop((name, path), None)

    def _recalled(self, key):
        return (key and self._context.folder.recall(KIND, key)) or {}

    def _key(self, item):
        hashes = self._context.hashes(file for path in item.plan.scans for file in scan_files(path))
        if not all(hashes.values()):
            return None
        plan = item.plan
        return digest_of([program_digest(), plan.reading.as_dict(), plan.wanted, plan.name, list(hashes.values())])

    def _task(self, item, helpers):
        paths, others = list(helpers), {other for own in helpers.values() for other in own}
        plan = replace(
            item.plan,
            photos=tuple(map(Path, paths)),
            outputs=(),
            hand=None,
            faces=None,
            texture=None,
            skip_unshown=True,
        )
        hashes = self._context.hashes(file for path in plan.scans for file in scan_files(path))
        hashes |= {path: self._looks.hashes[path] for path in {*paths, *others}}
        helpers = {path: own for path, own in helpers.items() if own}
        placed_by = self._found.placed_by(item.name, others)
        placed_by |= {path: [self._looks.hashes[other] for other in own] for path, own in helpers.items()}
        # One is open at a time, and those that help to place it.
        largest = sorted(map(Path, {*paths, *others}), key=lambda path: -self._context.costs.photos.get(path, 0))
        largest = largest[: 1 + MOST_HELPERS if others else 1]
        return Task(
            name=item.name,
            request={
                "do": "match",
                "plan": as_document(plan),
                "folder": str(self._context.folder.root),
                "hashes": hashes,
                "names": {path: self._looks.photos[path] for path in {*paths, *others}},
                "helpers": helpers,
                "placed_by": placed_by,
            },
            memory=self._context.costs.memory(plan.scans, largest),
            cost=SECONDS_PER_PAIR * len(paths),
            log=self._context.folder.log(f"{item.name} match"),
        )

    def verdicts(self):
        """The `Verdicts` on what was found so far."""
        claims = defaultdict(list)
        for name, found in self._found.pairs.items():
            for path, pairs in found.items():
                # A scan without any return claims nothing.
                if pairs:
                    claims[path].append(self._claim(name, path, pairs))
        return Verdicts(claims, self._compared, self._looks.overlaps, self._partners)

    def same_place(self, verdicts):
        """The items that are probably of the place which a photo was found to show, for the path of each photo."""
        if self._looks.few:
            return {}
        pictures = {
            (path, name): picture
            for path, verdict in verdicts.by_photo().items()
            for name in verdict.shown
            if (picture := self._claims[name, path].picture) is not None
        }
        # One that was deleted meanwhile is not missed.
        new = {
            picture: name
            for (_, name), picture in pictures.items()
            if picture not in self._fits and self._context.folder.sketch(picture).is_file()
        }
        if new:
            self._fits |= looks_of_scans(self._context, self._items.values(), new, self._looks)
        beside, found = verdicts.beside(), defaultdict(set)
        for (path, name), picture in pictures.items():
            # What was named once stays, though it is left out when it is confirmed.
            own = self._partners.setdefault(picture, set())
            own |= set(partners(self._fits.get(picture, {}), self._looks.usual, beside[name]))
            found[path] |= own
        return found

    def _claim(self, name, path, pairs):
        if (name, path) not in self._claims:
            by_hand = self._said.get((name, path), False)
            looked = self._looks.strengths.get(name, {}).get(path, 0.0)
            helpers = tuple(self._found.helpers[name].get(path, ()))
            self._claims[name, path] = Claim.of(name, self._looks.photos[path], pairs, by_hand, looked, helpers)
        return self._claims[name, path]

    def decide(self):
        """Find out what each photo shows; say where one contradicts itself, and where a person's word has no effect."""
        self._found.decided = True
        self._found.verdicts |= self.verdicts().by_photo()
        for path, found in sorted(self._found.verdicts.items()):
            warning = found.warning(self._looks.photos[path])
            if warning is not None and self._own.intersection(found.shown + found.refused):
                self._context.session.warnings.append(warning)
        for (name, path), shows in self._said.items():
            photo, file, pairs = self._looks.photos[path], self._table, self._found.pairs[name].get(path, ())
            if not shows:
                told = Message("gives no colors, as {file} says", file=file)
                self._found.effects[name].append({"photo": photo, "told": str(told)})
            elif pairs and not any(pair["verified"] for pair in pairs):
                told = Message("is not verified, so it gives no colors, although {file} says yes", file=file)
                self._found.effects[name].append({"photo": photo, "told": str(told)})
                if name in self._own:
                    self._context.session.warnings.append(
                        Message(
                            "{photo}: shows {scan}, as {file} says, but is not verified there, so it gives no colors; "
                            "four to six pairs picked by hand place it (hand = ... below its [[scan]] in the manifest)",
                            photo=photo,
                            scan=name,
                            file=file,
                        )
                    )
