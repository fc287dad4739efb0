"""Finds files of a batch that are the same, so that nothing is worked on twice."""

import hashlib
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...messages import Message
from ..paths import scan_files
from ..plan import PLACEHOLDER

# So many bytes of each file are compared before whole files are.
_BEGINNING = 1 << 20


@dataclass(frozen=True, kw_only=True)
class Duplicates:
    """What is the same in a batch.

    Parameters
    ----------
    photos : dict of Path to Path
        For each photo that is the same, byte for byte, as another one: that.
    items : dict of str to str
        For each item of the same scans and with the same plan as another one: the name of that.
    scans : dict of Path to Path
        For each file of a scan that is the same as another one: that. If its plan is another, it is worked on.
    """

    photos: dict[Path, Path] = field(default_factory=dict)
    items: dict[str, str] = field(default_factory=dict)
    scans: dict[Path, Path] = field(default_factory=dict)

    def told(self, name_of):
        """Yield a `Message` for each file that is the same as another one; ``name_of`` gives the name of a path."""
        for path, first in self.photos.items():
            photo, first = name_of(path), name_of(first)
            yield Message("{photo}: the same photo as {first}, so it is left out", photo=photo, first=first)
        for path, first in self.scans.items():
            yield Message("{scan}: the same scan as {first}", scan=name_of(path), first=name_of(first))


def duplicates(manifest, hash_of):
    """Return the `Duplicates` of a manifest.

    Parameters
    ----------
    manifest : Manifest
    hash_of : callable
        Returns the hash of a file as text, an empty one where it cannot be read. Only files of one size that begin
        alike are hashed.
    """
    photos = _same({path: [path] for path in manifest.photos}, hash_of)
    files = {path: scan_files(path) for item in manifest.items for path in item.plan.scans}
    scans = _same(files, hash_of)
    items, first = {}, {}
    for item in sorted(manifest.items, key=lambda item: _length(item.plan.scans[0])):
        if PLACEHOLDER in f"{item.plan.seeds} {item.plan.hand}":
            continue
        own = tuple(scans.get(path, path) for path in item.plan.scans)
        key = repr(replace(item.plan, scans=own, name=None))
        if key in first:
            items[item.name] = first[key]
        first.setdefault(key, item.name)
    return Duplicates(photos=photos, items=items, scans=scans)


def _same(files, hash_of):
    """For each path whose files are the same as those of another one: that with the shortest name, not "a (copy)"."""
    by_size, same = {}, {}
    for key, paths in files.items():
        sizes = tuple(map(_size, paths))
        if None not in sizes:
            by_size.setdefault(sizes, []).append(key)
    for keys in by_size.values():
        first = {}
        for key in _that_begin_alike(sorted(keys, key=_length), files):
            hashes = tuple(hash_of(path) for path in files[key])
            if all(hashes) and first.setdefault(hashes, key) != key:
                same[key] = first[hashes]
    return same


def _that_begin_alike(keys, files):
    """Those of some keys whose files begin as those of another one; large files are not read whole for nothing."""
    if len(keys) < 2:
        return []
    beginnings = {key: tuple(map(_beginning, files[key])) for key in keys}
    count = Counter(beginnings.values())
    return [key for key in keys if count[beginnings[key]] > 1 and None not in beginnings[key]]


def _beginning(path):
    """A hash of the first part of a file; None where it cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.sha256(file.read(_BEGINNING)).digest()
    except OSError:
        return None


def _length(path):
    return len(path.name), len(str(path))


def _size(path):
    try:
        return path.stat().st_size
    except OSError:
        return None
