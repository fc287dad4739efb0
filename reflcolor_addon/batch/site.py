"""The scans of one site: which ones a command works on, and the paths of what belongs to one of them."""

import re
import unicodedata
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import SeedsError, UsageError
from ..scan.scan import Scan

ALL = "all"
PLACEHOLDER = "{scan}"
_LONGEST_LABEL = 60


@dataclass(frozen=True, eq=False, kw_only=True)
class SiteScan:
    """One of the scans that a command works on.

    Parameters
    ----------
    scan : Scan
        No other of them has its name.
    index : int
        Its place in its file, from 1.
    path : Path
        Its file.
    label : str
        Its name made safe for a file name; no other's is the same, not even in capitals.
    """

    scan: Scan
    index: int
    path: Path
    label: str

    def filled(self, path):
        """Return a path with the label instead of the placeholder."""
        return Path(str(path).replace(PLACEHOLDER, self.label))


def check_choice(paths, wanted):
    """Raise UsageError if a file is given twice, or ``--scan`` chooses one scan where several files are given."""
    for place, path in enumerate(paths):
        if path.resolve() in {other.resolve() for other in paths[:place]}:
            raise UsageError(f"{path}: is given twice; give every file once")
    if len(paths) > 1 and wanted not in (None, ALL):
        raise UsageError(
            f"--scan {wanted}: chooses a scan of one file, but {len(paths)} are given; leave it out to take every scan"
        )


def check_placeholder(options, count):
    """See that the paths of what there is one of for each scan have the placeholder.

    Parameters
    ----------
    options : list of (str, Path)
        The option that names it, and the path.
    count : int
        How many scans there are, as far as is known.

    Raises
    ------
    UsageError
        If there are several scans and one of the paths is the same for all.
    """
    for option, path in options if count > 1 else ():
        if PLACEHOLDER not in str(path):
            example = path.with_name(f"{PLACEHOLDER}_{path.name}")
            raise UsageError(
                f"{option} {path}: each of several scans has its own; "
                f"write {PLACEHOLDER} where its name is to stand, as in {example}"
            )


def known_beforehand(options):
    """Return those of (option, path) whose folder is known before the scans are."""
    return [(option, path) for option, path in options if PLACEHOLDER not in str(path.parent)]


def filled_for_all(options, places):
    """Return (option, path) with the placeholder replaced by each scan's label, each once."""
    return list(dict.fromkeys((option, place.filled(path)) for option, path in options for place in places))


def read_site(paths, wanted, session):
    """Read the scans that a command works on.

    Parameters
    ----------
    paths : list of Path
    wanted : str or None
        What ``--scan`` says: "all", or as `choose_scan`; of several files every scan is taken.
    session : Session

    Returns
    -------
    list of SiteScan
        Scans of the same name are told apart by a number.
    """
    found = []
    for path in paths:
        scans = session.read_scans(path)
        if len(paths) > 1 or wanted == ALL:
            found += [(path, index, scan) for index, scan in enumerate(scans, 1)]
        else:
            found.append((path, *choose_scan(scans, wanted, path, otherwise=f"; --scan {ALL} takes every one")))
    names = distinct([scan.name for _, _, scan in found])
    labels = distinct([safe_label(name) for name in names], joint="_", key=str.casefold)
    return [
        SiteScan(scan=scan if scan.name == name else replace(scan, name=name), index=index, path=path, label=label)
        for (path, index, scan), name, label in zip(found, names, labels, strict=True)
    ]


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
    """Return a name as letters, digits, ``-``, ``_`` and inner dots, which any file system takes."""
    label = re.sub(r"[^\w.-]", "_", unicodedata.normalize("NFC", name))
    return label[:_LONGEST_LABEL].strip(".") or "scan"


def check_place(seeds, path, scan):
    """Raise SeedsError, naming their file, where seeds do not lie on a scan."""
    try:
        seeds.placed_on(scan)
    except SeedsError as error:
        raise SeedsError(f"{path}: {error}; expected seeds of the scan {scan.name}") from error


def match_places(places, photos, settings, session, hand=None):
    """Find seeds for all scans in the same photos, and keep what is to be said of it.

    Parameters
    ----------
    places : list of SiteScan
    photos : list of Path
    settings : Settings
    session : Session
    hand : list of (Seeds or None), optional
        For each scan, as `match_site`.

    Returns
    -------
    list of (Matching, list of str)
        For each scan; the lines say what became of each photo.
    """
    from ..matching import match_site

    scans = [place.scan for place in places]
    matchings = match_site(scans, photos, settings, hand=hand, progress=session.progress, cancelled=session.cancelled)
    found = []
    for scan, matching in zip(scans, matchings, strict=True):
        head = named(scan, len(scans))
        session.warnings += [
            warning if warning.startswith(f"{scan.name}: ") else f"{head}{warning}" for warning in matching.warnings
        ]
        found.append((matching, [f"{head}{photo.name}: {photo.note}" for photo in matching.photos]))
    return found


def choose_scan(scans, wanted, path, *, otherwise=""):
    """Return the index (from 1) and the scan that ``--scan`` names.

    Parameters
    ----------
    scans : list of Scan
    wanted : str or None
        A name or, where no scan has that name, an index counted from 1. None: the only scan there is.
    path : Path
        The file, for messages.
    otherwise : str
        What else can be done, as the end of the message.

    Raises
    ------
    UsageError
        If it names no scan or several, or names none where there are several.
    """
    indexed = list(enumerate(scans, 1))
    listing = ", ".join(f"{index} ({scan.name})" for index, scan in indexed)
    if wanted is None:
        found, problem = indexed, f"{path} holds {len(scans)} scans"
    else:
        found = [(index, scan) for index, scan in indexed if scan.name == wanted]
        found = found or [(index, scan) for index, scan in indexed if str(index) == wanted]
        problem = f"--scan {wanted} means {len(found) or 'none'} of the scans in {path}"
    if len(found) != 1:
        raise UsageError(f"{problem}; choose one by --scan NAME or --scan INDEX: {listing}{otherwise}")
    return found[0]


def named(scan, count):
    """Return the beginning of a line that is about one of several scans; nothing where there is only one."""
    return f"{scan.name}: " if count > 1 else ""
