"""One run of the virtual scanner over a scene, step by step, from rays to files."""

import json
from dataclasses import dataclass
from math import atan2, cos, hypot, sin
from pathlib import Path

import bpy
import numpy as np

from ...reflcolor_addon.batch.paths import check_outputs
from ...reflcolor_addon.errors import OutputError, SettingsError
from ...reflcolor_addon.files.atomic import written_atomically
from ...reflcolor_addon.files.images import write_png
from ...reflcolor_addon.files.writers import write_e57, write_image_pair, write_ptx
from ...reflcolor_addon.simulation.virtual_camera import VirtualCamera, with_own_look
from ...reflcolor_addon.simulation.virtual_scanner import ScannerModel, measure, ray_grids
from .scene_renders import SceneRenders

_PAIR_SUFFIX = ".scan.json"
# The axis that looks ahead, and its sign.
_FORWARD = {"CAMERA": (2, -1.0), "ACTIVE": (1, 1.0), "CURSOR": (1, 1.0)}


@dataclass(frozen=True, eq=False, kw_only=True)
class Simulation:
    """What to simulate and where to write it.

    Parameters
    ----------
    path : Path
        The scan: .ptx, .e57 or .scan.json. What else is written goes beside it, named after it: ``NAME.truth.png``, for
        each photo ``NAME.CAMERA.png``, and ``NAME.cameras.json``, which says exactly where those were taken from.
    pose : (4, 4) float64
        Scanner (Z up, looking along +Y) to world, meters.
    model : ScannerModel
    truth : bool
        Write the true color of every pixel of the scan, as an image.
    cameras : tuple of str
        Camera objects of the scene to take photos from, in the size of the scene's renders.
    samples : int
        Light paths per pixel of a photo.
    own_look : bool
        Give each photo an exposure, white balance, lens distortion and noise of its own.
    """

    path: Path
    pose: np.ndarray
    model: ScannerModel
    truth: bool = True
    cameras: tuple[str, ...] = ()
    samples: int = 32
    own_look: bool = True

    def files(self):
        """Return the paths of all that is written, the scan first."""
        endings = ["range.png", "reflectance.png"] * self._is_pair + ["truth.png"] * self.truth
        endings += ["cameras.json"] * bool(self.cameras)
        return [self.path, *map(self._beside, endings), *map(self.photo_path, self.cameras)]

    def photo_path(self, camera):
        """Return where the photo from a camera goes."""
        return self._beside(f"{bpy.path.clean_name(camera)}.png")

    @property
    def stem(self):
        """The name of the scan, without suffix."""
        return self.path.name[: -len(_PAIR_SUFFIX)] if self._is_pair else self.path.stem

    @property
    def _is_pair(self):
        return self.path.name.lower().endswith(_PAIR_SUFFIX)

    def _beside(self, ending):
        return self.path.with_name(f"{self.stem}.{ending}")


