"""Equation 1 over all seeds: fields computed by several threads, summed in the order of the seeds."""

from collections import OrderedDict, deque
from concurrent.futures import ThreadPoolExecutor, wait

from .errors import Cancelled

_POLL_S = 0.02


class HeldFields:
    """Fields by their seeds' pixels, up to a limit; the least recently used go first.

    Parameters
    ----------
    limit : int
        Bytes.
    """

    def __init__(self, limit):
        self._limit = limit
        self._fields = OrderedDict()
        self.nbytes = 0

    def get(self, pixel):
        """Return the field of a pixel, or None."""
        return self._fields.get(pixel)

    def hold(self, pixel, field):
        """Keep a field as the most recently used one."""
        if pixel not in self._fields:
            self.nbytes += field.nbytes
        self._fields[pixel] = field
        self._fields.move_to_end(pixel)
        while self.nbytes > self._limit:
            self.nbytes -= self._fields.popitem(last=False)[1].nbytes

    def clear(self):
        """Drop all fields."""
        self._fields.clear()
        self.nbytes = 0


def add_fields(engine, blend, seeds, *, threads, held, added, cancelled):
    """Add seeds to the sums of eq. 1, in their order, whatever the number of threads.

    A few fields are computed ahead, one in every thread; those that are held are not computed.

    Parameters
    ----------
    engine : NativeEngine or ScipyEngine
    blend : Blend
        The engine's.
    seeds : list of (int, (float, float))
        Pixel, row * W + column, and chrominance of each.
    threads : int
    held : HeldFields
    added : callable
        Called as ``added(index, field)`` when a seed was added.
    cancelled : callable
        Asked now and then; when it returns True, the work ends.

    Raises
    ------
    Cancelled
        The sums are then of no more use.
    """
    control = engine.control()

    def field_of(pixel):
        field = held.get(pixel)
        return engine.field(pixel, control) if field is None else field

    # One thread more for the sums: this one is to ask whether it should go on.
    with ThreadPoolExecutor(threads + 1, "reflcolor") as pool:
        ahead = deque()
        try:
            for index, (pixel, color) in enumerate(seeds):
                while len(ahead) < threads and index + len(ahead) < len(seeds):
                    ahead.append(pool.submit(field_of, seeds[index + len(ahead)][0]))
                field = awaited(ahead.popleft(), control, lambda: None, cancelled)
                awaited(pool.submit(blend.add, field, color, control), control, lambda: None, cancelled)
                held.hold(pixel, field)
                added(index, field)
        except BaseException:
            control.cancel()
            raise


def awaited(later, control, tell, cancelled):
    """The result of a future; the caller's own thread asks ``cancelled()`` and tells the progress meanwhile."""
    while True:
        if cancelled():
            control.cancel()
            wait([later])
            raise Cancelled
        if later in wait([later], _POLL_S).done:
            return later.result()
        tell()
