"""What was found for the pairs of a batch, and what follows from all of it: one photo shows one place."""

from dataclasses import dataclass

from ...messages import Message
from .places import same_place

CLEARLY = 2.0
"""Of several places that a photo seems to show, it shows the one for which so many times as much speaks as for any
other. In the archive of ``python -m benchmarks.archive`` wrong pairs, on painted squares, had up to 1.8 times as much
as the right one of the same photo. Scans of one place differ by no more than this."""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """What speaks for a photo on an item: what was found on that of its scans for which most speaks.

    Parameters
    ----------
    item : str
    verified, by_hand : bool
        Whether the photo's camera passed the test there; whether a person says that it shows the item.
    strength : float
        See `Evidence.strength`: unlike the evidence as a share of what is needed, it can be compared between scans.
    depths, camera : list or None
        See `places.depth_map` and `places.camera_place`.
    """

    item: str
    verified: bool
    strength: float
    by_hand: bool = False
    depths: list | None = None
    camera: list | None = None

    @classmethod
    def of(cls, item, pairs, by_hand=False):
        """Return what the pairs of a photo with the scans of an item (see `matches.match_at`) claim."""
        best = max(pairs, key=lambda pair: (pair["verified"], pair["strength"]))
        return cls(
            item=item,
            verified=any(pair["verified"] for pair in pairs),
            strength=best["strength"],
            by_hand=by_hand,
            depths=best["depths"],
            camera=best["camera"],
        )


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Which items a photo shows.

    Parameters
    ----------
    shown : tuple of str
        Their names; several where they show the same place.
    refused : tuple of str
        Items on which it was verified, although it can only show another place.
    """

    shown: tuple[str, ...] = ()
    refused: tuple[str, ...] = ()

    def warning(self, photo):
        """Return what a person should know of it; None where nothing contradicts itself."""
        if not self.refused:
            return None
        if not self.shown:
            return Message(
                "{photo}: seems to show {refused}, but these are different places, and none is clearly right, so it "
                "gives no colors; write yes into pairs.csv for the one that it shows",
                photo=photo,
                refused=", ".join(self.refused),
            )
        return Message(
            "{photo}: seems to show {shown} and {refused}, but these are different places; only {shown} gets its "
            "colors, because it is clearly the better one; if that is wrong, write yes into pairs.csv for the right "
            "one",
            photo=photo,
            shown=", ".join(self.shown),
            refused=", ".join(self.refused),
        )

    def doubt(self, item):
        """Return what this means for one of the items; empty where nothing contradicts itself."""
        others = [name for name in (*self.shown, *self.refused) if name != item]
        if not self.refused or item not in (*self.shown, *self.refused):
            return ""
        if not self.shown:
            text = "seems to show {others}, too, which is another place, and none is clearly right; it gives no colors"
        elif item in self.shown:
            text = "seems to show {others}, too, which is another place, but this one is clearly better"
            others = self.refused
        else:
            text = "gives no colors here: it shows {others}, which is another place and clearly better"
            others = self.shown
        return Message(text, others=", ".join(others))


def verdict(claims):
    """Return the `Verdict` on a photo.

    Parameters
    ----------
    claims : sequence of Claim
        Of all items that it was matched with.
    """
    verified = sorted((claim for claim in claims if claim.verified), key=lambda claim: (-claim.strength, claim.item))
    chosen = [claim for claim in verified if claim.by_hand]
    if not verified:
        return Verdict()
    best = chosen or [verified[0]]
    for claim in verified:
        # Two rooms can be alike, but then not as much speaks for both.
        if claim not in best and _of_one_place(claim, best):
            best.append(claim)
    others = [claim for claim in verified if claim not in best]
    if not chosen and any(CLEARLY * claim.strength > best[0].strength for claim in others):
        return Verdict(refused=tuple(claim.item for claim in verified))
    return Verdict(shown=tuple(claim.item for claim in best), refused=tuple(claim.item for claim in others))


def _of_one_place(claim, best):
    """Whether a claim stands beside better ones: nearly as much speaks for it, and the scans agree on what it shows."""
    return any(CLEARLY * claim.strength >= other.strength and same_place(claim, other) for other in best)
