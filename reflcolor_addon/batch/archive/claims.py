"""What was found for the pairs of a batch: what speaks for a photo on an item, and the verdict on a photo."""

from dataclasses import dataclass, field

from ...messages import Message
from .places import Cells


@dataclass(frozen=True, eq=False, kw_only=True)
class Claim:
    """What speaks for a photo on an item: what was found on that of its scans for which most speaks.

    Parameters
    ----------
    item, photo, scan : str
        Their names; the scan's is that of one of the item's.
    verified, by_hand : bool
        Whether the photo's camera passed the test there; whether a person says that it shows the item.
    strength, evidence : float
        See `Evidence`: unlike the evidence as a share of what is needed, the strength can be compared between scans.
    looked : float
        The strength that the second look found on the item; 0 where there was none.
    repeats : bool
        Whether the photo would fit elsewhere as well, so that nothing speaks for this place.
    reflectance, brightness : Cells or None
        See `places.reflectance_seen` and `places.brightness_seen`.
    camera : list or None
        See `places.camera_place`.
    picture : str or None
        Where a picture of what the scan measured there is kept, see `BatchFolder.sketch`.
    helpers : tuple of str
        The paths of the photos that it was placed by; none if it was placed by itself.
    """

    item: str
    photo: str = ""
    scan: str = ""
    verified: bool
    strength: float
    evidence: float
    by_hand: bool = False
    looked: float = 0.0
    repeats: bool = False
    reflectance: Cells | None = None
    brightness: Cells | None = None
    camera: list | None = None
    picture: str | None = None
    helpers: tuple[str, ...] = ()

    @property
    def weight(self):
        """How much speaks for it beside other claims: its strength, and how far that exceeds what is needed there.

        Where the walls of a room repeat themselves, wrong cameras are strong as well; but much is needed there.
        """
        return self.strength * self.evidence

    @classmethod
    def of(cls, item, photo, pairs, by_hand=False, looked=0.0, helpers=()):
        """Return what the pairs of a photo with the scans of an item (see `matches.match_at`) claim."""
        best = max(pairs, key=lambda pair: (pair["verified"], pair["strength"]))
        return cls(
            item=item,
            photo=photo,
            scan=best["scan"],
            verified=best["verified"],
            strength=best["strength"],
            evidence=best["evidence"],
            by_hand=by_hand,
            looked=looked,
            repeats=best["repeats"],
            reflectance=best["reflectance"] and Cells(*best["reflectance"]),
            brightness=best["brightness"] and Cells(*best["brightness"]),
            camera=best["camera"],
            picture=best["picture"],
            helpers=helpers if best["by_others"] else (),
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
    likelier : tuple of str
        Items on which it was not verified, but for which more speaks than for the refused ones.
    against : dict of str to tuple of str
        For refused items the photos that show the same part of them, but not the same there.
    unhelped : dict of str to tuple of str
        For refused items the photos that it was placed by, none of which shows them.
    """

    shown: tuple[str, ...] = ()
    refused: tuple[str, ...] = ()
    likelier: tuple[str, ...] = ()
    against: dict[str, tuple[str, ...]] = field(default_factory=dict)
    unhelped: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def warning(self, photo):
        """Return what a person should know of it; None where nothing contradicts itself."""
        if not self.refused:
            return None
        how = Message("write yes for the right scan into a copy of pairs.csv, and name the copy in the manifest")
        values = {"photo": photo, "refused": ", ".join(self.refused), "how": how}
        if self.shown:
            return Message(
                "{photo}: seems to show {shown} and {refused}, but these do not seem to be one place; only {shown} "
                "gets its colors, because it is clearly the better one; if that is wrong, {how}",
                shown=", ".join(self.shown),
                **values,
            )
        if self.against:
            return Message(
                "{photo}: seems to show {refused}, but does not fit {photos}, which shows the same part of it, so it "
                "gives no colors; if that is wrong, {how}",
                photos=_names(self.against),
                **values,
            )
        if self.unhelped:
            return Message(
                "{photo}: was placed on {refused} by what it has in common with {photos}, which turned out not to show "
                "it, so it gives no colors; if that is wrong, {how}",
                photos=_names(self.unhelped),
                **values,
            )
        if self.likelier:
            return Message(
                "{photo}: seems to show {refused}, but more speaks for {likelier}, although not enough to be sure, so "
                "it gives no colors; if you know it, {how}",
                likelier=", ".join(self.likelier),
                **values,
            )
        return Message(
            "{photo}: seems to show {refused}, but these do not seem to be one place, and none is clearly right, so it "
            "gives no colors; if you know it, {how}",
            **values,
        )

    def doubt(self, item):
        """Return what this means for one of the items; empty where nothing contradicts itself."""
        others = [name for name in (*self.shown, *self.refused) if name != item]
        if not self.refused or item not in (*self.shown, *self.refused):
            return ""
        if item in self.shown:
            text = "seems to show {others}, too, another place as it seems, but this one is clearly better"
            others = self.refused
        elif self.shown:
            text = "gives no colors here: it shows {others}, which is clearly better, and another place as it seems"
            others = self.shown
        elif item in self.against:
            text = "gives no colors: it does not fit {others}, which shows the same part of the scan"
            others = self.against[item]
        elif item in self.unhelped:
            text = "gives no colors: {others}, by which it was placed, turned out not to show the scan"
            others = self.unhelped[item]
        elif self.likelier:
            text = "gives no colors: more speaks for {others}, another place as it seems, but not enough to be sure"
            others = self.likelier
        else:
            text = "gives no colors: seems to show {others}, too, another place as it seems, and none is clearly right"
        return Message(text, others=", ".join(others))


def _names(photos):
    """The names of photos, given for items, one after the other."""
    return ", ".join(dict.fromkeys(name for own in photos.values() for name in own))
