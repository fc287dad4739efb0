"""Matches photos with the scans of one item of a batch, without coloring anything."""

from ...errors import ReflcolorError
from ...matching.opened_photos import opened_photos
from ...matching.registration.location import located
from ...matching.registration.registration import ScanViews
from ...messages import without_file
from ..check import check_plan
from ..read import read_jobs
from ..scan_job import require_reflectance
from .places import camera_place, depth_map

# Share of the progress that is done when the scans are read.
_READING = 0.1


def match_at(plan, session):
    """Match photos with the scans of an item, each by itself; nothing is written.

    Parameters
    ----------
    plan : Plan
        Of the item, with the photos to match.
    session : Session
        Whose ``registrations`` keep what is found.

    Returns
    -------
    dict
        ``pairs``: for the path of each photo a list of what was found on each scan (``scan``, its label; ``verified``,
        ``tested``, ``evidence``, ``strength``, ``note``; ``depths`` and ``camera``, see `places`, where it is
        verified); ``problems``: for the path of each photo that cannot be used why.
    """
    session.span = 0.0, _READING
    jobs = read_jobs(plan, check_plan(plan), session, {})
    session.span = _READING, 1 - _READING
    for job in jobs:
        require_reflectance(job)
    scans = [job.opened() for job in jobs]
    jobs = [job for job, scan in zip(jobs, scans, strict=True) if scan.valid.any()]
    scans = [scan for scan in scans if scan.valid.any()]
    views, nobody = [ScanViews(scan) for scan in scans], [None] * len(scans)
    pairs, problems = {}, {}
    for number, path in enumerate(plan.photos):

        def step(text, number=number):
            session.progress((number + 0.5) / len(plan.photos), text)

        try:
            (photo,) = opened_photos([path])
        except ReflcolorError as error:
            problems[str(path)] = without_file(error.message)
            continue

        def registered(scan, register, path=path):
            return session.registrations(jobs[scan], path, register)

        found = located(scans, views, nobody, photo, step, registered)
        pairs[str(path)] = [_told(job, location) for job, location in zip(jobs, found, strict=True)]
    return {"pairs": pairs, "problems": problems}


def _told(job, location):
    registration, depths, camera = location.registration, None, None
    if location.verified:
        depths, camera = (tell(job.scan, registration.model) for tell in (depth_map, camera_place))
    return {
        "scan": job.label,
        "verified": location.verified,
        "tested": location.tested,
        "evidence": round(registration.evidence.share, 3),
        "strength": round(registration.evidence.strength, 3),
        "note": str(location.note),
        "depths": depths,
        "camera": camera,
    }
