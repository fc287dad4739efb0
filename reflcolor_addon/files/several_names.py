"""New contents for a file that has several names (hard links), all of which are to keep showing the same file.

Such a file cannot be replaced by another; its contents are overwritten where they are. The old contents are kept beside
it meanwhile, so that a run that fails puts them back, and the next run does it for one that was killed.
"""

import os
import shutil
import stat
from contextlib import suppress
from pathlib import Path

from .locks import wait_for_lock

_BEFORE = ".reflcolor-before"
_NAME = ".reflcolor-name"
_CHUNK = 1 << 20
_WAIT_S = 30


def rewrite(target, new):
    """Overwrite ``target`` with the contents of ``new``, a file in the run's own folder; an error leaves the old ones.

    Raises
    ------
    OSError
        If it cannot be written, or another program goes on writing it.
    """
    before, name = new.with_name(_BEFORE), new.with_name(_NAME)
    with target.open("r+b") as file:
        wait_for_lock(file, _WAIT_S)
        with before.open("wb") as kept:
            shutil.copyfileobj(file, kept, _CHUNK)
            kept.flush()
            os.fsync(kept.fileno())
        # Written last: from now on the next run puts the old contents back, unless this one ends well.
        name.write_bytes(b"%d\n" % os.fstat(file.fileno()).st_ino + os.fsencode(target.name))
        try:
            _overwrite(file, new)
        except BaseException:
            _overwrite(file, before)
            raise
        finally:
            name.unlink()


def complete_rewriting(folder):
    """Put back what a killed run was overwriting, as the folder that it left tells."""
    with suppress(FileNotFoundError):
        # A folder may as well have come with files that a stranger sent.
        if not all(stat.S_ISREG((folder / part).lstat().st_mode) for part in (_NAME, _BEFORE)):
            return
        inode, _, name = (folder / _NAME).read_bytes().partition(b"\n")
        target = folder.parent / Path(os.fsdecode(name)).name
        if b"%d" % target.stat(follow_symlinks=False).st_ino == inode:
            with target.open("r+b") as file:
                wait_for_lock(file, _WAIT_S)
                _overwrite(file, folder / _BEFORE)


def _overwrite(file, source):
    with source.open("rb") as contents:
        size = os.fstat(contents.fileno()).st_size
        if hasattr(os, "posix_fallocate") and size:
            # The room for it is taken first, so that a full disk is noticed before the old contents are touched.
            os.posix_fallocate(file.fileno(), 0, size)
        file.seek(0)
        shutil.copyfileobj(contents, file, _CHUNK)
        file.truncate(size)
        file.flush()
        os.fsync(file.fileno())