def simulation_steps(scene, simulation):
    """Scan and photograph a scene, and write the files; a generator, for callers that do something between the steps.

    Yields
    ------
    (fraction, text)
        How far the work is, and what comes next.

    Raises
    ------
    OutputError, UsageError
        If the suffix is none of the three, a file cannot be written, or two would have the same name.
    SettingsError
        If a camera to take a photo from is not a perspective camera of the scene.
    """
    path, model, stem = simulation.path, simulation.model, simulation.stem
    write = _writer(path)
    check_outputs([("output", file) for file in simulation.files()], [])
    cameras = {name: _virtual_camera(scene, name) for name in simulation.cameras}
    if simulation.own_look:
        cameras = {
            name: with_own_look(camera, (model.seed + place) % 2**32)
            for place, (name, camera) in enumerate(cameras.items(), 1)
        }
    grids, hits = ray_grids(model), []
    # A photo takes about as long as all rays of a scan.
    last = len(grids) * (1 + len(cameras))
    with SceneRenders(scene) as renders:
        cast = renders.caster(simulation.pose)
        for done, grid in enumerate(grids):
            yield done / last, f"Scanning {stem}"
            hits.append(cast(*grid))
        scan, truth = measure(hits, model, name=stem, pose=simulation.pose)
        photos = {}
        for done, (name, camera) in enumerate(cameras.items(), 1):
            yield done * len(grids) / last, f"Photographing from {name}"
            photos[name] = renders.photo(camera, samples=simulation.samples)
    yield 1.0, f"Writing {path.name}"
    write(scan, path, model)
    if simulation.truth:
        write_png(path.with_name(f"{stem}.truth.png"), truth)
    for name, photo in photos.items():
        write_png(simulation.photo_path(name), photo.image)
    if photos:
        document = {simulation.photo_path(name).name: photo.camera.as_dict() for name, photo in photos.items()}
        with written_atomically(path.with_name(f"{stem}.cameras.json")) as temporary:
            temporary.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def leveled_pose(scene, station, item):
    """Return the pose of a scanner that stands leveled at a station.

    Parameters
    ----------
    scene : bpy.types.Scene
    station : {"CAMERA", "ACTIVE", "CURSOR"}
        Which axis of it looks ahead: a camera's view, or another object's or the cursor's Y.
    item : bpy.types.Object or None
        What stands there; None for the cursor.

    Returns
    -------
    (4, 4) float64
        Meters.

    Raises
    ------
    SettingsError
        If there is no such object.
    """
    if item is None and station != "CURSOR":
        if station == "CAMERA":
            raise SettingsError("scanner: the scene has no camera; choose where else the scanner stands")
        raise SettingsError("scanner: no object is active; choose where else the scanner stands")
    matrix = scene.cursor.matrix if item is None else item.matrix_world
    return leveled(matrix, scene.unit_settings.scale_length, *_FORWARD[station])


def photo_cameras(scene, station):
    """Return the names of all cameras of the scene but the object that the scanner stands at."""
    return tuple(item.name for item in scene.objects if item.type == "CAMERA" and item != station)


def leveled(matrix, meters_per_unit, axis=1, sign=1.0):
    """Return the (4, 4) float64 pose of a leveled scanner at a matrix's place, looking along one of its axes."""
    across, along, up = (sign * matrix.col[axis][i] for i in range(3))
    if hypot(across, along) < 1e-6 * abs(up):
        # The axis points straight up or down: there is no heading.
        across, along = 0.0, 1.0
    turn = atan2(-across, along)
    pose = np.eye(4)
    pose[:2, :2] = [[cos(turn), -sin(turn)], [sin(turn), cos(turn)]]
    pose[:3, 3] = np.array(matrix.translation, np.float64) * meters_per_unit
    return pose


def _writer(path):
    if path.name.lower().endswith(_PAIR_SUFFIX):
        return lambda scan, path, model: write_image_pair(
            scan, path, azimuth_deg=model.azimuth_deg, elevation_deg=model.elevation_deg
        )
    writers = {".ptx": write_ptx, ".e57": write_e57}
    if path.suffix.lower() not in writers:
        raise OutputError("{file}: the suffix tells what to write; expected .ptx, .e57 or .scan.json", file=path)
    return lambda scan, path, model: writers[path.suffix.lower()](scan, path)


def _virtual_camera(scene, name):
    item, render = scene.objects.get(name), scene.render
    if item is None or item.type != "CAMERA" or item.data.type != "PERSP":
        raise SettingsError("camera {name}: is no perspective camera of the scene {scene}", name=name, scene=scene.name)
    width, height = (
        max(1, side * render.resolution_percentage // 100) for side in (render.resolution_x, render.resolution_y)
    )
    frame = item.data.view_frame(scene=scene)
    across = (frame[0] - frame[3]).length
    pose = np.array(item.matrix_world.normalized(), np.float64) @ np.diag([1.0, -1, -1, 1])
    pose[:3, 3] *= scene.unit_settings.scale_length
    return VirtualCamera(width=width, height=height, focal_px=width * abs(frame[0].z) / across, pose=pose)
