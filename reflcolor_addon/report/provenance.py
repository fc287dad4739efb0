"""Describes for people where the colors of a report come from: which are evidence, and which are inference."""

import json
from collections import Counter
from dataclasses import dataclass

from ..errors import ReflcolorError
from ..files.json_files import read_json
from ..messages import Message
from ..seeds.sources import EVIDENCE, FOUND, GUESSED, HAND, IN_PHOTO
from .report import FORMAT, VERSION

_LARGEST_FILE = 1 << 28


@dataclass(frozen=True, kw_only=True)
class Provenance:
    """The outline of a report.

    Parameters
    ----------
    created : str
        UTC, as in ISO 8601; empty where it was not kept.
    inputs : tuple of (role, path, sha256)
        ``sha256`` is None where the file was not seen.
    sources : dict
        Seeds by source, in the order of ``EVIDENCE``, those that occur. They are the evidence.
    observed : tuple of (str, int)
        Photos, and how many pixels have the color that each shows there. They are evidence, too.
    inferred : int
        Pixels whose color was spread from the seeds.
    unreached : int
        Pixels that no seed reaches; they are gray.
    guessed : bool
        Whether all seeds were found by likeness alone, so that nothing of the colors is evidence.
    versions : dict
        Of reflcolor and of Blender, where they are known.
    """

    created: str
    inputs: tuple[tuple[str, str, str | None], ...]
    sources: dict[str, int]
    observed: tuple[tuple[str, int], ...]
    inferred: int
    unreached: int
    guessed: bool
    versions: dict[str, str]


def parse_provenance(text):
    """Return the report that a text holds.

    Raises
    ------
    ReflcolorError
        If it holds none that this version can read.
    """
    try:
        report = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ReflcolorError("the provenance is not JSON") from error
    return _checked(report)


def _checked(report):
    if not isinstance(report, dict) or (report.get("format"), report.get("version")) != (FORMAT, VERSION):
        raise ReflcolorError(
            'the provenance is not of the format "{format}", version {version}', format=FORMAT, version=VERSION
        )
    return report


def read_report(path):
    """Return the report that a JSON file holds.

    Raises
    ------
    ReflcolorError
        If the file cannot be read, or holds no report that this version can read.
    """
    report = read_json(path, Message("a report in JSON"), most=_LARGEST_FILE)
    try:
        return _checked(report)
    except ReflcolorError as error:
        raise ReflcolorError("{file}: {problem}", file=path, problem=error.message) from error


def outline(report):
    """Return the Provenance of a report.

    Raises
    ------
    ReflcolorError
        If something is missing in it.
    """
    try:
        found = Counter(_source(seed) for seed in report["seeds"])
        # Reports of earlier versions have nothing observed.
        observed = [(photo["name"], photo.get("observed", 0)) for photo in report["photos"]]
        seen = sum(count for _, count in observed)
        # A seed is a pixel that was not inferred; several may lie on the same one. Those found in photos are among what
        # the photos saw.
        evidence = {(seed["row"], seed["col"]) for seed in report["seeds"] if not seen or seed["reason"] not in FOUND}
        return Provenance(
            created=str(report.get("created", "")),
            inputs=tuple((entry["role"], entry["path"], entry["sha256"]) for entry in report["inputs"]),
            sources={source: found[source] for source in EVIDENCE if found[source]},
            observed=tuple(entry for entry in observed if entry[1]),
            inferred=report["result"]["colored"] - seen - len(evidence),
            unreached=report["result"]["unreached"],
            guessed=bool(found) and GUESSED.issuperset(found),
            versions={name: report["versions"][name] for name in ("reflcolor", "blender") if report["versions"][name]},
        )
    except (KeyError, TypeError) as error:
        raise ReflcolorError("the provenance is incomplete") from error


def _source(seed):
    if seed["reason"] in (None, HAND):
        return HAND if seed["photo"] is None else IN_PHOTO
    return seed["reason"]
