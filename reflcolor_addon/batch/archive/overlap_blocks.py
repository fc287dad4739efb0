"""A worker's part of finding photos that overlap: those of one block of photos are compared with those of another."""

from pathlib import Path

from ...errors import Cancelled, ReflcolorError
from ...matching.photo_image import PhotoImage
from ...matching.registration.overlaps import LEAST_AGREEMENT, Described, agreement
from .fingerprints import digest_of, program_digest
from .folder import BatchFolder
from .sketches import sketch_of

KIND = "looks"
# Share of the progress that is done when the photos are described.
_READING = 0.3


def overlaps_at(request, *, progress, cancelled):
    """Compare the photos of two blocks.

    Parameters
    ----------
    request : dict
        ``folder`` of the batch; ``photos`` and ``others``, the paths of two blocks of photos, which may be the same;
        ``hashes`` of them all, none of which is empty.
    progress, cancelled : callable

    Returns
    -------
    dict
        ``overlaps``: two paths, and how well the photos agree, of those that do; ``worked``: which share of the work
        had not been done before.
    """
    folder, hashes = BatchFolder(Path(request["folder"])), request["hashes"]
    blocks = [[hashes[path] for path in request[which]] for which in ("photos", "others")]
    key = digest_of([program_digest(), "overlaps", *blocks])
    known = (folder.recall(KIND, key) or {}).get("overlaps")
    if known is not None:
        return {"overlaps": _paths(request, known), "worked": 0.0}
    described, paths = {}, list(dict.fromkeys(request["photos"] + request["others"]))

    def step(fraction, path):
        if cancelled():
            raise Cancelled
        progress(fraction, Path(path).name)

    for number, path in enumerate(paths):
        step(_READING * number / len(paths), path)
        try:
            described[path] = Described.of(PhotoImage(Path(path).name, sketch_of(folder, path, hashes[path])))
        except ReflcolorError:
            continue  # what is wrong with it was told at the first look
    found, same = [], request["photos"] == request["others"]
    for number, path in enumerate(request["photos"]):
        step(_READING + (1 - _READING) * number / len(request["photos"]), path)
        for place, other in enumerate(request["others"]):
            if same and place <= number:
                continue
            if path in described and other in described:
                agreed = agreement(described[path], described[other])
                if agreed >= LEAST_AGREEMENT:
                    found.append([number, place, agreed])
    folder.remember(KIND, key, {"overlaps": found})
    return {"overlaps": _paths(request, found), "worked": 1.0}


def _paths(request, places):
    return [[request["photos"][one], request["others"][other], agreed] for one, other, agreed in places]
