"""Keeps the output of native libraries apart from the messages that the user reads."""

import contextlib
import os
import sys
import tempfile
import threading

_LOCK = threading.RLock()
_MOST = 1 << 16


@contextlib.contextmanager
def native_output_aside():
    """Hold back what native code writes to stderr in this block; gives a list that holds its lines afterwards.

    Image libraries print warnings before they return an error, which would then appear as several, and about oddities
    of valid files.
    """
    lines = []
    with _LOCK, contextlib.ExitStack() as stack:
        try:
            with contextlib.suppress(AttributeError, ValueError):
                sys.stderr.flush()
            held = stack.enter_context(tempfile.TemporaryFile())
            original = os.dup(2)
        except OSError:
            # A windowed program may have no stderr at all: then there is nothing to capture.
            yield lines
            return
        stack.callback(os.close, original)
        os.dup2(held.fileno(), 2)
        try:
            yield lines
        finally:
            os.dup2(original, 2)
            held.seek(0)
            lines += held.read(_MOST).decode(errors="replace").splitlines()
