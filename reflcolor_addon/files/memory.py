"""Refuses work that cannot fit into memory before anything is allocated for it, and gives back what is free."""

import os
import sys
from functools import cache
from pathlib import Path

from ..errors import ReflcolorError


def available_bytes():
    """Memory that can still be taken, in bytes; None where the platform does not say."""
    if sys.platform == "win32":
        return _available_on_windows()
    on_linux = [free for free in (_free_of_the_machine(), _free_of_the_container()) if free is not None]
    if on_linux:
        return min(on_linux)
    try:
        # macOS does not report free memory; the installed memory is an upper bound.
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return None


def require_memory(needed, what, *, way=None, error=ReflcolorError):
    """Raise `error` in one line if `needed` bytes for `what` are more than there are; a `way` out is told with it."""
    available = available_bytes()
    if available is None or needed <= available:
        return
    values = {"what": what, "needed": readable(needed), "free": readable(available)}
    if way is not None:
        raise error("{what} needs about {needed} of memory, and {free} are free; {way}", way=way, **values)
    raise error("{what} needs about {needed} of memory, and {free} are free", **values)


def give_back():
    """Return free memory to the system, for use between the steps of a run.

    The C library of Linux keeps freed arrays of up to 32 MB each for later, which add up to half of what a run holds.
    """
    if trim := _trim():
        trim(0)


@cache
def _trim():
    """The C library's function for that; None where there is none."""
    if sys.platform != "linux":
        return None
    import ctypes

    # musl, for one, has no such function.
    return getattr(ctypes.CDLL(None), "malloc_trim", None)


def readable(count):
    for unit in ("bytes", "KB", "MB", "GB"):
        if count < 1024:
            return f"{count:.3g} {unit}"
        count /= 1024
    return f"{count:,.3g} TB"


def _free_of_the_machine():
    try:
        for line in Path("/proc/meminfo").read_text("ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    except (OSError, ValueError, IndexError):
        pass
    return None


def _free_of_the_container():
    folder = Path("/sys/fs/cgroup")
    try:
        # Without a limit the file says "max", which is no number.
        return max(0, int((folder / "memory.max").read_text()) - int((folder / "memory.current").read_text()))
    except (OSError, ValueError):
        return None


def _available_on_windows():
    import ctypes

    class Status(ctypes.Structure):
        _fields_ = (
            ("length", ctypes.c_ulong),
            ("load", ctypes.c_ulong),
            *((name, ctypes.c_ulonglong) for name in ("total", "free", "page_total", "page_free")),
            *((name, ctypes.c_ulonglong) for name in ("virtual_total", "virtual_free", "extended")),
        )

    status = Status(length=ctypes.sizeof(Status))
    if not ctypes.windll.kernel32.GlobalMemoryStatusEx(ctypes.byref(status)):
        return None
    return status.free
