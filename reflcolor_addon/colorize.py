"""Method 1 of the paper: from a scan and seeds to a color at every pixel."""

from .colorizer import Colorizer


def colorize(scan, seeds, settings=None, *, progress=None, cancelled=None):
    """Colorize a scan from seeds: eq. 1, 2, 5 and 6.

    Parameters
    ----------
    scan : Scan
    seeds : Seeds
    settings : Settings, optional
        The paper's by default.
    progress : callable, optional
        Called as ``progress(fraction, text)`` with a fraction of 0 to 1.
    cancelled : callable, optional
        Asked now and then; when it returns True, the work ends.

    Returns
    -------
    Colorization

    Raises
    ------
    SeedsError
        If there are no seeds, or one is outside the grid.
    ReflcolorError
        If the memory that is free will not do.
    Cancelled
        If ``cancelled()`` returned True.
    """
    # Nothing is colorized a second time, so no field needs to be kept.
    return Colorizer(scan, settings, memory=0).colorize(seeds, progress=progress, cancelled=cancelled)
