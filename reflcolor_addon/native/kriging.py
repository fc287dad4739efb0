"""The sums that kriging estimates pixels by, in the kernel."""

import numpy as np

from .library import address, check, library, pointer_to

FEATURES = 8


def exponential_sums(features, seeds, weights, control=None):
    """Return, for every pixel, the sums over seeds j of ``weights[j] exp(-|f - f_j|)``.

    Parameters
    ----------
    features : (N, 8) float32
        Of the pixels.
    seeds : (S, 8) float32
        The seeds' features.
    weights : (S, C) float32
        C is 1 to 4.
    control : Control, optional
        Counts pixels.

    Returns
    -------
    (N, C) float32
        Each sum is taken in the order of the seeds, every exponential within 3e-7 of its value.

    Raises
    ------
    Cancelled, ReflcolorError
    """
    features, seeds, weights = (np.ascontiguousarray(array, np.float32) for array in (features, seeds, weights))
    if features.shape[1:] != (FEATURES,) or seeds.shape[1:] != (FEATURES,) or len(weights) != len(seeds):
        shapes = ", ".join(str(array.shape) for array in (features, seeds, weights))
        raise ValueError(f"expected (N, {FEATURES}), (S, {FEATURES}) and (S, C), found {shapes}")
    sums = np.empty((len(features), weights.shape[1]), np.float32)
    if len(features):
        arguments = len(features), address(features), len(seeds), address(seeds), weights.shape[1], address(weights)
        check(library().rc_kriging(*arguments, address(sums), pointer_to(control)))
    return sums
