"""How a batch is worked on, and what became of its items."""

from dataclasses import dataclass, field

from .manifest import Item

LOOK, MATCH, COLOR, RENDERING = "look", "match", "color", "render"
STAGES = (LOOK, MATCH, COLOR, RENDERING)
DONE, FAILED, UNSHOWN, KNOWN = "done", "failed", "unshown", "known"
ELSEWHERE, DUPLICATE, OPEN = "elsewhere", "duplicate", "open"
"""What became of an item: done now; not done; no photo shows it; done before; another batch has it; the same as another
one; not begun."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """How a batch is worked on.

    Parameters
    ----------
    stages : tuple of str
        Some of `STAGES`.
    first, last : int, optional
        Places of the first and the last item, from 1; all without.
    resume : bool
        Leave out what was done before and did not change.
    keep_going : bool
        Go on with the others after one has failed.
    workers : int
        How many processes.
    memory : int
        Bytes that they may take together.
    tries : int
        How often something is tried that may pass, such as a full disk.
    wait_s : float
        How long to wait before it is tried again.
    """

    stages: tuple[str, ...] = STAGES
    first: int | None = None
    last: int | None = None
    resume: bool = False
    keep_going: bool = False
    workers: int
    memory: int
    tries: int = 3
    wait_s: float = 20.0

    def chosen(self, items):
        """Return the items to work on."""
        return list(items)[(self.first or 1) - 1 : self.last]


@dataclass(eq=False)
class State:
    """An item with what became of it.

    Parameters
    ----------
    item : Item
    outcome : str
    error : str
        Why it failed.
    left_out : list of str
        Scans of it that no photo shows.
    matched : list of dict
        What was found for each of its scans and the photos of the whole batch; see `match_stage.Matched.told`.
    photos : list of dict
        The same, with what was found while it was colorized; see `worker`.
    refused : set of str
        The paths of photos that do not show it, as a person says.
    effects : list of dict
        See `match_stage.Matched`.
    warnings : list of str
        What its work had to say.
    same_as : str
        The item that it is a duplicate of.
    """

    item: Item
    outcome: str = OPEN
    error: str = ""
    left_out: list[str] = field(default_factory=list)
    matched: list[dict] = field(default_factory=list)
    photos: list[dict] = field(default_factory=list)
    refused: set[str] = field(default_factory=set)
    effects: list[dict] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    same_as: str = ""

    def add_photos(self, found):
        """Keep what was found for photos while the item was colorized, beside what was found before."""
        known = {(pair["scan"], pair["path"]): pair for pair in self.matched}
        # What was found earlier may be of photos that a person has refused since.
        own = {(pair["scan"], pair["path"]): pair for pair in found if pair["path"] not in self.refused}
        self.photos = [
            known.get(key, {}) | own.get(key, {}) | {"doubt": known.get(key, {}).get("doubt", "")}
            for key in {**known, **own}
        ]
