"""Open the example that comes with the extension."""

from pathlib import Path

import bpy

from ..reflcolor_addon.errors import ScanError
from .scene.blender_errors import refusal_of
from .scene.reports import reported

_FOLDER = Path(__file__).parents[1] / "examples" / "cones"
_SCAN, _PHOTO = "cones.scan.json", "photo.jpg"


class REFLCOLOR_OT_open_example(bpy.types.Operator):
    """Import the scan that comes with the extension, and the photo that goes with it, to try everything on"""

    bl_idname = "reflcolor.open_example"
    bl_label = "Open Example"
    bl_options = {"REGISTER", "UNDO"}

    _way = "EXEC_DEFAULT"

    def invoke(self, context, _event):
        # In the window the import shows its progress, and goes on with events.
        self._way = "INVOKE_DEFAULT"
        return self.execute(context)

    @reported
    def execute(self, _context):
        for name in (_SCAN, _PHOTO):
            if not (_FOLDER / name).is_file():
                raise ScanError("the example is not there: {path}; install the extension again", path=_FOLDER / name)
        try:
            bpy.ops.reflcolor.load_photo("EXEC_DEFAULT", filepath=str(_FOLDER / _PHOTO))
            # In the window it continues after this call, so it comes last.
            outcome = bpy.ops.reflcolor.import_scan(self._way, filepath=str(_FOLDER / _SCAN))
        except RuntimeError as error:
            raise ScanError("the example: {reason}", reason=refusal_of(error)) from error
        return {"CANCELLED"} if "CANCELLED" in outcome else {"FINISHED"}


classes = (REFLCOLOR_OT_open_example,)
