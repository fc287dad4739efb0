"""A folder of its own beside a file that is being written, and the end of those that a killed run has left.

Its name begins with ``.reflcolor-``, and it holds a file that stays locked as long as its run lives. The system gives
the lock up when the run ends, however it ends; a number of a process would not tell that, across containers and
machines that share a disk.
"""

import os
import shutil
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import mkdtemp

from .locks import try_lock

PREFIX = ".reflcolor-"
_LOCK = ".reflcolor-owner"
_TRIES = 100
# Folders that this process has already cleaned; what is left there later was left by another.
_cleaned: set[Path] = set()


@contextmanager
def work_folder(parent, *, rescue):
    """Give a new folder in ``parent`` that goes when the block ends; first remove those that killed runs left there.

    Parameters
    ----------
    parent : Path
    rescue : callable
        Called as ``rescue(folder)`` with each folder of a killed run before it is removed.

    Raises
    ------
    OSError
        If the folder cannot be made.
    """
    _clean(parent, rescue)
    folder, lock = _owned_folder(parent)
    try:
        yield folder
    finally:
        # Windows removes no file that is open.
        lock.close()
        shutil.rmtree(folder, ignore_errors=True)


def _owned_folder(parent):
    for _ in range(_TRIES):
        folder = Path(mkdtemp(prefix=PREFIX, dir=parent))
        # Until the lock is held, another run may take the folder for one that was left, and remove it.
        with suppress(FileNotFoundError):
            lock = (folder / _LOCK).open("xb")
            if try_lock(lock) is not False and os.fstat(lock.fileno()).st_nlink:
                return folder, lock
            lock.close()
    raise OSError(f"no folder of its own could be kept in {parent}")


def _clean(parent, rescue):
    place = parent.absolute()
    if place in _cleaned:
        return
    _cleaned.add(place)
    with suppress(OSError), os.scandir(parent) as entries:
        left = [Path(entry) for entry in entries if entry.name.startswith(PREFIX) and _is_ours(entry)]
        for folder in left:
            with suppress(OSError):
                _remove_unless_alive(folder, rescue)


def _is_ours(entry):
    """A folder of this user: in a place for everybody, others may leave what looks like one."""
    if not entry.is_dir(follow_symlinks=False):
        return False
    return not hasattr(os, "geteuid") or entry.stat(follow_symlinks=False).st_uid == os.geteuid()


def _remove_unless_alive(folder, rescue):
    try:
        lock = (folder / _LOCK).open("r+b")
    except FileNotFoundError:
        # Killed before it locked anything; where that is still to come, its run makes another folder.
        folder.rmdir()
        return
    with lock:
        if not try_lock(lock):
            return
        rescue(folder)
    shutil.rmtree(folder, ignore_errors=True)
