"""Method 2: from a scan, or all scans of a site, and photos to seeds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..color.observed import Observed
from ..errors import Cancelled, SeedsError
from ..messages import Message
from ..progress import IsCancelled, Progress
from ..scan.scan import Scan, require_scan
from ..seeds.seeds import Seeds
from ..settings import Settings, settings_or_default
from . import site
from .opened_photos import opened_photos
from .photo_image import Photos
from .published.seeds import published_seeds

_LEAST_CHROMA = 6
_AS_PUBLISHED = "matched by appearance, as published"


@dataclass(frozen=True, eq=False)
class PhotoMatch:
    """The result for one photo on one scan.

    Parameters
    ----------
    name : str
    verified : bool
        Whether its camera was found and passed the test, or follows from pairs picked by hand.
    model : Camera, GridHomography or None
        In pixels of the photo as given.
    reason : {"pose", "homography", "hand"} or None
        What was verified.
    note : str
        One line for a person.
    evidence : float
        Evidence for the best camera found, as a share of what is needed: below 1 it is not verified, unless pairs
        picked by hand give it.
    tested : bool
        False where it cannot be decided whether the photo shows the scan: the scan is too coarse, or the photo is of
        one tone. The note says which.
    """

    name: str
    verified: bool
    model: object
    reason: str | None
    note: str
    evidence: float = 0.0
    tested: bool = True


@dataclass(frozen=True, eq=False)
class Matching:
    """Seeds of one scan, and the result for each photo.

    Parameters
    ----------
    seeds : Seeds
        With ``photos``, ``photo_xy``, ``confidence`` and ``reason``.
    photos : tuple of PhotoMatch
    warnings : tuple of str
        One line each, for a person; of a photo that could not be verified there is always one.
    observed : Observed or None
        The colors of all pixels that verified photos saw; ``photo`` counts the photos as they were given. None where no
        photo is verified.
    """

    seeds: Seeds
    photos: tuple[PhotoMatch, ...]
    warnings: tuple[str, ...]
    observed: Observed | None = None


def match_seeds(
    scan: Scan,
    photos: Photos,
    settings: Settings | None = None,
    *,
    hand: Seeds | None = None,
    kept: Seeds | None = None,
    progress: Progress | None = None,
    cancelled: IsCancelled | None = None,
) -> Seeds:
    """Find seeds in photos; see `match_photos`, which returns more.

    Returns
    -------
    Seeds

    Examples
    --------
    >>> from reflcolor_addon import Settings, match_seeds, read_scans
    >>> seeds = match_seeds(read_scans("garage.ptx")[0], ["garage.jpg"], Settings(guess=True))
    >>> len(seeds) > 0, seeds.all_guessed
    (True, True)
    """
    return match_photos(scan, photos, settings, hand=hand, kept=kept, progress=progress, cancelled=cancelled).seeds


def match_photos(
    scan: Scan,
    photos: Photos,
    settings: Settings | None = None,
    *,
    hand: Seeds | None = None,
    kept: Seeds | None = None,
    progress: Progress | None = None,
    cancelled: IsCancelled | None = None,
) -> Matching:
    """Find seeds for one scan in photos: Method 2.

    Parameters
    ----------
    scan : Scan
    photos : sequence of paths, of (H, W, 3) uint8 sRGB, or of (name, (H, W, 3) uint8 sRGB)
        Not calibrated, from wherever they were taken. Arrays without a name are called "photo 1", "photo 2" ...
    settings : Settings, optional
        ``matching="verified"``: each photo's camera is estimated and accepted only if it passes a test; an accepted
        photo gives a seed in every superpixel that it really shows, and others by similarity where that is reliable.
        A photo that is not accepted by itself is placed by what it has in common with others that are beyond doubt.
        Without an accepted photo there are no seeds, unless ``guess`` asks for guesses.
        ``matching="paper"``: as published, by the most similar superpixel.
    hand : Seeds, optional
        Seeds picked by a person: they stay as they are, and four or more with a point of a photo give its camera.
    kept : Seeds, optional
        Seeds that stay as they are, reason and confidence included, found earlier for example; no seed is found on
        their pixels. They are not used to find a photo's camera.
    progress : callable, optional
        Called as ``progress(fraction, text)`` with a fraction of 0 to 1.
    cancelled : callable, optional
        Called now and then; when it returns True, the work ends.

    Returns
    -------
    Matching

    Raises
    ------
    SeedsError
        If there is no photo, the scan has no return, or a seed of ``hand`` or ``kept`` cannot be used.
    ImageError
        If a photo cannot be read or is smaller than 16 pixels a side.
    Cancelled
        If ``cancelled()`` returned True.

    References
    ----------
    .. [1] S. Oishi, R. Kurazume, Y. Iwashita, T. Hasegawa, "Colorization of 3D Geometric Model utilizing Laser
       Reflectivity", ICRA 2013: the photos' part of the method. Verified cameras are not in the paper.

    Examples
    --------
    >>> from reflcolor_addon import match_photos, read_scans
    >>> matching = match_photos(read_scans("garage.ptx")[0], ["garage.jpg"])
    >>> [(photo.name, photo.verified) for photo in matching.photos]
    [('garage.jpg', False)]
    """
    return match_site([scan], photos, settings, hand=[hand], kept=[kept], progress=progress, cancelled=cancelled)[0]


def match_site(
    scans: Sequence[Scan],
    photos: Photos,
    settings: Settings | None = None,
    *,
    hand: Sequence[Seeds | None] | None = None,
    kept: Sequence[Seeds | None] | None = None,
    registered: Callable | None = None,
    progress: Progress | None = None,
    cancelled: IsCancelled | None = None,
) -> list[Matching]:
    """Find seeds for all scans of a site in the same photos, with one exposure for all and one model of appearance.

    Where the scans have poses, a photo verified on one scan is tried on the others where that puts it.

    Parameters
    ----------
    scans : sequence of Scan
    hand, kept : sequence of Seeds or None, optional
        For each scan, as `match_photos`.
    registered : callable, optional
        Called as ``registered(scan_number, photo_number, register)`` where a photo has to be registered without any
        help; returns a `Registration`. ``register()`` finds it; what is known from before need not be found again.
    photos, settings, progress, cancelled
        As `match_photos`.

    Returns
    -------
    list of Matching
        One for each scan.

    Raises
    ------
    SeedsError, ImageError, Cancelled
        As `match_photos`.

    Examples
    --------
    >>> from reflcolor_addon import match_site, read_scans
    >>> scans = read_scans("garage.ptx")
    >>> len(match_site(scans, ["garage.jpg"])) == len(scans)
    True
    """
    settings = settings_or_default(settings)
    progress = progress or (lambda fraction, text: None)
    cancelled = cancelled or (lambda: False)
    for scan in scans:
        require_scan(scan)
        if not scan.valid.any():
            raise SeedsError("{scan}: no pixel has a return, so nothing can be matched", scan=scan.name)
    hand = [None if own is None else _picked(own) for own in _placed(hand, scans)]
    kept = _placed(kept, scans)
    progress(0.0, "Opening the photos")
    of_files: list[str] = []
    opened = opened_photos(photos, of_files)
    if not opened:
        raise SeedsError("no photo: give at least one")

    def step(fraction, text):
        if cancelled():
            raise Cancelled
        progress(fraction, text)

    if settings.matching == "paper":
        notes = tuple(PhotoMatch(photo.name, False, None, None, _AS_PUBLISHED) for photo in opened)
        matchings = [Matching(published_seeds(scan, opened, settings, step), notes, ()) for scan in scans]
    else:
        matchings = [
            Matching(seeds, tuple(map(_report, opened, locations)), tuple(warnings), observed)
            for seeds, locations, observed, warnings in site.verified(scans, opened, hand, settings, step, registered)
        ]
    progress(1.0, "Matched")
    gray = tuple(
        Message("{photo}: is black and white, it gives no colors", photo=photo.name)
        for photo in opened
        if _is_gray(photo.rgb)
    )
    return [
        replace(
            matching,
            seeds=joined(picked, stays, matching.seeds),
            warnings=(*of_files, *gray, *matching.warnings),
        )
        for matching, picked, stays in zip(matchings, hand, kept, strict=True)
    ]


def joined(*groups):
    """Return all seeds of several `Seeds` (or None); on a pixel that several have, only the first one's."""
    groups = [group for group in groups if group is not None]
    taken, chosen = set(), []
    for group in groups:
        places = list(zip(group.rows.tolist(), group.cols.tolist(), strict=True))
        chosen.append([index for index, place in enumerate(places) if place not in taken])
        taken.update(places)
    arrays = {
        name: np.concatenate([getattr(group, name)[index] for group, index in zip(groups, chosen, strict=True)])
        for name in ("rows", "cols", "rgb", "photo_xy", "confidence", "locked")
    }
    lists = {
        name: tuple(getattr(group, name)[k] for group, index in zip(groups, chosen, strict=True) for k in index)
        for name in ("photos", "reason")
    }
    return Seeds(**arrays, **lists)


def _placed(seeds, scans):
    """Seeds or None for each scan, on pixels with a return."""
    seeds = list(seeds) if seeds is not None else [None] * len(scans)
    return [
        None if own is None or len(own) == 0 else own.placed_on(scan)[0] for own, scan in zip(seeds, scans, strict=True)
    ]


def _picked(seeds):
    return replace(seeds, confidence=np.ones(len(seeds)), reason=("hand",) * len(seeds))


def _is_gray(rgb):
    return bool((np.ptp(rgb[::4, ::4], axis=-1) <= _LEAST_CHROMA).all())


def _report(photo, location):
    model = location.registration.model if location.verified else None
    share = location.registration.evidence.share
    return PhotoMatch(photo.name, location.verified, model, location.reason, location.note, share, location.tested)
