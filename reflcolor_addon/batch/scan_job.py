"""One scan on its way through the pipeline."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..color.colorization import Colorization
from ..color.observed import Observed
from ..errors import ScanError
from ..matching import Matching
from ..scan.light_mesh import LightMesh
from ..scan.scan import Scan
from ..scan.surface import ScanSurface
from ..seeds.seeds import Seeds
from .plan import Output


@dataclass(eq=False, kw_only=True)
class ScanJob:
    """A scan with all that belongs to it; every step of the pipeline adds its part.

    Parameters
    ----------
    name : str
        No other scan of the run has it.
    scan : Scan or callable
        Or a function without arguments that returns it, for a scan that is made when its turn comes. None when nothing
        needs it any more.
    label : str
        The name made safe for a file name; no other scan's is the same, not even in capitals.
    path : Path, optional
        The scan's file.
    index : int, optional
        Its place in the file, from 1.
    seeds : Seeds, optional
        What colors it, as given or found.
    observed : Observed or callable, optional
        What verified photos saw of it; or a function without arguments that returns it, or None. None when nothing
        needs it any more.
    hand, kept : Seeds, optional
        Seeds picked by hand, and seeds that stay, where others are found; see `match_photos`.
    inputs : list of (str, Path)
        What for, and the file.
    outputs : list of Output
        Those of this scan alone.
    matching : Matching, optional
        How its seeds were found.
    colorization : Colorization, optional
    texture : (h, w, 3) uint8, optional
        The same as an image on the scan's grid, see `matching.texture`, which meshes show instead of their vertices'.
    light : LightMesh, optional
        What meshes show instead of the scan's own.
    report : dict, optional
    times : dict
        Seconds that each step took.
    """

    name: str
    scan: Scan | Callable[[], Scan] | None
    label: str = ""
    path: Path | None = None
    index: int | None = None
    seeds: Seeds | None = None
    observed: Observed | Callable[[], Observed | None] | None = None
    hand: Seeds | None = None
    kept: Seeds | None = None
    inputs: list[tuple[str, Path]] = field(default_factory=list)
    outputs: list[Output] = field(default_factory=list)
    matching: Matching | None = None
    colorization: Colorization | None = None
    texture: np.ndarray | None = None
    light: LightMesh | None = None
    report: dict | None = None
    times: dict[str, float] = field(default_factory=dict)

    def opened(self):
        """Return the scan, which is there from now on."""
        if callable(self.scan):
            self.scan = self.scan()
        return self.scan

    def let_go(self):
        """Drop the larger arrays, which nothing needs any more."""
        self.scan = self.observed = self.colorization = self.texture = self.light = None

    def seen(self):
        """Return what photos saw, which is there from now on, or None."""
        if callable(self.observed):
            self.observed = self.observed()
        return self.observed


def surface_of(job):
    """Return the surface of a job's scan as it is written into meshes; without colors as long as there are none."""
    if job.colorization is None:
        return ScanSurface(job.scan, None)
    values, textured = job.colorization.values, job.texture is not None
    if job.light is not None:
        return job.light.surface(job.colorization.rgb, values, split_seam=textured)
    return ScanSurface(job.scan, job.colorization.rgb, values, split_seam=textured)


def require_reflectance(job):
    """Raise ScanError if a job's scan has no reflectance, without which no color can spread."""
    if not job.opened().has_reflectance:
        raise ScanError(
            "{scan}: its reflectance is the same everywhere, so that there is nothing to colorize it by; export it "
            "with intensity, or with colors",
            scan=job.name,
        )
