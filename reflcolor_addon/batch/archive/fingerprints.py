"""Hashes of files and of the program itself; a file that did not change is not hashed again."""

import hashlib
import json
import time
from contextlib import suppress
from functools import cache
from pathlib import Path

from ...errors import OutputError
from ...files.locks import wait_for_lock
from ...geodesic.kernel import library_file
from ...report.report import fingerprint, versions

_NAME = "hashes"
# Another batch holds the file only while it writes it.
_WAITS_S = 2.0


class Fingerprints:
    """SHA-256 of files, remembered by their size and time.

    Parameters
    ----------
    folder : BatchFolder
    """

    def __init__(self, folder):
        self._folder = folder
        self._known, self._new, self._saved = self._recalled(), {}, 0.0

    def of(self, path, cancelled=None):
        """Return the hash of a file.

        Raises
        ------
        ReflcolorError
            If it cannot be read.
        Cancelled
        """
        path = Path(path)
        try:
            found = path.stat()
        except OSError:
            found = None
        key = str(path.absolute())
        state = None if found is None else [found.st_size, found.st_mtime_ns]
        entry = self._known.get(key)
        if entry is None or entry[:2] != state:
            entry = [*(state or [0, 0]), fingerprint(path, cancelled)["sha256"]]
            self._known[key] = self._new[key] = entry
        return entry[2]

    def save(self, every_s=0.0):
        """Keep what is known for the next time, unless that was done less than so many seconds ago.

        What other batches on the same folder have kept meanwhile, as tasks of a render farm do, stays. Where nothing
        can be kept, files are hashed again the next time.
        """
        if self._new and time.monotonic() - self._saved >= every_s:
            self._saved = time.monotonic()
            with suppress(OSError, OutputError), self._folder.state(f"{_NAME}.lock").open("ab") as file:
                wait_for_lock(file, _WAITS_S)
                self._known = self._known | self._recalled() | self._new
                self._folder.remember("", _NAME, self._known)
                self._new = {}

    def _recalled(self):
        known = self._folder.recall("", _NAME) or {}
        return {path: entry for path, entry in known.items() if isinstance(entry, list) and len(entry) == 3}


@cache
def program_digest():
    """Return a hash of everything else that results depend on: our code, the kernel, versions of libraries."""
    core = Path(__file__).resolve().parents[2]
    kernel = library_file()
    found = [versions(), None if kernel is None else hashlib.sha256(kernel.read_bytes()).hexdigest()]
    digest = hashlib.sha256(json.dumps(found, sort_keys=True).encode())
    for path in sorted(core.rglob("*.py"), key=lambda path: path.relative_to(core).as_posix()):
        digest.update(path.relative_to(core).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def digest_of(document):
    """Return the hash of a value that can be written as JSON."""
    return hashlib.sha256(json.dumps(document, sort_keys=True, allow_nan=False).encode()).hexdigest()
