"""Keeps native libraries from printing beside the one line that an error is."""

import contextlib
import os
import sys
import tempfile
import threading

_LOCK = threading.RLock()


@contextlib.contextmanager
def quiet_on_failure():
    """Hold back what native code writes to stderr in this block; drop it if the block raises, else let it through.

    Image and scan libraries print about a broken file before they return their error, which then reads as several.
    """
    with _LOCK, contextlib.ExitStack() as stack:
        try:
            with contextlib.suppress(AttributeError, ValueError):
                sys.stderr.flush()
            held = stack.enter_context(tempfile.TemporaryFile())
            original = os.dup(2)
        except OSError:
            # A windowed program may have no stderr at all: then there is nothing to hold back.
            yield
            return
        stack.callback(os.close, original)
        os.dup2(held.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(original, 2)
        held.seek(0)
        if text := held.read():
            os.write(2, text)
