"""An image on a scan's grid at the photos' own resolution.

The colors of the scan's pixels are enlarged, and where a photo leads, its detail between the pixels is added: what it
shows at a texel less what it shows, enlarged alike, at the pixels around. So the image has a photo's sharpness, and
at every pixel of the scan just the color that the vertex there has, whatever made that: a photo, seeds, or both.
"""

from dataclasses import dataclass

import numpy as np

from ...errors import Cancelled
from ...srgb import linear_to_srgb8, srgb8_to_linear
from ..opened_photos import opened_photos
from ..photo_image import PhotoImage
from ..scan_image import pixel_steps
from .surface import GridSurface
from .views import colors_at, sighted

LARGEST = 16384
"""Texels along the longer side that graphics cards take at most."""
# Texels that are worked on at a time.
_STRIP = 1 << 19
_TRUSTED = (12, 245)
_LARGEST_GAIN = 8.0


@dataclass(frozen=True, eq=False)
class Shot:
    """A photo and the model of how the scan falls into it."""

    photo: PhotoImage
    model: object


def texture_shape(scan, longest):
    """Return (rows, columns) of an image of a scan's grid with square texels and so many along its longer side."""
    vertical, horizontal = pixel_steps(scan)
    tall, wide = scan.shape[0] * vertical, scan.shape[1] * horizontal
    scale = longest / max(tall, wide)
    return max(1, round(tall * scale)), max(1, round(wide * scale))


