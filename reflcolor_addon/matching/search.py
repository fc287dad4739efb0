"""Where a photo may have been taken from: every direction at once, for a list of focal lengths and places.

Seen from one place, the scan is a map over azimuth and elevation, and so is a photo of a known focal length; turning
the photo left and right shifts its map. So one correlation by FFT tries every direction, on edge features (`edges`),
normalized by what overlaps.
"""

from dataclasses import dataclass

import numpy as np

from .edges import edge_features, filled, scan_features
from .models import Camera, camera_axes
from .scan_image import pixel_steps

FOCALS = (0.5, 0.6, 0.72, 0.866, 1.04, 1.25, 1.5, 1.8, 2.2)
"""Focal lengths that are tried, in lengths of the photo's longer side: fields of view of 90 to 26 degrees."""

ASIDE_FOCALS = (0.55, 0.7, 0.87, 1.1, 1.5)
"""Those tried from beside the scanner, where there are many places to try."""

_TURNS_DEG = (10, -10, 20, -20, 30, -30, 40, -40, 50, -50)
# How far a place is moved to find a better one, in distances to what is seen, and how often.
_MOVES, _MOST_MOVES = (0.1, 0.05), 3
_LEAST_OVERLAP = 0.2
# A skyline or an edge of a thing is seen from afar, so range counts for more here than in the tiles.
_RANGE_WEIGHT = 0.7
_CUT_MARGIN_DEG = 100


@dataclass(frozen=True)
class Guess:
    """A camera that may be right, and how far its correlation stands out (in deviations of chance)."""

    score: float
    focal: float
    yaw_deg: float
    pitch_deg: float
    roll_deg: float
    center: tuple[float, float, float]

    def camera(self, photo):
        """Return it as a `Camera` for a `PhotoImage`."""
        rotation = camera_axes(self.yaw_deg, self.pitch_deg, self.roll_deg)
        focal_px = self.focal * max(photo.width, photo.height)
        return Camera(rotation, np.array(self.center), focal_px, 0.0, photo.width, photo.height)


def map_step(scan):
    """Return the size in degrees of the pixels that a scan is searched with."""
    vertical, horizontal = pixel_steps(scan)
    extent = max(scan.shape[0] * vertical, scan.shape[1] * horizontal)
    return float(np.clip(extent / 200, max(vertical, horizontal), 0.6 if extent > 120 else 2.0))


