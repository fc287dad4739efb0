"""A batch as its manifest describes it: scans with what is to be done with them, and the photos for all."""

from dataclasses import dataclass, replace
from pathlib import Path

from ..plan import Plan
from .folder import BatchFolder


@dataclass(frozen=True, kw_only=True)
class Item:
    """One piece of a batch: the scans of one file, or those of one site, which are matched together.

    Parameters
    ----------
    name : str
        What its files are called; no other item's is the same, not even in capitals.
    plan : Plan
    offered : bool
        Whether its photos are those of the whole batch, of which has to be found out which ones show it.
    line : int
        Where the manifest names it.
    blender_line : int
        Where it asks for what only Blender can do, if it does.
    number : int, optional
        Which scan of a file is meant, where the manifest says that by a number; see `Plan.wanted`.
    """

    name: str
    plan: Plan
    offered: bool
    line: int
    blender_line: int
    number: int | None = None


@dataclass(frozen=True, kw_only=True)
class Manifest:
    """A whole batch.

    Parameters
    ----------
    path : Path
        Of the manifest.
    folder : BatchFolder
        Where all its files go.
    items : tuple of Item
    photos : tuple of Path
        Those of the whole batch.
    pairs : Path or None
        A table that says which photos show which scans, as far as a person knows.
    photo_lines : dict of Path to int
        Where the manifest names each photo, of one scan as well.
    """

    path: Path
    folder: BatchFolder
    items: tuple[Item, ...]
    photos: tuple[Path, ...]
    pairs: Path | None
    photo_lines: dict[Path, int]

    def with_photos(self, photos):
        """Return the same batch with some of its photos only."""
        items = (
            replace(item, plan=replace(item.plan, photos=tuple(photos))) if item.offered else item
            for item in self.items
        )
        return replace(self, photos=tuple(photos), items=tuple(items))

    def name_of(self, path):
        """Return a path as the manifest's folder sees it, with slashes; so tables and reports name photos and scans."""
        try:
            return Path(path).relative_to(self.path.parent).as_posix()
        except ValueError:
            return Path(path).as_posix()
