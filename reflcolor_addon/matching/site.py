"""All scans and all photos of a site: each photo registered on each scan, and seeds made from what was verified."""

from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from ..files.memory import give_back
from ..messages import Message
from ..seeds.seeds import Seeds
from .grid_angles import GridAngles
from .published.hog_matching import described_photo, described_scan, hog_matches, scan_superpixels, square_image
from .registration.alignment import Alignment
from .registration.location import located
from .registration.registration import ScanViews
from .registration.resection import overlapping, placed_by
from .scan_image import reflectance_image
from .transfer.appearance import LEAST_CONFIDENCE, Appearance, described
from .transfer.fallback import cautious_colors, mean_color
from .transfer.fusion import fused
from .transfer.seen_seeds import seen_seeds
from .transfer.several_photos import gains
from .transfer.sharing import shared
from .transfer.surface import GridSurface
from .transfer.views import seen_by

NO_SEEDS = "{scan}: no photo could be verified, so there are no seeds; pick four to six pairs, or have colors guessed"
"""The warning where a scan has no seeds for that."""
_STEPS_PER_PHOTO = 40
# A photo that shows fewer pixels of a scan than this counts as showing none of it.
_LEAST_SEEN = 100


@dataclass(eq=False)
class _OnScan:
    """One scan and what was found for it; what refused photos do not need is computed on first use."""

    scan: object
    settings: object
    views: ScanViews | None
    surface: GridSurface
    locations: list = field(default_factory=list)
    warnings: list = field(default_factory=list)
    to_align: bool = False

    @classmethod
    def of(cls, scan, settings):
        """Begin with a scan."""
        return cls(scan, settings, ScanViews(scan), GridSurface(scan))

    @cached_property
    def angles(self):
        """The `GridAngles` of the scan."""
        return GridAngles.of(self.scan)

    @cached_property
    def image(self):
        """The scan as a `ScanImage` that superpixels are computed on."""
        return square_image(self.scan, reflectance_image(self.scan, "percentiles"), self.angles)

    @cached_property
    def superpixels(self):
        """The `Superpixels` of that image."""
        return scan_superpixels(self.scan, self.image, self.settings)

    @cached_property
    def look(self):
        """What each superpixel looks like, see `described`."""
        return described(self.image, self.superpixels.labels, len(self.superpixels))


