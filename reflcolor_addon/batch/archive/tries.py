"""Which pairs of a photo and a scan are matched next: what is likeliest first, and no more than it takes."""

from collections import defaultdict

# How many scans a photo is tried on at first, and then in each round, and at most.
_AT_FIRST, _A_ROUND, MOST_SCANS = 2, 2, 8
# From this strength on a photo is placed; then it is tried on so many at most, because another scan may show the same
# place, and on those that are known to.
_PLACED, _MOST_PLACED = 50.0, 4
# Which share of all pairs is matched at most, beyond the first round.
_MOST_PAIRS = 0.11


class Tries:
    """The rounds of a batch. Each depends on nothing but what the earlier ones have found, so all is the same again.

    Parameters
    ----------
    ranks : dict of str to list of (str, float)
        For each photo its scans (the items of the batch, by their names) in the order in which they are tried, and how
        likely each is.
    few : bool
        Whether there are so few pairs that a photo which is not placed may be tried on all scans.
    """

    def __init__(self, ranks, few=False):
        count = sum(map(len, ranks.values()))
        self._ranks = ranks
        self._most = count if few else MOST_SCANS
        self._budget = count if few else int(_MOST_PAIRS * count)
        self._tried = {photo: [] for photo in ranks}

    def next(self, claims, beside):
        """Return the pairs of the next round; none at the end.

        Parameters
        ----------
        claims : dict of str to list of Claim
            What was found so far, for each photo.
        beside : dict of str to set of str
            For each item those that are known to show the same place.

        Returns
        -------
        dict of str to list of str
            For each item its photos.
        """
        first = not any(self._tried.values())
        wanted = []
        for photo, ranked in self._ranks.items():
            tried = self._tried[photo]
            most, neighbors = self._left(claims.get(photo, ()), beside)
            open_ones = [(share, photo, name) for name, share in ranked if name not in tried]
            count = max(0, min(_AT_FIRST if first else _A_ROUND, most - len(tried)))
            wanted += [one for one in open_ones[:count] if one[2] not in neighbors]
            wanted += [(1.0, photo, name) for _, _, name in open_ones if name in neighbors]
        wanted.sort(key=lambda one: (-one[0], one[1], one[2]))
        if not first:
            wanted = wanted[: max(0, self._budget - sum(map(len, self._tried.values())))]
        pairs = defaultdict(list)
        for _, photo, name in wanted:
            self._tried[photo].append(name)
            pairs[name].append(photo)
        return dict(pairs)

    def _left(self, claims, beside):
        """On how many scans at most a photo is tried, and which are tried beyond that."""
        placed = [claim for claim in claims if claim.verified and claim.strength >= _PLACED]
        if not placed:
            return self._most, ()
        return _MOST_PLACED, beside.get(max(placed, key=lambda claim: claim.strength).item, ())
