"""What Cycles sees of a scene, as arrays: surfaces for the virtual scanner, light for the virtual camera.

The scene is linked into a scene of its own for the time of the renders, so that no setting of the user's changes.
"""

from contextlib import ExitStack, contextmanager
from math import radians

import bpy
import numpy as np
from mathutils import Matrix

from ...reflcolor_addon.errors import SettingsError
from ...reflcolor_addon.files.exr import read_exr_channels
from ...reflcolor_addon.simulation.cryptomatte import name_as_float
from ...reflcolor_addon.simulation.virtual_camera import Photo
from ...reflcolor_addon.simulation.virtual_scanner import Hits
from ...reflcolor_addon.srgb import linear_to_srgb8
from .temporary import temporary_folder

NIR_ALBEDO = "nir_albedo"
# Most dyes and paints are brighter in the near infrared than they look, and red is the visible color next to it.
_NIR_OFFSET, _NIR_FROM_RGB = 0.1, np.array([0.6, 0.2, 0.1])
_NOTHING = 1e9
# Names of passes in Blender 4 and 5.
_DIFFUSE, _GLOSSY = ("DiffCol", "Diffuse Color"), ("GlossCol", "Glossy Color")
_LEAST_STEP_DEG = 0.01
_SENSOR_MM = 36.0
_NAME = "reflcolor simulation"


class SceneRenders:
    """Renders of one scene without touching it; a context manager. Lengths in and out are meters."""

    def __init__(self, scene):
        self._source = scene
        self._meters = scene.unit_settings.scale_length

    def __enter__(self):
        self._undo = ExitStack()
        try:
            self._open()
        except BaseException:
            self._undo.close()
            raise
        return self

    def __exit__(self, *_):
        self._undo.close()

    def _open(self):
        source, undo = self._source, self._undo
        self._scene = scene = bpy.data.scenes.new(_NAME)
        undo.callback(bpy.data.scenes.remove, scene)
        for child in source.collection.children:
            scene.collection.children.link(child)
        for item in source.collection.objects:
            scene.collection.objects.link(item)
        # A new scene has no layer collections until it is evaluated.
        scene.view_layers[0].update()
        _copy_exclusions(source.view_layers[0].layer_collection, scene.view_layers[0].layer_collection)
        scene.world = source.world
        scene.frame_set(source.frame_current)
        self._camera_data = bpy.data.cameras.new(_NAME)
        undo.callback(bpy.data.cameras.remove, self._camera_data)
        self._camera = bpy.data.objects.new(_NAME, self._camera_data)
        undo.callback(bpy.data.objects.remove, self._camera)
        self._camera_data.clip_start, self._camera_data.clip_end = 1e-4, 1e6
        scene.collection.objects.link(self._camera)
        scene.camera = self._camera
        _choose_renderer(scene, undo.enter_context(temporary_folder()) / "passes.exr")

    def caster(self, pose):
        """Return the ``cast`` function for `simulate_scan` of a scanner with this (4, 4) pose (Z up, looking along +Y).

        Cycles shoots one ray through the center of every pixel of an equirectangular picture; it is off by less than
        0.001 of a step.
        """
        scanner_matrix = self._matrix(pose)

        def cast(azimuths_deg, elevations_deg):
            with self._surface_settings():
                return self._cast(scanner_matrix, np.asarray(azimuths_deg), np.asarray(elevations_deg))

        return cast

    def photo(self, camera, *, samples):
        """Take a `Photo` with a `VirtualCamera`, with so many light paths per pixel."""
        data, cycles = self._camera_data, self._scene.cycles
        # Rendered larger and without distortion, then distorted.
        margin = camera.margin_px()
        size = camera.width + 2 * margin, camera.height + 2 * margin
        data.type, data.sensor_fit, data.sensor_width = "PERSP", "HORIZONTAL", _SENSOR_MM
        data.lens = camera.focal_px * _SENSOR_MM / size[0]
        # Blender's cameras look along -Z with Y up.
        self._camera.matrix_world = self._matrix(camera.pose) @ Matrix.Diagonal((1, -1, -1, 1))
        cycles.samples, cycles.filter_width, cycles.max_bounces = samples, 1.5, 4
        light = _stack(self._render(*size), ("Combined",), "RGB")
        # Depth at the very middle of every pixel; among the paths of the light it would be that of any place in it.
        cycles.samples, cycles.filter_width, cycles.max_bounces = 1, 0.01, 0
        depth = self._in_meters(_find(self._render(*size), ("Depth",), "Z"))
        image = camera.develop(camera.distort(light, margin))
        return Photo(camera, image, camera.distort(depth, margin, blend=False))

    @contextmanager
    def _surface_settings(self):
        layer, cycles = self._scene.view_layers[0], self._scene.cycles
        passes = ("normal", "diffuse_color", "glossy_color", "cryptomatte_material")
        cycles.samples, cycles.filter_width, cycles.max_bounces = 1, 0.01, 0
        aov = layer.aovs.add()
        aov.name, aov.type = NIR_ALBEDO, "VALUE"
        layer.pass_cryptomatte_depth = 2
        for name in passes:
            setattr(layer, f"use_pass_{name}", True)
        try:
            yield
        finally:
            for name in passes:
                setattr(layer, f"use_pass_{name}", False)
            layer.aovs.remove(aov)

    def _cast(self, scanner_matrix, azimuths, elevations):
        horizontal, vertical = _step(azimuths), _step(elevations)
        # A row whose pixels reach over the pole cannot be rendered; it is a copy of its neighbor.
        rows = np.flatnonzero(np.abs(elevations) + vertical / 2 <= 90 + 1e-9)
        data = self._camera_data
        data.type, data.panorama_type = "PANO", "EQUIRECTANGULAR"
        half_width = radians(horizontal) * azimuths.size / 2
        data.longitude_min, data.longitude_max = -half_width, half_width
        data.latitude_min = radians(elevations[rows[-1]] - vertical / 2)
        data.latitude_max = radians(elevations[rows[0]] + vertical / 2)
        turn = Matrix.Rotation(-radians((azimuths[0] + azimuths[-1]) / 2), 4, "Z")
        # A camera looks along -Z with Y up.
        pose = scanner_matrix @ turn @ Matrix.Rotation(radians(90), 4, "X")
        self._camera.matrix_world = pose
        channels = self._render(azimuths.size, rows.size)
        distance = self._in_meters(_find(channels, ("Depth",), "Z").astype(np.float64))
        hits = _hits(channels, distance, np.array(pose)[:3, :3], azimuths, elevations[rows])
        source = np.clip(np.arange(elevations.size) - rows[0], 0, rows.size - 1)
        return Hits(**{key: getattr(hits, key)[source] for key in ("range", "cos_incidence", "albedo", "color")})

    def _matrix(self, pose):
        matrix = Matrix(np.asarray(pose, np.float64).tolist())
        matrix.translation /= self._meters
        return matrix

    def _in_meters(self, depth):
        return np.where(depth < _NOTHING, depth * self._meters, np.inf)

    def _render(self, width, height):
        render = self._scene.render
        render.resolution_x, render.resolution_y = width, height
        bpy.ops.render.render(write_still=True, scene=self._scene.name)
        return read_exr_channels(render.filepath)


