"""Which pairs of a photo and a scan are matched next: what is likeliest first, and no more than it takes."""

from collections import defaultdict

from .claims import CLEARLY

# On how many scans a photo is tried at most.
MOST_SCANS = 9
# In a small archive, or with so few photos, a round tries a photo on several scans: scans are not read again and again,
# and no processor waits for the last pair of a short round.
_AT_ONCE, _FEW_PHOTOS = 3, 24
# A photo is placed where at least so much speaks for it, and clearly more than for any other place that it was tried
# on. Then it is tried on further scans, which may show the same place, only if they are nearly as likely as the best
# one, and only in every third round.
_PLACED, _NEARLY, _MORE_EVERY = 25.0, 0.5, 3
# Which share of all pairs is matched at most, beyond the first round.
_MOST_PAIRS = 0.115


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
        self._ranks, self._tried, self._rounds = ranks, {photo: [] for photo in ranks}, 0
        self._most = count if few else MOST_SCANS
        self._at_once = _AT_ONCE if few or len(ranks) < _FEW_PHOTOS else 1
        self._budget = count if few else max(len(ranks), int(_MOST_PAIRS * count))

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
        pairs, left = defaultdict(list), self._budget - sum(map(len, self._tried.values()))
        while not pairs and left > 0 and self._rounds < self._most:
            self._rounds += 1
            wanted = [(-share, photo, name) for photo in self._ranks for share, name in self._of(photo, claims, beside)]
            for _, photo, name in sorted(wanted)[:left]:
                self._tried[photo].append(name)
                pairs[name].append(photo)
        return dict(pairs)

    def _of(self, photo, claims, beside):
        """What a photo is tried on in this round: (how likely, item)."""
        ranked, tried = self._ranks[photo], self._tried[photo]
        placed = _placed(claims.get(photo, ()), beside)
        open_ones = [(share, name) for name, share in ranked if name not in tried]
        if placed is None:
            return open_ones[: max(0, min(self._rounds * self._at_once, self._most) - len(tried))]
        # A scan of the same place comes before all others.
        neighbors = [(1.0, name) for _, name in open_ones if name in beside.get(placed, ())]
        best = max(share for _, share in ranked)
        likely = [(share, name) for share, name in open_ones if share >= _NEARLY * best]
        return neighbors or likely[: max(0, 1 + self._rounds // _MORE_EVERY - len(tried))]


def _placed(claims, beside):
    """The item that a photo certainly shows; None as long as that is not known."""
    verified = [claim for claim in claims if claim.verified and claim.strength >= _PLACED]
    if not verified:
        return None
    best = max(verified, key=lambda claim: claim.strength)
    others = [claim for claim in claims if claim is not best and claim.item not in beside.get(best.item, ())]
    clear = all(best.strength >= CLEARLY * claim.strength for claim in others)
    return best.item if clear else None
