"""The folder of a batch: where its results go, what was done already, and who works on what.

What it remembers lies in a folder of its own, which may be deleted; then everything is done again.
"""

import json
import os
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ...files.atomic import written_atomically
from ...files.locks import try_lock
from ...files.refusals import unwritable
from ...report.archive_entries import ITEMS, PAIRS, REPORTS, STATE
from ...report.report import REPORT_OPTION
from ..plan import PREVIEW, REPORT, Output


def files_below(folder):
    """Yield all files below a folder, except hidden ones, those that batches have written, and what may not be looked
    at; in the same order each time."""
    for root, folders, names in os.walk(folder):
        here = Path(root)
        shown = (name for name in folders if not name.startswith("."))
        folders[:] = sorted(name for name in shown if not is_there(here / name / STATE))
        paths = (here / name for name in sorted(names) if not name.startswith("."))
        yield from (path for path in paths if is_there(path) and path.is_file())


def is_there(path):
    """Whether a path can be looked at and is something; a name that no file can have is nothing."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


@dataclass(frozen=True)
class BatchFolder:
    """The folder of a batch.

    Parameters
    ----------
    root : Path
    """

    root: Path

    def result(self, label, suffix):
        """Where a result of a scan goes."""
        return self.root / f"{label}{suffix}"

    def render(self, label):
        """Where the rendered picture of a scan goes."""
        return self.root / f"{label} render.png"

    def records(self, label):
        """The outputs that describe a scan: its preview and its report, which is written last."""
        reports = self.root / REPORTS
        return Output("preview", reports / f"{label}.jpg", PREVIEW), Output(
            REPORT_OPTION, reports / f"{label}.json", REPORT
        )

    def log(self, name):
        """The log of everything printed while an item is processed."""
        return self.root / "logs" / f"{name}.log"

    @property
    def pairs(self):
        """The table of photos and the scans that they show."""
        return self.root / PAIRS

    def state(self, *parts):
        """A path in the folder where the batch keeps its records."""
        return self.root.joinpath(STATE, *parts)

    def sketch(self, key):
        """A small picture that is looked at, by the hash of what it shows."""
        return self.state("looks", f"{key}.png")

    def make(self):
        """Make the folders.

        Raises
        ------
        OutputError
            If they cannot be made.
        """
        for folder in (self.root, self.root / REPORTS, self.root / "logs"):
            _make(folder)
        for name in ("done", "begun", ITEMS, "locks", "matched", "looks", "pairs"):
            _make(self.state(name))

    @contextmanager
    def claimed(self, name):
        """Keep an item from every other batch while the block runs; gives False where another has it.

        The lock ends with the process, however that ends.
        """
        path = self.state("locks", name)
        try:
            file = path.open("ab")
        except OSError as error:
            raise unwritable(path, error) from error
        with file:
            # On file systems without locks, other batches cannot be kept out.
            yield try_lock(file) is not False

    def remember(self, kind, name, document):
        """Keep a document of JSON."""
        with written_atomically(self.state(kind, f"{name}.json")) as temporary:
            temporary.write_text(json.dumps(document, allow_nan=False), encoding="utf-8")

    def recall(self, kind, name):
        """Return a document that was kept; None where there is none, or none that can be read."""
        try:
            document = json.loads(self.state(kind, f"{name}.json").read_text(encoding="utf-8"))
        except (OSError, ValueError, RecursionError):
            return None
        return document if isinstance(document, dict) else None


def _make(folder):
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(folder, error) from error
