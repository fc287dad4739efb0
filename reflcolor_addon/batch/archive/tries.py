"""Which pairs of a photo and a scan are matched next: what is likeliest first, and no more than it takes."""

from collections import defaultdict
from dataclasses import dataclass

# On how many scans a photo is tried at most, and on how many in full. A scan of a place where a photo was found, or one
# that overlaps it, does not count.
MOST_SCANS, _MOST_IN_FULL = 12, 4
# How many pairs a round has for each photo. In a small archive, or with so few photos, a round tries a photo on several
# scans: scans are not read again and again, and no processor waits for the last pair of a short round.
_IN_A_ROUND, _AT_ONCE, _FEW_PHOTOS = 0.5, 3, 24
# A photo does not always pass the test where it belongs; this often it does not.
_MISSED = 0.4
# How often another scan shows the place of a photo that was found; and what is not worth trying for that.
_ANOTHER, _WORTH = 0.2, 0.05
# Which share of all pairs is matched at most, beyond the first round and scans that another photo shows to be of one
# place; and as how much of a pair a short try counts.
_MOST_PAIRS, _SHORT = 0.105, 0.35
MOST_OF_A_PHOTO = _MOST_IN_FULL + _SHORT * (MOST_SCANS - 1)
"""As many full tries take at most as long as those of a photo that is not found."""
# How many photos help to place another one.
MOST_HELPERS = 3


@dataclass(frozen=True)
class Try:
    """How a pair is matched.

    Parameters
    ----------
    helpers : tuple of str
        The photos that help to place this one, if there are any.
    short : bool
        Whether it is given up where nothing is found soon; see `registration.register`.
    """

    helpers: tuple[str, ...] = ()
    short: bool = False


