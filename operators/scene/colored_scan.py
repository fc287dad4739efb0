"""A scan's object with the colors that it shows, to be written back into a scan file."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from ...reflcolor_addon.errors import Cancelled, ReflcolorError, UsageError
from ...reflcolor_addon.files.readers.options import AS_IT_IS, ReadOptions
from ...reflcolor_addon.files.writers.scans_back import ColoredScan
from ...reflcolor_addon.report.report import fingerprint
from ...reflcolor_addon.scan.georeference import shifted
from ...reflcolor_addon.scan.object_arrays import on_grid
from .provenance import import_record
from .scan_object import SHIFT, colors_of, grid_indices, scan_reader, shown_in_renders


def colored_scans_reader(objects):
    """Return ``read(cancelled)``, which gives a ColoredScan of each object; it touches no bpy, a thread may call it.

    The scan's file is named where it is still what the object was made from.

    Raises
    ------
    ScanError
        If the mesh of one has lost the attributes that it takes.
    """
    readers = [_reader(obj) for obj in objects]

    def read(cancelled=None):
        # All scans of a site may come from one large file.
        unchanged = lru_cache(maxsize=None)(lambda path, sha256: _is_unchanged(path, sha256, cancelled))
        return [read_one(unchanged) for read_one in readers]

    return read


def _reader(obj):
    """A function that makes the ColoredScan of an object; it is given the check whether a file is unchanged."""
    read_scan, colors, place = scan_reader(obj), colors_of(obj, shown_in_renders(obj)), grid_indices(obj)
    record, shape = import_record(obj), (obj.reflcolor.rows, obj.reflcolor.cols)
    shift = np.array(obj.get(SHIFT, (0, 0, 0)), np.float64)

    def read(unchanged):
        entry = record.get("scan", {})
        source, options = _source(record, unchanged), _options(entry)
        known = source is not None and options is not None and isinstance(entry.get("index"), int)
        scan = read_scan()
        return ColoredScan(
            scan=replace(scan, pose=shifted(scan.pose, shift)),
            rgb=on_grid(colors, place, shape),
            source=source if known else None,
            index=entry.get("index") if known else None,
            options=options if known else AS_IT_IS,
        )

    return read


def _source(record, unchanged):
    """The scan's file, if it is there as it was; None else."""
    inputs = [entry for entry in record.get("inputs", []) if entry.get("role") == "scan"]
    if len(inputs) != 1 or not {"path", "sha256"} <= inputs[0].keys():
        return None
    path, sha256 = inputs[0]["path"], inputs[0]["sha256"]
    return Path(path) if unchanged(path, sha256) else None


def _is_unchanged(path, sha256, cancelled):
    try:
        return fingerprint(path, cancelled)["sha256"] == sha256
    except Cancelled:
        raise
    except ReflcolorError:
        return False


def _options(entry):
    """The ReadOptions that an import was made with; None where the record makes no sense."""
    given = dict(entry.get("reading", {})) | {f"flip_{way}": True for way in entry.get("flipped", [])}
    if given.get("position") is not None:
        given["position"] = tuple(given["position"])
    try:
        return ReadOptions(**given)
    except (UsageError, TypeError):
        return None
