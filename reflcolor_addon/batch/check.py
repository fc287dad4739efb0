"""Checks a plan before the work begins, so that errors are found here and not at its end."""

from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from ..errors import ReflcolorError, SeedsError, UsageError
from ..files.photo_files import photos_of
from ..files.readers.e57_photos import photos_inside
from ..files.writers.glb import check_glb_size
from ..messages import Message
from ..seeds.seeds import Seeds
from .blender_tasks import require_blender
from .paths import output_faults, photo_files, scan_files
from .plan import MESH, PLACEHOLDER, RESULT_SUFFIXES, SCENE
from .scan_job import require_reflectance, surface_of

ALL = "all"


def _raise(fault):
    raise fault


@dataclass(frozen=True)
class Given:
    """What was loaded while a plan was checked: seeds that are the same for every scan.

    Parameters
    ----------
    seeds, hand : Seeds or None
        None where there are none, or each scan has its own.
    warnings : list of str
    """

    seeds: Seeds | None = None
    hand: Seeds | None = None
    warnings: list[str] = field(default_factory=list)


def check_plan(plan, blender=None, *, refuse=_raise):
    """Check everything that can be checked before a scan is read.

    Parameters
    ----------
    plan : Plan
    blender : BlenderTasks or None
    refuse : callable
        Given an error for each thing that is wrong, in turn. By default the first is raised; whoever wants to name all
        of them keeps them, and does not run the plan.

    Returns
    -------
    Given
    """
    given = plan.seeds is not None or plan.from_color is not None or plan.colors is not None
    if not (given or plan.photos or plan.skip_unshown):
        refuse(
            UsageError("--seeds or --photo: give seeds, or photos to find them in{inside}", inside=_inside(plan.scans))
        )
    _check_choice(plan, refuse)
    for output in plan.outputs:
        if output.needs_blender:
            _attempt(refuse, require_blender, blender, f"{output.option} {output.path}")
    _attempt(refuse, check_has_mesh, plan)
    if plan.needs_light_mesh:
        _attempt(refuse, require_blender, blender, f"--faces {plan.faces}")
    check_placeholder(plan, len(plan.scans), refuse)
    warnings, seeds, hand = [], None, None
    if plan.seeds is not None and PLACEHOLDER not in str(plan.seeds):
        seeds = _attempt(refuse, load_seeds, plan.seeds, plan.photos)
        if seeds is not None:
            _attempt(refuse, check_photos, plan.photos, [seeds], warnings)
    if plan.hand is not None and PLACEHOLDER not in str(plan.hand):
        hand = _attempt(refuse, Seeds.load, plan.hand, plan.photos)
    known = [(output.option, output.path) for output in plan.outputs if PLACEHOLDER not in str(output.path.parent)]
    read = inputs_of(plan, plan.scans, plan.seeds, seeds) + [("hand", plan.hand)] * (plan.hand is not None)
    for fault in output_faults(known, [path for _, path in read]):
        refuse(fault)
    return Given(seeds, hand, warnings)


def check_has_mesh(plan):
    """Raise UsageError if a plan is to have few faces, but writes nothing that has any."""
    if plan.faces is not None and not plan.needs_light_mesh:
        known = (suffix for suffix, kind in RESULT_SUFFIXES.items() if kind in (MESH, SCENE))
        raise UsageError(
            "--faces {count}: none of the outputs has a mesh; write one of {known}, or leave it out",
            count=plan.faces,
            known=", ".join(known),
        )


def _inside(scans):
    """A hint to the photos that scan files have inside; empty where there are none."""
    for path in scans:
        with suppress(ReflcolorError):
            if count := sum(photo.usable for photo in photos_inside(path)):
                return Message(
                    "; {file} holds {count} of its own: --photo {path}", file=path.name, count=count, path=path
                )
    return ""


def check_jobs(plan, jobs, *, refuse=_raise):
    """Check the rest, now that the scans are known; after this only memory and the disk can fail.

    Parameters
    ----------
    plan : Plan
    jobs : list of ScanJob
    refuse : callable
        As `check_plan`.
    """
    check_placeholder(plan, len(jobs), refuse)
    for job in jobs:
        _attempt(refuse, require_reflectance, job)
    outputs = [output.of(job.label) for output in plan.outputs for job in jobs]
    read = [path for job in jobs for _, path in job.inputs]
    named = dict.fromkeys((output.option, output.path) for output in outputs)
    for fault in output_faults(list(named), read):
        refuse(fault)
    for output in plan.outputs:
        if output.path.suffix.lower() == ".glb":
            together = [[job] for job in jobs] if output.is_of_each else [jobs]
            for group in together:
                surfaces, path = [surface_of(job) for job in group], output.of(group[0].label).path
                _attempt(refuse, partial(check_glb_size, faces=plan.faces), surfaces, path)


def check_placeholder(plan, count, refuse=_raise):
    """Refuse paths that are the same for several scans where each needs its own."""
    for option, path in plan.paths_of_each() if count > 1 else ():
        if PLACEHOLDER not in str(path):
            refuse(
                UsageError(
                    "{option} {path}: each of several scans has its own; "
                    "write {placeholder} where its name is to stand, as in {example}",
                    option=option,
                    path=path,
                    placeholder=PLACEHOLDER,
                    example=path.with_name(f"{PLACEHOLDER}_{path.name}"),
                )
            )


def load_seeds(path, photos):
    """Return the seeds of a file.

    Raises
    ------
    SeedsError
        If it cannot be used, or holds none.
    """
    seeds = Seeds.load(path, photos)
    if len(seeds) == 0:
        raise SeedsError("{path}: holds no seeds; give at least one pixel with a color", path=path)
    return seeds


def check_photos(photos, given, warnings):
    """Check that every photo is an image; warn about photos that no seed names."""
    named = {Path(name).name for seeds in given for name in seeds.photos if name}
    for path in photos:
        if not named & {photo.name for photo in photos_of(path, warnings)}:
            warnings.append(Message("{path}: no seed names this photo", path=path))


def check_place(seeds, path, scan):
    """Raise SeedsError, naming their file, where seeds do not lie on a scan."""
    try:
        seeds.placed_on(scan)
    except SeedsError as error:
        raise SeedsError(
            "{path}: {problem}; expected seeds of the scan {scan}", path=path, problem=error.message, scan=scan.name
        ) from error


def inputs_of(plan, scan_paths, seeds_path=None, seeds=None):
    """Return (role, path) of every file that colors come from; ``seeds`` is None where they are not known yet."""
    inputs = [("scan", file) for path in scan_paths for file in scan_files(path)]
    if seeds_path is None or seeds is None:
        return inputs + [("photo", path) for path in dict.fromkeys(plan.photos)]
    photos = photo_files(seeds, seeds_path, plan.photos)
    return [*inputs, ("seeds", seeds_path), *(("photo", path) for path in photos)]


def _check_choice(plan, refuse):
    resolved = [path.resolve() for path in plan.scans]
    for place, path in enumerate(plan.scans):
        if resolved[place] in resolved[:place]:
            refuse(UsageError("{path}: is given twice; give every file once", path=path))
    if len(plan.scans) > 1 and plan.wanted not in (None, ALL):
        refuse(
            UsageError(
                "--scan {wanted}: chooses a scan of one file, but {count} are given; leave it out to take every scan",
                wanted=plan.wanted,
                count=len(plan.scans),
            )
        )


def _attempt(refuse, act, *arguments):
    try:
        return act(*arguments)
    except (ReflcolorError, UsageError) as error:
        refuse(error)
        return None
