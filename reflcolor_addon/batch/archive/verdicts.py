"""What follows from all claims of a batch together: one photo shows one place, and photos of one scan agree."""

from collections import defaultdict
from itertools import combinations, pairwise

from .claims import Verdict
from .places import ALIKE, agreement, same_place, unlike

CLEARLY = 1.5
"""Of two claims that contradict each other, that one is right for which so many times as much speaks."""
# A photo is placed where so much speaks for it, and another photo agrees or its evidence is so high. The test is made
# for one try: with nine, the best of what chance gives lies 2.8 deviations above its mean, not 2, which asks for more.
_PLACED, _SURE = 25.0, 1.15
# With so much evidence, more than nearly all wrong photos have, a photo shows a scan whatever others show that overlap
# it.
_BEYOND_DOUBT = 2.0


class Verdicts:
    """The verdict on every photo.

    Parameters
    ----------
    claims : dict of str to list of Claim
        For the path of each photo those on all items that it was matched with.
    known : dict, optional
        Where comparisons of claims are kept from one time to the next.
    overlaps : dict of str to list of str, optional
        For the path of each photo those of others that show partly the same.
    partners : dict of str to set of str, optional
        For the `Claim.picture` of what a scan measured the items that are probably of the same place.
    """

    def __init__(self, claims, known=None, overlaps=None, partners=None):
        self._known = {} if known is None else known
        self._claims, self._overlaps, self._partners = claims, overlaps or {}, partners or {}
        self._of_photo = {claim: own for own in claims.values() for claim in own}
        self._path_of = {claim: path for path, own in claims.items() for claim in own}
        self._verified = [claim for own in claims.values() for claim in own if claim.verified]
        # Whatever contradicts a claim, for each; and what speaks for it, together with the best photo that agrees. One
        # that overlaps it does not count: it shows the same, and would make the same mistake.
        self._rivals, self._weights = defaultdict(list), {claim: claim.weight for claim in self._verified}
        # For each item those that are connected with it by photos, each of which shows some of them.
        self._supported, self._joined = set(), {}
        self._compare_photos()
        self._compare_places()
        self._decide()

    def by_photo(self):
        """Return for the path of each photo that was verified anywhere its `Verdict`."""
        found = {}
        for path, own in self._claims.items():
            ordered = sorted((claim for claim in own if claim.verified), key=self._order)
            if not ordered:
                continue
            shown, refused = ([claim for claim in ordered if claim in some] for some in (self._shown, self._refused))
            likelier = [other.item for claim in refused for other in self._likelier(claim)]
            against = {
                claim.item: tuple(sorted(other.photo for other in self._rivals[claim] if other.item == claim.item))
                for claim in refused
            }
            found[path] = Verdict(
                shown=_names(shown),
                refused=_names(refused),
                likelier=tuple(dict.fromkeys(likelier)),
                against={item: photos for item, photos in against.items() if photos},
                unhelped={
                    claim.item: tuple(other.photo for path in claim.helpers for other in self._claims.get(path, ())[:1])
                    for claim in refused
                    if claim in self._unhelped
                },
            )
        return found

    def placed(self):
        """Return the paths of photos that certainly show what they were verified on."""
        return {path for path, _ in self.certain()}

    def certain(self):
        """Return pairs (path, item) of photos and what they certainly show."""
        return {
            (self._path_of[claim], claim.item)
            for claim in self._shown
            if claim.strength >= _PLACED and (claim.evidence >= _SURE or claim in self._supported)
        }

    def beside(self):
        """Return for each item those that photos say show the same place."""
        beside = defaultdict(set)
        for verdict in self.by_photo().values():
            for name in verdict.shown:
                beside[name] |= set(verdict.shown) - {name}
        return beside

    def _compare_photos(self):
        """Photos on one scan: that both are right is possible only if they are alike where they show the same."""
        of_scan, best = defaultdict(list), defaultdict(float)
        for claim in self._verified:
            of_scan[claim.item, claim.scan].append(claim)
        for own in of_scan.values():
            for one, other in combinations(own, 2):
                found = self._compared(one, other, lambda one, other: agreement(one.brightness, other.brightness))
                if unlike(found):
                    self._contradict(one, other)
                elif found is not None and found >= ALIKE:
                    self._supported |= {one, other}
                    if not self._overlap(one, other):
                        best[one], best[other] = (
                            max(best[claim], its.weight) for claim, its in ((one, other), (other, one))
                        )
        for claim, weight in best.items():
            self._weights[claim] += weight

    def _overlap(self, one, other):
        """Whether the photos of two claims show partly the same."""
        paths = self._path_of[one], self._path_of[other]
        return any(its in self._overlaps.get(own, ()) for own, its in (paths, reversed(paths)))

    def _compare_places(self):
        """One photo on several items: they must be of one place. Where that cannot be told, because two see different
        parts of the photo or a camera is a little off, what the scans measured around there may tell, or a third one
        may be of one place with both."""
        for own in self._claims.values():
            verified = [claim for claim in own if claim.verified]
            place = {claim: {claim} for claim in verified}
            for one, other in combinations(verified, 2):
                same = self._compared(one, other, same_place)
                if same or (same is None and self._are_partners(one, other)):
                    both = place[one] | place[other]
                    place |= dict.fromkeys(both, both)
            for one, other in combinations(verified, 2):
                if other not in place[one] or self._compared(one, other, same_place) is False:
                    self._contradict(one, other)

    def _are_partners(self, one, other):
        return any(its.item in self._partners.get(own.picture, ()) for own, its in ((one, other), (other, one)))

    def _contradict(self, one, other):
        self._rivals[one].append(other)
        self._rivals[other].append(one)

    def _compared(self, one, other, compare):
        if (one, other) not in self._known:
            self._known[one, other] = compare(one, other)
        return self._known[one, other]

    def _decide(self):
        """Take claims, until these show no more scans to be beside each other."""
        while True:
            self._take_with_help()
            if not self._join():
                return

    def _join(self):
        """Join items that a photo shows beside each other; return whether they were not joined before."""
        joined = False
        for own in self._claims.values():
            for one, other in pairwise(claim.item for claim in own if claim in self._shown):
                if other not in self._joined.get(one, ()):
                    both = self._joined.get(one, {one}) | self._joined.get(other, {other})
                    self._joined |= dict.fromkeys(both, both)
                    joined = True
        return joined

    def _take_with_help(self):
        """Take claims; what was placed with the help of photos that are refused there is refused, too."""
        self._unhelped = set()
        while True:
            self._take()
            shown = {(self._path_of[claim], claim.item) for claim in self._shown}
            unhelped = {
                claim
                for claim in self._shown
                if claim.helpers
                and not claim.by_hand
                and shown.isdisjoint((path, claim.item) for path in claim.helpers)
            }
            if not unhelped:
                break
            self._unhelped |= unhelped

    def _take(self):
        """Take claims, that for which most speaks first, unless they contradict one that was taken."""
        self._shown, self._refused = set(), set()
        for claim in sorted(self._verified, key=self._order):
            open_ones = [other for other in self._contradicting(claim) if not self._is_out(other)]
            if claim.by_hand or (not self._is_out(claim) and self._is_clear(claim, open_ones)):
                self._shown.add(claim)
            else:
                self._refused.add(claim)

    def _contradicting(self, claim):
        """Claims that contradict one. A photo that does not tell whether two scans are of one place may show both, if
        other photos connect them."""
        joined, own = self._joined.get(claim.item, ()), self._of_photo[claim]
        return [
            other
            for other in self._rivals[claim]
            if not (other in own and other.item in joined and self._compared(claim, other, same_place) is None)
        ]

    def _order(self, claim):
        return not claim.by_hand, -self._weights[claim], claim.item, claim.photo

    def _is_out(self, claim):
        """Whether a claim contradicts one that was taken, or more speaks for another place."""
        taken = any(other in self._shown for other in self._contradicting(claim))
        return not claim.by_hand and (taken or claim in self._unhelped or bool(self._likelier(claim)))

    def _is_clear(self, claim, rivals):
        return all(self._weights[claim] >= CLEARLY * self._weights[other] for other in rivals)

    def _likelier(self, claim):
        """Claims of the same photo on other places for which more speaks, although they were not verified."""
        return [
            other
            for other in self._of_photo[claim]
            if not other.verified and self._speaks_more(other, claim) and not self._compared(claim, other, same_place)
        ]

    def _speaks_more(self, other, claim):
        """Whether clearly more speaks for a claim than for one that was verified: in the match, in the second look, or
        because another photo is there."""
        # Matching does not always end where the look saw most; but looks tell only where both places were looked at.
        looked = (other.looked, claim.looked) if other.looked and claim.looked else (0.0, 0.0)
        if not other.repeats and max(other.strength, looked[0]) > CLEARLY * max(claim.strength, looked[1]):
            return True
        if claim.evidence >= _BEYOND_DOUBT:
            return False
        backed = self._backing(other, claim)
        return backed > 0 and other.weight + backed >= CLEARLY * self._weights[claim]

    def _backing(self, other, claim):
        """What speaks for another place because a photo that overlaps this one, and for which more speaks, shows it."""
        # Where scans stand beside each other, photos that overlap may show different ones of them.
        place = {claim.item, *(its.item for its in self._of_photo[claim] if its in self._shown)}
        beside = set().union(*(self._joined.get(item, ()) for item in place), self._partners.get(claim.picture, ()))
        if other.item in beside:
            return 0.0
        # Claims for which less speaks were not decided on yet: what is refused later must not speak for anything.
        backing = (
            its.weight
            for path in self._overlaps.get(self._path_of[claim], ())
            for its in self._claims.get(path, ())
            if its in self._shown and its.item == other.item and claim.item not in self._partners.get(its.picture, ())
        )
        return max(backing, default=0.0)


def _names(claims):
    return tuple(claim.item for claim in claims)
