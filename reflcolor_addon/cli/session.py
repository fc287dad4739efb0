"""What every verb is given besides its arguments."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import Cancelled
from ..files.readers import read_scans
from .blender_door import BlenderDoor
from .console import Console


@dataclass(kw_only=True)
class Session:
    """One run of the command line.

    Parameters
    ----------
    console : Console
    cancelled : callable
        Whether the work should end.
    blender : BlenderDoor or None
        What only Blender can do; None without Blender.
    written : list of Path
        The results that are there, whole; for the message when a later one fails.
    warnings : list of str
        What is to be said when all went well; a failure is the only line of its run.
    """

    console: Console
    cancelled: Callable[[], bool]
    blender: BlenderDoor | None = None
    written: list[Path] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    @property
    def blender_version(self):
        """Blender's version; None without Blender."""
        return None if self.blender is None else self.blender.version

    def progress(self, fraction, text):
        """Show progress; for work that can be told to end by nothing else, this is where it ends.

        Raises
        ------
        Cancelled
            If the work should end.
        """
        if self.cancelled():
            raise Cancelled
        self.console.progress(fraction, text)

    def part(self, number, count, name):
        """Return a `progress` for one of several equal parts, counted from 0, that says which one it is."""
        if count == 1:
            return self.progress
        return lambda fraction, text: self.progress((number + fraction) / count, f"{name}: {text}")

    def read_scans(self, path):
        """Read all scans of a file, with progress; print nothing else."""
        return read_scans(path, progress=self.progress, cancelled=self.cancelled)
