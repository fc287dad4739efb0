"""One run of the pipeline or of the command line: where its messages go, when it ends, and what it leaves."""

import time
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import Cancelled
from ..files.readers import read_scans
from ..files.readers.options import AS_IT_IS
from ..matching import Matching
from .blender_tasks import BlenderTasks


def _ignore(*_):
    pass


@dataclass(kw_only=True)
class Session:
    """One run: whom it tells, when it ends, and what it leaves.

    Parameters
    ----------
    say : callable
        Called with each line of the result.
    complain : callable
        Called with each line of what is wrong, where it is more than one.
    show : callable
        Called as ``show(fraction, text)`` to show progress.
    cancelled : callable
        Whether the work should end.
    blender : BlenderTasks or None
        What only Blender can do; None without Blender.
    registrations : callable, optional
        Called as ``registrations(job, photo, register)`` where the photo at a path has to be registered on the scan of
        a `ScanJob`; keeps what was found for the next time.
    written : list of Path
        The results that are there, whole; for the message when a later one fails.
    matchings : dict of str to Matching
        How the seeds of each scan were found, by its label.
    left_out : list of str
        Labels of scans that no photo shows, and that were left out for it.
    span : (float, float)
        Where the step at work begins, and which share of the whole it is, for the progress that is shown.
    warnings : list of str
        What is to be said at the end, before the error where there is one.
    """

    say: Callable[[str], None] = _ignore
    complain: Callable[[str], None] = _ignore
    show: Callable[[float, str], None] = _ignore
    cancelled: Callable[[], bool] = bool
    blender: BlenderTasks | None = None
    registrations: Callable | None = None
    written: list[Path] = field(default_factory=list)
    matchings: dict[str, Matching] = field(default_factory=dict)
    left_out: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    span: tuple[float, float] = (0.0, 1.0)

    @property
    def blender_version(self):
        """Blender's version; None without Blender."""
        return None if self.blender is None else self.blender.version

    def progress(self, fraction, text):
        """Show progress; work that can be ended in no other way ends here.

        Raises
        ------
        Cancelled
            If the work should end.
        """
        if self.cancelled():
            raise Cancelled
        begin, share = self.span
        self.show(begin + share * fraction, text)

    def read_scans(self, path, *, outside=False, options=AS_IT_IS):
        """Read all scans of a file, with progress; ``outside`` and ``options`` as in `read_scans`."""
        return read_scans(path, options=options, outside=outside, progress=self.progress, cancelled=self.cancelled)


@contextmanager
def timed(times, name):
    """Add the seconds that the block takes to ``times[name]``."""
    start = time.perf_counter()
    yield
    times[name] = round(times.get(name, 0) + time.perf_counter() - start, 3)
