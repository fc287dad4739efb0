"""Where Blender keeps what is temporary: its preferences may name another disk than the system's."""

from pathlib import Path

import bpy

from ...reflcolor_addon.files.work_folder import scratch_folder


def temporary_folder():
    """Give a `scratch_folder` where this Blender has its own temporary folder."""
    own = bpy.app.tempdir
    return scratch_folder(Path(own).parent if own else None)
