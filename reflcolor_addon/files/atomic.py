"""Writes files completely or not at all; every output takes this way, Blender's own files included."""

import os
import stat
import sys
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import OutputError
from .refusals import unwritable
from .several_names import complete_rewriting, rewrite
from .whole import fault_of
from .work_folder import work_folder

_NOT_WHOLE = "{file}: was not written completely ({fault}); check whether the disk is full. Any earlier file was kept"


@contextmanager
def written_atomically(path):
    """Give a temporary path to write to; when the block ends well, what is there takes the place of ``path``.

    The temporary path lies in a folder of its own beside ``path`` and has the same name, for writers that choose the
    format by it or leave a backup beside it. What was written is checked (`whole.fault_of`) and flushed to the disk
    before it takes the place; until then what was there is untouched. A link is followed; an existing file keeps its
    permissions, its owner where that is allowed, and all its names (hard links). What killed runs have left in the
    folder is removed first, never what belongs to a run that is alive.

    Raises
    ------
    OutputError
        If the folder is missing or not writable, ``path`` is a directory, a device or write-protected, or the disk is
        full.
    """
    path = Path(path)
    target, found = _destination(path)
    try:
        with work_folder(target.parent, rescue=complete_rewriting) as folder:
            yield (temporary := folder / target.name)
            if (fault := fault_of(temporary)) is not None:
                raise OutputError(_NOT_WHOLE, file=path, fault=fault)
            _take_place(temporary, target, found)
    except OSError as error:
        raise unwritable(path, error) from error


def require_writable(path):
    """Find out before the work begins whether `written_atomically` can write there.

    Raises
    ------
    OutputError
        As `written_atomically`, as far as it can be known.
    """
    path = Path(path)
    target, _ = _destination(path)
    folder = target.parent
    try:
        if not folder.is_dir():
            raise OutputError(
                "{file}: cannot be written: there is no folder {folder}; make it first", file=path, folder=folder
            )
        # A permission check proves nothing (read-only and full disks, network shares); writing a file does.
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"\0")
    except OSError as error:
        raise unwritable(path, error) from error


def _destination(path):
    """Where the file really goes, and what is there: its `os.stat_result`, or None."""
    try:
        target = Path(os.path.realpath(path)) if path.is_symlink() else path
        found = target.stat()
    except FileNotFoundError:
        return target, None
    except (OSError, ValueError) as error:
        raise unwritable(path, error) from error
    if stat.S_ISDIR(found.st_mode):
        raise OutputError("{file}: cannot be written: it is a directory; name a file", file=path)
    if not stat.S_ISREG(found.st_mode):
        raise OutputError("{file}: cannot be written: it is not an ordinary file; name another", file=path)
    if not os.access(target, os.W_OK):
        raise OutputError("{file}: cannot be written: it exists and is write-protected; choose another name", file=path)
    return target, found


def _take_place(temporary, target, found):
    with temporary.open("r+b") as file:
        if found is not None:
            _keep_permissions(temporary, found)
        # A network disk may report only now that it is full.
        os.fsync(file.fileno())
    if found is not None and found.st_nlink > 1:
        rewrite(target, temporary)
    else:
        temporary.replace(target)
    _flush_folder(target.parent)


def _keep_permissions(temporary, found):
    if hasattr(os, "chown"):
        with suppress(OSError):
            os.chown(temporary, found.st_uid, found.st_gid)
    temporary.chmod(stat.S_IMODE(found.st_mode))


def _flush_folder(path):
    """Flush the new name to the disk as well, where the system allows it."""
    if sys.platform == "win32":
        return
    with suppress(OSError):
        folder = os.open(path, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
