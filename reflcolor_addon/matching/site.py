"""All scans and all photos of a site: each photo registered on each scan, and seeds made from what was verified."""

from dataclasses import dataclass, replace

import numpy as np

from ..messages import Message
from ..seeds.seeds import Seeds
from .published.hog_matching import described_photo, described_scan, hog_matches, scan_superpixels, square_image
from .registration.location import located
from .registration.registration import ScanViews
from .scan_image import toned
from .transfer.appearance import LEAST_CONFIDENCE, Appearance, described
from .transfer.fallback import cautious_colors, mean_color
from .transfer.several_photos import blended, gains
from .transfer.views import seen_by

_STEPS_PER_PHOTO = 40


@dataclass(eq=False)
class _OnScan:
    """One scan with what was found out about it."""

    scan: object
    views: ScanViews
    image: object
    superpixels: object
    locations: list
    warnings: list
    shown: list


def verified(scans, photos, hand, settings, step, registered=None):
    """Yield seeds, the `Location` of each photo, and warnings for every scan.

    Parameters
    ----------
    scans : sequence of Scan
    photos : sequence of PhotoImage
    hand : sequence of Seeds or None
        For each scan, on pixels with a return.
    settings : Settings
    step : callable
        ``step(fraction, text)``; may raise to end the work.
    registered : callable, optional
        As `match_site`.
    """
    places = [_prepared(scan, settings, step) for scan in scans]
    share = 0.8 / len(photos)
    for index, photo in enumerate(photos):
        counted = _counted(step, 0.05 + share * index, share, len(places))
        of_photo = registered and (lambda number, register, index=index: registered(number, index, register))
        found = located(scans, [place.views for place in places], hand, photo, counted, of_photo)
        for place, location in zip(places, found, strict=True):
            place.locations.append(location)
            place.warnings += location.warnings
    for place in places:
        step(0.87, f"{place.scan.name}: transferring colors")
        for index, photo in enumerate(photos):
            place.shown.append(_shown(place, photo, index))
    photo_gains = gains([place.shown for place in places])
    seen = [_seen_seeds(place, photos, photo_gains) for place in places]
    step(0.93, "Learning the materials")
    looks = [described(place.image, place.superpixels.labels, len(place.superpixels)) for place in places]
    appearance = _learnt(places, seen, looks)
    for place, own, look in zip(places, seen, looks, strict=True):
        yield _with_unseen(place, own, look, appearance, photos, settings, step), place.locations, place.warnings


def _prepared(scan, settings, step):
    step(0.02, f"{scan.name}: superpixels")
    views = ScanViews(scan)
    image = square_image(scan, toned(scan, "percentiles"))
    return _OnScan(scan, views, image, scan_superpixels(scan, image, settings), [], [], [])


def _shown(place, photo, index):
    """The `View` of a photo on a scan; None, and no longer verified, where it shows nothing that could be used."""
    location = place.locations[index]
    if not location.verified:
        return None
    view = seen_by(photo, location.registration.model, place.image)
    if view.usable.any():
        return view
    note = Message("{note}; so placed, it shows nothing of the scan", note=location.note)
    place.locations[index] = replace(location, verified=False, reason=None, note=note)
    warning = "{scan}: {photo}, so placed, shows nothing of the scan; pick four to six pairs by hand"
    if location.by_hand:
        warning = (
            "{scan}: {photo}, so placed, shows nothing of the scan; check the pairs, and add some far from the others"
        )
    place.warnings.append(Message(warning, scan=place.scan.name, photo=photo.name))
    return None


def _counted(step, begin, share, scans):
    count, expected = 0, _STEPS_PER_PHOTO * scans

    def counted(text):
        nonlocal count
        count += 1
        step(begin + share * min(count / expected, 1.0), text)

    return counted


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
    trust = np.array([_trust(location.registration) for location in place.locations])[photo]
    seeds = Seeds(
        rows=place.image.rows[rows],
        cols=place.image.cols[cols],
        rgb=rgb[rows, cols],
        photos=tuple(photos[index].name for index in photo),
        photo_xy=np.array([place.shown[p].xy[r, c] for p, r, c in zip(photo, rows, cols, strict=True)]),
        confidence=trust * np.where(behind[rows, cols], 0.3, 0.6 + 0.4 * quality[rows, cols] / best),
        reason=tuple("homography" if place.locations[p].reason == "homography" else "pose" for p in photo),
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
    # Scans lie apart.
    places = [np.column_stack([own.seeds.cols, own.seeds.rows]) + 1e6 * k for k, (_, own, _) in enumerate(known)]
    return Appearance.learnt(descriptors, rgb, np.concatenate(places))


def _with_unseen(place, seen, look, appearance, photos, settings, step):
    """Seeds of a scan: where it was seen, and by likeness elsewhere as far as that is sure."""
    if seen is None and appearance is None:
        return _unverified(place, photos, settings, step)
    count = len(place.superpixels)
    unseen = np.setdiff1d(np.arange(count), seen.segments if seen is not None else [])
    rgb, confidence = (
        appearance.predict(look[unseen])
        if appearance is not None and len(unseen)
        else (np.zeros((len(unseen), 3), np.uint8), np.zeros(len(unseen)))
    )
    sure = confidence >= LEAST_CONFIDENCE
    if seen is None and not sure.any():
        return _unverified(place, photos, settings, step)
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
        warning = "{scan}: no photo shows it; all its colors are guessed from the other scans"
        place.warnings.append(Message(warning, scan=place.scan.name))
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


def _unverified(place, photos, settings, step):
    """Seeds where nothing was verified: none, unless guesses are wanted."""
    if settings.guess:
        return _cautious(place, photos, settings, step)
    warning = (
        "{scan}: no photo could be verified, so there are no seeds; pick four to six pairs, or have colors guessed"
    )
    place.warnings.append(Message(warning, scan=place.scan.name))
    return Seeds(rows=np.zeros(0, int), cols=np.zeros(0, int), rgb=np.zeros((0, 3), np.uint8))


def _cautious(place, photos, settings, step):
    """Seeds where nothing was verified: the mean color of the photos, and more only where neighbors agree."""
    warning = "{scan}: no photo could be verified; colors are guessed from likeness, near the photos' mean color"
    place.warnings.append(Message(warning, scan=place.scan.name))
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
