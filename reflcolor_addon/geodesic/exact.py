"""Equation 1 over all seeds: fields computed by several threads, summed in the order of the seeds."""

from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor, wait
from itertools import islice

from ..errors import Cancelled
from ..messages import Message

_POLL_S = 0.02


class HeldFields:
    """Fields by their seeds' pixels, up to a limit; the least recently used go first.

    Parameters
    ----------
    limit : int
        Bytes.
    """

    def __init__(self, limit):
        self.limit = limit
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
        while self.nbytes > self.limit:
            self.nbytes -= self._fields.popitem(last=False)[1].nbytes

    def clear(self):
        """Drop all fields."""
        self._fields.clear()
        self.nbytes = 0


class SeedProgress:
    """Reports how many seeds are summed and, between them, how far the fields in work are.

    Parameters
    ----------
    progress : callable
    count : int
        Seeds in all.
    held : int
        Seeds whose fields need not be computed.
    pixels : int
        Pixels of a field.
    threads : int
        Fields that are computed at a time.
    """

    def __init__(self, progress, count, held, pixels, threads):
        self._progress, self._count, self._held, self._pixels = progress, count, held, pixels
        self._threads, self._reported = threads, 0

    def __call__(self, summed, settled=0):
        """Report that ``summed`` seeds are done, and ``settled`` pixels in all fields together."""
        # Pixels are settled a little more than once on average, so the fields in work limit what they count for.
        most = min(summed + self._threads, self._count)
        self._reported = max(self._reported, summed, min(self._held + settled / self._pixels, most))
        text = Message("Seed {number} of {count}", number=summed, count=self._count)
        self._progress(self._reported / self._count, text)


def add_fields(engine, blend, seeds, *, threads, held, added, cancelled, working=lambda pixels: None):
    """Add seeds to the sums of eq. 1, in their order, whatever the number of threads.

    A few fields are computed ahead, one in every thread; those that are held are not computed.

    Parameters
    ----------
    engine : NativeEngine or ScipyEngine
    blend : Blend
        The engine's.
    seeds : list of (int, tuple of float)
        Pixel, row * W + column, and values of each.
    threads : int
    held : HeldFields
    added : callable
        Called as ``added(index, field)`` when a seed was added.
    cancelled : callable
        Asked now and then; when it returns True, the work ends.
    working : callable, optional
        Called now and then with the number of pixels settled in all fields so far; the scipy engine counts none.

    Raises
    ------
    Cancelled
        The sums are then of no more use.
    """
    control = engine.control()

    def report():
        working(control.done)

    # One more thread: this one checks for cancellation.
    with ThreadPoolExecutor(threads + 1, "reflcolor") as pool:
        ahead, index = {}, 0
        try:
            while index < len(seeds):
                # Held fields take no further memory, however many are added at once.
                end = index
                fields = []
                while end < len(seeds) and end not in ahead and (field := held.get(seeds[end][0])) is not None:
                    fields.append(field)
                    end += 1
                for other in _missing(seeds, end, held, threads):
                    if other not in ahead:
                        ahead[other] = pool.submit(engine.field, seeds[other][0], control)
                if not fields:
                    fields.append(awaited(ahead.pop(index), control, report, cancelled))
                    end = index + 1
                values = [own for _, own in seeds[index:end]]
                run = pool.map if len(fields) > 1 else map
                summed = pool.submit(blend.add_all, fields, values, control, run)
                awaited(summed, control, report, cancelled)
                for field in fields:
                    held.hold(seeds[index][0], field)
                    added(index, field)
                    index += 1
        except BaseException:
            control.cancel()
            raise


def _missing(seeds, first, held, count):
    """Indices of the next seeds, up to ``count``, whose fields are not held."""
    found = (index for index in range(first, len(seeds)) if held.get(seeds[index][0]) is None)
    return list(islice(found, count))


def awaited(later, control, report, cancelled):
    """The result of a future; meanwhile the caller's own thread asks ``cancelled()`` and reports the progress."""
    while True:
        if cancelled():
            control.cancel()
            wait([later])
            raise Cancelled
        if later in wait([later], _POLL_S).done:
            return later.result()
        report()


def done_apart(control, work, report, cancelled):
    """Return ``work(control)``, run in a thread; meanwhile this one checks for cancellation and reports the
    progress."""
    with ThreadPoolExecutor(1, "reflcolor") as pool:
        later = pool.submit(work, control)
        try:
            return awaited(later, control, lambda: report(control), cancelled)
        except BaseException:
            control.cancel()
            raise
