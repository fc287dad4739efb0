"""A file that native code reads in a child process, into memory that is shared with it."""

import contextlib
import importlib.util
import mmap
import os
import sys
import tempfile
import weakref
from pathlib import Path

from ...errors import ScanError
from ...messages import Message
from .child import Child, ChildFailed

_FAILURES = {
    "no python": "cannot be read: {kind} is read by a Python program of its own, and none was found beside Blender; "
    "export the scan as PTX",
    "not started": "cannot be read: the program that reads {kind} did not start ({detail}); close other programs",
    "crashed": "what reads {kind} crashed on it; the file is damaged, or made to do harm; export it again",
    "killed": "takes longer to read, or more memory, than its size explains; export it again, or as PTX",
    "stalled": "was not read on for {detail}; see whether its disk answers, or export it again",
    "garbage": "what reads {kind} answered what makes no sense; export the file again",
}


class ConfinedReading:
    """A child process that reads one file into shared memory; a context manager that ends it.

    Parameters
    ----------
    script : Path
        The child's program.
    kind : str
        Of the file, for messages: "E57".
    file : binary file
        Open; systems that cannot hand that on open it anew.
    path : Path
    size : int
        Bytes of the shared memory.
    limits : dict
        ``memory`` in bytes and ``seconds`` of the processor, which the child may take.
    request : dict
        What else the child is to know.
    reason_of : callable
        Makes the end of a message of what the child says of an error.
    cancelled : callable, optional

    Raises
    ------
    ScanError
        In one line, here and from every method.
    Cancelled
        If ``cancelled()`` returned True.
    """

    def __init__(self, script, kind, file, path, *, size, limits, request, reason_of, cancelled=None):
        self._path, self._kind, self._reason_of = path, kind, reason_of
        shared, shown = shared_file(size)
        try:
            self.memory = mmap.mmap(shared, size)
            if shown:
                # Windows lets nobody remove what is still mapped; the arrays that are handed out hold it.
                weakref.finalize(self.memory, _remove, shown)
            handed_on = sys.platform != "win32"
            with OneLine(path, kind):
                self._child = Child(
                    script, inherited=[file.fileno(), shared] if handed_on else [], cancelled=cancelled, **limits
                )
                self._child.ask(
                    {
                        "file": [file.fileno() if handed_on else None, str(path)],
                        "columns": [shared if handed_on else None, shown],
                        "written": size,
                        **limits,
                        **request,
                    }
                )
        finally:
            os.close(shared)

    def __enter__(self):
        try:
            self.answer(ready=1)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self._child.__exit__()

    def ask(self, request):
        """Send a request."""
        with OneLine(self._path, self._kind):
            self._child.ask(request)

    def answer(self, **most):
        """(kind, number) of the next answer, which is one of these kinds with a number from 0 to what each can be."""
        with OneLine(self._path, self._kind):
            answer = self._child.answer()
            if isinstance(answer.get("error"), str):
                raise ScanError("{file}: {reason}", file=self._path.name, reason=self._reason_of(answer["error"]))
            for kind, greatest in most.items():
                number = answer.get(kind)
                if isinstance(number, int) and 0 <= number <= greatest:
                    return kind, number
            raise ChildFailed("garbage")


class OneLine:
    """Turns a child's failure within the block into a ScanError."""

    def __init__(self, path, kind):
        self._path, self._kind = path, kind

    def __enter__(self):
        return self

    def __exit__(self, _kind, error, _traceback):
        if isinstance(error, ChildFailed):
            problem = Message(_FAILURES[error.why], kind=self._kind, detail=error.detail)
            raise ScanError("{file}: {problem}", file=self._path.name, problem=problem) from error
        return False


def shared_file(size):
    """A file that goes with its last user: its number, and its path where a child needs that."""
    if hasattr(os, "memfd_create"):
        number, shown = os.memfd_create("reflcolor"), ""
    else:
        number, shown = tempfile.mkstemp(prefix="reflcolor-")
        if sys.platform != "win32":
            Path(shown).unlink()
            shown = ""
    try:
        os.ftruncate(number, size)
    except OSError:
        os.close(number)
        if shown:
            _remove(shown)
        raise
    return number, shown


def _remove(path):
    with contextlib.suppress(OSError):
        Path(path).unlink()


def native_library(package, pattern):
    """Return the path of a native module in a package, by a pattern of its name; None where it is missing."""
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):
        spec = None
    folders = [Path(folder) for folder in spec.submodule_search_locations or ()] if spec else []
    files = (file for folder in folders for file in sorted(folder.glob(pattern)))
    return next((file for file in files if file.suffix in (".so", ".pyd")), None)
