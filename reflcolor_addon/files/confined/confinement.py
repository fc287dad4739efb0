"""The restrictions that a child process puts on itself before it opens an untrusted file; it imports nothing of the
package.

Each step is taken where the system has it; `confine` returns the names of those that were.
"""

import contextlib
import ctypes
import platform
import struct
import sys
from pathlib import Path

_KILLED_WITH_PARENT, _NO_NEW_PRIVILEGES, _FILTER_CALLS = 1, 38, 22
_SIGKILL = 9
_MOST_FILES = 64
# System calls of Linux that a reader of one open file does not need, by machine: network, starting programs, changing
# files, access to other processes.
_CALLS = {
    "x86_64": (
        0xC000003E,
        (41, 42, 43, 44, 46, 49, 50, 53, 288, 307),
        (56, 57, 58, 59, 322, 435, 101, 310, 311, 62, 200, 234),
        (76, 82, 83, 84, 85, 86, 87, 88, 90, 92, 94, 133, *range(258, 261), *range(263, 267), 268, 316, 425, 434, 437),
        {2: 1, 257: 2},
    ),
    "aarch64": (
        0xC00000B7,
        (198, 199, 200, 201, 202, 203, 206, 211, 242, 269),
        (220, 221, 281, 435, 117, 270, 271, 129, 130, 131),
        (33, 34, 35, 36, 37, 38, 45, 52, 53, 54, 276, 425, 434, 437),
        {56: 2},
    ),
}
_LOAD, _EQUAL, _ANY_BIT, _AT_LEAST, _RETURN = 0x20, 0x15, 0x45, 0x35, 0x06
_ALLOW, _REFUSE, _KILL = 0x7FFF0000, 0x00050000 | 13, 0x80000000
# O_WRONLY, O_RDWR, O_CREAT, O_TRUNC, O_APPEND.
_TO_WRITE = 0o1 | 0o2 | 0o100 | 0o1000 | 0o2000
_FIRST_X32_CALL = 0x40000000


def confine(*, memory, written, seconds):
    """Give up everything that is not needed to read one open file into memory; this cannot be undone.

    Parameters
    ----------
    memory : int
        Bytes of address space that may be used.
    written : int
        Bytes that a file may grow to.
    seconds : int
        Of the processor.

    Returns
    -------
    list of str
        What was done: "limits", "ends with parent", "calls", "sandbox".
    """
    done = []
    for name, step in (
        ("limits", lambda: _limit(memory, written, seconds)),
        ("ends with parent", _end_with_parent),
        ("calls", _filter_calls),
        ("sandbox", _leave_network),
    ):
        with contextlib.suppress(OSError, AttributeError, ImportError, ValueError):
            if step():
                done.append(name)
    return done


def _limit(memory, written, seconds):
    import resource

    for name, most in (
        ("RLIMIT_AS", memory),
        ("RLIMIT_CPU", seconds),
        ("RLIMIT_FSIZE", written),
        ("RLIMIT_NOFILE", _MOST_FILES),
        ("RLIMIT_CORE", 0),
    ):
        with contextlib.suppress(AttributeError, ValueError, OSError):
            number = getattr(resource, name)
            _, hard = resource.getrlimit(number)
            most = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.setrlimit(number, (most, most))
    return True


def _end_with_parent():
    if not sys.platform.startswith("linux"):
        return False
    return ctypes.CDLL(None).prctl(_KILLED_WITH_PARENT, _SIGKILL, 0, 0, 0) == 0


def _filter_calls():
    """Linux: system calls that are not needed fail with "permission denied" in this process from now on (seccomp)."""
    if not sys.platform.startswith("linux") or struct.calcsize("P") != 8:
        return False
    program = _program(platform.machine())

    class Program(ctypes.Structure):
        _fields_ = (("length", ctypes.c_ushort), ("instructions", ctypes.c_void_p))

    held = ctypes.create_string_buffer(program)
    whole = Program(len(program) // 8, ctypes.cast(held, ctypes.c_void_p))
    prctl = ctypes.CDLL(None, use_errno=True).prctl
    if prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0):
        return False
    return prctl(_FILTER_CALLS, 2, ctypes.byref(whole), 0, 0) == 0


def _program(machine):
    """The filter as the kernel wants it: eight bytes for an instruction.

    Raises
    ------
    ValueError
        For a machine whose calls are not known here.
    """
    if machine not in _CALLS:
        raise ValueError(machine)
    architecture, *refused, opening = _CALLS[machine]
    # Offsets in the kernel's description of a call: its number, the architecture, and the arguments from byte 16 on.
    lines = [(_LOAD, 0, 0, 4), (_EQUAL, 1, 0, architecture), (_RETURN, 0, 0, _KILL), (_LOAD, 0, 0, 0)]
    lines += [(_AT_LEAST, 0, 1, _FIRST_X32_CALL), (_RETURN, 0, 0, _REFUSE)]
    for number in sorted(number for group in refused for number in group):
        lines += [(_EQUAL, 0, 1, number), (_RETURN, 0, 0, _REFUSE)]
    for number, argument in opening.items():
        flags = 16 + 8 * argument
        lines += [(_EQUAL, 0, 4, number), (_LOAD, 0, 0, flags), (_ANY_BIT, 0, 1, _TO_WRITE), (_RETURN, 0, 0, _REFUSE)]
        lines += [(_RETURN, 0, 0, _ALLOW)]
    lines.append((_RETURN, 0, 0, _ALLOW))
    return b"".join(struct.pack("HBBI", *line) for line in lines)


def _leave_network():
    """macOS: no network for this process from now on."""
    if sys.platform != "darwin":
        return False
    library = ctypes.CDLL("/usr/lib/libSystem.dylib")
    error = ctypes.c_char_p()
    return library.sandbox_init(b"(version 1)(allow default)(deny network*)", 0, ctypes.byref(error)) == 0


def reopened(number, path):
    """A path by which native code opens a file that this process was given open; its own path where there is none."""
    for folder in ("/proc/self/fd", "/dev/fd"):
        if number is not None and Path(f"{folder}/{number}").exists():
            return f"{folder}/{number}"
    return path
