"""The one way from files to files: plan, check, session, write.

The command line and batches run a whole `Plan`. Blender's operators make jobs from what is in the scene and take the
same steps; they read and write the scene instead of files.
"""

from dataclasses import replace

import numpy as np

from ..color.colorization import Colorization
from ..color.colorizer import colorize
from ..errors import ScanError, SeedsError
from ..files.images import read_image
from ..files.memory import give_back
from ..matching import colors_of_texture, grid_texture, match_site, shots_of, texture, texture_shape
from ..matching.site import NO_SEEDS
from ..messages import Message, about_scan, value_of
from ..progress import part
from ..seeds.scan_colors import seeds_from_color
from ..seeds.seeds import Seeds
from ..view.fewer_faces import few_faces_missed, light_mesh
from .check import check_plan
from .memory import require_matching, require_run
from .plan import filled
from .read import read_jobs
from .scan_job import require_reflectance
from .session import timed
from .write import pictured, write_uncolored, writing

# Where reading and matching begin, and which share of a run they are, roughly; the rest is coloring and writing.
_READING, _MATCHING = (0.0, 0.1), (0.1, 0.7)


def run_plan(plan, session):
    """Do all that a plan asks for.

    Parameters
    ----------
    plan : Plan
    session : Session
        Its lists tell afterwards, and after a failure, what was written and what is to be said.

    Raises
    ------
    UsageError
        If the plan cannot mean anything.
    ReflcolorError
        If an input cannot be used, or an output cannot be written.
    Cancelled
        If ``session.cancelled()`` returned True.
    """
    times = {}
    with timed(times, "seeds"):
        given = check_plan(plan, session.blender)
    session.warnings += given.warnings
    session.span = _READING
    opened = []
    with pictured(plan, opened):
        jobs = read_jobs(plan, given, session, times, opened)
        for job in jobs:
            session.warnings += job.scan.warnings
        _run_jobs(plan, jobs, times, session)


def _run_jobs(plan, jobs, times, session):
    """Find the seeds of jobs whose scans were read, color them, and write what the plan asks for."""
    require_run(plan, jobs)
    if plan.colors is not None:
        _take_colors(jobs, plan)
    elif plan.from_color is not None:
        with timed(times, "seeds"):
            for job in jobs:
                job.seeds = seeds_from_color(job.opened(), plan.from_color)
    elif plan.seeds is None:
        # The time to find a file of seeds is not counted.
        del times["seeds"]
        if plan.photos:
            session.span = _MATCHING
            with timed(times, "match"):
                find_seeds(
                    jobs,
                    plan.photos,
                    plan.settings,
                    registered=_registered(jobs, plan, session),
                    progress=session.progress,
                    cancelled=session.cancelled,
                )
            give_back()
            session.matchings |= {job.label: job.matching for job in jobs}
            _report_matching(jobs, plan, session)
        jobs = _shown(jobs, plan, session)
    count, begin = len(jobs), sum(session.span)
    session.span = begin, 1.0 - begin
    with writing(plan, jobs, session) as write:
        for number in range(count):
            job = jobs.pop(0)
            job.times |= times
            if plan.needs_colors:
                with timed(job.times, "colorize"):
                    progress = part(session.progress, number, count, job.name)
                    colorize_job(job, plan.settings, progress=progress, cancelled=session.cancelled)
                give_back()
                if plan.texture and job.texture is None:
                    with timed(job.times, "texture"):
                        _add_texture(job, plan, progress, session.cancelled)
                if plan.needs_light_mesh:
                    with timed(job.times, "faces"):
                        _add_light_mesh(job, plan, session, progress)
                session.warnings += _named(job, count, job.colorization.warnings)
            write(job)


def _take_colors(jobs, plan):
    """Give each scan the colors of an image that was made from it before."""
    for job in jobs:
        path = filled(plan.colors, job.label)
        rgb, shape = read_image(path), job.scan.shape
        expected = texture_shape(job.scan, plan.texture) if plan.texture else shape
        if rgb.shape[:2] != expected:
            raise ScanError(
                "{file}: has {width} x {height} pixels, expected {columns} x {rows} as the scan {scan} has",
                file=path,
                width=rgb.shape[1],
                height=rgb.shape[0],
                columns=expected[1],
                rows=expected[0],
                scan=job.name,
            )
        if plan.texture:
            job.texture, rgb = rgb, colors_of_texture(job.scan, rgb)
        job.seeds = Seeds(rows=[], cols=[], rgb=np.zeros((0, 3), np.uint8))
        job.colorization = Colorization(
            rgb=rgb,
            confidence=np.zeros(shape, np.float32),
            nearest_seed=np.full(shape, -1, np.int32),
            observed=np.zeros(shape, np.float32),
            photo=np.full(shape, -1, np.int16),
            seeds=job.seeds,
            normalization={"reflectance": (0.0, 0.0), "range": (0.0, 0.0)},
        )


