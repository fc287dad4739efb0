"""The native kernel's library and how its functions are called: types, error codes, cancelling.

The library lives in the package ``reflcolor_kernel`` (one wheel per platform, bundled with the extension) and is called
through ctypes, so that the interpreter is free while it runs and threads of Python run side by side.
"""

import ctypes
import functools
from pathlib import Path

import numpy as np

from ..errors import Cancelled, ReflcolorError

ABI_VERSION = 6
MAX_CHANNELS = 4
"""Values that a seed can have, of which means and sums are taken."""

OK, _CANCELLED, _MEMORY = 0, 1, 2
SHORT, BAD_VALUE = 3, -3
_REFUSED = {
    -1: "a null pointer",
    -2: "an image that is empty or too large for 32-bit pixel indices",
    -3: "a value that is negative, not a number, infinite or out of its range",
    -4: "a seed outside the image or on a pixel without a return",
}

_i32, _i64, _f32, _pointer = ctypes.c_int32, ctypes.c_int64, ctypes.c_float, ctypes.c_void_p


class CGraph(ctypes.Structure):
    """rc_graph of the kernel's header."""

    _fields_ = (
        ("height", _i64),
        ("width", _i64),
        ("neighbors", _i32),
        ("wrap", _i32),
        ("beta", _f32),
        ("step_cost", _f32),
        ("y", _pointer),
        ("d", _pointer),
    )


class _CControl(ctypes.Structure):
    _fields_ = (("cancel", _pointer), ("progress", _pointer))


_graph_pointer, _control_pointer = ctypes.POINTER(CGraph), ctypes.POINTER(_CControl)
_FUNCTIONS = {
    "rc_abi_version": (_i32,),
    "rc_plane_size": (_i64, _i64, _i64),
    "rc_graph_fill": (_i32, _i64, _i64, _i32, *[_pointer, _i64] * 3, _pointer, _pointer, _control_pointer),
    "rc_field": (_i32, _graph_pointer, _i64, _pointer, _pointer, _pointer, _control_pointer),
    "rc_nearest_bounds": (
        *(_i32, _graph_pointer, _i64, _pointer, _i32, _i32),
        *[_pointer] * 2,
        _control_pointer,
    ),
    "rc_nearest_part": (
        *(_i32, _graph_pointer, _pointer, _i64, _pointer, _pointer, _i32),
        *[_pointer] * 2,
        _control_pointer,
    ),
    "rc_nearest_merge": (
        *(_i32, _graph_pointer, _i64, _i64, _pointer, _i32, _i32),
        *[_pointer] * 2,
        _control_pointer,
    ),
    "rc_blend_add": (
        *(_i32, _i64, _i64, _pointer, _i64, _f32, _i32, _i32, _pointer),
        *[_pointer] * 4,
        *(_i64, _control_pointer),
    ),
    "rc_blend_finish": (_i32, _i64, _pointer, _i32, _pointer, _i64),
    "rc_blend_nearest": (
        *(_i32, _graph_pointer, _i64, _i64, _i32, _pointer, _i64, _i32, _pointer, _f32),
        *[_pointer] * 5,
    ),
    "rc_numbers": (_i32, _i64, _pointer, _i64, _i32, _pointer, _pointer),
    "rc_kriging": (_i32, _i64, _pointer, _i64, _pointer, _i32, *[_pointer] * 2, _control_pointer),
}


@functools.cache
def _load():
    """(library, None), or (None, why not)."""
    try:
        import reflcolor_kernel

        library = ctypes.CDLL(str(reflcolor_kernel.library_path()))
    except ImportError:
        return None, "no kernel for this platform is installed (package reflcolor_kernel)"
    except OSError as error:
        return None, f"the kernel does not load: {error}"
    try:
        for name, (result, *arguments) in _FUNCTIONS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except AttributeError as error:
        return None, f"the kernel is not the one this version needs: {error}"
    version = library.rc_abi_version()
    if version != ABI_VERSION:
        return None, f"the kernel has interface {version}, this version needs {ABI_VERSION}"
    return library, None


def library_file():
    """The path of the kernel that loaded; None where none did."""
    if not available():
        return None
    import reflcolor_kernel

    return Path(reflcolor_kernel.library_path())


def available():
    """Whether the kernel loaded."""
    return _load()[0] is not None


def reason():
    """Why the kernel did not load, one line; None if it did."""
    return _load()[1]


def library():
    """The library; a ReflcolorError says why there is none."""
    loaded, why = _load()
    if loaded is None:
        raise ReflcolorError("the native kernel did not load: {reason}", reason=why)
    return loaded


def check(code):
    """Raise what a code that a function of the kernel returned stands for."""
    if code == _CANCELLED:
        raise Cancelled
    if code == _MEMORY:
        raise MemoryError
    if code != OK:
        raise ReflcolorError("the kernel refused {code}", code=_REFUSED.get(code, f"its arguments (code {code})"))


def address(array):
    """Where an array's first value lies."""
    return array.ctypes.data


class Control:
    """Cancels a running call from another thread and tells how far it is.

    ``cancel()`` makes every call that was given this object raise `Cancelled`, those running within a millisecond
    or so. ``done`` counts pixels settled (`field`) or seeds finished (`nearest`).
    """

    def __init__(self):
        self._cancel, self._done = np.zeros(1, np.int32), np.zeros(1, np.int64)
        self._c = _CControl(address(self._cancel), address(self._done))

    def cancel(self):
        """Stop the calls that use this object."""
        self._cancel[0] = 1

    def uncounted(self):
        """Return a Control that is cancelled together with this one, but whose work does not count."""
        other = Control()
        other._cancel, other._c = self._cancel, _CControl(address(self._cancel), None)
        return other

    @property
    def cancelled(self):
        """Whether `cancel` was called."""
        return bool(self._cancel[0])

    @property
    def done(self):
        """Units of work finished since the object was made."""
        return int(self._done[0])


def pointer_to(control):
    """A Control as the kernel takes it; None stays None."""
    return None if control is None else ctypes.byref(control._c)
