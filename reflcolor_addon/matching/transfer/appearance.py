"""Colors for what no photo saw, learnt from what was seen: the same material has the same reflectance and texture.

How far that can be trusted is measured, not assumed: parts of what was seen are held out, contiguous ones as the unseen
are, and predicted from the rest. Where the prediction is no better than the mean color, there is no seed.
"""

from dataclasses import dataclass

import numpy as np

from ...color import colorspaces

_NEIGHBORS = 9
_FOLDS = 5
_LEAST_SEEN = 30
LEAST_CONFIDENCE = 0.2
_BINS = 4


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
    """Colors learnt from seen segments."""

    descriptors: np.ndarray
    chrominance: np.ndarray
    rgb: np.ndarray
    scale: np.ndarray
    limits: np.ndarray
    skill: np.ndarray

    @classmethod
    def learnt(cls, descriptors, rgb, places):
        """Learn from segments of known color.

        Parameters
        ----------
        descriptors : (N, D)
            See `described`; of all scans of a site together.
        rgb : (N, 3) uint8
        places : (N,)
            Where they are, along one direction: neighbors are held out together.

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
        fold = np.argsort(np.argsort(places, kind="stable"), kind="stable") * _FOLDS // len(rgb)
        error, baseline, doubt = np.zeros(len(rgb)), np.zeros(len(rgb)), np.zeros(len(rgb))
        for part in range(_FOLDS):
            held, rest = fold == part, fold != part
            predicted, _, doubt[held] = _nearest(
                descriptors[held] * scale, descriptors[rest] * scale, chrominance[rest]
            )
            error[held] = np.linalg.norm(predicted - chrominance[held], axis=1)
            baseline[held] = np.linalg.norm(chrominance[rest].mean(axis=0) - chrominance[held], axis=1)
        limits = np.quantile(doubt, np.linspace(0, 1, _BINS + 1)[1:-1])
        in_bin = np.searchsorted(limits, doubt)
        skill = np.array(
            [
                1 - error[in_bin == b].sum() / max(baseline[in_bin == b].sum(), 1e-9) if (in_bin == b).any() else 0.0
                for b in range(_BINS)
            ]
        )
        # More doubt is never more trust.
        skill = np.minimum.accumulate(np.clip(skill, 0, 1))
        return cls(descriptors, chrominance, rgb, scale, limits, skill)

    def predict(self, descriptors):
        """Return (M, 3) uint8 colors and (M,) confidence in 0..1."""
        own = self.descriptors * self.scale
        _, near, doubt = _nearest(descriptors * self.scale, own, self.chrominance)
        rgb = np.rint(np.median(self.rgb[near], axis=1)).astype(np.uint8)
        return rgb, self.skill[np.searchsorted(self.limits, doubt)]


def _nearest(wanted, known, chrominance):
    """Mean chrominance of the nearest known ones, which they are, and how doubtful: far, or not of one opinion."""
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
