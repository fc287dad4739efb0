"""All scans and all photos of a site: each photo registered on each scan, and seeds made from what was verified."""

from dataclasses import dataclass

import numpy as np

from ..seeds import Seeds
from .appearance import LEAST_CONFIDENCE, Appearance, described
from .fallback import cautious_colors, mean_color
from .hog_matching import described_photo, described_scan, hog_matches, scan_superpixels, square_image
from .models import Camera
from .pairs import LEAST_PAIRS, camera_from_pairs
from .registration import Registration, ScanViews, confirmed, register
from .several_photos import blended, gains
from .transfer import seen_by

_STEPS_PER_PHOTO = 40


@dataclass(eq=False)
class _OnScan:
    """One scan with what was found out about it."""

    scan: object
    views: ScanViews
    image: object
    superpixels: object
    hand: Seeds | None
    registrations: list
    reports: list
    warnings: list
    shown: list


def verified(scans, photos, hand, settings, step):
    """Yield seeds, reports (fields of `PhotoMatch`) and warnings for every scan.

    Parameters
    ----------
    scans : sequence of Scan
    photos : sequence of PhotoImage
    hand : sequence of Seeds or None
        For each scan, on pixels with a return.
    settings : Settings
    step : callable
        ``step(fraction, text)``; may raise to end the work.
    """
    places = [_prepared(scan, own, settings, step) for scan, own in zip(scans, hand, strict=True)]
    share = 0.8 / (len(photos) * len(places))
    for index, photo in enumerate(photos):
        for number, place in enumerate(places):
            begin = 0.05 + share * (index * len(places) + number)
            _register(place, photo, places[:number], _counted(step, begin, share))
    for place in places:
        step(0.87, f"{place.scan.name}: transferring colors")
        place.shown = [
            None if not report[1] else seen_by(photo, registration.model, place.image)
            for photo, registration, report in zip(photos, place.registrations, place.reports, strict=True)
        ]
    photo_gains = gains([place.shown for place in places])
    seen = [_seen_seeds(place, photos, photo_gains) for place in places]
    step(0.93, "Learning the materials")
    looks = [described(place.image, place.superpixels.labels, len(place.superpixels)) for place in places]
    appearance = _learnt(places, seen, looks)
    for place, own, look in zip(places, seen, looks, strict=True):
        yield _with_unseen(place, own, look, appearance, photos, settings, step), place.reports, place.warnings


def _prepared(scan, hand, settings, step):
    step(0.02, f"{scan.name}: superpixels")
    views = ScanViews(scan)
    image = square_image(scan, views.tone("percentiles"))
    return _OnScan(scan, views, image, scan_superpixels(scan, image, settings), hand, [], [], [], [])


def _counted(step, begin, share):
    count = 0

    def counted(text):
        nonlocal count
        count += 1
        step(begin + share * min(count / _STEPS_PER_PHOTO, 1.0), text)

    return counted


def _register(place, photo, earlier, step):
    """Find a photo's model on one scan: from pairs by hand, from a scan where it is known, or from nothing."""
    name, scan = photo.name, place.scan
    by_hand, note = _from_pairs(place, photo)
    index = len(place.registrations)
    found = None
    if by_hand is not None:
        step(f"{name}: refining the picked pairs")
        found = confirmed(place.views, photo, by_hand)
        registration = found if found.accepted else Registration(by_hand, found.evidence, "hand")
        place.registrations.append(registration)
        checked = f"; {found.evidence}" if found.accepted else "; nothing but the pairs speaks for it"
        place.reports.append((name, True, registration.model, "hand", f"{note}{checked}"))
        return
    if note:
        place.warnings.append(note)
    for other in earlier:
        known = other.registrations[index]
        if other.reports[index][1] and known.model.kind == "pose" and not np.allclose(scan.pose, other.scan.pose):
            step(f"{name}: trying its place on {other.scan.name}")
            found = confirmed(place.views, photo, _carried(known.model, other.scan.pose, scan.pose))
            if found.accepted:
                break
    if found is None or not found.accepted:
        found = register(place.views, photo, step=step)
    place.registrations.append(found)
    if found.accepted:
        place.reports.append((name, True, found.model, found.model.kind, f"verified: {found.evidence}"))
        return
    place.reports.append((name, False, None, None, f"not verified: {found.evidence}"))
    place.warnings.append(
        f"{scan.name}: {name} could not be verified ({found.evidence}); pick four to six pairs by hand to place it"
    )


