"""Which pairs of a photo and a scan are matched next: what is likeliest first, and no more than it takes."""

from collections import defaultdict

from .candidates import TELLING

# On how many scans a photo is tried at most; and on how many if second looks found nothing telling on any scan.
MOST_SCANS, _FEWER_SCANS = 9, 3
# How many pairs a round has for each photo. In a small archive, or with so few photos, a round tries a photo on several
# scans: scans are not read again and again, and no processor waits for the last pair of a short round.
_IN_A_ROUND, _AT_ONCE, _FEW_PHOTOS = 0.5, 3, 24
# A photo does not always pass the test where it belongs; this often it does not.
_MISSED = 0.4
# How often another scan shows the place of a photo that was found; and what is not worth trying for that: less where
# there are so few pairs that scans of one place are not looked for.
_ANOTHER, _WORTH, _WORTH_OF_FEW = 0.2, 0.1, 0.05
# Which share of all pairs is matched at most, but for each photo's likeliest scan and scans that another photo shows to
# be of one place.
MOST_PAIRS = 0.105
# How many photos help to place another one.
MOST_HELPERS = 3


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
    strongest : dict of str to float, optional
        For each photo the most that second looks found for it on any scan.
    """

    def __init__(self, ranks, first, few=False, overlaps=None, strongest=None):
        count = sum(map(len, ranks.values()))
        self._ranks, self._tried, self._rounds = ranks, {photo: set() for photo in ranks}, 0
        self._overlaps, self._helpers = overlaps or {}, {}
        self._first = {photo: own[0][0] for photo, own in first.items() if own}
        weak = {photo for photo, strength in (strongest or {}).items() if strength < TELLING}
        self._most = {photo: count if few else _FEWER_SCANS if photo in weak else MOST_SCANS for photo in ranks}
        self._at_once = _AT_ONCE if few or len(ranks) < _FEW_PHOTOS else 1
        self._size = max(1, int(len(ranks) * (self._at_once if self._at_once > 1 else _IN_A_ROUND)))
        self._left = count if few else max(len(ranks), int(MOST_PAIRS * count))
        self._worth = _WORTH_OF_FEW if few else _WORTH

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
        dict of str to dict of str to tuple of str
            For each item its photos, and for each of these the photos that help to place it, if there are any.
        """
        pairs = defaultdict(dict)
        if self._rounds == 0:
            # Every photo's likeliest scan, then every one's second.
            places = range(self._at_once)
            chosen = [(photo, own[k][0]) for k in places for photo, own in self._ranks.items() if k < len(own)]
            size, free = len(chosen), set()
        else:
            helped = self._helped(verdicts)
            for (photo, name), helpers in helped.items():
                self._tried[photo].add(name)
                pairs[name][photo] = helpers
            chosen, free = self._by_themselves(verdicts, partners)
            size = self._size
        self._rounds += 1
        for photo, name in chosen:
            if size > 0 and ((photo, name) in free or self._left > 0):
                size, self._left = size - 1, self._left - ((photo, name) not in free)
                self._tried[photo].add(name)
                pairs[name][photo] = ()
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
        """Pairs (photo, item), the likeliest first, and the set of those that do not count."""
        placed, found, beside = verdicts.placed(), verdicts.by_photo(), verdicts.beside()
        chances, free = [], set()
        for photo in self._ranks:
            shown = found[photo].shown if photo in found else ()
            # What another photo of the same place shows, this one probably shows, too. If that one was refused because
            # this one shows another scan, this one may show both.
            others = [found[other] for other in self._overlaps.get(photo, ()) if other in found]
            others = [other.shown or other.refused for other in others]
            seen = {name for own in (shown, *others) for name in own}
            neighbors = seen.union(*(beside[item] for item in seen))
            free |= {(photo, name) for name in neighbors}
            neighbors |= set(partners.get(photo, ()))
            chances += [(-chance, photo, name) for chance, name in self._of(photo, photo in placed, shown, neighbors)]
        return [(photo, name) for _, photo, name in sorted(chances)], free

    def _of(self, photo, placed, shown, neighbors):
        """How likely it is that a photo shows each of the scans that it may be tried on: (chance, item)."""
        ranked, tried = self._ranks[photo], self._tried[photo]
        open_ones = [(share, name) for name, share in ranked if name not in tried]
        # A scan of the same place comes before all others, and so does what was likeliest at the first look: the second
        # one fits a camera to the best directions alone, and may miss the right one.
        likeliest = None if placed else self._first.get(photo)
        certain = [(1.0, name) for _, name in open_ones if name in neighbors or name == likeliest]
        room = self._most[photo] - len(tried)
        if room <= 0 or certain:
            return certain
        missed = _MISSED * sum(share for name, share in ranked if name in tried and name not in shown)
        every = max(sum(share for share, _ in open_ones) + missed, 1e-12)
        chances = [((_ANOTHER if placed else 1.0) * share / every, name) for share, name in open_ones[:room]]
        return [(chance, name) for chance, name in chances if chance >= self._worth] if placed else chances
