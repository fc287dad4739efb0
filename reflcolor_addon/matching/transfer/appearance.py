"""Colors for what no photo saw, learned from what was seen: the same material has the same reflectance and texture.

How far that can be trusted is measured, not assumed: parts of what was seen are held out, contiguous ones as the unseen
are, and predicted from the rest. Where the prediction does not prove better than the mean color by a margin, there is
no seed.
"""

from dataclasses import dataclass

import numpy as np

from ...color import colorspaces

_NEIGHBORS = 9
_FOLDS = 4
_LEAST_SEEN = 30
LEAST_CONFIDENCE = 0.2
"""The share of the mean color's error by which a guess must be better, with what chance may do taken off."""
_BINS = 4
# Standard errors, from held out part to part, that are subtracted from what the guesses gained.
_DOUBT = 1.5


def described(image, labels, count):
    """Return (count, D) what the segments of a `ScanImage` look like to the scanner.

    Reflectance and its spread, texture at two scales, edge directions, height, slope and distance.
    """
    import cv2

    valid = (labels >= 0) & image.valid
    label = labels[valid]
    number = np.maximum(np.bincount(label, minlength=count), 1)

    def mean(values):
        return np.bincount(label, values[valid].astype(np.float64), count) / number

    reflectance = image.reflectance.astype(np.float64)
    mean_reflectance = mean(reflectance)
    squared = mean(reflectance**2) - mean_reflectance**2
    fine = np.abs(image.reflectance - cv2.GaussianBlur(image.reflectance, (0, 0), 1.5))
    coarse = np.abs(image.reflectance - cv2.GaussianBlur(image.reflectance, (0, 0), 5.0))
    columns = [
        mean_reflectance * 2,
        np.sqrt(np.maximum(squared, 0)),
        mean(fine),
        mean(coarse),
        *(mean(image.features[..., channel]) for channel in (1, 2)),
        mean(np.abs(image.normals[..., 2])),
        mean(image.points[..., 2]),
        mean(np.log(np.maximum(image.range, 1e-3))),
    ]
    return np.column_stack(columns)


@dataclass(frozen=True, eq=False)
class Appearance:
    """Colors learned from seen segments."""

    descriptors: np.ndarray
    chrominance: np.ndarray
    rgb: np.ndarray
    scale: np.ndarray
    limits: np.ndarray
    skill: np.ndarray

    @classmethod
    def learned(cls, descriptors, rgb, places):
        """Learn from segments of known color.

        Parameters
        ----------
        descriptors : (N, D)
            See `described`; of all scans of a site together.
        rgb : (N, 3) uint8
        places : (N, 2)
            Where they are, in two directions: neighbors along one are held out together, then along the other.

        Returns
        -------
        Appearance or None
            None where there is too little to learn from.
        """
        if len(rgb) < _LEAST_SEEN:
            return None
        spread = descriptors.std(axis=0)
        scale = np.where(spread > 1e-9, 1 / np.maximum(spread, 1e-9), 0)
        chrominance = colorspaces.chrominance(rgb, "cielab")
        held_out = []
        for along in np.transpose(places):
            fold = np.argsort(np.argsort(along, kind="stable"), kind="stable") * _FOLDS // len(rgb)
            for part in range(_FOLDS):
                held, rest = fold == part, fold != part
                predicted, _, doubt = _nearest(descriptors[held] * scale, descriptors[rest] * scale, chrominance[rest])
                error = np.linalg.norm(predicted - chrominance[held], axis=1)
                baseline = np.linalg.norm(chrominance[rest].mean(axis=0) - chrominance[held], axis=1)
                held_out.append((doubt, error, baseline))
        limits = np.quantile(np.concatenate([doubt for doubt, _, _ in held_out]), np.linspace(0, 1, _BINS + 1)[1:])
        # Beyond the largest doubt that was measured there is no trust; and more doubt never means more trust.
        skill = np.minimum.accumulate([*(_skill(held_out, limits, number) for number in range(_BINS)), 0.0])
        return cls(descriptors, chrominance, rgb, scale, limits, skill)

    def predict(self, descriptors):
        """Return (M, 3) uint8 colors and (M,) confidence in 0..1."""
        own = self.descriptors * self.scale
        _, near, doubt = _nearest(descriptors * self.scale, own, self.chrominance)
        rgb = np.rint(np.median(self.rgb[near], axis=1)).astype(np.uint8)
        return rgb, self.skill[np.searchsorted(self.limits, doubt)]


def _skill(held_out, limits, number):
    """What of the mean color's error is gone in one range of doubt, less what may be chance; 0 at least."""
    gained, all_ = [], 0.0
    for doubt, error, baseline in held_out:
        own = np.minimum(np.searchsorted(limits, doubt), _BINS - 1) == number
        if own.any():
            gained.append((baseline[own] - error[own]).sum())
            all_ += baseline[own].sum()
    if len(gained) < 2 or all_ <= 0:
        return 0.0
    by_chance = np.sqrt(len(gained)) * np.std(gained, ddof=1)
    return float(np.clip((np.sum(gained) - _DOUBT * by_chance) / all_, 0, 1))


def _nearest(wanted, known, chrominance):
    """Mean chrominance of the nearest known ones, which they are, and how doubtful: far, or contradictory."""
    near = np.empty((len(wanted), min(_NEIGHBORS, len(known))), int)
    distance = np.empty(near.shape)
    squares = (known**2).sum(axis=1)
    for start in range(0, len(wanted), 512):
        own = wanted[start : start + 512]
        squared = np.maximum((own**2).sum(axis=1)[:, None] + squares - 2 * own @ known.T, 0)
        near[start : start + 512] = np.argsort(squared, axis=1, kind="stable")[:, : near.shape[1]]
        distance[start : start + 512] = np.sqrt(np.take_along_axis(squared, near[start : start + 512], axis=1))
    colors = chrominance[near]
    usual = np.linalg.norm(chrominance - chrominance.mean(axis=0), axis=1).mean() + 1e-6
    opinion = np.linalg.norm(colors - colors.mean(axis=1, keepdims=True), axis=2).mean(axis=1) / usual
    return colors.mean(axis=1), near, opinion + distance.mean(axis=1) / np.sqrt(wanted.shape[1])
