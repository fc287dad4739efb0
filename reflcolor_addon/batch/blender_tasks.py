"""Tasks that need Blender, passed in by the caller: the core itself does not import it."""

from collections.abc import Callable
from dataclasses import dataclass

from ..errors import UsageError


@dataclass(frozen=True, kw_only=True)
class BlenderTasks:
    """What Blender does for a run.

    Parameters
    ----------
    version : str
        Blender's, for the report.
    write_scene : callable
        Called as ``write_scene(jobs, paths, render, picture, progress)`` with an iterable of colorized `ScanJob`, each
        to become an object that keeps its report, the .blend and .usd files to write, the file of the picture to render
        or None, and the `Picture` that says how it looks; raises OutputError.
    decimate : callable
        As `light_mesh` takes it.
    simulate : callable
        Called as ``simulate(request, progress, written)`` with a `SimulationRequest`; adds every file that it wrote to
        the list ``written``. Raises ReflcolorError, and UsageError where something that was asked for is not in the
        scene, or two files would have the same name.
    read_provenance : callable
        Called as ``read_provenance(path)`` with a .blend; returns a list of (name, text) of the objects in it that are
        scans: text is the report as JSON, or None. Raises ReflcolorError.
    command : tuple of str, optional
        What starts this command line in another Blender like this one; arguments follow.
    """

    version: str
    write_scene: Callable
    decimate: Callable
    simulate: Callable
    read_provenance: Callable
    command: tuple[str, ...] | None = None


def require_blender(blender, what):
    """Raise UsageError where ``blender`` is None: what was asked for can be had in Blender only."""
    if blender is None:
        raise UsageError("{what} needs Blender; run the same as: blender -b --command reflcolor ...", what=what)