def verified(scans, photos, hand, settings, step, registered=None):
    """Yield seeds, the `Location` of each photo, `Observed` colors or None, and warnings for every scan.

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
    places = [_OnScan.of(scan, settings) for scan in scans]
    share = 0.8 / len(photos)
    for index, photo in enumerate(photos):
        counted = _counted(step, 0.05 + share * index, share, len(places))
        of_photo = registered and (lambda number, register, index=index: registered(number, index, register))
        found = located(scans, [place.views for place in places], hand, photo, counted, of_photo)
        for place, location in zip(places, found, strict=True):
            place.locations.append(location)
    # What a batch found was compared with others then.
    _place_by_others(places, photos, hand, step, verified_too=registered is None)
    for place in places:
        place.warnings += [warning for location in place.locations for warning in location.warnings]
        _let_go_of_views(place)
    _let_go_of_images(photos)
    observed = _observed(places, photos, step)
    seen = [_seeds(place, own, photos, step) for place, own in zip(places, observed, strict=True)]
    step(0.93, Message("Learning the materials"))
    appearance = _learned(places, seen)
    for place, own, colors in zip(places, seen, observed, strict=True):
        seeds = _with_unseen(place, own, appearance, photos, settings, step)
        yield seeds, place.locations, colors, place.warnings


def _place_by_others(places, photos, hand, step, verified_too):
    """Place photos by what they have in common with photos that are verified beyond doubt, for a wrong camera would be
    passed on; those so placed help to place others in turn.

    With ``verified_too`` it is tried for photos, too, that are verified themselves, but not beyond doubt.
    """
    scans, views = [place.scan for place in places], [place.views for place in places]
    compared, progressed = set(), len(photos) > 1
    while progressed:
        progressed = False
        for index, photo in enumerate(photos):
            text = partial(step, 0.85)
            found = {
                number: registration
                for number, place in enumerate(places)
                if (verified_too or not place.locations[index].verified)
                and (registration := _by_others(place, photos, number, index, compared, text)) is not None
            }
            if not found:
                continue
            progressed = True
            known = {number: place.locations[index].registration for number, place in enumerate(places)} | found
            again = located(scans, views, hand, photo, text, lambda number, _, known=known: known[number])
            for place, location in zip(places, again, strict=True):
                place.locations[index] = location


def _by_others(place, photos, scan, index, compared, step):
    """The registration of a photo on a scan by others, see `_place_by_others`; None where it is no better.

    ``compared`` holds the numbers of scan, photo and other photo of what was compared already.
    """
    location = place.locations[index]
    if location.beyond_doubt or not location.tested:
        return None
    others = [
        number
        for number, other in enumerate(place.locations)
        if other.beyond_doubt and number != index and (scan, index, number) not in compared
    ]
    compared.update((scan, index, number) for number in others)
    if not others:
        return None
    near = overlapping(photos[index], [photos[number] for number in others], step)
    known = [(photos[others[k]], place.locations[others[k]].registration.model) for k in near]
    found = placed_by(place.views, photos[index], known, step)
    return found if found is not None and found.preferable_to(location.registration) else None


def _observed(places, photos, step):
    """The `Observed` of each scan, or None."""
    views = []
    for place in places:

        def transferring(place=place):
            step(0.87, Message("{scan}: transferring colors", scan=place.scan.name))

        transferring()
        _align(place, photos, transferring)
        _let_go_of_images(photos)
        views.append([_shown(place, photo, index, transferring) for index, photo in enumerate(photos)])
    photo_gains = gains(views)
    observed = []
    for place in places:
        step(0.9, Message("{scan}: blending photos", scan=place.scan.name))
        # The views of a scan's photos take much memory and are not needed any more.
        observed.append(fused(views.pop(0), photo_gains, place.surface))
    return shared([place.surface for place in places], observed)


def _seeds(place, observed, photos, step):
    """The `SeenSeeds` of a scan; None where nothing was seen."""
    if observed is None:
        return None
    step(0.92, Message("{scan}: superpixels", scan=place.scan.name))
    return seen_seeds(place.scan, observed, place.image, place.superpixels, place.locations, photos)


def _let_go_of_views(place):
    """Drop the images that photos were sought on, which take much memory."""
    verified = any(location.verified for location in place.locations)
    # A camera that was found by stretched measurements is moved away by a further fit.
    place.to_align = verified and not place.views.stretched
    place.views = None


def _let_go_of_images(photos):
    """Give back what was made of the photos for one step."""
    for photo in photos:
        photo.let_go()
    give_back()


def _align(place, photos, step):
    """Fit the verified photos of a scan once more, where that helps."""
    if not place.to_align:
        return
    alignment = Alignment(place.scan, place.angles)
    for index, (photo, location) in enumerate(zip(photos, place.locations, strict=True)):
        if location.verified:
            step()
            model = alignment.aligned(photo, location.registration.model, camera_only=location.by_hand)
            # A picture that was warped is placed better by a homography than by the camera that was found.
            reason = location.reason if location.by_hand else model.kind
            registration = replace(location.registration, model=model)
            place.locations[index] = replace(location, registration=registration, reason=reason)


def _shown(place, photo, index, step):
    """The `View` of a photo on a scan; None, and no longer verified, where it shows nothing that could be used."""
    location = place.locations[index]
    if not location.verified:
        return None
    step()
    model = location.registration.model
    view = seen_by(photo, model, place.surface)
    if np.count_nonzero(view.usable) >= _LEAST_SEEN:
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


def _learned(places, seen):
    """The `Appearance` of what was seen on all scans; None where nothing was."""
    known = [(place, own) for place, own in zip(places, seen, strict=True) if own is not None]
    if not known:
        return None
    descriptors = np.concatenate([place.look[own.segments] for place, own in known])
    rgb = np.concatenate([own.seeds.rgb for _, own in known])
    # Scans lie apart.
    at = [np.column_stack([own.seeds.cols, own.seeds.rows]) + 1e6 * k for k, (_, own) in enumerate(known)]
    return Appearance.learned(descriptors, rgb, np.concatenate(at))


def _with_unseen(place, seen, appearance, photos, settings, step):
    """Seeds of a scan: where it was seen, and by similarity elsewhere as far as that is reliable."""
    if seen is None and appearance is None:
        return _unverified(place, photos, settings, step)
    look, count = place.look, len(place.superpixels)
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
    place.warnings.append(Message(NO_SEEDS, scan=place.scan.name))
    return Seeds(rows=np.zeros(0, int), cols=np.zeros(0, int), rgb=np.zeros((0, 3), np.uint8))


def _cautious(place, photos, settings, step):
    """Seeds where nothing was verified: the mean color of the photos, and more only where neighbors agree."""
    warning = "{scan}: no photo could be verified; colors are guessed from likeness, near the photos' mean color"
    place.warnings.append(Message(warning, scan=place.scan.name))
    text = Message("{scan}: comparing superpixels", scan=place.scan.name)
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
