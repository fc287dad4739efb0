"""Estimates the memory of a whole run before its work begins: matching, colors, meshes, pictures."""

from pathlib import Path

from ..color.spreader import bytes_of_colorizing
from ..errors import ReflcolorError
from ..files.images import image_size
from ..files.memory import available_bytes, readable
from ..messages import Message
from ..view.thinned_scan import thinning_step
from .plan import MESH, RENDER, SCANS, SCENE

# Peak bytes of each step, in addition to the loaded scans; docs/reliability.md describes how they were measured. For
# each pixel of a scan:
_RESULT = 16
_LIGHT_MESH = 1600
_WRITING = {MESH: 60, SCANS: 60, SCENE: 300, RENDER: 700}
# Photos are matched on a smaller grid of limited size; the scan's own grid is needed as well.
_MATCHING, _MATCHING_MOST, _MATCHING_ALWAYS = 2400, 550e6, 130
# For each pixel of a photo: in memory, and while it is decoded.
_PHOTO, _DECODING = 3, 9
_SOME_SEEDS = 2000
"""Assumed number of seeds while they are not known yet."""


def require_run(plan, jobs):
    """Refuse a run that cannot fit into memory, when its scans are read and before anything else is done.

    Parameters
    ----------
    plan : Plan
    jobs : list of ScanJob

    Raises
    ------
    ReflcolorError
        In one line: what is needed, by which step, and what is free.
    """
    steps = {}
    if plan.seeds is None and plan.from_color is None and plan.colors is None:
        steps[Message("finding seeds")] = bytes_of_matching(jobs, plan.photos)
    pixels = [job.opened().valid.size for job in jobs]
    if plan.needs_colors:
        kept = _RESULT * sum(pixels)
        if plan.colors is None:
            steps[Message("colorizing")] = kept + max(_colorizing(job, plan.settings) for job in jobs)
        if plan.needs_light_mesh:
            steps[Message("making the mesh lighter")] = kept + max(
                bytes_of_light_mesh(job.opened().shape, plan.faces) for job in jobs
            )
        for output in plan.outputs:
            if plan.faces is not None and output.has_mesh:
                continue
            together = max(pixels) if output.is_of_each else sum(pixels)
            steps[Message("writing {name}", name=output.path.name)] = kept + _WRITING.get(output.kind, 0) * together
    _require(steps, ", ".join(dict.fromkeys(str(path) for path in plan.scans)))


def require_matching(jobs, photos):
    """The same for finding seeds alone."""
    _require({Message("finding seeds"): bytes_of_matching(jobs, photos)}, ", ".join(job.name for job in jobs))


def require_objects(scans, path):
    """The same for making objects of the scans of a file in Blender."""
    _require({Message("making meshes"): _WRITING[SCENE] * sum(scan.valid.size for scan in scans)}, path.name)


def require_light_mesh(scan, faces):
    """The same for making the mesh of a Scan lighter."""
    _require({Message("making the mesh lighter"): bytes_of_light_mesh(scan.shape, faces)}, scan.name)


def bytes_of_light_mesh(shape, faces):
    """What making a mesh of so many faces takes at its worst moment."""
    height, width = shape
    return _LIGHT_MESH * height * width / thinning_step(shape, faces) ** 2


def bytes_of_matching(jobs, photos):
    """What finding seeds takes at its worst moment.

    Parameters
    ----------
    jobs : list of ScanJob
    photos : sequence
        As `match_site` takes them. Photos inside an E57 are held against the memory when each is read.

    Raises
    ------
    ImageError
        If a photo is none.
    """
    sizes = [_photo_pixels(photo) for photo in photos]
    # Scans are matched one after the other; the results of each are kept.
    return bytes_of_pixels(max(job.opened().valid.size for job in jobs), sizes)


def bytes_of_pixels(largest, sizes):
    """The same for a scan of so many pixels, and photos of so many."""
    sought = min(_MATCHING * largest, _MATCHING_MOST) + _MATCHING_ALWAYS * largest
    return _PHOTO * sum(sizes) + max(sought, _DECODING * max(sizes, default=0))


def _photo_pixels(photo):
    if isinstance(photo, str | Path):
        height, width = (0, 0) if Path(photo).suffix.lower() == ".e57" else image_size(photo)
        return height * width
    pixels = photo[1] if isinstance(photo, tuple) else getattr(photo, "rgb", photo)
    return pixels.shape[0] * pixels.shape[1]


def _colorizing(job, settings):
    if job.colorization is not None:
        return 0
    return bytes_of_colorizing(job.opened().shape, _SOME_SEEDS if job.seeds is None else len(job.seeds), settings)


def _require(steps, what):
    available = available_bytes()
    step, needed = max(steps.items(), key=lambda item: item[1], default=("", 0))
    if available is not None and needed > available:
        raise ReflcolorError(
            "{what}: {step} needs about {needed} of memory, and {free} are free; read every second row and column "
            "(step 2), or fewer scans at once",
            what=what,
            needed=readable(needed),
            step=step,
            free=readable(available),
        )
