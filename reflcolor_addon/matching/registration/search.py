"""Where a photo may have been taken from: every direction at once, for a list of focal lengths and places."""

from functools import partial
from itertools import chain, product

import numpy as np

from ...threads import in_threads
from ..scan_image import pixel_steps
from .sphere_map import PhotoMaps, SphereMap

_FOCALS = (0.5, 0.6, 0.72, 0.866, 1.04, 1.25, 1.5, 1.8, 2.2)
"""Focal lengths that are tried, in lengths of the photo's longer side: fields of view of 90 to 26 degrees."""
_PITCHES = (-18.0, 0.0, 18.0)
_ASIDE_FOCALS = (0.56, 0.72, 0.93, 1.2, 1.55)
_ASIDE_PITCHES = (0.0, -15.0)

# Places around what a scan sees: degrees to the side, and distances in those of the scanner.
_TURNS_DEG = (12, -12, 24, -24, 36, -36, 50, -50)
_DISTANCES = (0.8, 1.0, 1.25)
# Places around a scanner that sees all around: distances in the median one of what is seen, and how many of each.
_RINGS = ((0.25, 6), (0.5, 9), (0.8, 12))
# Many places are tried on maps so much coarser, the best of them on the finer ones.
_COARSER = 2
# Pixels of a photo's map at most, or not many more.
_MOST_PIXELS = 250
_SHARPENED, _LOOKED_AT = 5, 14
_REACH_DEG = 6.0
# What a photo shows of a scan is hardly wider, in degrees: a scan that is has no larger pixels.
_VIEW_DEG = 72


def map_step(scan):
    """Return the size in degrees of the pixels that a scan is searched with."""
    vertical, horizontal = pixel_steps(scan)
    extent = max(scan.shape[0] * vertical, scan.shape[1] * horizontal)
    return float(max(min(extent, _VIEW_DEG) / 200, min(vertical, horizontal)))


def viewing_distance(scan):
    """Return the median horizontal distance of what a scan sees, in meters."""
    points = scan.points[scan.valid]
    return float(np.median(np.hypot(points[:, 0], points[:, 1])))


def viewpoints(scan):
    """Return (x, y, z) places a photo may have been taken from beside the scanner's own, in meters, scanner frame.

    Around what a scan sees, up to 56 degrees to either side, nearer and farther; around the scanner, if that sees all
    around.
    """
    points = scan.points[scan.valid]
    distance = viewing_distance(scan)
    _, horizontal = pixel_steps(scan)
    if scan.full_turn or scan.shape[1] * horizontal > 200:
        turns = [(share, 2 * np.pi * (k + share) / count) for share, count in _RINGS for k in range(count)]
        return [(share * distance * np.cos(turn), share * distance * np.sin(turn), 0.0) for share, turn in turns]
    x, y = np.median(points[:, :2], axis=0)
    places = []
    for nearness in _DISTANCES:
        for turn in np.radians((0, *_TURNS_DEG) if nearness != 1.0 else _TURNS_DEG):
            along, across = -nearness * np.cos(turn), -nearness * np.sin(turn)
            places.append((float(x + along * x - across * y), float(y + across * x + along * y), 0.0))
    return places


