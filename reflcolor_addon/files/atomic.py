"""Files that are whole or not there."""

import shutil
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

from ..errors import OutputError


@contextmanager
def written_atomically(path):
    """Give a temporary path to write to; rename it to ``path`` when the block ends well.

    It lies in a folder of its own beside ``path`` and has the same name, for writers that choose the format by it or
    leave a backup beside it.

    Raises
    ------
    OutputError
        If the folder is missing or not writable, ``path`` is a directory, or the disk is full.
    """
    path = Path(path)
    if path.is_dir():
        raise OutputError(f"{path}: cannot be written: it is a directory; name a file")
    try:
        folder = Path(mkdtemp(prefix=".reflcolor-", dir=path.parent))
    except OSError as error:
        raise OutputError(
            f"{path}: cannot be written ({error.strerror}); choose a folder that you may write to"
        ) from error
    try:
        yield folder / path.name
        (folder / path.name).replace(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error.strerror or error})") from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)
