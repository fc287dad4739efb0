"""Locks on open files, which the system gives up when a process ends, however it ends."""

import errno
import os
import sys
import time

_ASK_AGAIN_S = 0.05


def try_lock(file):
    """Take the lock of an open file: True where it is ours now, False where another has it.

    None where this file system knows no locks.
    """
    try:
        if sys.platform == "win32":
            import msvcrt

            file.seek(0)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:
        return None
    return True


def wait_for_lock(file, seconds):
    """Take the lock of an open file, waiting for it at most that long; OSError where another keeps it."""
    end = time.monotonic() + seconds
    while try_lock(file) is False:
        if time.monotonic() > end:
            raise OSError(errno.EBUSY, os.strerror(errno.EBUSY))
        time.sleep(_ASK_AGAIN_S)
