"""What one photo shows and the others do not: people, cars, highlights, shadows that moved.

Where three or more photos see a place, the majority decides. Where they stand one against one, the color that is
inferred there from all the places that are not disputed decides, for each region as a whole.
"""

import numpy as np

# Distances in CIELAB: nearer than the first, two photos show the same; farther than the second, they do not.
_SAME, _OTHER = 14.0, 20.0
# Of a reduced pixel that a photo must have seen.
_LEAST_SHARE = 0.5
# Pixels of the reduced grid: what is narrower is an edge that one photo has elsewhere, and how far blurred borders go.
_NARROWEST, _BORDER = 5, 2


def outliers(colors, usable, reduced, inference):
    """Find where photos show something else than the scan's surface.

    Parameters
    ----------
    colors : dict of (H, W, 3) uint8
        By photo: sRGB, of one exposure for all.
    usable : dict of (H, W) bool
        Where each saw the surface.
    reduced : Reduced
    inference : Inference

    Returns
    -------
    dict of (H, W) bool
        By photo: where its color is to be left out. Another photo's is there.
    """
    numbers = list(colors)
    lab, seen = [], []
    for number in numbers:
        share = reduced.share(usable[number])
        lab.append(reduced.lab(colors[number], usable[number], share))
        seen.append(share >= _LEAST_SHARE)
    votes = [own.astype(np.int16) for own in seen]
    apart = {}
    for one in range(len(numbers)):
        for other in range(one + 1, len(numbers)):
            both = seen[one] & seen[other]
            if both.any():
                distance = np.where(both, np.linalg.norm(lab[one] - lab[other], axis=-1), 0)
                apart[one, other] = apart[other, one] = both & (distance > _OTHER)
                same = both & (distance < _SAME)
                votes[one] += same
                votes[other] += same
    if not any(mask.any() for mask in apart.values()):
        return {}
    votes = np.stack(votes)
    best = votes.argmax(axis=0)
    most = votes.max(axis=0)
    against = np.zeros(votes.shape, bool)
    for (one, other), mask in apart.items():
        against[other] |= mask & (best == one)
    # As many for what differs as for the best: no majority.
    disputed = (against & (votes == most)).any(axis=0)
    left_out = against & ~disputed
    disputed = _opened(disputed)
    if disputed.any():
        left_out |= _judged(disputed, lab, seen, apart, best, inference)
    result = {}
    for place, number in enumerate(numbers):
        excluded = _widened(_opened(left_out[place]))
        if excluded.any():
            result[number] = reduced.whole_nearest(excluded) & usable[number]
    # A place where every photo is left out would have no color at all.
    if result:
        none = np.logical_and.reduce([result.get(n, np.zeros_like(usable[n])) | ~usable[n] for n in numbers])
        result = {number: mask & ~none for number, mask in result.items()}
    return result


def _judged(disputed, lab, seen, apart, best, inference):
    """(P, h, w) bool: which photo is left out of disputed regions, where the inferred color is nearer to another's."""
    import cv2

    known = np.logical_or.reduce(seen) & ~disputed
    of_best = np.take_along_axis(np.stack(lab), best[None, ..., None], axis=0)[0]
    guess = inference.estimate(of_best, known, disputed)
    off = [np.where(own, np.linalg.norm(one - guess, axis=-1), np.nan) for one, own in zip(lab, seen, strict=True)]
    left_out = np.zeros((len(lab), *disputed.shape), bool)
    count, label = cv2.connectedComponents(disputed.astype(np.uint8), connectivity=8)
    order = np.argsort(label, axis=None, kind="stable")
    ends = np.searchsorted(label.reshape(-1)[order], np.arange(count + 1))
    for region in range(1, count):
        place = np.unravel_index(order[ends[region] : ends[region + 1]], disputed.shape)
        cost = [_mean_of_most(distance[place]) for distance in off]
        right = int(np.argmin(cost))
        for photo in range(len(lab)):
            if (right, photo) in apart and np.isfinite(cost[right]):
                left_out[photo][place] = apart[right, photo][place]
    return left_out


def _mean_of_most(values):
    """The mean of those that are known; infinite where most are not."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if 2 * len(known) > len(values) else np.inf


def _opened(mask):
    import cv2

    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (_NARROWEST, _NARROWEST))
    return cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, kernel) > 0


def _widened(mask):
    import cv2

    return cv2.dilate(mask.astype(np.uint8), np.ones((2 * _BORDER + 1, 2 * _BORDER + 1), np.uint8)) > 0
