"""Reads the scans of a plan: one job for each, with its seeds and its files."""

import re
import unicodedata
from dataclasses import replace

from ..errors import SeedsError, UsageError
from ..messages import Message
from ..seeds.seeds import Seeds
from .check import ALL, check_jobs, check_photos, check_place, check_placeholder, inputs_of, load_seeds
from .plan import filled
from .scan_job import ScanJob
from .session import timed

_LONGEST_LABEL = 60


def read_jobs(plan, given, session, times, opened=None):
    """Read the scans of a plan, and the seeds that each has of its own.

    Parameters
    ----------
    plan : Plan
    given : Given
        From `check_plan`.
    session : Session
    times : dict
        Seconds are added to it.
    opened : list, optional
        Gets the jobs as soon as their scans are read, before anything else can be wrong.

    Returns
    -------
    list of ScanJob
        Scans of the same name are told apart by a number.
    """
    with timed(times, "read"):
        jobs = _scan_jobs(plan, session)
    if opened is not None:
        opened += jobs
    check_placeholder(plan, len(jobs))
    session.left_out += [job.label for job in jobs if job.label in plan.left_out]
    jobs = [job for job in jobs if job.label not in plan.left_out]
    if plan.seeds is not None:
        with timed(times, "seeds"):
            _add_seeds(jobs, plan, given, session)
    if plan.hand is not None:
        _add_hand(jobs, plan, given, session)
    for job in jobs:
        seeds_path = None if plan.seeds is None else filled(plan.seeds, job.label)
        job.inputs = inputs_of(plan, [job.path], seeds_path, job.seeds)
        job.outputs = [output.of(job.label) for output in plan.outputs if output.is_of_each or len(jobs) == 1]
    check_jobs(plan, jobs)
    return jobs


def _scan_jobs(plan, session):
    found = []
    for path in plan.scans:
        scans = session.read_scans(path, outside=plan.outside_files, options=plan.reading)
        if len(plan.scans) > 1 or plan.wanted == ALL:
            found += [(path, index, scan) for index, scan in enumerate(scans, 1)]
        else:
            found.append((path, *choose_scan(scans, plan.wanted, path, all_of_them=True)))
    names = distinct([scan.name for _, _, scan in found])
    labels = _labels(names, plan.name)
    return [
        ScanJob(
            name=name,
            scan=scan if scan.name == name else replace(scan, name=name),
            label=label,
            path=path,
            index=index,
        )
        for (path, index, scan), name, label in zip(found, names, labels, strict=True)
    ]


def _labels(names, plan_name):
    """The names made safe for file names; no two are equal, even if capitals are ignored."""
    if plan_name is not None and len(names) == 1:
        return [plan_name]
    labels = distinct([safe_label(name) for name in names], joint="_", key=str.casefold)
    # No safe label holds a plus sign: none of these can be another plan's.
    return labels if plan_name is None else [f"{plan_name}+{label}" for label in labels]


def _add_seeds(jobs, plan, given, session):
    paths = [filled(plan.seeds, job.label) for job in jobs]
    for job, path in zip(jobs, paths, strict=True):
        if given.seeds is None and not path.is_file():
            raise SeedsError("{path}: no such file; expected the seeds of the scan {scan}", path=path, scan=job.name)
    for job, path in zip(jobs, paths, strict=True):
        job.seeds = given.seeds or load_seeds(path, plan.photos)
    if given.seeds is None:
        check_photos(plan.photos, [job.seeds for job in jobs], session.warnings)
    for job, path in zip(jobs, paths, strict=True):
        check_place(job.seeds, path, job.scan)


def _add_hand(jobs, plan, given, session):
    """Seeds picked by hand for each scan; it is enough that one has a file."""
    paths = [filled(plan.hand, job.label) for job in jobs]
    if not any(path.is_file() for path in paths):
        expected = ", ".join(map(str, paths))
        raise SeedsError(
            "--hand {path}: no scan has such a file; expected one of {expected}", path=plan.hand, expected=expected
        )
    for job, path in zip(jobs, paths, strict=True):
        if given.hand is not None:
            job.hand = given.hand
        elif path.is_file():
            job.hand = Seeds.load(path, plan.photos)
        else:
            session.warnings.append(Message("{path}: no such file; that scan gets no pairs picked by hand", path=path))
    for job, path in zip(jobs, paths, strict=True):
        if job.hand is not None and len(job.hand):
            check_place(job.hand, path, job.scan)


def choose_scan(scans, wanted, path, *, all_of_them=False):
    """Return the index (from 1) and the scan that is wanted.

    Parameters
    ----------
    scans : list of Scan
    wanted : str or None
        A name or, where no scan has that name, an index counted from 1. None: the only scan there is.
    path : Path
        The file, for messages.
    all_of_them : bool
        Whether all of them could be taken, too, as the message says then.

    Raises
    ------
    UsageError
        If it names no scan or several, or names none where there are several.
    """
    indexed = list(enumerate(scans, 1))
    if wanted is None:
        found = indexed
        problem = Message("{path} holds {count} scans", path=path, count=len(scans))
    else:
        found = [(index, scan) for index, scan in indexed if scan.name == wanted]
        found = found or [(index, scan) for index, scan in indexed if str(index) == wanted]
        problem = Message(
            "--scan {wanted} means {count} of the scans in {path}",
            wanted=wanted,
            count=len(found) or Message("none"),
            path=path,
        )
    if len(found) != 1:
        template = (
            "{problem}; choose one by --scan NAME or --scan INDEX: {listing}; --scan all takes every one"
            if all_of_them
            else "{problem}; choose one by --scan NAME or --scan INDEX: {listing}"
        )
        listing = ", ".join(f"{index} ({scan.name})" for index, scan in indexed)
        raise UsageError(template, problem=problem, listing=listing)
    return found[0]


def distinct(names, *, joint=" ", key=str):
    """Return the names, each that came before with a number behind it that makes it another; ``key`` compares them."""
    given, taken, made = {key(name) for name in names}, set(), []
    for name in names:
        fresh, number = name, 1
        while key(fresh) in taken or (fresh != name and key(fresh) in given):
            number += 1
            fresh = f"{name}{joint}{number}"
        taken.add(key(fresh))
        made.append(fresh)
    return made


def safe_label(name):
    """Return a name as letters, digits, brackets, ``-``, ``_``, commas and inner dots, which any file system takes."""
    label = re.sub(r"[^\w.,()[\]-]", "_", unicodedata.normalize("NFC", name))
    return label[:_LONGEST_LABEL].strip(".") or "scan"
