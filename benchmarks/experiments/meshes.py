"""Rendered meshes of the experiments, made by the extension in the bpy wheel, from its zip."""

import importlib
import math
import sys
from pathlib import Path

import cv2

TOOLS = Path(__file__).resolve().parents[2] / "tools"


class Renderer:
    """Blender with the extension installed; one per process.

    Parameters
    ----------
    folder : Path
        For Blender's user folder and pictures on their way.
    """

    def __init__(self, folder):
        sys.path.insert(0, str(TOOLS))
        self._session, build = importlib.import_module("blender_session"), importlib.import_module("build_extension")
        zip_file = build.zip_path(build.host_platform(), (build.running_python(),))
        self._bpy = self._session.start(zip_file, folder / "blender")
        self._path = folder / "render.png"
        names = ("scan_object", "add_scan", "render")
        self._objects, self._adding, self._render = (
            importlib.import_module(f"{self._session.EXTENSION}.operators.scene.{name}") for name in names
        )
        core = importlib.import_module(f"{self._session.EXTENSION}.reflcolor_addon.scan.object_arrays")
        self._object_arrays = core.object_arrays
        view = importlib.import_module(f"{self._session.EXTENSION}.reflcolor_addon.view.picture")
        # As measured: what is compared here is the colors.
        self._picture = view.Picture(look=view.LIT, filled=False)

    def picture(self, scans, colors=None, view=None):
        """Return the (800, 1280, 3) uint8 picture of the meshes of several scans together.

        Parameters
        ----------
        scans : list of Scan
        colors : list of (H, W, 3) uint8, optional
            sRGB of each scan's pixels; by default its reflectance.
        view : (position, target, field of view in degrees), optional
            World meters; by default the first scan as its scanner saw it.
        """
        bpy, objects = self._bpy, self._objects
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        context = bpy.context
        made = [self._adding.add_scan_object(context, self._object_arrays(scan)) for scan in scans]
        for item, scan, rgb in zip(made, scans, colors, strict=True) if colors else ():
            objects.add_colors(item, objects.COLORIZED, rgb[scan.valid])
            objects.show_colors(item, objects.COLORIZED)
        self._render.set_up_picture(context, made[0], self._picture, {})
        context.scene.render.resolution_x, context.scene.render.resolution_y = 1280, 800
        if view is not None:
            self._look(context.scene, *view)
        return self.taken()

    def taken(self):
        """Return another picture of the same meshes, for which the scene may have been changed."""
        self._render.render(self._bpy.context, self._path)
        return cv2.imread(str(self._path))[..., ::-1]

    def end(self, status):
        """End the process."""
        self._session.end(status)

    def _look(self, scene, position, target, fov_deg):
        vector = importlib.import_module("mathutils").Vector
        toward = vector(target) - vector(position)
        camera = scene.camera
        camera.location = position
        camera.rotation_euler = toward.to_track_quat("-Z", "Y").to_euler()
        camera.data.angle = math.radians(fov_deg)
        camera.data.clip_start, camera.data.clip_end = 0.1, 1000
        # The light comes from where the camera is.
        self._render.follow_picture(scene, self._picture)
