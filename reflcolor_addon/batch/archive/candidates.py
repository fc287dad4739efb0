"""Which photos are matched with which scans: by looks, by when and where they were taken, and by which overlap."""

import math
from bisect import bisect_left, bisect_right
from itertools import chain
from statistics import median_high

from ...files.exif import Moment

# Up to so many pairs of a scan and a photo, all are matched: first looks save little there, and may miss what fits.
ALL_PAIRS = 300
# How many scans each photo gets a second look at, the likeliest at the first: all together take about as long as it
# takes to match one pair.
SECOND_LOOKS = 30
# Where nothing is known of other scans, a photo is matched with the likeliest at the first look, and with those for
# which at least so much speaks at the second.
LIKELIEST, TELLING = 2, 20.0
# How much of a scan's usual score is taken out of a look's scores, and to which power they say how likely a pair is.
# After the second look the first one counts less, by the last power. All were fitted to the looks at a third of the
# archive of ``python -m benchmarks.archive --seed 0``. On some real scans second looks find nothing for most photos:
# what is usual there is taken to be no less than the third number (of ``python -m benchmarks.real_archive``).
_FIRST, _SECOND, _FIRST_AFTER = (1.0, 8.0, 1e-9), (0.6, 4.0, 0.3), 0.25
# Photos taken within this many seconds, or meters, of each other probably show the same thing.
_TOGETHER_S, _TOGETHER_M = 60.0, 10.0
# Cameras seldom store their time zone, so times may differ by this much; a scan from another day is less likely.
_SAME_DAY_S, _ANOTHER_DAY = 14 * 3600.0, 0.5
_METERS_PER_DEGREE = 111_195.0


def ranks(scores, moments=None, scanned=None, overlaps=None, second=False):
    """Put the scans in order that each photo may show.

    Parameters
    ----------
    scores : dict of str to dict of str to float
        For each item, by its name, what `look_at` gave: a number for the path of each photo.
    moments : dict of str to Moment, optional
        When and where photos were taken, by their paths.
    scanned : dict of str to float, optional
        When items were scanned, in seconds since 1970, by their names.
    overlaps : dict of str to list of str, optional
        For each photo others that show partly the same.
    second : bool
        Whether these are scores of second looks.

    Returns
    -------
    dict of str to list of (str, float)
        For each photo its items, the likeliest first, and how likely each is as a share of that.
    """
    scanned, (leveled, telling_power, least) = scanned or {}, _SECOND if second else _FIRST
    # A scan with much detail gets higher scores with every photo; what counts is how much a photo stands out.
    shares = {}
    for name, own in scores.items():
        usual = max(median_high(own.values()), least) ** leveled if own else 1.0
        for photo, score in own.items():
            shares.setdefault(photo, {})[name] = score / usual
    shares = {
        photo: {name: share**telling_power for name, share in _of_the_best(own).items()}
        for photo, own in shares.items()
    }
    moments = {photo: its for photo, its in (moments or {}).items() if photo in shares and its != Moment()}
    others, ranked = _Neighbors(moments), {}
    for photo in shares:
        beside = {*others.of(photo), *(overlaps or {}).get(photo, ())} & shares.keys()
        own, moment = _supported(photo, shares, sorted(beside)), moments.get(photo)
        if moment is not None and moment.seconds is not None:
            own = {name: share * _of_its_day(moment.seconds, scanned.get(name)) for name, share in own.items()}
        ranked[photo] = sorted(_of_the_best(own).items(), key=lambda entry: (-entry[1], entry[0]))
    return ranked


def merged(first, second):
    """Return ranks by two looks: a pair is as likely as the one and the other say together.

    Either look misses some of the right pairs that the other one sees. So the places are taken in turn by what both
    speak for and by what the first one alone does; how likely a pair is follows from its place.

    Parameters
    ----------
    first, second : dict of str to list of (str, float)
        From `ranks`; what was not looked at twice comes last.
    """
    found = {}
    for photo, own in first.items():
        again, before = second.get(photo, []), dict(own)
        both = _of_the_best({name: share * before[name] ** _FIRST_AFTER for name, share in again})
        shares = sorted(both.items(), key=lambda entry: (-entry[1], entry[0]))
        shares += [(name, 0.0) for name, _ in own if name not in both]
        places = dict.fromkeys(chain.from_iterable(zip((name for name, _ in shares), before, strict=True)))
        found[photo] = [(name, share) for name, (_, share) in zip(places, shares, strict=True)]
    return found


