"""Whether the packages that the extension brings along are there."""

import time

from ...reflcolor_addon.bundled import missing_packages

_FRESH_S = 2.0
_seen = (0.0, ())


def missing():
    """Return the names of those that are gone; quick enough to be asked whenever a panel is drawn."""
    global _seen
    if time.monotonic() - _seen[0] > _FRESH_S:
        _seen = time.monotonic(), tuple(missing_packages())
    return _seen[1]
