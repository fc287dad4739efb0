"""Temporary folders, beside a file that is being written or elsewhere, and the removal of what killed runs have left.

Its name begins with ``.reflcolor-``, and it holds a file that stays locked as long as its run lives. The system
releases the lock when the run ends, however it ends; a process id would not work across containers and machines that
share a disk.
"""

import os
import shutil
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import gettempdir, mkdtemp

from .locks import try_lock

PREFIX = ".reflcolor-"
_LOCK = ".reflcolor-owner"
_TRIES = 100
# Folders that this process has already cleaned; anything found there later belongs to another run.
_cleaned: set[Path] = set()


@contextmanager
def work_folder(parent, *, rescue=None):
    """Give a new folder in ``parent`` that goes when the block ends; first remove those that killed runs left there.

    Parameters
    ----------
    parent : Path
    rescue : callable, optional
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


def scratch_folder(parent=None):
    """Give a `work_folder` in a place for temporary files, the system's unless another is given.

    It is for what goes from one program to another.
    """
    return work_folder(Path(parent or gettempdir()))


def _owned_folder(parent):
    for _ in range(_TRIES):
        folder = Path(mkdtemp(prefix=PREFIX, dir=parent))
        # Until the lock is held, another run may mistake the folder for an abandoned one and remove it.
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
    """Only folders of this user: in a shared place, others may leave something that looks like one."""
    if not entry.is_dir(follow_symlinks=False):
        return False
    return not hasattr(os, "geteuid") or entry.stat(follow_symlinks=False).st_uid == os.geteuid()


def _remove_unless_alive(folder, rescue):
    try:
        lock = (folder / _LOCK).open("r+b")
    except FileNotFoundError:
        # The run was killed before it locked anything; if it is alive and about to lock, it makes another folder.
        folder.rmdir()
        return
    with lock:
        if not try_lock(lock):
            return
        if rescue is not None:
            rescue(folder)
    shutil.rmtree(folder, ignore_errors=True)
