"""A quick comparison of every scan with every photo, to find the pairs that are worth matching."""

from pathlib import Path

from ...errors import Cancelled, ReflcolorError
from ...files.images import read_image, write_png
from ...files.readers import read_scans
from ...matching.photo_image import PhotoImage
from ...matching.registration.first_look import first_look
from ...matching.registration.registration import ScanViews
from .fingerprints import digest_of, program_digest
from .folder import BatchFolder

KIND = "looks"
_SKETCH_SIDE = 640
# How many scans each photo of a batch is matched with at most, and how much lower their scores may be than the best
# one's.
MOST_SCANS, LEAST_SHARE = 4, 0.4


def look_at(request, *, progress, cancelled):
    """Look at photos for one item of a batch.

    Parameters
    ----------
    request : dict
        ``folder`` of the batch, ``scans``, ``photos``, and ``hashes`` of them all.
    progress, cancelled : callable

    Returns
    -------
    dict
        ``scores``: for the path of each photo how much speaks for it on any of the scans; ``problems``: for the path of
        each photo that cannot be read why.
    """
    folder, hashes = BatchFolder(Path(request["folder"])), request["hashes"]
    key = digest_of([program_digest(), *(hashes[path] for path in request["scans"])])
    known = folder.recall(KIND, key) or {}
    problems, missing = {}, [path for path in request["photos"] if hashes[path] not in known]
    views = _views(request["scans"], progress, cancelled) if missing else []

    def step():
        if cancelled():
            raise Cancelled

    try:
        for number, path in enumerate(missing):
            step()
            progress(number / len(missing), Path(path).name)
            try:
                photo = PhotoImage(Path(path).name, _sketch(folder, path, hashes[path]))
            except ReflcolorError as error:
                problems[path] = str(error)
                continue
            known[hashes[path]] = max((first_look(own, photo, step) for own in views), default=0.0)
    finally:
        if missing:
            folder.remember(KIND, key, known)
    scores = {path: known[hashes[path]] for path in request["photos"] if hashes[path] in known}
    return {"scores": scores, "problems": problems}


def candidates(scores):
    """Choose which photos are matched with which scans.

    Parameters
    ----------
    scores : dict of str to dict of str to float
        For each item, by its name, what `look_at` gave.

    Returns
    -------
    dict of str to list of str
        For each item its photos, what looks best first.
    """
    # A scan with much detail gets higher scores with every photo; what counts is how much a photo stands out.
    usual = {name: _median(list(own.values())) for name, own in scores.items()}
    chosen = {name: [] for name in scores}
    for photo in dict.fromkeys(path for own in scores.values() for path in own):
        ranked = sorted(
            ((own[photo] / max(usual[name], 1e-9), name) for name, own in scores.items() if photo in own),
            key=lambda entry: (-entry[0], entry[1]),
        )
        best = ranked[0][0]
        for share, name in ranked[:MOST_SCANS]:
            if share > 0 and share >= LEAST_SHARE * best:
                chosen[name].append((share, photo))
    return {
        name: [photo for _, photo in sorted(own, key=lambda entry: (-entry[0], entry[1]))]
        for name, own in chosen.items()
    }


def _views(paths, progress, cancelled):
    views = []
    for path in paths:
        views += [ScanViews(scan) for scan in read_scans(path, progress=progress, cancelled=cancelled)]
    return [own for own in views if own.scan.valid.any()]


def _sketch(folder, path, key):
    """A photo made small, kept for the other scans."""
    import cv2

    kept = folder.state(KIND, f"{key}.png")
    if kept.is_file():
        return read_image(kept)
    rgb = read_image(path)
    scale = max(rgb.shape) / _SKETCH_SIDE
    if scale > 1:
        size = max(1, round(rgb.shape[1] / scale)), max(1, round(rgb.shape[0] / scale))
        rgb = cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)
    write_png(kept, rgb)
    return rgb


def _median(values):
    values = sorted(values)
    return values[len(values) // 2] if values else 0.0
