"""Seeds where photos saw a scan: one in each superpixel, well inside of it and of what was seen."""

from dataclasses import dataclass

import numpy as np

from ...seeds.seeds import Seeds

_PATCH = 3


@dataclass(frozen=True, eq=False)
class SeenSeeds:
    """Seeds where a photo saw the scan, and the superpixel of each."""

    seeds: Seeds
    segments: np.ndarray


def seen_seeds(scan, observed, image, superpixels, locations, photos):
    """Return one seed for each superpixel of which a photo saw something.

    Parameters
    ----------
    scan : Scan
    observed : Observed
    image : ScanImage
    superpixels : Superpixels
        Of that image.
    locations : sequence of Location
        Of each photo.
    photos : sequence of PhotoImage

    Returns
    -------
    SeenSeeds or None
        None where there is none.
    """
    import cv2

    chosen = np.ix_(image.rows, image.cols)
    weight, source, labels = observed.weight[chosen], observed.photo[chosen], superpixels.labels
    usable = (weight > 0) & (labels >= 0)
    if not usable.any():
        return None
    share = usable.astype(np.float32)
    sums = cv2.blur(observed.rgb[chosen].astype(np.float32) * share[..., None], (_PATCH, _PATCH))
    rgb = sums / np.maximum(cv2.blur(share, (_PATCH, _PATCH)), 1e-6)[..., None]
    # A seed at a border between superpixels is as unreliable as one at the border of what was seen.
    inner = usable.copy()
    inner[:, 1:] &= labels[:, 1:] == labels[:, :-1]
    inner[1:] &= labels[1:] == labels[:-1]
    # What was seen badly anywhere in a superpixel comes after what was seen well at its border.
    depth = cv2.distanceTransform(inner.astype(np.uint8), cv2.DIST_L2, 3) * np.where(weight < 1, 1e-3, 1)
    rows, cols = np.nonzero(usable)
    label = labels[rows, cols]
    order = np.lexsort((-depth[rows, cols], label))
    segments, first = np.unique(label[order], return_index=True)
    rows, cols = rows[order[first]], cols[order[first]]
    photo = source[rows, cols]
    grid_rows, grid_cols = image.rows[rows], image.cols[cols]
    # Of a photo that was recognized on another scan of the site only, the place in it is not known.
    xy = np.full((len(rows), 2), np.nan)
    for index in np.unique(photo):
        if locations[index].verified:
            own, model = photo == index, locations[index].registration.model
            xy[own] = model.project(model.sites_of(scan, grid_rows[own], grid_cols[own]))[0]
    trust = np.array([_trust(location.registration) for location in locations])[photo]
    seeds = Seeds(
        rows=grid_rows,
        cols=grid_cols,
        rgb=np.rint(rgb[rows, cols]).astype(np.uint8),
        photos=tuple(photos[index].name if locations[index].verified else None for index in photo),
        photo_xy=xy,
        confidence=trust * weight[rows, cols],
        reason=tuple("homography" if locations[index].reason == "homography" else "pose" for index in photo),
    )
    return SeenSeeds(seeds, segments)


def _trust(registration):
    """How reliable a registration is: 0.75 if just accepted or resting on pairs alone, 1 if beyond doubt."""
    if registration.model is None or not registration.accepted:
        return 0.75
    return float(np.clip(0.75 + 0.25 * (registration.evidence.rank - 1) / 4, 0.75, 1.0))