def _from_pairs(place, photo):
    """The camera from the pairs picked in this photo, and one line about it; (None, "") where there are none."""
    if place.hand is None:
        return None, ""
    mine = np.array([name == photo.name for name in place.hand.photos]) & np.isfinite(place.hand.photo_xy).all(axis=1)
    count = int(mine.sum())
    if count == 0:
        return None, ""
    if count < LEAST_PAIRS:
        return None, f"{photo.name}: {count} pairs picked by hand do not place it, at least {LEAST_PAIRS} do"
    points = place.scan.points[place.hand.rows[mine], place.hand.cols[mine]]
    camera, error, left_out = camera_from_pairs(points, place.hand.photo_xy[mine], photo)
    pixels = error * max(photo.width, photo.height)
    if camera is None:
        return None, (
            f"{photo.name}: no camera sees the {count} pairs picked by hand where they are"
            f"{f' (off by {pixels:.0f} pixels)' if np.isfinite(pixels) else ''}; check them"
        )
    slips = f", pair {np.flatnonzero(mine)[left_out[0]] + 1} left out as wrong" if len(left_out) else ""
    return camera, f"placed by {count} pairs picked by hand, off by {pixels:.0f} pixels{slips}"


def _carried(camera, pose_from, pose_to):
    """A camera in the frame of one scan brought to that of another."""
    change = np.linalg.inv(pose_to) @ pose_from
    center = change[:3, :3] @ camera.center + change[:3, 3]
    rotation = camera.rotation @ change[:3, :3].T
    return Camera(rotation, center, camera.focal_px, camera.distortion, camera.width, camera.height)


@dataclass(frozen=True, eq=False)
class _Seen:
    """Seeds where a photo saw the scan, and the superpixel of each."""

    seeds: Seeds
    segments: np.ndarray


def _seen_seeds(place, photos, photo_gains):
    """One seed in each superpixel that a photo saw: well inside of it and of what was seen."""
    import cv2

    if all(view is None for view in place.shown):
        return None
    rgb, source, quality = blended(place.shown, photo_gains)
    labels = place.superpixels.labels
    usable = (source >= 0) & (labels >= 0)
    if not usable.any():
        return None
    # A border between superpixels is as bad a place as the border of what was seen.
    inner = usable.copy()
    inner[:, 1:] &= labels[:, 1:] == labels[:, :-1]
    inner[1:] &= labels[1:] == labels[:-1]
    depth = cv2.distanceTransform(inner.astype(np.uint8), cv2.DIST_L2, 3)
    # From the front anywhere in a superpixel before from behind in its middle.
    behind = np.zeros(usable.shape, bool)
    for index, view in enumerate(place.shown):
        if view is not None:
            behind |= (source == index) & view.behind
    depth[behind] /= 1000
    rows, cols = np.nonzero(usable)
    label = labels[rows, cols]
    order = np.lexsort((-depth[rows, cols], label))
    segments, first = np.unique(label[order], return_index=True)
    rows, cols = rows[order[first]], cols[order[first]]
    photo = source[rows, cols]
    best = max(float(quality.max()), 1e-6)
    trust = np.array([_trust(registration) for registration in place.registrations])[photo]
    seeds = Seeds(
        rows=place.image.rows[rows],
        cols=place.image.cols[cols],
        rgb=rgb[rows, cols],
        photos=tuple(photos[index].name for index in photo),
        photo_xy=np.array([place.shown[p].xy[r, c] for p, r, c in zip(photo, rows, cols, strict=True)]),
        confidence=trust * np.where(behind[rows, cols], 0.3, 0.6 + 0.4 * quality[rows, cols] / best),
        reason=tuple(place.reports[index][3] if place.reports[index][3] != "hand" else "pose" for index in photo),
    )
    return _Seen(seeds, segments)


def _trust(registration):
    """How sure a registration is: 0.75 if just accepted or resting on pairs alone, 1 if beyond doubt."""
    if registration.model is None or not registration.accepted:
        return 0.75
    return float(np.clip(0.75 + 0.25 * (registration.evidence.rank - 1) / 4, 0.75, 1.0))


