"""A first look at whether a photo may show a scan, for a few hundredths of what registering it takes."""

import numpy as np

from ...matching.registration.fitting import refined
from ...matching.registration.search import Search

# Lengths of the photo's longer side; one step of the search's own list is covered from one to the next.
_FOCALS = (0.62, 0.8, 1.04)
# Maps twice as coarse as the search's own are enough where their pixels are not larger than so many degrees.
_COARSER, _COARSEST_DEG = 2, 0.75
_GUESSES = 5
# As a place aside is refined at first: pixels, tile, radius, blur and spread.
_LEVEL = (1.3, 24, 10, 1.5, 1.2)


def first_look(views, photo, step=lambda: None):
    """Return how much speaks for a photo on a scan at the first look.

    Only directions from about the scanner's place are tried, on coarse maps; the best guesses are fitted once on coarse
    tiles. What this gives is good to put photos in an order, never to believe one: matching decides.

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
        The strength of the best guess (see `Evidence.strength`) times the correlation that it was found by: either
        alone misses photos that the other finds. 0 where nothing can be told.
    """
    if views.untestable is not None or np.ptp(photo.gray) == 0:
        return 0.0
    rng, best = np.random.default_rng(0), 0.0
    coarser = _COARSER if views.step_deg * _COARSER <= _COARSEST_DEG else 1
    for guess in Search(views, photo).roughly(_FOCALS, coarser, step)[:_GUESSES]:
        step()
        camera = guess.camera(photo)
        _, proof = refined(views, photo, camera, [_LEVEL], free=camera.POSE, rng=rng)
        best = max(best, proof.strength * max(guess.score, 0.0))
    return float(best)
