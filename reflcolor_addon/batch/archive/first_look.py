"""A first look at whether a photo may show a scan, for a few hundredths of what registering it takes."""

import numpy as np

from ...matching.registration.search import Search


def first_look(views, photo, step=lambda: None):
    """Return how much speaks for a photo on a scan at the first look.

    Every direction from the scanner's place is tried, and nothing is fitted: on coarse tiles a wrong camera can be
    fitted as well as a right one, while correlation with the whole map tells them apart. What this gives is good to put
    photos in an order, never to believe one: matching decides. A scan with much detail has higher scores with every
    photo, so scores of one scan are to be compared with its usual one.

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
        The score of the best `Guess`; 0 where nothing can be told.
    """
    if views.untestable is not None or np.ptp(photo.gray) == 0:
        return 0.0
    return float(max(Search(views, photo).likeness(step), 0.0))
