"""Where one photo was taken, on all scans of a site: from pairs picked by hand, from another scan, or from nothing.

A photo has one camera. Where scans have poses of their own, the surest camera counts on all of them: another scan
confirms it, or shows nothing of the photo, or contradicts it only if its own camera is beyond doubt.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...messages import Message
from ..models import Camera
from .pairs import LEAST_PAIRS, camera_from_pairs
from .refinement import HandPairs
from .registration import Registration, confirmed, register

# The accuracy of a careful click, as a share of the photo's longer side.
_SUREST_CLICK = 0.001
# How many tiles lie over each other, of those that say something; and a power: where pixels are drawn out, the tiles'
# errors do not average out, because an edge is known to a pixel of the grid only.
_OVERLAP, _TOGETHER = 3.0, 1.5


@dataclass(frozen=True, eq=False)
class Location:
    """The result for one photo on one scan.

    registration : Registration
    verified : bool
        Its camera was found and passed the test, or follows from pairs picked by hand.
    reason : {"pose", "homography", "hand"} or None
    note : Message
        One line for a person.
    warnings : tuple of str
        What a person should act on.
    """

    registration: Registration
    verified: bool
    reason: str | None
    note: str
    warnings: tuple[str, ...] = ()

    @property
    def tested(self):
        """Whether it could be decided if the photo shows the scan."""
        return self.verified or self.registration.untestable is None

    @property
    def beyond_doubt(self):
        """Whether it stands even where another scan says otherwise."""
        return self.verified and (self.by_hand or self.registration.beyond_doubt)

    @property
    def by_hand(self):
        """Whether it rests on pairs that a person picked."""
        return self.reason == "hand"

    @property
    def _order(self):
        return self.by_hand, self.registration.evidence.rank


def located(scans, views, hand, photo, step, registered=None):
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
    registered : callable, optional
        Called as ``registered(number, register)`` where a photo has to be registered on a scan without any help;
        ``register()`` does it. So a registration that is known already can be used.
    """
    registered = registered or (lambda number, register: register())
    found = [_by_hand(*own, photo, step) for own in zip(scans, views, hand, strict=True)]
    of_pairs = [location.warnings for location in found]
    for number, (scan, own_views) in enumerate(zip(scans, views, strict=True)):
        if not found[number].verified:
            anchor = _surest(scans, found, scan)
            known = None if anchor is None else _known_from(scans[anchor], found[anchor], scan, own_views, photo, step)
            if known is None or not known.verified:
                known = _as_stated(scan, own_views, photo, step) or known
            if known is None or not known.verified:
                known = _judged(scan, photo, registered(number, partial(register, own_views, photo, step=step)))
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
    step(Message("{photo}: trying its place on {other}", photo=photo.name, other=anchor.name))
    again = confirmed(views, photo, _carried(location.registration.model, anchor.pose, scan.pose))
    if again.accepted:
        return _judged(scan, photo, again)
    note = Message("shows {other}; too little of {scan} to take colors from", other=anchor.name, scan=scan.name)
    return Location(again, False, None, note)


def _as_stated(scan, views, photo, step):
    """The location that a photo's file states, if it stands the test; None where it does not, or states none."""
    if photo.place is None:
        return None
    step(Message("{photo}: trying its place in the file", photo=photo.name))
    turn, center = photo.place.seen_from(scan.pose)
    again = confirmed(views, photo, Camera(turn, center, photo.place.focal_px, 0.0, photo.width, photo.height))
    return _judged(scan, photo, again) if again.accepted else None


def _judged(scan, photo, registration):
    """The location that was found without a person's help."""
    said = registration.evidence.said
    if registration.accepted:
        note = Message("verified: {evidence}", evidence=said)
        if registration.beside is not None:
            note = "verified with the help of {other}, which shows part of the same: {evidence}"
            note = Message(note, other=registration.beside, evidence=said)
        return Location(registration, True, registration.model.kind, note)
    if registration.untestable:
        warning = "{scan}: {photo} cannot be tested ({reason}); pick four to six pairs by hand to place it"
        note, reason = "cannot be tested: {reason}", registration.untestable
    else:
        warning = "{scan}: {photo} could not be verified ({reason}); pick four to six pairs by hand to place it"
        note, reason = "not verified: {reason}", said
    warning = Message(warning, scan=scan.name, photo=photo.name, reason=reason)
    return Location(registration, False, None, Message(note, reason=reason), (warning,))


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
        warning = "{photo}: {count} pairs picked by hand do not place it, at least {least} do"
        warning = Message(warning, photo=photo.name, count=count, least=LEAST_PAIRS)
        return replace(nothing, warnings=(warning,))
    points = scan.points[hand.rows[mine], hand.cols[mine]]
    camera, error, left_out = camera_from_pairs(points, hand.photo_xy[mine], photo)
    pixels = error * max(photo.width, photo.height)
    if camera is None:
        off = Message(" (off by {pixels} pixels)", pixels=round(pixels)) if np.isfinite(pixels) else ""
        warning = "{photo}: no camera sees the {count} pairs picked by hand where they are{off}; check them"
        warning = Message(warning, photo=photo.name, count=count, off=off)
        return replace(nothing, warnings=(warning,))
    step(Message("{photo}: refining the picked pairs", photo=photo.name))
    kept = np.setdiff1d(np.arange(count), left_out)
    picked = HandPairs(
        points[kept], hand.photo_xy[mine][kept], _doubt(pixels, len(kept), photo), _OVERLAP * views.repeats
    )
    refined = confirmed(views, photo, camera, picked)
    # Where measurements are stretched, pairs say better than tiles where the camera is.
    by_tiles = refined.accepted and not views.stretched
    registration = refined if by_tiles else Registration(camera, refined.evidence, "hand")
    slips, warnings = "", ()
    if len(left_out):
        slip = int(np.flatnonzero(mine)[left_out[0]])
        slips = Message(", pair {number} left out as wrong", number=slip + 1)
        warning = (
            "{photo}: pair {number} (row {row}, column {col}) does not fit the others; its color is kept, check it"
        )
        place = {"row": int(hand.rows[slip]), "col": int(hand.cols[slip])}
        warnings = (Message(warning, photo=photo.name, number=slip + 1, **place),)
    checked = refined.evidence.said if refined.accepted else Message("nothing but the pairs speaks for it")
    note = Message(
        "placed by {count} pairs picked by hand, off by {pixels} pixels{slips}; {evidence}",
        count=count,
        pixels=round(pixels),
        slips=slips,
        evidence=checked,
    )
    return Location(registration, True, "hand", note, warnings)


def _doubt(pixels, count, photo):
    """How far picked pairs are off, from how far they are off their own camera, which seven numbers bend to them."""
    free = 2 * count - 7
    usual = pixels * np.sqrt(2 * count / free) if free >= 3 else 0.0
    return max(usual, _SUREST_CLICK * max(photo.width, photo.height))


def _carried(camera, pose_from, pose_to):
    """A camera in the frame of one scan brought to that of another."""
    change = np.linalg.inv(pose_to) @ pose_from
    return replace(
        camera,
        rotation=camera.rotation @ change[:3, :3].T,
        center=change[:3, :3] @ camera.center + change[:3, 3],
    )