class SphereMap:
    """The scan over azimuth and elevation, seen from ``center``."""

    def __init__(self, scan, tone_image, center, step_deg):
        self.center = tuple(float(value) for value in center)
        self.step_deg = step_deg
        from_center = scan.points[scan.valid] - center
        distance = np.maximum(np.linalg.norm(from_center, axis=1), 1e-9)
        azimuth = np.degrees(np.arctan2(from_center[:, 0], from_center[:, 1]))
        elevation = np.degrees(np.arcsin(np.clip(from_center[:, 2] / distance, -1, 1)))
        self.left, around = _cut(azimuth)
        azimuth = (azimuth - self.left) % 360
        self.top = elevation.max()
        cols = (azimuth / step_deg).astype(int)
        rows = ((self.top - elevation) / step_deg).astype(int)
        shape = (rows.max() + 1, cols.max() + 1)
        reflectance, range_m, valid = _drawn(rows, cols, shape, distance, tone_image[scan.valid])
        if around:
            # The photo may lie across the cut.
            margin = min(shape[1], int(_CUT_MARGIN_DEG / step_deg))
            reflectance, range_m, valid = (np.hstack([a, a[:, :margin]]) for a in (reflectance, range_m, valid))
        features = scan_features(reflectance, range_m, valid, range_weight=_RANGE_WEIGHT)
        self._features = np.moveaxis(features, -1, 0)
        self._weight = features.any(axis=-1).astype(np.float32)
        self._transformed = {}

    def guesses(self, photo, focals, pitches_deg, rolls_deg, per_try=3):
        """Return the best `Guess`es for a `PhotoImage`, best first."""
        found = []
        for focal in focals:
            for pitch in pitches_deg:
                for roll in rolls_deg:
                    patch = _photo_map(photo, focal, pitch, roll, self.step_deg)
                    if patch is not None:
                        found += self._peaks(patch, focal, pitch, roll, per_try)
        return sorted(found, key=lambda guess: -guess.score)

    def _peaks(self, patch, focal, pitch, roll, count):
        features, seen, left, top = patch
        scores = self._correlation(features, seen)
        height, width = seen.shape
        apart = max(2, round(1.6 / self.step_deg))
        peaks = []
        for _ in range(count):
            row, col = np.unravel_index(scores.argmax(), scores.shape)
            if scores[row, col] <= 0:
                break
            yaw = self.left + (col - width) * self.step_deg - left
            rise = self.top - (row - height) * self.step_deg - top
            score = float(scores[row, col])
            peaks.append(Guess(score, focal, float(yaw), float(pitch + rise), float(roll), self.center))
            scores[max(0, row - apart) : row + apart + 1, max(0, col - apart) : col + apart + 1] = -1
        return peaks

    def _correlation(self, features, seen):
        """(h, w): correlation times the root of the overlap, for the photo's corner at (row - its height, ...)."""
        from scipy import fft

        height, width = seen.shape
        shape = tuple(
            fft.next_fast_len(-(-(own + other) // 32) * 32, real=True)
            for own, other in zip(self._weight.shape, seen.shape, strict=True)
        )
        if shape not in self._transformed:
            stack = np.concatenate([self._features, (self._features**2).sum(axis=0)[None], self._weight[None]])
            self._transformed[shape] = fft.rfft2(stack.astype(np.float32), shape)
        own = self._transformed[shape]
        stack = np.concatenate([np.moveaxis(features, -1, 0), (features**2).sum(axis=-1)[None], seen[None]])
        other = np.conj(fft.rfft2(stack.astype(np.float32), shape))
        # Products, and the energies of both within the overlap, and the overlap itself.
        spectra = [(own[:-2] * other[:-2]).sum(axis=0), own[-2] * other[-1], own[-1] * other[-2], own[-1] * other[-1]]
        product, energy, energy_other, overlap = fft.irfft2(np.stack(spectra), shape)
        enough = overlap > _LEAST_OVERLAP * min(seen.sum(), self._weight.sum())
        correlation = product / np.sqrt(np.maximum(energy, 1e-2) * np.maximum(energy_other, 1e-2))
        scores = np.where(enough, correlation * np.sqrt(np.maximum(overlap, 0)), -1)
        return np.roll(scores, (height, width), (0, 1))


def sharpened(maps, photo, guesses, count):
    """Return better guesses: focal length and roll varied around the best ``count``, and those alike merged."""
    tried = []
    for guess in guesses[:count]:
        sphere = maps[guess.center]
        focals = [guess.focal * factor for factor in (0.92, 1.0, 1.09)]
        rolls = [guess.roll_deg + turn for turn in (-4.0, 0.0, 4.0)]
        # The pitch is found by the shift; it need be right only as far as it bends the map.
        tried += sphere.guesses(photo, focals, (float(np.clip(round(guess.pitch_deg / 12) * 12, -60, 60)),), rolls, 2)
    kept = []
    for guess in sorted([*tried, *guesses], key=lambda guess: -guess.score):
        if all(_unlike(guess, other) for other in kept):
            kept.append(guess)
    return kept


def climbed(sphere_at, photo, guess, distance):
    """Return the best guess reached by moving its place sideways, to and fro, and up and down, while that helps.

    Parameters
    ----------
    sphere_at : callable
        Makes the `SphereMap` of a place.
    photo : PhotoImage
    guess : Guess
    distance : float
        Metres to what is seen.
    """
    for move in _MOVES:
        for _ in range(_MOST_MOVES):
            yaw = np.radians(guess.yaw_deg)
            ahead, aside, up = [np.sin(yaw), np.cos(yaw), 0], [np.cos(yaw), -np.sin(yaw), 0], [0, 0, 0.5]
            ways = [np.array(way) * sign * move * distance for way in (aside, ahead, up) for sign in (1, -1)]
            focals = [guess.focal * factor for factor in (0.93, 1.0, 1.07)]
            tried = [
                sphere_at(tuple(guess.center + way)).guesses(photo, focals, (guess.pitch_deg,), (guess.roll_deg,), 1)
                for way in ways
            ]
            best = max((found[0] for found in tried if found), key=lambda found: found.score, default=guess)
            if best.score <= guess.score:
                break
            guess = best
    return guess


def _unlike(guess, other):
    turn = abs((guess.yaw_deg - other.yaw_deg + 180) % 360 - 180) + abs(guess.pitch_deg - other.pitch_deg)
    return (
        guess.center != other.center
        or turn > 1.5
        or abs(np.log(guess.focal / other.focal)) > 0.12
        or abs(guess.roll_deg - other.roll_deg) > 5
    )


def viewing_distance(scan):
    """Return the median horizontal distance of what a scan sees, in metres."""
    points = scan.points[scan.valid]
    return float(np.median(np.hypot(points[:, 0], points[:, 1])))


def viewpoints(scan):
    """Return (x, y, z) places a photo may have been taken from beside the scanner's own, in metres, scanner frame.

    Around what a scan sees, 10 to 50 degrees to either side; around the scanner, if that sees all around.
    """
    points = scan.points[scan.valid]
    distance = viewing_distance(scan)
    _, horizontal = pixel_steps(scan)
    if scan.full_turn or scan.shape[1] * horizontal > 200:
        return [(x * distance, y * distance, 0.0) for x, y in ((0.3, 0), (-0.3, 0), (0, 0.3), (0, -0.3))]
    middle = np.median(points, axis=0)
    middle[2] = 0.0
    places = []
    for turn in np.radians(_TURNS_DEG):
        x, y = -middle[:2]
        turned = [np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y]
        places.append((float(middle[0] + turned[0]), float(middle[1] + turned[1]), 0.0))
    return places


def _cut(azimuth_deg):
    """The azimuth at the right end of the widest empty sector, and whether there is none."""
    empty = np.histogram(azimuth_deg, 360, (-180, 180))[0] == 0
    if not empty.any():
        return -180.0, True
    starts = np.flatnonzero(np.diff(np.concatenate([[0], np.tile(empty, 2), [0]])) == 1)
    ends = np.flatnonzero(np.diff(np.concatenate([[0], np.tile(empty, 2), [0]])) == -1)
    widest = np.argmax(ends - starts)
    return float(-180 + ends[widest] % 360), bool(ends[widest] - starts[widest] < 3)


def _drawn(rows, cols, shape, distance, tone):
    """Points drawn into a map: the mean of the nearest surface in each pixel, small holes closed."""
    import cv2

    place = rows * shape[1] + cols
    nearest = np.full(shape[0] * shape[1], np.inf)
    np.minimum.at(nearest, place, distance)
    front = distance < nearest[place] * 1.03
    place, tone, distance = place[front], tone[front], distance[front]
    count = np.bincount(place, minlength=nearest.size)
    sums = [np.bincount(place, values, nearest.size) for values in (tone, distance)]
    reflectance, range_m = ((total / np.maximum(count, 1)).reshape(shape).astype(np.float32) for total in sums)
    valid = (count > 0).reshape(shape)
    closed = cv2.morphologyEx(valid.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3))) > 0
    holes = closed & ~valid
    share = np.maximum(cv2.blur(valid.astype(np.float32), (3, 3)), 1e-6)
    for image in (reflectance, range_m):
        image[holes] = (cv2.blur(image, (3, 3)) / share)[holes]
    return reflectance, range_m, closed