def _copy_exclusions(source, target):
    for child in source.children:
        twin = target.children[child.name]
        twin.exclude = child.exclude
        _copy_exclusions(child, twin)


def _choose_renderer(scene, path):
    try:
        scene.render.engine = "CYCLES"
    except TypeError:
        raise SettingsError("Cycles is not there to cast rays; enable Cycles Render Engine among the add-ons") from None
    cycles, render, settings = scene.cycles, scene.render, scene.render.image_settings
    cycles.device, cycles.seed, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", 0, False, False
    cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    render.resolution_percentage, render.pixel_aspect_x, render.pixel_aspect_y = 100, 1, 1
    render.use_border, render.use_compositing, render.use_sequencer = False, False, False
    render.use_file_extension, render.use_motion_blur = False, False
    render.filepath = str(path)
    if hasattr(settings, "media_type"):
        settings.media_type, settings.use_exr_interleave = "MULTI_LAYER_IMAGE", True
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "NONE"
    scene.view_layers[0].use_pass_z = True


def _hits(channels, distance, rotation, azimuths, elevations):
    elevation, azimuth = np.meshgrid(np.radians(elevations), np.radians(azimuths), indexing="ij")
    azimuth = azimuth - np.radians((azimuths[0] + azimuths[-1]) / 2)
    in_camera = [np.cos(elevation) * np.sin(azimuth), np.sin(elevation), -np.cos(elevation) * np.cos(azimuth)]
    ray = np.stack(in_camera, axis=-1) @ (rotation / np.linalg.norm(rotation, axis=0)).T
    normal = _stack(channels, ("Normal",), "XYZ")
    color = _surface_color(_stack(channels, _DIFFUSE, "RGB"), _stack(channels, _GLOSSY, "RGB"))
    return Hits(
        range=distance,
        cos_incidence=np.einsum("ijk,ijk->ij", ray, normal),
        albedo=_nir_albedo(channels, color),
        color=linear_to_srgb8(color),
    )


def _surface_color(diffuse, glossy):
    """(H, W, 3) linear base color: of a metal its gloss, of anything else what its gloss leaves to be diffuse."""
    metal = (diffuse.sum(axis=-1, keepdims=True) < 1e-4) & (glossy.max(axis=-1, keepdims=True) > 0.1)
    return np.where(metal, glossy, diffuse / np.maximum(1 - glossy, 0.1))


def _nir_albedo(channels, color):
    """(H, W) near-infrared albedo.

    Of each material: the value that its AOV output "nir_albedo" has at the spot, else its custom property
    "nir_albedo", else 0.1 + 0.6 R + 0.2 G + 0.1 B of its linear color.
    """
    albedo = _NIR_OFFSET + color @ _NIR_FROM_RGB
    material_id, from_shader = _find(channels, ("CryptoMaterial00",), "r"), _find(channels, (NIR_ALBEDO,), "X")
    for material in bpy.data.materials:
        shaded = _has_nir_output(material)
        if shaded or NIR_ALBEDO in material:
            here = material_id == np.float32(name_as_float(material.name))
            albedo = np.where(here, from_shader if shaded else float(material[NIR_ALBEDO]), albedo)
    return albedo


def _has_nir_output(material):
    tree = material.node_tree
    return tree is not None and any(
        node.bl_idname == "ShaderNodeOutputAOV" and node.aov_name == NIR_ALBEDO for node in tree.nodes
    )


def _step(angles_deg):
    return (abs(angles_deg[-1] - angles_deg[0]) / (angles_deg.size - 1)) if angles_deg.size > 1 else _LEAST_STEP_DEG


def _find(channels, names, part):
    """The channel whose full name is "<layer>.<one of names>.<part>"."""
    return next(array for key, array in channels.items() if tuple(key.rsplit(".", 2)[1:]) in {(n, part) for n in names})


def _stack(channels, names, parts):
    return np.stack([_find(channels, names, part) for part in parts], axis=-1)
