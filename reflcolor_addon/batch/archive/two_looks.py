"""Two looks at whether a photo may show a scan, for a few hundredths of what registering it takes.

They are good to put pairs in an order, never to believe one: matching decides.
"""

from dataclasses import astuple

import numpy as np

from ...matching.registration.fitting import refined
from ...matching.registration.search import Search
from ...matching.registration.sphere_map import Guess
from ...matching.registration.verification import RADIUS, TILE

_GUESSES = 6
# As a direction from the scanner's place is fitted first: pixels, tile, radius, blur and spread.
_LEVEL = (0.6, TILE, RADIUS, 2.0, 0.5)


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
        guesses = Search(views, photo).directions(step)[:_GUESSES]
    directions = [[*map(float, astuple(guess)[:-1]), list(map(float, guess.center))] for guess in guesses]
    return max(directions[0][0], 0.0) if directions else 0.0, directions


def second_look(views, photo, directions, step=lambda: None):
    """Return how much speaks for the best of a few directions once tiles of the scan were fitted to each.

    Unlike what `first_look` returns, this can be compared between scans. It takes about half as long.

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
    rng, best = np.random.default_rng(0), 0.0
    for *numbers, center in directions:
        step()
        camera = Guess(*numbers, tuple(center)).camera(photo)
        _, proof = refined(views, photo, camera, [_LEVEL], free=camera.ROTATION, rng=rng)
        best = max(best, proof.strength)
    return float(best)