class Tries:
    """The rounds of a batch. Each depends on nothing but what the earlier ones have found, so all is the same again.

    Parameters
    ----------
    ranks : dict of str to list of (str, float)
        For each photo its scans (the items of the batch, by their names), the likeliest first, and how likely each is.
    first : dict of str to list of (str, float)
        The same by the first look alone.
    few : bool
        Whether there are so few pairs that a photo which is not placed may be tried on all scans.
    overlaps : dict of str to list of str, optional
        For each photo others that show partly the same, those first that agree best.
    """

    def __init__(self, ranks, first, few=False, overlaps=None):
        count = sum(map(len, ranks.values()))
        self._ranks, self._tried, self._rounds = ranks, {photo: set() for photo in ranks}, 0
        self._overlaps, self._helpers, self._few = overlaps or {}, {}, few
        self._shortly = defaultdict(set)
        self._first = {photo: own[0][0] for photo, own in first.items() if own}
        self._most, self._most_in_full = (count, count) if few else (MOST_SCANS, _MOST_IN_FULL)
        self._at_once = _AT_ONCE if few or len(ranks) < _FEW_PHOTOS else 1
        self._size = max(1, int(len(ranks) * (self._at_once if self._at_once > 1 else _IN_A_ROUND)))
        self._left = count if few else max(len(ranks), int(_MOST_PAIRS * count))

    def next(self, verdicts, partners):
        """Return the pairs of the next round; none at the end.

        Parameters
        ----------
        verdicts : Verdicts
            On what was found so far.
        partners : dict of str to set of str
            For photos that were found: other scans that are probably of the same place.

        Returns
        -------
        dict of str to dict of str to Try
            For each item its photos, and how they are tried.
        """
        pairs = defaultdict(dict)
        if self._rounds == 0:
            chosen = [(photo, name, Try()) for photo, own in self._ranks.items() for name, _ in own[: self._at_once]]
            size, free = len(chosen), set()
        else:
            for (photo, name), helpers in self._helped(verdicts).items():
                self._tried[photo].add(name)
                # Where it cannot be placed so, it is tried in full.
                self._shortly[photo].discard(name)
                pairs[name][photo] = Try(helpers)
            chosen, free = self._by_themselves(verdicts, partners)
            size = self._size
        self._rounds += 1
        for photo, name, how in chosen:
            if size > 0 and ((photo, name) in free or self._left > 0):
                size -= 1
                self._left -= 0 if (photo, name) in free else _SHORT if how.short else 1
                self._tried[photo].add(name)
                if how.short:
                    self._shortly[photo].add(name)
                else:
                    self._shortly[photo].discard(name)
                pairs[name][photo] = how
        return dict(pairs)

    def _helped(self, verdicts):
        """Pairs (photo, item), and for each the photos that help: they overlap it, and certainly show the item."""
        shown = {(photo, name) for photo, verdict in verdicts.by_photo().items() for name in verdict.shown}
        certain, helped = verdicts.certain(), {}
        shows = defaultdict(set)
        for other, name in certain:
            shows[other].add(name)
        for photo in self._ranks:
            others = [other for other in self._overlaps.get(photo, ()) if other in shows]
            for name in sorted(set().union(*(shows[other] for other in others))):
                helpers, before = [other for other in others if name in shows[other]], self._helpers.get((photo, name))
                if (photo, name) in shown:
                    # What was placed with help does not help to place better what was placed without.
                    helpers = [other for other in helpers if (other, name) not in self._helpers]
                    if (photo, name) in certain or before:
                        continue
                helpers = helpers[:MOST_HELPERS]
                if not (before or set()).issuperset(helpers):
                    helped[photo, name] = tuple(helpers)
        for pair, helpers in helped.items():
            self._helpers.setdefault(pair, set()).update(helpers)
        return helped

    def _by_themselves(self, verdicts, partners):
        """Pairs (photo, item, how they are tried), the likeliest first, and the set of those that do not count."""
        placed, found, beside = verdicts.placed(), verdicts.by_photo(), verdicts.beside()
        chances, again, free = [], [], set()
        for photo in self._ranks:
            shown = found[photo].shown if photo in found else ()
            self._shortly[photo] -= set(shown)
            # What another photo of the same place shows, this one probably shows, too.
            others = [found[other].shown for other in self._overlaps.get(photo, ()) if other in found]
            seen = {name for own in (shown, *others) for name in own}
            neighbors = seen.union(*(beside[item] for item in seen))
            free |= {(photo, name) for name in neighbors}
            neighbors |= set(partners.get(photo, ()))
            certain = self._certain(photo, photo in placed, neighbors)
            own = [] if certain else self._of(photo, photo in placed, shown)
            chances += [(-1.0, photo, name, Try()) for name in certain]
            chances += [(-chance, photo, name, Try(short=not self._few)) for chance, name in own]
            room = self._most_in_full - len(self._tried[photo] - self._shortly[photo])
            if not certain and not own and not shown and room > 0:
                some = [
                    (-share, photo, name, Try()) for name, share in self._ranks[photo] if self._is_short(photo, name)
                ]
                again += some[:room]
        # What was tried shortly and found nothing is tried in full when all else was tried.
        chosen = sorted(chances or again, key=lambda entry: entry[:3])
        return [entry[1:] for entry in chosen], free

    def _is_short(self, photo, name):
        return name in self._shortly[photo]

    def _certain(self, photo, placed, neighbors):
        """What comes before all others: scans of the same place, and what was likeliest at the first look.

        The second look fits a camera to the best directions alone, and may miss the right one.
        """
        likeliest = None if placed else self._first.get(photo)
        return [
            name
            for name, _ in self._ranks[photo]
            if (name not in self._tried[photo] or self._is_short(photo, name))
            and (name in neighbors or name == likeliest)
        ]

    def _of(self, photo, placed, shown):
        """How likely it is that a photo shows each of the scans that it may be tried on: (chance, item)."""
        ranked, tried = self._ranks[photo], self._tried[photo]
        open_ones = [(share, name) for name, share in ranked if name not in tried]
        missed = _MISSED * sum(share for name, share in ranked if name in tried and name not in shown)
        every = max(sum(share for share, _ in open_ones) + missed, 1e-12)
        room = max(0, self._most - len(tried))
        chances = [((_ANOTHER if placed else 1.0) * share / every, name) for share, name in open_ones[:room]]
        return [(chance, name) for chance, name in chances if chance >= _WORTH] if placed else chances
