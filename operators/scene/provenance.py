"""Where a scan's colors are from, kept with its object; what they are made from, kept with objects and images.

All of it is JSON in custom properties, so that it follows undo and copies, is saved with the .blend, and can be read
without this extension.
"""

import json
from dataclasses import replace
from pathlib import Path

import bpy

from ...reflcolor_addon.report.provenance import parse_provenance
from ...reflcolor_addon.report.report import build_report, input_entry, photo_entry, stamped
from ...reflcolor_addon.seeds.sources import FOUND

PROVENANCE = "reflcolor_provenance"
# On objects: the scan as it was imported, files of seeds, the last search for seeds. On images: the photo's file.
_IMPORTED, _SEEDS_FILES, _MATCHED, _PHOTO = (
    f"reflcolor_{name}" for name in ("import", "seeds_files", "matching", "photo")
)


def record_import(obj, scan, inputs, warnings=()):
    """Keep what a report says of the scan that an object was made from.

    Parameters
    ----------
    obj : bpy.types.Object
    scan : dict
        From `scan_entry`.
    inputs : list of dict
        From `input_entry`, one a file.
    warnings : sequence of str
        What was noticed when it was read.
    """
    obj[_IMPORTED] = json.dumps({"scan": scan, "inputs": inputs, "warnings": list(warnings)})


def import_record(obj):
    """Return what `record_import` kept, as a dictionary; an empty one where there is none."""
    return _read(obj, _IMPORTED)


def record_photo(image, entry):
    """Keep which file an image was read from: its `input_entry`."""
    image[_PHOTO] = json.dumps(entry)


def record_seeds_file(obj, path, *, others):
    """Keep which file the object's seeds were read from; with ``others``, beside those that are kept already.

    Raises
    ------
    ReflcolorError
        If the file can no longer be read.
    """
    before = _read(obj, _SEEDS_FILES).get("inputs", []) if others else []
    obj[_SEEDS_FILES] = json.dumps({"inputs": [*before, input_entry("seeds", Path(path))]})


def record_matching(obj, matching, settings, names):
    """Keep how the object's seeds were found: the settings ``names``, and what became of each photo."""
    chosen = settings.as_dict()
    photos = [photo_entry(photo) for photo in matching.photos]
    obj[_MATCHED] = json.dumps({"settings": {name: chosen[name] for name in names}, "photos": photos})


def record_provenance(obj, report):
    """Keep a report as where the object's colors are from."""
    obj[PROVENANCE] = json.dumps(report)
    if _IMPORTED not in obj:
        record_import(obj, report["scan"], [entry for entry in report["inputs"] if entry["role"] == "scan"])


def copy_records(obj, other):
    """Keep with another object, too, where an object's scan and colors are from."""
    for name in (PROVENANCE, _IMPORTED):
        if name in obj:
            other[name] = obj[name]


def provenance_text(obj):
    """Return the report on the object's colors as JSON; None where there is none."""
    text = obj.get(PROVENANCE)
    return text if isinstance(text, str) and text else None


def provenance_of(obj):
    """Return the report on the object's colors; None where there is none.

    Raises
    ------
    ReflcolorError
        If it cannot be read.
    """
    text = provenance_text(obj)
    return None if text is None else parse_provenance(text)


def window_report(obj, colorization, settings, given_seeds):
    """Return the report on a colorization of an object's scan, with the time that it is now.

    Parameters
    ----------
    obj : bpy.types.Object
    colorization : Colorization
    settings : Settings
    given_seeds : Seeds
        The seeds before any was moved.
    """
    imported, matched = _read(obj, _IMPORTED), _read(obj, _MATCHED)
    if not any(reason in FOUND for reason in given_seeds.reason) and not colorization.observed.any():
        matched = {}
    photos = [photo["name"] for photo in matched.get("photos", [])]
    photos += [photo for photo in given_seeds.photos if photo is not None]
    inputs = imported.get("inputs") or [_unseen("scan", obj.reflcolor.source or obj.name)]
    return stamped(
        build_report(
            _scan_entry(obj, imported.get("scan", {})),
            colorization,
            replace(settings, **matched.get("settings", {})),
            given_seeds=given_seeds,
            inputs=[*inputs, *_read(obj, _SEEDS_FILES).get("inputs", []), *map(_photo_input, dict.fromkeys(photos))],
            photos=matched.get("photos", []),
            noticed=imported.get("warnings", []),
            blender=bpy.app.version_string,
        )
    )


def _scan_entry(obj, known):
    """The scan as the mesh holds it; what a mesh cannot tell is as it was imported."""
    state = obj.reflcolor
    there = {"rows": state.rows, "columns": state.cols, "returns": len(obj.data.vertices)}
    return {"name": obj.name, "index": None, **there, "full_turn": None, "flipped": []} | known | there


def _photo_input(name):
    image = bpy.data.images.get(name)
    known = {} if image is None else _read(image, _PHOTO)
    return (known or _unseen("photo", name)) | {"image": name}


def _unseen(role, path):
    """The entry of an input whose file was not hashed."""
    return {"role": role, "path": path, "bytes": None, "sha256": None}


def _read(owner, name):
    """A stored record; an empty one if it was removed or damaged."""
    try:
        record = json.loads(owner.get(name, ""))
    except (ValueError, TypeError):
        return {}
    return record if isinstance(record, dict) else {}
