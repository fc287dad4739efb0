"""Two looks at whether a photo may show a scan, for a few hundredths of what registering it takes.

They are good to put pairs in an order, never to believe one: matching decides.
"""

from dataclasses import astuple

import numpy as np

from ...matching.registration.fitting import COARSE, MIDDLE, refined
from ...matching.registration.search import Search
from ...matching.registration.sphere_map import Guess
from ...matching.scan_image import pixel_steps

_GUESSES, _FINER = 6, 2
# The pixels that directions are told by, in degrees: smaller ones take longer and hardly help. But so many must be left
# across, and so many of the scan's rows and columns: a spinning lidar has few, and tells nothing if they are averaged.
_STEP_DEG, _LEAST_ACROSS, _LEAST_ROWS = 0.6, 90, 60
# As a camera aside is fitted: pixels, tile, radius, blur and spread, on the coarse level and on the middle one.
_ROUGHLY, _CLOSER = (*COARSE, 10, 1.5, 1.2), (*MIDDLE, 10, 1.0, 0.8)


def coarseness(views):
    """Return how many times as large as in matching the pixels are that a scan is looked at with.

    Parameters
    ----------
    views : ScanViews

    Returns
    -------
    int
    """
    extent = max(length * step for length, step in zip(views.scan.shape, pixel_steps(views.scan), strict=True))
    across = extent / views.step_deg
    most = min(int(across / _LEAST_ACROSS), min(views.scan.shape) // _LEAST_ROWS)
    return max(1, min(round(_STEP_DEG / views.step_deg), most))


def first_look(views, photo, step=lambda: None):
    """Return how well the best direction from the scanner's place correlates.

    A scan with much detail correlates better with every photo, so this is to be compared with what is usual for it.

    Parameters
    ----------
    views : ScanViews
    photo : PhotoImage
        It may be small: 640 pixels a side will do.
    step : callable
        Called now and then; may raise to end the work.

    Returns
    -------
    score : float
        0 where nothing can be told.
    directions : list of list
        The best ones, which can be written as JSON; see `second_look`.
    """
    guesses = []
    if views.untestable is None and np.ptp(photo.gray) > 0:
        guesses = Search(views, photo).directions(step, coarser=coarseness(views))[:_GUESSES]
    directions = [[*map(float, astuple(guess)[:-1]), list(map(float, guess.center))] for guess in guesses]
    return max(directions[0][0], 0.0) if directions else 0.0, directions


def second_look(views, photo, directions, step=lambda: None):
    """Return how much speaks for the best of a few directions once a camera was fitted to tiles of the scan from each.

    The camera may move away from the scanner's place, as most photos are taken beside it. All directions are fitted
    on large pixels, and those that fit best there on smaller ones. Unlike what `first_look` returns, this can be
    compared between scans. It takes about as long.

    Parameters
    ----------
    views, photo, step
        As `first_look`.
    directions : list of list
        What that returned.

    Returns
    -------
    float
        See `Evidence.strength`; 0 where nothing can be told.
    """
    rng, tried = np.random.default_rng(0), []
    for *numbers, center in directions:
        step()
        camera = Guess(*numbers, tuple(center)).camera(photo)
        moved, proof = refined(views, photo, camera, [_ROUGHLY], free=camera.POSE, rng=rng)
        tried.append((proof.strength, camera if moved is None else moved))
    best = 0.0
    for _, camera in sorted(tried, key=lambda pair: -pair[0])[:_FINER]:
        step()
        _, proof = refined(views, photo, camera, [_CLOSER], free=camera.POSE, rng=rng)
        best = max(best, proof.strength)
    return float(best)
