"""The output of the command line: results on standard output, everything else on standard error."""

import os
import shutil
import sys
import time
from contextlib import suppress
from pathlib import Path

from ..errors import OutputError
from ..messages import LONGEST_LINE, one_line

_REDRAW_S = 0.1


def open_standard_streams():
    """Open standard input, output and error on nothing where they are closed.

    Otherwise the next files that are opened get their numbers, and what native code prints would go into those.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            # The system gives the lowest number that is free, which is this one.
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
    for number, name in enumerate(("stdout", "stderr"), 1):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(number, "w", encoding="utf-8", closefd=False))


class Console:
    """Writes lines, one at a time, with any content; shows progress where standard error is a terminal."""

    def __init__(self):
        self._is_terminal = sys.stderr.isatty()
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
                raise OutputError("standard output: cannot be written ({strerror})", strerror=error.strerror) from error

    def finish(self):
        """Flush the output, so that the interpreter reports no error when it exits."""
        for stream in (sys.stdout, sys.stderr):
            try:
                stream.flush()
            except OSError:
                _silence(stream)

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
        try:
            sys.stderr.write(_encodable(text, sys.stderr))
            sys.stderr.flush()
        except OSError:
            # There is nowhere left to report that standard error fails.
            _silence(sys.stderr)


def _encodable(text, stream):
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


def _silence(stream):
    """Discard all further output, including the interpreter's last flush."""
    with suppress(OSError), Path(os.devnull).open("wb") as nowhere:
        os.dup2(nowhere.fileno(), stream.fileno())
