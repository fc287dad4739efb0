"""Blends the photos of one scan: a color for every pixel that any of them saw.

The photo that saw a pixel best gives its detail. What photos still differ by after their exposures were reconciled
changes slowly (the light at another hour, a lens that darkens its corners): it is blended over where they overlap, so
that no seam shows where one takes over from another. That is multi-band blending (Burt and Adelson 1983) with two
bands, the low one made of differences only, so that it stays within what both photos show.
"""

import numpy as np

from ...color.observed import Observed
from ...srgb import linear_to_srgb8, srgb8_to_linear
from .inference import Inference
from .outliers import outliers
from .reduced import Reduced
from .rims import ghosts, islands

# Shares of the grid's longer side: over which a photo comes in from its border, and over which differences are blended.
_FEATHER, _BLEND = 0.03, 0.03
# The weight of a doubtful pixel of one photo beside a sure one of another.
_DOUBTFUL = 0.01
# Levels: two photos that differ by more show different things.
_LARGEST_DIFFERENCE = 40.0
# The weight of what is seen from behind, and of what is doubtful but agrees with its surface.
_BEHIND, _AGREEING = 0.3, 0.75


def fused(views, photo_gains, surface):
    """Return the `Observed` colors of one scan.

    Parameters
    ----------
    views : sequence of View or None
        Of every photo.
    photo_gains : (P, 3) float64
        See `several_photos.gains`.
    surface : GridSurface

    Returns
    -------
    Observed or None
        None where no photo shows anything.
    """
    shown = {number: view for number, view in enumerate(views) if view is not None and view.usable.any()}
    if not shown:
        return None
    reduced = Reduced(surface.scan)
    inference = Inference(surface.scan, reduced)
    colors = {number: _lit(view.rgb, photo_gains[number]) for number, view in shown.items()}
    usable = {number: view.usable for number, view in shown.items()}
    if len(shown) > 1:
        for number, mask in outliers(colors, usable, reduced, inference).items():
            usable[number] = usable[number] & ~mask
    shape = surface.scan.shape
    leader, most = np.full(shape, -1, np.int16), np.zeros(shape, np.float32)
    shares = {}
    for number, view in shown.items():
        shares[number] = view.quality * _coming_in(usable[number], surface.scan.full_turn)
        own = np.maximum(shares[number], np.float32(1e-6)) * np.where(view.doubtful, np.float32(_DOUBTFUL), 1)
        better = usable[number] & (own > most)
        leader[better] = number
        most[better] = own[better]
    rgb = np.zeros((*shape, 3), np.uint8)
    behind, doubtful, aside = (np.zeros(shape, bool) for _ in range(3))
    for number, view in shown.items():
        own = leader == number
        rgb[own], behind[own], doubtful[own] = colors[number][own], view.behind[own], view.doubtful[own]
        aside[own] = view.aside
    if len(shown) > 1:
        rgb = _reconciled(rgb, leader, colors, usable, shares, reduced)
    weight = np.where(behind, np.float32(_BEHIND), np.where(doubtful, np.float32(_AGREEING), np.float32(1)))
    weight[leader < 0] = 0
    # From the scanner's own place a photo shows as much of everything as the scan.
    seen = leader >= 0
    cut_off = islands(seen, seen & ~doubtful) & aside
    lost = cut_off | ghosts(
        rgb, seen & ~doubtful & ~cut_off, doubtful & aside & ~cut_off, surface.scan, reduced, inference
    )
    weight[lost], leader[lost], rgb[lost] = 0, -1, 0
    return Observed(rgb, weight, leader)


def _lit(rgb, gain):
    """The colors in light of other strength."""
    if np.all(gain == 1):
        return rgb
    table = linear_to_srgb8(srgb8_to_linear(np.arange(256))[:, None] * gain)
    return np.stack([table[rgb[..., channel], channel] for channel in range(3)], axis=-1)


def _coming_in(usable, wrap):
    """(H, W) float32: from 0 beyond the border of what a photo saw to 1 farther inside of it."""
    import cv2

    reach = max(2.0, _FEATHER * max(usable.shape))
    # A hole of a pixel or two is no border.
    whole = cv2.morphologyEx(usable.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    margin = min(int(np.ceil(reach)), usable.shape[1])
    padded = np.pad(whole, ((1, 1), (margin, margin)), mode="wrap" if wrap else "edge")
    padded[[0, -1]] = padded[[1, -2]]
    distance = cv2.distanceTransform(padded, cv2.DIST_L2, 3)[1:-1, margin : margin + usable.shape[1]]
    near = np.minimum(distance / np.float32(reach), 1)
    return np.where(usable, near * near * (3 - 2 * near), 0)


def _reconciled(rgb, leader, colors, usable, shares, reduced):
    """(H, W, 3) uint8: the leaders' colors, and what all photos differ from them by, slowly, as far as each counts."""
    sigma = max(1.0, _BLEND * max(reduced.shape))
    small, total = {}, sum(shares.values())
    for number, mask in usable.items():
        share = reduced.share(mask)
        small[number] = reduced.mean(colors[number], mask, share), share
    change = np.zeros(rgb.shape, np.float32)
    numbers = list(colors)
    for place, one in enumerate(numbers):
        for other in numbers[place + 1 :]:
            both = small[one][1] * small[other][1]
            if both.max() < 0.25:
                continue
            difference = small[other][0] - small[one][0]
            both = both * (np.abs(difference).max(axis=-1) <= _LARGEST_DIFFERENCE)
            near = reduced.blurred(both, sigma)
            difference = reduced.blurred(difference * both[..., None], sigma) / (near + np.float32(0.02))[..., None]
            difference = reduced.whole(difference)
            for first, second, sign in ((one, other, 1), (other, one, -1)):
                led = (leader == first) & (shares[second] > 0)
                change[led] += np.float32(sign) * difference[led] * (shares[second][led] / total[led])[:, None]
    return np.clip(np.rint(rgb + change), 0, 255).astype(np.uint8)
