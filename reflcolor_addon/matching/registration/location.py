"""Where one photo was taken, on all scans of a site: from pairs picked by hand, from another scan, or from nothing.

A photo has one camera. Where scans have poses of their own, the surest camera counts on all of them: another scan
confirms it, or shows nothing of the photo, or must be beyond doubt by itself to contradict it.
"""

from dataclasses import dataclass, replace

import numpy as np

from .pairs import LEAST_PAIRS, camera_from_pairs
from .registration import Registration, confirmed, register


@dataclass(frozen=True, eq=False)
class Location:
    """What became of one photo on one scan.

    registration : Registration
    verified : bool
        Its camera was found and stood the test, or follows from pairs picked by hand.
    reason : {"pose", "homography", "hand"} or None
    note : str
        One line for a person.
    warnings : tuple of str
        What a person should do something about.
    """

    registration: Registration
    verified: bool
    reason: str | None
    note: str
    warnings: tuple[str, ...] = ()

    @property
    def beyond_doubt(self):
        """Whether it need not give way to what another scan says."""
        return self.verified and (self.by_hand or self.registration.beyond_doubt)

    @property
    def by_hand(self):
        """Whether it rests on pairs that a person picked."""
        return self.reason == "hand"

    @property
    def _order(self):
        return self.by_hand, self.registration.evidence.rank


def located(scans, views, hand, photo, step):
    """Return the `Location` of a photo on each scan of a site.

    Parameters
    ----------
    scans : sequence of Scan
    views : sequence of ScanViews
        Of each scan.
    hand : sequence of Seeds or None
        Of each scan, on pixels with a return.
    photo : PhotoImage
    step : callable
        Called with a text before each stage; may raise to end the work.
    """
    found = [_by_hand(*own, photo, step) for own in zip(scans, views, hand, strict=True)]
    of_pairs = [location.warnings for location in found]
    for number, (scan, own_views) in enumerate(zip(scans, views, strict=True)):
        if not found[number].verified:
            anchor = _surest(scans, found, scan)
            known = None if anchor is None else _known_from(scans[anchor], found[anchor], scan, own_views, photo, step)
            if known is None or not known.verified:
                known = _judged(scan, photo, register(own_views, photo, step=step))
            found[number] = replace(known, warnings=of_pairs[number] + known.warnings)
    for number, (scan, own_views) in enumerate(zip(scans, views, strict=True)):
        anchor = _surest(scans, found, scan)
        if anchor is None or found[number]._order >= found[anchor]._order or found[number].beyond_doubt:
            continue
        known = _known_from(scans[anchor], found[anchor], scan, own_views, photo, step)
        found[number] = replace(known, warnings=of_pairs[number] + known.warnings)
    return found


def _surest(scans, found, scan):
    """Which scan, of those with another pose than ``scan``, the surest camera of the photo is from; None without."""
    others = [
        number
        for number, location in enumerate(found)
        if location.verified
        and location.registration.model.kind == "pose"
        and not np.allclose(scans[number].pose, scan.pose)
    ]
    return max(others, key=lambda number: found[number]._order, default=None)


def _known_from(anchor, location, scan, views, photo, step):
    """The location on a scan, of a photo whose camera is known from another one."""
    step(f"{photo.name}: trying its place on {anchor.name}")
    again = confirmed(views, photo, _carried(location.registration.model, anchor.pose, scan.pose))
    if again.accepted:
        return _judged(scan, photo, again)
    return Location(again, False, None, f"shows {anchor.name}; too little of {scan.name} to take colors from")


def _judged(scan, photo, registration):
    """The location that was found without a person's help."""
    evidence = registration.evidence
    if registration.accepted:
        return Location(registration, True, registration.model.kind, f"verified: {evidence}")
    warning = (
        f"{scan.name}: {photo.name} could not be verified ({evidence}); pick four to six pairs by hand to place it"
    )
    return Location(registration, False, None, f"not verified: {evidence}", (warning,))


def _by_hand(scan, views, hand, photo, step):
    """The location by the pairs picked in this photo; not verified where they do not give one."""
    nothing = Location(Registration.nothing(), False, None, "")
    mine = np.zeros(0, bool)
    if hand is not None:
        mine = np.array([name == photo.name for name in hand.photos]) & np.isfinite(hand.photo_xy).all(axis=1)
    count = int(mine.sum())
    if count == 0:
        return nothing
    if count < LEAST_PAIRS:
        warning = f"{photo.name}: {count} pairs picked by hand do not place it, at least {LEAST_PAIRS} do"
        return replace(nothing, warnings=(warning,))
    points = scan.points[hand.rows[mine], hand.cols[mine]]
    camera, error, left_out = camera_from_pairs(points, hand.photo_xy[mine], photo)
    pixels = error * max(photo.width, photo.height)
    if camera is None:
        off = f" (off by {pixels:.0f} pixels)" if np.isfinite(pixels) else ""
        warning = f"{photo.name}: no camera sees the {count} pairs picked by hand where they are{off}; check them"
        return replace(nothing, warnings=(warning,))
    step(f"{photo.name}: refining the picked pairs")
    refined = confirmed(views, photo, camera)
    registration = refined if refined.accepted else Registration(camera, refined.evidence, "hand")
    slips, warnings = "", ()
    if len(left_out):
        slip = np.flatnonzero(mine)[left_out[0]]
        slips = f", pair {slip + 1} left out as wrong"
        place = f"row {hand.rows[slip]}, column {hand.cols[slip]}"
        warnings = (f"{photo.name}: pair {slip + 1} ({place}) does not fit the others; its color is kept, check it",)
    checked = refined.evidence if refined.accepted else "nothing but the pairs speaks for it"
    note = f"placed by {count} pairs picked by hand, off by {pixels:.0f} pixels{slips}; {checked}"
    return Location(registration, True, "hand", note, warnings)


def _carried(camera, pose_from, pose_to):
    """A camera in the frame of one scan brought to that of another."""
    change = np.linalg.inv(pose_to) @ pose_from
    return replace(
        camera,
        rotation=camera.rotation @ change[:3, :3].T,
        center=change[:3, :3] @ camera.center + change[:3, 3],
    )
