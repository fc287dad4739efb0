"""The folder that an operator's file browser opens in."""

import os
from pathlib import Path

# Operator -> the folder of the file that was picked last.
_last = {}


def open_in(operator, fallback=None):
    """Have the file browser open where this operator's last file was picked or, at first, in a fallback folder."""
    folder = _last.get(operator.bl_idname, fallback)
    if folder is not None and Path(folder).is_dir():
        operator.filepath = f"{folder}{os.sep}"


def was_picked(operator):
    """Remember the folder of the operator's file."""
    if operator.filepath:
        _last[operator.bl_idname] = Path(operator.filepath).parent


def unregister():
    """Forget all folders; called before the extension is unregistered."""
    _last.clear()