def _report_matching(jobs, plan, session):
    # The error that follows is about the first.
    failing = next((job for job in jobs if not plan.skip_unshown and _lacks_seeds(job)), None)
    for job in jobs:
        warnings = job.matching.warnings
        if plan.skip_unshown and plan.hand is None:
            # Most photos of an archive show other scans, which their notes say.
            refused = {photo.name for photo in job.matching.photos if not photo.verified}
            warnings = [line for line in warnings if value_of(line, "photo") not in refused]
        if job is failing:
            warnings = [line for line in warnings if getattr(line, "template", None) != NO_SEEDS]
        session.warnings += _named(job, len(jobs), warnings)
        notes = [Message("{photo}: {note}", photo=photo.name, note=photo.note) for photo in job.matching.photos]
        for line in _named(job, len(jobs), notes):
            session.say(line)


def _named(job, count, lines):
    """Lines that say which scan they are about, where there are several."""
    return [about_scan(line, job.name) for line in lines] if count > 1 else lines


def _registered(jobs, plan, session):
    """What `find_seeds` asks for a photo's registration; None where nothing is remembered."""
    if session.registrations is None:
        return None
    jobs = list(jobs)
    return lambda scan, photo, register: session.registrations(jobs[scan], plan.photos[photo], register)


def _shown(jobs, plan, session):
    """The jobs for which seeds were found; the others are left out if the plan has it so, else SeedsError is raised."""
    for job in filter(_lacks_seeds, jobs):
        if not plan.skip_unshown:
            raise SeedsError(
                "{scan}: no photo could be verified, so there are no seeds; in Blender, click four to six points, each "
                "in the scan and in the photo, save them as seeds, and run seeds --hand; or take guessed colors with "
                "--guess",
                scan=job.name,
            )
        session.left_out.append(job.label)
        write_uncolored(plan, job)
    return [job for job in jobs if not _lacks_seeds(job)]


def _lacks_seeds(job):
    return job.seeds is None or not len(job.seeds)


def find_seeds(jobs, photos, settings, *, registered=None, progress=None, cancelled=None):
    """Find the seeds of all jobs in the same photos; each job keeps its `Matching`.

    Parameters
    ----------
    jobs : list of ScanJob
    photos : sequence
        As `match_site` takes them.
    settings : Settings
    registered : callable, optional
        As `match_site`.
    progress, cancelled : callable, optional
    """
    for job in jobs:
        require_reflectance(job)
    require_matching(jobs, photos)
    matchings = match_site(
        [job.opened() for job in jobs],
        photos,
        settings,
        hand=[job.hand for job in jobs],
        kept=[job.kept for job in jobs],
        registered=registered,
        progress=progress,
        cancelled=cancelled,
    )
    for job, matching in zip(jobs, matchings, strict=True):
        job.seeds, job.observed = matching.seeds, matching.observed
        # The job drops its observed colors when nothing needs them any longer.
        job.matching = replace(matching, observed=None)


def colorize_job(job, settings, *, progress=None, cancelled=None):
    """Colorize the scan of a job, unless it is colorized already."""
    if job.colorization is None:
        require_reflectance(job)
        job.colorization = colorize(
            job.opened(), job.seeds, settings, job.seen(), progress=progress, cancelled=cancelled
        )


def _add_texture(job, plan, progress, cancelled):
    shots, found = shots_of(plan.photos, job.matching), job.colorization
    job.texture = texture(
        job.scan,
        found.rgb,
        found.observed,
        found.photo,
        shots,
        plan.texture,
        progress=progress,
        cancelled=cancelled,
    )


def _add_light_mesh(job, plan, session, progress):
    """Make the mesh of a job light. It has too few vertices for the colors, so these are an image."""
    job.light = light_mesh(
        job.scan,
        plan.faces,
        session.blender.decimate,
        filled=plan.picture.filled,
        drop_mixed=plan.picture.drop_mixed,
        progress=progress,
        cancelled=session.cancelled,
    )
    if len(job.light.triangles) > plan.faces:
        session.warnings.append(few_faces_missed(job.name, job.light, plan.faces))
    if job.texture is None:
        job.texture = grid_texture(job.scan, job.colorization.rgb)


def colorize_jobs(jobs, settings, *, progress=None, cancelled=None):
    """Colorize one job after the other, each with an equal share of the progress; no scan is kept."""
    for number, job in enumerate(jobs):
        colorize_job(job, settings, progress=part(progress, number, len(jobs), job.name), cancelled=cancelled)
        job.scan = job.observed = None
