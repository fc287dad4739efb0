"""The parent's side of a child process that answers line by line: started, asked, watched, and ended."""

import contextlib
import json
import queue
import subprocess
import sys
import threading
import time

from ...errors import Cancelled
from .python_program import ALONE, python_program

_STALLED_S = 120
_LOOK_EVERY_S = 0.05
_LONGEST_LINE = 1 << 16
_ENDS_WITHIN_S = 10


class ChildFailed(Exception):
    """A child process crashed, hung, exceeded its limits, or gave an invalid answer.

    Parameters
    ----------
    why : {"no python", "not started", "crashed", "killed", "stalled", "garbage"}
        "killed": by a limit on its time.
    detail : str
    """

    def __init__(self, why, detail=""):
        super().__init__(why, detail)
        self.why, self.detail = why, detail


class Child:
    """A Python program that reads lines of JSON and answers in such lines; a context manager that ends it.

    Parameters
    ----------
    script : Path
    inherited : sequence of int
        Open files that it gets, by their numbers; POSIX.
    cancelled : callable, optional
        Asked several times a second while an answer is waited for; True ends the child at once.
    memory, seconds : int
        Limits that have to be set from here; Windows.
    """

    def __init__(self, script, *, inherited=(), cancelled=None, memory=None, seconds=None):
        program = python_program()
        if program is None:
            raise ChildFailed("no python")
        self._cancelled = cancelled
        options = {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {}
        if sys.platform != "win32":
            # In a group of its own, Ctrl-C reaches only the parent, which ends it.
            options = {"pass_fds": tuple(inherited), "start_new_session": True}
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
        try:
            self._process = subprocess.Popen([str(program), *ALONE, str(script)], **pipes, **options)
        except OSError as error:
            raise ChildFailed("not started", error.strerror or str(error)) from error
        self._let_go = contextlib.ExitStack()
        if sys.platform == "win32":
            from .windows_job import limited

            with contextlib.suppress(OSError):
                self._let_go.callback(limited(int(self._process._handle), memory=memory, seconds=seconds))
        self._answers = queue.SimpleQueue()
        threading.Thread(target=self._listen, name="reflcolor child", daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        # It only reads, so it can be ended at any moment.
        with contextlib.suppress(OSError):
            self._process.kill()
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        self._process.wait(_ENDS_WITHIN_S)
        self._let_go.close()

    def _listen(self):
        with self._process.stdout as answers:
            while line := answers.readline(_LONGEST_LINE):
                self._answers.put(line)
        self._answers.put(None)

    def ask(self, request):
        """Send a request."""
        # If the child has ended, waiting for its answer shows that.
        with contextlib.suppress(OSError):
            self._process.stdin.write(json.dumps(request).encode() + b"\n")
            self._process.stdin.flush()

    def answer(self):
        """Wait for the next answer and return it.

        Raises
        ------
        ChildFailed
            If there will be none, or it is no JSON object.
        Cancelled
            If ``cancelled()`` returned True.
        """
        end = time.monotonic() + _STALLED_S
        while True:
            if self._cancelled is not None and self._cancelled():
                raise Cancelled
            with contextlib.suppress(queue.Empty):
                line = self._answers.get(timeout=_LOOK_EVERY_S)
                break
            if time.monotonic() > end:
                raise ChildFailed("stalled", f"{_STALLED_S} s")
        if line is None:
            raise ChildFailed(*self._ended())
        try:
            found = json.loads(line)
        except (ValueError, RecursionError):
            found = None
        if not isinstance(found, dict):
            raise ChildFailed("garbage")
        return found

    def _ended(self):
        """Why it ended, as ChildFailed takes it."""
        try:
            status = self._process.wait(_ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:
            return "garbage", ""
        too_long = {"SIGXCPU", "SIGKILL"}
        name = _signal_name(-status) if status < 0 else ""
        return ("killed", name) if name in too_long else ("crashed", name or str(status))


def _signal_name(number):
    import signal

    try:
        return signal.Signals(number).name
    except ValueError:
        return str(number)
