"""Signals that end a run: a flag while it works, so that work ends at a place of its own choice and leaves nothing.

Ctrl-C (SIGINT), SIGTERM and, where there is one, SIGHUP, which comes when a terminal is closed. Nothing heavy is
imported here: this is the first that ``python -m reflcolor_addon`` imports.
"""

import os
import signal
import threading

STATUS = 128
"""A process that a signal ended has this plus the signal's number as its exit status: 130, 143, 129."""
_SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


class Interruption:
    """While its block runs, a signal to end only sets a flag; the second one raises KeyboardInterrupt.

    The handlers are installed here, whoever had them before: in Blender Python's own are not, and a shell's background
    job starts with Ctrl-C ignored. Only an ignored SIGHUP stays so: that is what nohup asks for. They are put back at
    the end. Outside the main thread nothing is installed.
    """

    def __init__(self):
        self._signal = None
        self._count = 0
        self._previous = {}

    def __enter__(self):
        self._previous = _listen(self._handle)
        return self

    def __exit__(self, *_):
        for number, handler in self._previous.items():
            # None is a handler that is not Python's; it cannot be put back from here.
            signal.signal(number, signal.SIG_DFL if handler is None else handler)

    def _handle(self, number, _frame):
        if self._signal is None:
            self._signal = number
        self._count += 1
        # Only once: further signals while the work is ending have no effect.
        if self._count == 2:
            raise KeyboardInterrupt

    def requested(self):
        """Whether a signal came."""
        return self._signal is not None

    @property
    def exit_status(self):
        """What a shell calls the signal that came: 130 for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP."""
        return STATUS + (self._signal or signal.SIGINT)


def leave_at_once():
    """From now on a signal to end ends the process with one line; for a program that has only begun to start."""
    _listen(_leave)


def ignore():
    """From now on signals to end are ignored; for a program that has said what came of its work and ends."""
    _listen(signal.SIG_IGN)


def _listen(handler):
    """Install a handler for every signal to end; return the handlers that there were."""
    if threading.current_thread() is not threading.main_thread():
        return {}
    listened = [number for number in _SIGNALS if number == signal.SIGINT or signal.getsignal(number) != signal.SIG_IGN]
    return {number: signal.signal(number, handler) for number in listened}


def _leave(number, _frame):
    # Without the interpreter's own way out: what is half imported cannot be relied on, and nothing was begun.
    try:
        os.write(2, b"error: interrupted\n")
    finally:
        os._exit(STATUS + number)