class Search:
    """The search for one photo's place and direction on one scan.

    Parameters
    ----------
    views : registration.ScanViews
    photo : PhotoImage
    """

    def __init__(self, views, photo):
        self._views, self._photo = views, photo
        self._photo_maps = {}

    def from_scanner(self, step=lambda: None):
        """Return `Guess`es of a photo taken from the scanner's place, best first.

        Parameters
        ----------
        step : callable
            Called now and then; may raise to end the work.
        """
        guesses = self.directions(step)
        tried = self._around(guesses[:_SHARPENED], (0.92, 1.0, 1.09), (-4.0, 0.0, 4.0), 2, step)
        return _unlike_ones([*tried, *guesses])

    def from_aside(self, step=lambda: None):
        """Return `Guess`es of a photo taken from beside the scanner; see `from_scanner`."""
        places = viewpoints(self._views.scan)
        guesses = _unlike_ones(self._everywhere(places, _COARSER, _ASIDE_FOCALS, _ASIDE_PITCHES, 2, step))
        return _unlike_ones(self._around(guesses[:_LOOKED_AT], (0.93, 1.0, 1.07), (0.0,), 1, step))

    def directions(self, step=lambda: None, focals=_FOCALS, coarser=1):
        """Return `Guess`es of a photo taken from the scanner's place before they are sharpened; see `from_scanner`.

        ``focals`` are the focal lengths that are tried, in lengths of the photo's longer side; ``coarser`` is how many
        times as large as `map_step` says the pixels of the maps are.
        """
        return _unlike_ones(self._everywhere([(0.0, 0.0, 0.0)], coarser, focals, _PITCHES, 3, step))

    def _everywhere(self, places, coarser, focals, pitches, count, step):
        """The best guesses from each place for each focal length and pitch."""
        guesses, spheres = [], {}
        for focal in focals:
            maps = self._maps(focal, coarser)
            if maps.step_deg not in spheres:
                step()
                whole_sphere = partial(self._whole_sphere, step_deg=maps.step_deg)
                spheres = {maps.step_deg: list(in_threads(whole_sphere, places))}
            step()
            tried = [
                partial(sphere.peaks, maps, (focal, pitch, 0.0), count)
                for pitch, sphere in product(pitches, spheres[maps.step_deg])
            ]
            guesses += chain.from_iterable(in_threads(_called, tried))
        return guesses

    def _around(self, guesses, factors, rolls, count, step):
        """Guesses near these, with focal lengths changed by factors, and rolled."""
        found = []
        near = partial(self._near, factors=factors, rolls=rolls, count=count)
        for some in in_threads(near, guesses):
            step()
            found += some
        return found

    def _maps(self, focal, coarser=1):
        """The photo's maps, of larger pixels for a photo that is much wider than the scan."""
        wide = np.degrees(2 * np.arctan(0.5 / focal)) / (self._views.step_deg * coarser * _MOST_PIXELS)
        coarser *= 2 ** max(0, round(np.log2(wide)))
        if coarser not in self._photo_maps:
            self._photo_maps[coarser] = PhotoMaps(self._photo, self._views.step_deg * coarser)
        return self._photo_maps[coarser]

    def _whole_sphere(self, center, step_deg):
        """The scan all around a place, made once for all photos."""
        return self._views.once(("sphere", center, step_deg), lambda: self._sphere(center, step_deg))

    def _sphere(self, center, step_deg, window=None):
        image = self._views.image(0.5)
        points, tone = image.once("returns", lambda: (image.surface[image.valid], image.reflectance[image.valid]))
        return SphereMap(points, tone, center, step_deg, window)

    def _near(self, guess, factors, rolls, count):
        """Guesses from the same place in nearly the same direction."""
        # The pitch of the map need be right only as far as it bends the map: then many guesses share one.
        pitch = float(np.clip(round(guess.pitch_deg / 6) * 6, -60, 60))
        keys = [(_rounded(guess.focal * factor), pitch, roll) for factor, roll in product(factors, rolls)]
        maps = self._maps(guess.focal)
        patch = maps.at(min(keys)[0], pitch, 0.0)
        if patch is None:
            return []
        height, width = (length * maps.step_deg for length in patch.seen.shape)
        top = patch.top + guess.pitch_deg - pitch
        left = guess.yaw_deg + patch.left
        window = (left - _REACH_DEG, left + width + _REACH_DEG, top - height - _REACH_DEG, top + _REACH_DEG)
        sphere = self._sphere(guess.center, maps.step_deg, window)
        found = []
        for key in keys:
            found += sphere.peaks(maps, key, count, _REACH_DEG)
        return found


def _called(function):
    return function()


def _rounded(focal):
    """A focal length of a list whose neighbors differ by 2.5 %, so that like ones share a map."""
    return float(1.025 ** round(np.log(focal) / np.log(1.025)))


def _unlike_ones(guesses):
    """The guesses, best first, without those that are nearly like a better one."""
    kept = []
    for guess in sorted(guesses, key=lambda guess: -guess.score):
        if all(_unlike(guess, other) for other in kept):
            kept.append(guess)
        if len(kept) >= 4 * _LOOKED_AT:
            break
    return kept


def _unlike(guess, other):
    turn = abs((guess.yaw_deg - other.yaw_deg + 180) % 360 - 180) + abs(guess.pitch_deg - other.pitch_deg)
    return (
        guess.center != other.center
        or turn > 1.5
        or abs(np.log(guess.focal / other.focal)) > 0.12
        or abs(guess.roll_deg - other.roll_deg) > 5
    )
