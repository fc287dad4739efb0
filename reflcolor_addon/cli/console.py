"""What the command line says: results on standard output, everything else on standard error."""

import os
import shutil
import sys
import time
from contextlib import suppress

from ..errors import OutputError
from ..messages import LONGEST_LINE, one_line

_REDRAW_S = 0.1


class Console:
    """Writes lines, one at a time, whatever is in them; shows progress where standard error is a terminal."""

    def __init__(self):
        self._is_terminal = sys.stderr is not None and sys.stderr.isatty()
        self._shown = 0
        self._next_redraw = 0.0

    def print(self, text):
        """Write a result to standard output. It is no error if nobody reads it (``info ... | head``).

        Raises
        ------
        OutputError
            If standard output cannot be written for another reason, such as a full disk.
        """
        self._clear()
        try:
            sys.stdout.write(_encodable(text, sys.stdout) + "\n")
            sys.stdout.flush()
        except OSError as error:
            _silence(sys.stdout)
            if not isinstance(error, BrokenPipeError):
                raise OutputError(f"standard output: cannot be written ({error.strerror})") from error

    def warn(self, text):
        """Write one line ``warning: ...`` to standard error."""
        self._line(f"warning: {text}")

    def error(self, text):
        """Write one line ``error: ...`` to standard error."""
        self._line(f"error: {text}")

    def progress(self, fraction, text):
        """Show how far the work is, over what was shown before; nothing if standard error is no terminal."""
        now = time.monotonic()
        if not self._is_terminal or now < self._next_redraw:
            return
        self._next_redraw = now + _REDRAW_S
        line = one_line(f"{fraction:4.0%}  {text}", LONGEST_LINE)[: shutil.get_terminal_size().columns - 1]
        self._write(f"\r{line:<{self._shown}}")
        self._shown = len(line)

    def _line(self, text):
        self._clear()
        self._write(one_line(text, LONGEST_LINE) + "\n")

    def _clear(self):
        if self._shown:
            self._write("\r" + " " * self._shown + "\r")
            self._shown = 0

    def _write(self, text):
        # Standard error is the last place to complain at.
        with suppress(OSError):
            sys.stderr.write(_encodable(text, sys.stderr))
            sys.stderr.flush()


def _encodable(text, stream):
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


def _silence(stream):
    """Send what is still to come, the interpreter's last flush too, to nowhere."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)
