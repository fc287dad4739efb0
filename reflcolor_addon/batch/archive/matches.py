"""Matches photos with the scans of one item of a batch, without coloring anything."""

from contextlib import suppress
from dataclasses import astuple
from functools import partial

from ...errors import ReflcolorError
from ...matching.opened_photos import opened_photos
from ...matching.registration.location import located
from ...matching.registration.registration import ScanViews
from ...matching.registration.resection import placed_by
from ...messages import without_file
from ..check import check_plan
from ..read import read_jobs
from ..scan_job import require_reflectance
from .partners import picture_of
from .places import brightness_seen, camera_place, pixels_seen, reflectance_seen

# Share of the progress that is done when the scans are read.
_READING = 0.1


def match_at(plan, session, names, helpers=None):
    """Match photos with the scans of an item, each by itself or by others; nothing is written.

    Parameters
    ----------
    plan : Plan
        Of the item, with the photos to match.
    session : Session
        Whose ``registrations`` keep what is found, and know what was found for the helpers.
    names : dict of str to str
        What these photos and the helpers are called, by their paths.
    helpers : dict of str to list of str, optional
        For photos that overlap others which were found to show the item the paths of those, the best first. Such a
        photo is placed by what it has in common with them, and by itself only where that fails.

    Returns
    -------
    dict
        ``pairs``: for the path of each photo a list of what was found on each scan (``scan``, its label; ``verified``,
        ``tested``, ``evidence``, ``strength``, ``repeats``, ``note``; ``reflectance``, ``brightness`` and ``camera``,
        see `places`, where a camera was found; ``picture``, see `partners`, where it was verified; ``by_others``,
        whether it was placed by its helpers); ``problems``: for the path of each photo that cannot be used why.
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
    pairs, problems, helpers = {}, {}, helpers or {}
    for number, path in enumerate(plan.photos):

        def step(text, number=number):
            session.progress((number + 0.5) / len(plan.photos), text)

        try:
            photo = _opened(path, names)
        except ReflcolorError as error:
            problems[str(path)] = without_file(error.message)
            continue

        def registered(scan, register, path=path, photo=photo, step=step):
            if own := helpers.get(str(path)):
                session.registrations.place(
                    jobs[scan], path, lambda: _by_helpers(session, jobs[scan], views[scan], photo, own, names, step)
                )
            return session.registrations(jobs[scan], path, register)

        found = located(scans, views, nobody, photo, step, registered)
        pairs[str(path)] = [
            _told(job, own, location, photo, partial(session.registrations.keep_picture, job, path))
            for job, own, location in zip(jobs, views, found, strict=True)
        ]
    return {"pairs": pairs, "problems": problems}


def _opened(path, names):
    """A photo with the name by which the batch knows it: in an archive several files may have one name."""
    (photo,) = opened_photos([path])
    photo.name = names[str(path)]
    return photo


def _by_helpers(session, job, views, photo, paths, names, step):
    """The `Registration` of a photo by others that overlap it; None where they do not place it."""
    known = []
    for path in paths:
        registration = session.registrations.known(job, path)
        if registration is not None and registration.accepted:
            # One that was deleted meanwhile helps no more.
            with suppress(ReflcolorError):
                known.append((_opened(path, names), registration.model))
    return placed_by(views, photo, known, step)


def _told(job, views, location, photo, keep):
    registration, evidence = location.registration, location.registration.evidence
    reflectance = brightness = camera = picture = None
    if registration.model is not None:
        reflectance = astuple(reflectance_seen(job.scan, registration.model))
    if location.verified:
        brightness = astuple(brightness_seen(job.scan, registration.model, photo))
        camera = camera_place(job.scan, registration.model)
        picture = keep(picture_of(views, *pixels_seen(job.scan, registration.model)[:2]))
    return {
        "scan": job.label,
        "verified": location.verified,
        "tested": location.tested,
        "evidence": round(evidence.share, 3),
        "strength": round(evidence.strength, 3),
        "repeats": evidence.repeats,
        "note": str(location.note),
        "reflectance": reflectance,
        "brightness": brightness,
        "camera": camera,
        "picture": picture,
        "by_others": registration.beside is not None,
    }
