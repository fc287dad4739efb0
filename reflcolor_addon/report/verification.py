"""Whether the files that a report names are the ones that its run wrote."""

from dataclasses import dataclass
from pathlib import Path

from ..errors import ReflcolorError
from ..files.whole import fault_of
from ..messages import Message
from .report import REPORT_OPTION, fingerprint

WHOLE, CHANGED, MISSING = "whole", "changed", "missing"


@dataclass(frozen=True)
class Verified:
    """One output of a report.

    Parameters
    ----------
    path : Path
        Where it was looked for.
    state : {"whole", "changed", "missing"}
        "changed": there is a file, but not the one that the run wrote.
    note : Message
        Why, in a few words; empty where it is whole.
    """

    path: Path
    state: str
    note: str


def verify_outputs(report, report_path, cancelled=None):
    """Look at every output that a report names.

    Parameters
    ----------
    report : dict
        From `parse_provenance`.
    report_path : Path
        Where it lies; outputs are looked for from its folder, then where the run had put them.
    cancelled : callable, optional

    Returns
    -------
    list of Verified

    Raises
    ------
    ReflcolorError
        If the report names no hashes, or a file cannot be read.
    Cancelled
        If ``cancelled()`` returned True.
    """
    try:
        named = [entry for entry in report["outputs"] if entry["option"] != REPORT_OPTION]
        entries = [
            (report_path.parent / entry["from_report"], Path(entry["path"]), entry["bytes"], entry["sha256"])
            for entry in named
        ]
    except (KeyError, TypeError, ValueError):
        raise ReflcolorError(
            "{file}: does not hold the hashes of its outputs; it was written by an earlier release", file=report_path
        ) from None
    return [_verified(*entry, cancelled) for entry in entries]


def _verified(path, elsewhere, size, sha256, cancelled):
    if not _is_file(path) and _is_file(elsewhere):
        path = elsewhere
    if not _is_file(path):
        return Verified(path, MISSING, Message("there is no such file"))
    same_size = path.stat().st_size == size
    if same_size and fingerprint(path, cancelled)["sha256"] == sha256:
        return Verified(path, WHOLE, Message(""))
    if (fault := fault_of(path)) is not None:
        return Verified(path, CHANGED, fault)
    return Verified(path, CHANGED, Message("it is whole, but was written by another run or changed since"))


def _is_file(path):
    try:
        return path.is_file()
    except (OSError, ValueError):  # a name that is too long to be a file's
        return False
