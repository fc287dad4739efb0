"""Two looks at whether a photo may show a scan, for a few hundredths of what registering it takes.

They are good to put pairs in an order, never to believe one: matching decides.
"""

import numpy as np

from ...matching.registration.fitting import refined
from ...matching.registration.search import Search
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
    float
        0 where nothing can be told.
    """
    guesses = _guesses(views, photo, step)
    return float(max(guesses[0].score, 0.0)) if guesses else 0.0


def second_look(views, photo, step=lambda: None):
    """Return how much speaks for the best of a few directions once tiles of the scan were fitted to each.

    Unlike what `first_look` returns, this can be compared between scans. It takes about twice as long.

    Parameters
    ----------
    views, photo, step
        As `first_look`.

    Returns
    -------
    float
        See `Evidence.strength`; 0 where nothing can be told.
    """
    rng, best = np.random.default_rng(0), 0.0
    for guess in _guesses(views, photo, step)[:_GUESSES]:
        step()
        camera = guess.camera(photo)
        _, proof = refined(views, photo, camera, [_LEVEL], free=camera.ROTATION, rng=rng)
        best = max(best, proof.strength)
    return float(best)


def _guesses(views, photo, step):
    if views.untestable is not None or np.ptp(photo.gray) == 0:
        return []
    return Search(views, photo).directions(step)
