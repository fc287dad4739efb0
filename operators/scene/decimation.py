"""Blender's own decimation, in a Blender of its own: the window goes on, and the memory it takes is given back."""

import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import bpy
import numpy as np

from ...reflcolor_addon.errors import Cancelled, ReflcolorError
from ...reflcolor_addon.files.confined.python_program import python_program
from ...reflcolor_addon.messages import Message
from .temporary import temporary_folder

_PROGRAM = Path(__file__).with_name("decimation_program.py")
_LOOK_EVERY_S = 0.1
_ENDS_WITHIN_S = 10


def decimate(coordinates, corners, sizes, fixed, faces, *, progress=None, cancelled=None):
    """Merge vertices of a mesh until it has so few triangles.

    Parameters
    ----------
    coordinates : (V, 3) float32
    corners : (C,) int32
        Vertices of the faces, one face after the other.
    sizes : (F,) int32
        Corners of each face.
    fixed : (V,) bool
        Which vertices must stay as they are.
    faces : int
        How many triangles are left, if it can be done.
    progress, cancelled : callable, optional

    Returns
    -------
    coordinates : (N, 3) float32
    triangles : (T, 3) int32

    Raises
    ------
    ReflcolorError
        If Blender could not do it.
    Cancelled
        If ``cancelled()`` returned True.
    """
    with temporary_folder() as folder:
        given = {"coordinates": coordinates, "corners": corners, "sizes": sizes, "fixed": np.flatnonzero(fixed)}
        for kind, array in given.items():
            np.save(folder / f"{kind}.npy", np.ascontiguousarray(array), allow_pickle=False)
        if progress is not None:
            progress(0.1, Message("Making the mesh lighter"))
        _run(folder, faces, cancelled)
        try:
            return tuple(
                np.load(folder / f"light_{kind}.npy", allow_pickle=False) for kind in ("vertices", "triangles")
            )
        except (OSError, ValueError) as error:
            raise ReflcolorError("the mesh could not be made lighter ({reason})", reason=str(error)) from error


def _run(folder, faces, cancelled):
    """Run the program in a Blender, and wait for its end."""
    log = folder / "log.txt"
    # In a group of its own, Ctrl-C reaches only this process, which ends it.
    apart = {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {"start_new_session": True}
    with log.open("wb") as file:
        try:
            process = subprocess.Popen(
                [*_blender(), str(folder), str(faces)], stdin=subprocess.DEVNULL, stdout=file, stderr=file, **apart
            )
        except OSError as error:
            raise ReflcolorError(
                "the mesh could not be made lighter: Blender did not start ({reason})",
                reason=error.strerror or str(error),
            ) from error
        try:
            while process.poll() is None:
                if cancelled is not None and cancelled():
                    raise Cancelled
                time.sleep(_LOOK_EVERY_S)
        finally:
            with suppress(OSError):
                process.kill()
            process.wait(_ENDS_WITHIN_S)
    if process.returncode != 0:
        last = log.read_text(errors="replace").strip().splitlines()[-1:] or [""]
        raise ReflcolorError(
            "the mesh could not be made lighter: Blender ended with {status} ({reason}); it may have run out of "
            "memory: read every second row and column (step 2)",
            status=process.returncode,
            reason=last[0][:200],
        )


def _blender():
    """What starts the program: Blender, or where Blender is a module of Python, Python."""
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "--python", _PROGRAM, "--"]
    # The folder of the program holds modules with the names of others.
    return [python_program(), "-P", _PROGRAM]
