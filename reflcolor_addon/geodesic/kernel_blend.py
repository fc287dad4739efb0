"""The blending of equation 1 by the native kernel, seed by seed."""

from typing import NamedTuple

import numpy as np

from ..errors import ReflcolorError
from ..native.library import MAX_CHANNELS, address, check, library, pointer_to
from .kernel_graph import adjacent_rows

PIXELS_AT_ONCE = 1 << 15
"""Pixels blended between two checks for cancellation: few enough for the sums to stay in the cache."""


class Mean(NamedTuple):
    """Equation 1 for every pixel."""

    values: np.ndarray
    """(C, H, W) float32: the weighted means; 0 where no seed arrives."""
    weight: np.ndarray
    """(H, W) float32: the sum of (r / least r)^-alpha; at least 1, 0 where no seed arrives."""
    nearest_seed: np.ndarray
    """(H, W) int32: -1 where no seed arrives."""
    least: np.ndarray
    """(H, W) float32: distance of the nearest seed; infinite where none arrives."""


class Blend:
    """The sums of equation 1, taken seed by seed; 12 bytes per pixel, and 4 for each channel.

    Parameters
    ----------
    shape : (H, W)
    alpha : float
        Exponent of eq. 2, at least 0.
    channels : int
        How many values a seed has: 2 of chrominance, or 3 of a whole color; 1 to 4.
    """

    def __init__(self, shape, alpha, channels=2):
        check_alpha(alpha)
        self._alpha = alpha
        self._mean = Mean(
            values=np.zeros((channels, *shape), np.float32),
            weight=np.zeros(shape, np.float32),
            nearest_seed=np.full(shape, -1, np.int32),
            least=np.full(shape, np.inf, np.float32),
        )
        self._count = 0

    def add(self, distances, values, control=None):
        """Add a seed: its (H, W) float32 distances, infinite where it does not reach, and its value in each channel.

        Its index is the number of seeds added so far. The order of adding decides the last bits of the sums. After
        a cancellation they are of no more use.
        """
        self.add_all([distances], [values], control)

    def add_all(self, fields, values, control=None, run=map):
        """Add several seeds; ``run`` is `map` or a pool's, which lets threads work on parts of the image."""
        first, self._count = self._count, self._count + len(fields)
        fields = [adjacent_rows(np.asarray(distances, np.float32)) for distances in fields]
        values = checked_values(values)
        channels, height, width = self._mean.values.shape
        for distances in fields:
            if distances.shape != (height, width):
                raise ReflcolorError(
                    "distances of shape {shape} do not fit an image {height} x {width}",
                    shape=distances.shape,
                    height=height,
                    width=width,
                )
        if values.shape != (len(fields), channels):
            raise ReflcolorError(
                "expected values of shape {expected}, found {shape}",
                expected=(len(fields), channels),
                shape=values.shape,
            )
        sums = (self._mean.least, self._mean.nearest_seed, self._mean.weight, self._mean.values[0])
        rows = max(1, PIXELS_AT_ONCE // width)

        def add_to(strip):
            parts = [address(each[strip]) for each in sums]
            for seed, (distances, own) in enumerate(zip(fields, values, strict=True), first):
                part = distances[strip]
                stride = max(part.strides[0] // 4, width)
                arguments = len(part), width, address(part), stride, self._alpha, seed, channels, address(own)
                check(library().rc_blend_add(*arguments, *parts, height * width, pointer_to(control)))

        for _ in run(add_to, [slice(top, min(top + rows, height)) for top in range(0, height, rows)]):
            pass

    def mean(self, keep=True):
        """Return the `Mean` of the seeds so far.

        More can be added afterwards if the sums are kept; else they become the result, which saves their memory.
        """
        mean = Mean(*(sums.copy() for sums in self._mean)) if keep else self._mean
        channels, pixels = len(mean.values), mean.weight.size
        check(library().rc_blend_finish(pixels, address(mean.weight), channels, address(mean.values), pixels))
        return mean


def check_alpha(alpha):
    """Raise ReflcolorError unless alpha is one that the kernel takes."""
    if not 0 <= alpha <= np.finfo(np.float32).max:
        raise ReflcolorError("alpha must be finite and at least 0, found {alpha}", alpha=alpha)


def checked_values(values):
    """Return the values of seeds as (S, C) float32; raise ReflcolorError if they are none."""
    values = np.ascontiguousarray(values, np.float32)
    if values.ndim != 2 or not 1 <= values.shape[1] <= MAX_CHANNELS:
        raise ReflcolorError(
            "expected values of shape (seeds, 1 to {most}), found {shape}",
            most=MAX_CHANNELS,
            shape=values.shape,
        )
    if not np.isfinite(values).all():
        raise ReflcolorError("the seeds' values must be finite, found NaN or infinity")
    return values
