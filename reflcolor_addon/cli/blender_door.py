"""What the command line can do in Blender only, handed to it from there: the core itself knows no Blender."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..simulation.virtual_scanner import ScannerModel


@dataclass(frozen=True, kw_only=True)
class BlenderDoor:
    """Blender, as far as the command line needs it.

    Parameters
    ----------
    version : str
        Blender's, for the report.
    write_scene : callable
        Called as ``write_scene(results, paths, render, progress)`` with an iterable of (scan, colorization, report
        without how long it took), each to become an object, the .blend, .glb and .ply files to write, and the picture
        to render or None; raises OutputError.
    simulate : callable
        Called as ``simulate(request, progress, written)`` with a `SimulationRequest`; adds every file that it wrote to
        the list ``written``. Raises ReflcolorError, and UsageError where something that was asked for is not in the
        scene, or two files would have the same name.
    read_provenance : callable
        Called as ``read_provenance(path)`` with a .blend; returns a list of (name, text) of the objects in it that are
        scans: text is the report as JSON, or None. Raises ReflcolorError.
    """

    version: str
    write_scene: Callable
    simulate: Callable
    read_provenance: Callable


@dataclass(frozen=True, kw_only=True)
class SimulationRequest:
    """A scene to scan with the virtual scanner, as it was asked for.

    Parameters
    ----------
    scene : Path
        The .blend.
    output : Path
        The scan: .ptx, .e57 or .scan.json; what else is written goes beside it, named after it.
    model : ScannerModel
    camera, item : str or None
        The camera, or another object, that the scanner stands at; both None: the camera of the scene.
    truth : bool
        Write the true color of every pixel of the scan.
    photos : bool
        Take a photo from every other camera of the scene.
    photo_samples : int
        Light paths for each pixel of a photo.
    own_look : bool
        Give each photo an exposure, white balance, lens distortion and noise of its own.
    """

    scene: Path
    output: Path
    model: ScannerModel
    camera: str | None = None
    item: str | None = None
    truth: bool = False
    photos: bool = False
    photo_samples: int = 32
    own_look: bool = True