def for_second_looks(ranked):
    """Return for each item the photos that are worth a second look; ``ranked`` is from `ranks`."""
    return _by_item(ranked, lambda place, name, photo: place < SECOND_LOOKS)


def all_of_them(ranked):
    """Return for each item all of its photos, what looks best first."""
    return _by_item(ranked, lambda place, name, photo: True)


def telling(first, strengths):
    """Return for each item the photos that are worth matching with it, by that item's looks alone.

    Parameters
    ----------
    first : dict of str to list of (str, float)
        From `ranks`, at first looks.
    strengths : dict of str to dict of str to float
        For each item what second looks gave for photos.
    """

    def worth(place, name, photo):
        strength = strengths.get(name, {}).get(photo)
        return strength is not None and (place < LIKELIEST or strength >= TELLING)

    return _by_item(first, worth)


def _by_item(ranked, worth):
    """For each item the photos for which ``worth(place, item, photo)`` is true, what looks best first."""
    found = {}
    for photo, own in ranked.items():
        for place, (name, share) in enumerate(own):
            if worth(place, name, photo):
                found.setdefault(name, []).append((-share, photo))
    return {name: [photo for _, photo in sorted(own)] for name, own in found.items()}


def are_few(scans, photos):
    """Whether all pairs of so many scans and photos are matched, whatever the first looks say."""
    return scans * photos <= ALL_PAIRS


def _of_the_best(shares):
    """Shares of the largest one."""
    best = max(shares.values(), default=0.0)
    return {name: share / best if best > 0 else 0.0 for name, share in shares.items()}


def _supported(photo, shares, beside):
    """A photo's shares, and the mean ones of photos of the same place."""
    own, others = shares[photo], [shares[other] for other in beside]
    if not others:
        return own
    return {name: share + sum(other.get(name, 0.0) for other in others) / len(others) for name, share in own.items()}


class _Neighbors:
    """Which photos were taken together: by their times where both have one, else by their places."""

    def __init__(self, moments):
        self._moments = moments
        placed = {photo: its for photo, its in moments.items() if None not in (its.latitude, its.longitude)}
        self._by_time = _Sorted({photo: its.seconds for photo, its in moments.items() if its.seconds is not None})
        self._by_latitude = _Sorted({photo: its.latitude for photo, its in placed.items()})
        untimed = {photo: its.latitude for photo, its in placed.items() if its.seconds is None}
        self._untimed_by_latitude = _Sorted(untimed)

    def of(self, photo):
        """Return the other photos, in their order."""
        own = self._moments.get(photo)
        if own is None:
            return []
        found = set() if own.seconds is None else set(self._by_time.near(own.seconds, _TOGETHER_S))
        if None not in (own.latitude, own.longitude):
            places = self._by_latitude if own.seconds is None else self._untimed_by_latitude
            near = places.near(own.latitude, _TOGETHER_M / _METERS_PER_DEGREE)
            found |= {other for other in near if _beside(own, self._moments[other])}
        return sorted(found - {photo})


class _Sorted:
    """Photos in the order of a number that each has."""

    def __init__(self, numbers):
        pairs = sorted((number, photo) for photo, number in numbers.items())
        self._numbers, self._photos = [number for number, _ in pairs], [photo for _, photo in pairs]

    def near(self, number, distance):
        """Return the photos whose number is at most so far from another."""
        first, last = bisect_left(self._numbers, number - distance), bisect_right(self._numbers, number + distance)
        return self._photos[first:last]


def _beside(one, other):
    north = one.latitude - other.latitude
    east = (one.longitude - other.longitude) * math.cos(math.radians(one.latitude))
    return math.hypot(north, east) * _METERS_PER_DEGREE <= _TOGETHER_M


def _of_its_day(taken, scanned):
    return 1.0 if scanned is None or abs(taken - scanned) <= _SAME_DAY_S else _ANOTHER_DAY
