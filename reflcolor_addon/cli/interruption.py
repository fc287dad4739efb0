"""Ctrl-C as a flag, so that work ends at a place of its own choice and leaves nothing half-made."""

import signal
import threading


class Interruption:
    """While its block runs, a signal to end only sets a flag; a second one raises KeyboardInterrupt.

    The handlers are installed here, whoever had them before: in Blender Python's own are not, and a shell's background
    job starts with Ctrl-C ignored. They are put back at the end. Outside the main thread nothing is installed.
    """

    def __init__(self):
        self._signal = None
        self._previous = {}

    def __enter__(self):
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                self._previous[number] = signal.signal(number, self._handle)
        return self

    def __exit__(self, *_):
        for number, handler in self._previous.items():
            # None is a handler that is not Python's; it cannot be put back from here.
            signal.signal(number, signal.SIG_DFL if handler is None else handler)

    def _handle(self, number, _frame):
        again, self._signal = self._signal is not None, number
        if again:
            raise KeyboardInterrupt

    def requested(self):
        """Whether a signal came."""
        return self._signal is not None

    @property
    def exit_status(self):
        """What a shell calls the signal that came: 130 for Ctrl-C, 143 for SIGTERM."""
        return 128 + (self._signal or signal.SIGINT)
