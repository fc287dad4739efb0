"""A quick comparison of every scan with every photo, to find the pairs that are worth matching."""

from pathlib import Path

from ...errors import Cancelled, ReflcolorError
from ...files.readers import read_scans
from ...matching.photo_image import PhotoImage
from ...matching.registration.registration import ScanViews
from ...messages import without_file
from ..paths import scan_files
from ..plan_document import reading_of
from . import partners
from .fingerprints import digest_of, program_digest
from .folder import BatchFolder
from .sketches import sketch_of
from .two_looks import first_look, second_look

FIRST, SECOND, OF_SCANS = "first", "second", "of scans"
"""Which look it is."""
KIND = "looks"
# Share of the progress that is done when the scans are read.
_READING = 0.2


def look_at(request, *, progress, cancelled):
    """Look at photos for one item of a batch.

    Parameters
    ----------
    request : dict
        ``folder`` of the batch, ``scans``, how they are read (``reading``), ``photos``, and ``hashes`` of them all;
        ``look``: `FIRST`, `SECOND`, or `OF_SCANS`, where the photos are pictures of other scans (see `partners`).
    progress, cancelled : callable

    Returns
    -------
    dict
        ``scores``: for the path of each photo how much speaks for it on any of the scans; ``problems``: for the path of
        each photo that cannot be read why; ``worked``: which share of the work had not been done before.
    """
    folder, hashes = BatchFolder(Path(request["folder"])), request["hashes"]
    scans = [hashes[str(file)] for path in request["scans"] for file in scan_files(Path(path))]
    # Files that could not be hashed cannot be told from one another: nothing is kept about them.
    key, first_key = (
        digest_of([program_digest(), request["reading"], *scans, which]) if all(scans) else None
        for which in (request["look"], FIRST)
    )
    known, firsts = _recalled(folder, key), _recalled(folder, first_key) if request["look"] == SECOND else {}
    scores = {path: _score(known[hashes[path]]) for path in request["photos"] if hashes[path] in known}
    problems, missing = {}, [path for path in request["photos"] if path not in scores]
    views = _views(request, progress, cancelled) if missing else []

    def step():
        if cancelled():
            raise Cancelled

    try:
        for number, path in enumerate(missing):
            step()
            # Pictures of scans are named by hashes.
            name = f"{number + 1} of {len(missing)}" if request["look"] == OF_SCANS else Path(path).name
            progress(_READING + (1 - _READING) * number / len(missing), name)
            try:
                photo = PhotoImage(Path(path).name, sketch_of(folder, path, hashes[path]))
            except ReflcolorError as error:
                problems[path] = without_file(error.message)
                continue
            looked = _looked(request["look"], views, photo, firsts.get(hashes[path]), step)
            scores[path] = _score(looked)
            if hashes[path]:
                known[hashes[path]] = looked
    finally:
        if missing and key:
            folder.remember(KIND, key, known)
    worked = (1 + len(missing)) / (1 + len(request["photos"])) if missing else 0.0
    return {"scores": scores, "problems": problems, "worked": worked}


def _looked(which, views, photo, first, step):
    """Score and directions on each scan; ``first`` is what the first look found, where that is known."""
    if which == OF_SCANS:
        return [[partners.look(own, photo, step), []] for own in views]
    if first is None:
        first = [first_look(own, photo, step) for own in views]
    if which == FIRST:
        return first
    ways = [directions for _, directions in first]
    return [[second_look(own, photo, directions, step), []] for own, directions in zip(views, ways, strict=True)]


def _recalled(folder, key):
    """What looks have found, for the hash of each photo: score and directions on each scan."""
    return (key and folder.recall(KIND, key)) or {}


def _score(looked):
    return max((score for score, _ in looked), default=0.0)


def _views(request, progress, cancelled):
    views, options = [], reading_of(request["reading"])

    def reading(fraction, text):
        progress(_READING * fraction, text)

    for path in request["scans"]:
        scans = read_scans(path, options=options, progress=reading, cancelled=cancelled)
        views += [ScanViews(scan) for scan in scans]
    return [own for own in views if own.scan.valid.any()]
