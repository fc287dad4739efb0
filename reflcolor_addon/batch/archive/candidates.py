"""Which photos are matched with which scans: by first looks, and by when and where they were taken."""

import math
from statistics import median_high

from ...files.exif import Moment

# How many scans each photo is matched with at most, and how much lower their scores may be than the best one's.
MOST_SCANS, LEAST_SHARE = 6, 0.4
# Photos taken within this many seconds, or meters, of each other probably show the same thing.
_TOGETHER_S, _TOGETHER_M = 60.0, 10.0
# Cameras seldom store their time zone, so times may differ by this much; a scan from another day is less likely.
_SAME_DAY_S, _ANOTHER_DAY = 14 * 3600.0, 0.5
_METERS_PER_DEGREE = 111_195.0


def candidates(scores, moments=None, scanned=None):
    """Choose which photos are matched with which scans.

    Parameters
    ----------
    scores : dict of str to dict of str to float
        For each item, by its name, what `look_at` gave: a number for the path of each photo.
    moments : dict of str to Moment, optional
        When and where photos were taken, by their paths.
    scanned : dict of str to float, optional
        When items were scanned, in seconds since 1970, by their names.

    Returns
    -------
    dict of str to list of str
        For each item its photos, what looks best first.
    """
    scanned = scanned or {}
    # A scan with much detail gets higher scores with every photo; what counts is how much a photo stands out.
    usual = {name: max(median_high(own.values()), 1e-9) if own else 1.0 for name, own in scores.items()}
    shares = {}
    for name, own in scores.items():
        for photo, score in own.items():
            shares.setdefault(photo, {})[name] = score / usual[name]
    shares = {photo: _of_the_best(own) for photo, own in shares.items()}
    moments = {photo: its for photo, its in (moments or {}).items() if photo in shares and its != Moment()}
    supported = {photo: _supported(photo, shares, moments) for photo in shares}
    chosen = {name: [] for name in scores}
    for photo, own in supported.items():
        moment = moments.get(photo)
        if moment is not None and moment.seconds is not None:
            own = {name: share * _of_its_day(moment.seconds, scanned.get(name)) for name, share in own.items()}
        ranked = sorted(_of_the_best(own).items(), key=lambda entry: (-entry[1], entry[0]))
        for name, share in ranked[:MOST_SCANS]:
            if share > 0 and share >= LEAST_SHARE:
                chosen[name].append((share, photo))
    return {
        name: [photo for _, photo in sorted(own, key=lambda entry: (-entry[0], entry[1]))]
        for name, own in chosen.items()
    }


def _of_the_best(shares):
    """Shares of the largest one."""
    best = max(shares.values(), default=0.0)
    return {name: share / best if best > 0 else 0.0 for name, share in shares.items()}


def _supported(photo, shares, moments):
    """A photo's shares, and the mean ones of photos that were taken together with it."""
    own, moment = shares[photo], moments.get(photo)
    if moment is None:
        return own
    others = [shares[other] for other, its in moments.items() if other != photo and _together(moment, its)]
    if not others:
        return own
    return {name: share + sum(other.get(name, 0.0) for other in others) / len(others) for name, share in own.items()}


def _together(one, other):
    if one.seconds is not None and other.seconds is not None:
        return abs(one.seconds - other.seconds) <= _TOGETHER_S
    if None in (one.latitude, one.longitude, other.latitude, other.longitude):
        return False
    north = one.latitude - other.latitude
    east = (one.longitude - other.longitude) * math.cos(math.radians(one.latitude))
    return math.hypot(north, east) * _METERS_PER_DEGREE <= _TOGETHER_M


def _of_its_day(taken, scanned):
    return 1.0 if scanned is None or abs(taken - scanned) <= _SAME_DAY_S else _ANOTHER_DAY