def texture(scan, rgb, observed, photo, shots, longest, *, progress=None, cancelled=None):
    """Make the image.

    Parameters
    ----------
    scan : Scan
    rgb : (H, W, 3) uint8
        sRGB of its pixels.
    observed : (H, W) float32
        How far each color is a photo's own, 0..1.
    photo : (H, W) int
        Which photo's; -1 where none.
    shots : sequence of Shot or None
        By the photos' numbers; None for a photo that was not recognized on this scan. May be empty.
    longest : int
        Texels along the longer side.
    progress, cancelled : callable, optional

    Returns
    -------
    (rows, columns, 3) uint8
        sRGB; see `texture_shape`. Row 0 is the scan's top. Where the scan has no return it has the nearest color.

    Raises
    ------
    Cancelled
        If ``cancelled()`` returned True.
    """
    image = np.empty((*texture_shape(scan, longest), 3), np.uint8)
    enlarged = _Enlarged(scan, image.shape)
    nearest = _nearest_return(scan.valid)
    base = rgb.reshape(-1, 3)[nearest].astype(np.float32)
    surface, details = GridSurface(scan), []
    for number, shot in enumerate(shots):
        own = np.where(photo == number, observed, 0).astype(np.float32)
        if shot is not None and own.any():
            detail = _Detail(shot, surface, nearest, own, rgb, enlarged)
            base -= detail.at_pixels
            detail.at_pixels = None
            details.append(detail)
    rows = max(1, _STRIP // image.shape[1])
    for top in range(0, len(image), rows):
        if cancelled is not None and cancelled():
            raise Cancelled
        if progress is not None:
            progress(top / len(image), "Making the texture")
        strip = np.arange(top, min(top + rows, len(image)))
        colors = enlarged.of(base, strip)
        for detail in details:
            detail.add_to(colors, strip)
        image[strip] = np.rint(np.clip(colors, 0, 255))
    return image


def grid_texture(scan, rgb):
    """Return an image of a scan's grid with the colors of its pixels, of no more than `LARGEST` texels a side.

    Parameters
    ----------
    scan : Scan
    rgb : (H, W, 3) uint8

    Returns
    -------
    (rows, columns, 3) uint8
        Where the scan has no return it has the nearest color.
    """
    import cv2

    image = rgb.reshape(-1, 3)[_nearest_return(scan.valid)]
    rows, columns = (min(side, LARGEST) for side in scan.shape)
    if (rows, columns) == scan.shape:
        return image
    return cv2.resize(image, (columns, rows), interpolation=cv2.INTER_AREA)


def colors_of_texture(scan, image):
    """Return the colors that an image of a scan's grid has at its pixels.

    Parameters
    ----------
    scan : Scan
    image : (rows, columns, 3) uint8
        See `texture`.

    Returns
    -------
    (H, W, 3) uint8
    """
    import cv2

    smaller = image.shape[0] > scan.shape[0]
    return cv2.resize(image, scan.shape[::-1], interpolation=cv2.INTER_AREA if smaller else cv2.INTER_LINEAR)


class _Enlarged:
    """Images of a scan's grid at the size of a texture, strip by strip, interpolated between the pixels' middles."""

    def __init__(self, scan, shape):
        height, width = scan.shape
        self.per_pixel = np.sqrt(shape[0] / height * shape[1] / width)
        self._rows = self._between(shape[0], height, False)
        self._cols = self._between(shape[1], width, scan.full_turn)

    @staticmethod
    def _between(count, length, wrap):
        """The two pixels around each texel, the share of the second, and the pixel that the texel lies in."""
        place = (np.arange(count) + 0.5) * (length / count) - 0.5
        first = np.floor(place).astype(int)
        share = (place - first).astype(np.float32)
        pair = [index % length if wrap else np.clip(index, 0, length - 1) for index in (first, first + 1)]
        return *pair, share, np.minimum((place + 0.5).astype(int), length - 1)

    def of(self, image, strip, first=0):
        """(rows, columns, ...) of the texture's rows, of an image that begins at a row of the grid."""
        above, below, down, _ = (index[strip] for index in self._rows)
        left, right, across, _ = self._cols
        down, across = down.reshape(-1, *(1,) * (image.ndim - 1)), across.reshape(-1, *(1,) * (image.ndim - 2))
        between = image[above - first] * (1 - down) + image[below - first] * down
        return between[:, left] * (1 - across) + between[:, right] * across

    def nearest(self, image, strip):
        """The same, from the pixel that each texel lies in."""
        return image[self._rows[3][strip][:, None], self._cols[3]]

    def rows_of(self, strip):
        """The slice of the grid's rows that these rows lie between."""
        return slice(self._rows[0][strip[0]], self._rows[1][strip[-1]] + 1)


class _Detail:
    """What one photo adds."""

    def __init__(self, shot, surface, nearest, weight, rgb, enlarged):
        self._shot, self._scan, self._weight, self._enlarged = shot, surface.scan, weight, enlarged
        self._nearest = nearest
        sight = sighted(shot.model, surface)
        led = (weight > 0) & np.isfinite(sight.xy).all(axis=-1)
        self._footprint = sight.footprint / np.float32(enlarged.per_pixel)
        own = np.zeros_like(rgb)
        own[led] = colors_at(shot.photo, sight.xy[led], sight.footprint[led])
        gain = _gain(rgb[led], own[led])
        self._lit = linear_to_srgb8(srgb8_to_linear(np.arange(256))[:, None] * gain)
        self.at_pixels = self._in_its_light(own) * weight[..., None]

    def _in_its_light(self, colors):
        return np.stack([self._lit[colors[..., channel], channel] for channel in range(3)], axis=-1).astype(np.float32)

    def add_to(self, colors, strip):
        """Add it to a strip of the texture."""
        if not self._weight[self._enlarged.rows_of(strip)].any():
            return
        weight = self._enlarged.of(self._weight, strip)
        wanted = weight > 0
        xy, _ = self._shot.model.project(self._sites(strip, wanted))
        footprint = self._enlarged.nearest(self._footprint, strip)[wanted]
        own = colors_at(self._shot.photo, np.nan_to_num(xy).astype(np.float32), np.nan_to_num(footprint))
        colors[wanted] += self._in_its_light(own) * weight[wanted][:, None]

    def _sites(self, strip, wanted):
        """(N, D) float64: where on the surface between the pixels the wanted texels are, as the model takes it."""
        rows = self._enlarged.rows_of(strip)
        if self._shot.model.kind == "pose":
            # Beside a pixel without a return the surface goes on as it is.
            pixels = np.divmod(self._nearest[rows], self._scan.shape[1])
        else:
            pixels = np.arange(rows.start, rows.stop)[:, None], np.arange(self._scan.shape[1])
        return self._enlarged.of(self._shot.model.sites_of(self._scan, *pixels), strip, rows.start)[wanted]


def _gain(colors, own):
    """(3,) gain of linear light that brings a photo's own colors to those that the scan has from it."""
    low, high = _TRUSTED
    trusted = np.logical_and.reduce([(image >= low) & (image <= high) for image in (colors, own)]).all(axis=-1)
    if not trusted.any():
        return np.ones(3)
    ratio = np.median(srgb8_to_linear(colors[trusted]) / srgb8_to_linear(own[trusted]), axis=0)
    return np.clip(ratio, 1 / _LARGEST_GAIN, _LARGEST_GAIN)


def _nearest_return(valid):
    """(H, W) int: the pixel with a return that is nearest to each, ``row * width + column``."""
    import cv2

    own = np.arange(valid.size).reshape(valid.shape)
    if valid.all() or not valid.any():
        return own
    _, label = cv2.distanceTransformWithLabels(
        (~valid).astype(np.uint8), cv2.DIST_L2, 3, labelType=cv2.DIST_LABEL_PIXEL
    )
    place = np.zeros(label.max() + 1, np.int64)
    place[label[valid]] = own[valid]
    return place[label]


def shots_of(photos, matching):
    """Return a `Shot` of every photo that was recognized, None for the others: what `texture` takes.

    Parameters
    ----------
    photos : sequence
        As `match_photos` was given them.
    matching : Matching or None
        None where nothing was sought in them.
    """
    if matching is None or not any(found.verified for found in matching.photos):
        return []
    opened = opened_photos(photos)
    return [
        Shot(photo, found.model) if found.verified else None
        for photo, found in zip(opened, matching.photos, strict=True)
    ]
