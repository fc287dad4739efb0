"""What is asked of the virtual scanner on the command line."""

from dataclasses import dataclass
from pathlib import Path

from .virtual_scanner import ScannerModel


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
