"""What was done, with what, to what: enough to do it again."""

import hashlib
import importlib.metadata
import math
import platform

from .errors import ReflcolorError
from .normalization import PERCENTILES
from .version import __version__

FORMAT = "reflcolor-report"
VERSION = 1
# Packages that a result depends on.
_PACKAGES = ("numpy", "scipy", "scikit-image", "opencv-python-headless", "pye57")
_CHUNK_BYTES = 1 << 20


def build_report(scan, colorization, settings, *, index, given_seeds, inputs, outputs, photos=(), blender=None):
    """Describe a colorization; the same work on the same machine gives the same report.

    Parameters
    ----------
    scan : Scan
    colorization : Colorization
    settings : Settings
    index : int
        The scan's place in its file, from 1.
    given_seeds : Seeds
        The seeds before any was moved.
    inputs : list of (str, Path)
        What the file is for ("scan", "seeds", "photo"), and the file.
    outputs : list of (str, Path)
        The option that asked for it, and the file.
    photos : sequence of PhotoMatch
        What became of each photo that seeds were looked for in.
    blender : str, optional
        Blender's version.

    Returns
    -------
    dict
        Ready for JSON, with no number that is not finite.

    Raises
    ------
    ReflcolorError
        If an input can no longer be read.
    """
    rows, columns = scan.shape
    return {
        "format": FORMAT,
        "version": VERSION,
        "scan": {
            "name": scan.name,
            "index": index,
            "rows": rows,
            "columns": columns,
            "returns": int(scan.valid.sum()),
            "full_turn": scan.full_turn,
        },
        "settings": settings.as_dict(),
        "seeds": seed_entries(colorization.seeds, given_seeds),
        "photos": [
            {"name": photo.name, "verified": photo.verified, "reason": photo.reason, "note": photo.note}
            for photo in photos
        ],
        "normalization": {
            "percentiles": list(PERCENTILES),
            "reflectance": list(colorization.normalization["reflectance"]),
            "range_m": list(colorization.normalization["range"]),
        },
        "result": {
            "colored": int((colorization.nearest_seed >= 0).sum()),
            "unreached": int((scan.valid & (colorization.nearest_seed < 0)).sum()),
        },
        "method": colorization.method,
        "warnings": [*scan.warnings, *colorization.warnings],
        "inputs": [{"role": role, "path": str(path)} | fingerprint(path) for role, path in inputs],
        "outputs": [{"option": option, "path": str(path)} for option, path in outputs],
        "versions": versions(blender),
    }


def seed_entries(seeds, given):
    """Return one dictionary for each seed as it was used.

    ``photo``, ``x``, ``y`` tell where its color is from (None: given directly), ``moved_from`` the pixel that was asked
    for where that had no return (None: not moved).
    """
    entries = []
    for index, photo in enumerate(seeds.photos):
        used, asked = ({"row": int(those.rows[index]), "col": int(those.cols[index])} for those in (seeds, given))
        x, y = (None if math.isnan(value) else value for value in seeds.photo_xy[index].tolist())
        color = {"rgb": seeds.rgb[index].tolist(), "photo": photo, "x": x, "y": y}
        confidence = seeds.confidence[index].item()
        found = {"confidence": None if math.isnan(confidence) else confidence, "reason": seeds.reason[index]}
        entries.append(used | color | found | {"moved_from": None if asked == used else asked})
    return entries


def fingerprint(path):
    """Return the size and the SHA-256 of a file, as ``{"bytes": ..., "sha256": ...}``.

    Raises
    ------
    ReflcolorError
        If it cannot be read.
    """
    digest, size = hashlib.sha256(), 0
    try:
        with path.open("rb") as file:
            while chunk := file.read(_CHUNK_BYTES):
                digest.update(chunk)
                size += len(chunk)
    except OSError as error:
        raise ReflcolorError(f"{path}: can no longer be read ({error.strerror})") from error
    return {"bytes": size, "sha256": digest.hexdigest()}


def versions(blender=None):
    """Return the versions of everything that a result depends on; None for what is not installed."""
    return {
        "reflcolor": __version__,
        "blender": blender,
        "python": platform.python_version(),
        "platform": platform.platform(),
        **{name: _package_version(name) for name in _PACKAGES},
    }


def _package_version(name):
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None