def _learnt(places, seen, looks):
    """The `Appearance` of what was seen on all scans; None where nothing was."""
    known = [(place, own, look) for place, own, look in zip(places, seen, looks, strict=True) if own is not None]
    if not known:
        return None
    descriptors = np.concatenate([look[own.segments] for _, own, look in known])
    rgb = np.concatenate([own.seeds.rgb for _, own, _ in known])
    along = np.concatenate([own.seeds.cols + 1e6 * number for number, (_, own, _) in enumerate(known)])
    return Appearance.learnt(descriptors, rgb, along)


def _with_unseen(place, seen, look, appearance, photos, settings, step):
    """Seeds of a scan: where it was seen, and by likeness elsewhere as far as that is sure."""
    if seen is None and appearance is None:
        return _cautious(place, photos, settings, step)
    count = len(place.superpixels)
    unseen = np.setdiff1d(np.arange(count), seen.segments if seen is not None else [])
    rgb, confidence = (
        appearance.predict(look[unseen])
        if appearance is not None and len(unseen)
        else (np.zeros((len(unseen), 3), np.uint8), np.zeros(len(unseen)))
    )
    sure = confidence >= LEAST_CONFIDENCE
    if seen is None and not sure.any():
        return _cautious(place, photos, settings, step)
    if seen is not None:
        lost = _cut_off(place, np.concatenate([seen.segments, unseen[sure]]), unseen)
        rgb[lost & ~sure] = np.rint(seen.seeds.rgb.mean(axis=0))
        confidence = np.where(lost & ~sure, LEAST_CONFIDENCE / 2, confidence)
        sure |= lost
    rows, cols = place.superpixels.centers[unseen[sure]].T
    likely = Seeds(
        rows=place.image.rows[rows],
        cols=place.image.cols[cols],
        rgb=rgb[sure],
        confidence=0.75 * confidence[sure],
        reason=("appearance",) * int(sure.sum()),
    )
    if seen is None:
        return likely
    return Seeds(
        rows=np.concatenate([seen.seeds.rows, likely.rows]),
        cols=np.concatenate([seen.seeds.cols, likely.cols]),
        rgb=np.concatenate([seen.seeds.rgb, likely.rgb]),
        photos=seen.seeds.photos + likely.photos,
        photo_xy=np.concatenate([seen.seeds.photo_xy, likely.photo_xy]),
        confidence=np.concatenate([seen.seeds.confidence, likely.confidence]),
        reason=seen.seeds.reason + likely.reason,
    )


def _cut_off(place, seeded, unseen):
    """Which of the unseen superpixels lie in a part of the scan that no seed reaches: they would stay gray."""
    import cv2

    _, part = cv2.connectedComponents(place.image.valid.astype(np.uint8), connectivity=8)
    of_segment = part[tuple(place.superpixels.centers.T)]
    return ~np.isin(of_segment[unseen], of_segment[seeded])


def _cautious(place, photos, settings, step):
    """Seeds where nothing was verified: the mean color of the photos, and more only where neighbors agree."""
    place.warnings.append(
        f"{place.scan.name}: no photo could be verified; colors are guessed from likeness, near the photos' mean color"
    )
    text = f"{place.scan.name}: comparing superpixels"
    step(0.96, text)
    own, others = described_scan(place.scan, place.image, place.superpixels, settings), []
    for photo in photos:
        step(0.96, text)
        others.append(described_photo(photo.rgb, max(place.image.shape), settings))
    step(0.96, text)
    matches = hog_matches(own, others)
    rgb, confidence = cautious_colors(matches, own.centers_xy, mean_color([photo.rgb for photo in photos]))
    rows, cols = own.superpixels.centers.T
    sizes = np.array([(photo.width, photo.height) for photo in photos])
    return Seeds(
        rows=place.image.rows[rows],
        cols=place.image.cols[cols],
        rgb=rgb,
        photos=tuple(photos[index].name for index in matches.photo),
        photo_xy=matches.xy * sizes[matches.photo],
        confidence=confidence,
        reason=("appearance",) * len(rows),
    )