def _photo_map(photo, focal, pitch_deg, roll_deg, step_deg):
    """Features of the photo over azimuth and elevation, where it is seen, its left azimuth and its top elevation."""
    width, height = photo.width, photo.height
    focal_px = focal * max(width, height)
    rotation = camera_axes(0.0, pitch_deg, roll_deg)
    x, y = np.meshgrid(np.linspace(-width / 2, width / 2, 9), np.linspace(-height / 2, height / 2, 9))
    rays = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, focal_px)]) @ rotation
    azimuth = np.degrees(np.arctan2(rays[:, 0], rays[:, 1]))
    elevation = np.degrees(np.arctan2(rays[:, 2], np.hypot(rays[:, 0], rays[:, 1])))
    if np.ptp(azimuth) > 170:
        return None
    left, top = np.floor(azimuth.min() / step_deg) * step_deg, np.ceil(elevation.max() / step_deg) * step_deg
    cols, rows = int((azimuth.max() - left) / step_deg) + 1, int((top - elevation.min()) / step_deg) + 1
    azimuth, elevation = np.meshgrid(
        np.radians(left + (np.arange(cols) + 0.5) * step_deg), np.radians(top - (np.arange(rows) + 0.5) * step_deg)
    )
    rays = np.stack([np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)], -1)
    xy, _ = Camera(rotation, np.zeros(3), focal_px, 0.0, width, height).project(rays)
    seen = np.isfinite(xy).all(axis=-1)
    image, seen = photo.sampled(xy, seen, focal_px * np.radians(step_deg))
    if np.count_nonzero(seen) < 64:
        return None
    return edge_features(filled(image, seen), seen), seen, left, top
