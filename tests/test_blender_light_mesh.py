"""Light meshes in Blender, made by its own decimation in another Blender, through the installed zip."""

import importlib

import numpy as np
import pytest
from blender_session import EXTENSION
from gltf_files import Glb
from small_scans import random_scan
from test_blender_import import srgb, values, write_small_ptx

SHAPE = (24, 40)
FACES = 300


def test_a_light_mesh_shows_the_scan_and_can_be_taken_back(blender, tmp_path):
    bpy = blender
    scan_file = write_small_ptx(tmp_path / "wall.ptx", random_scan(3, SHAPE))
    bpy.ops.reflcolor.import_scan(filepath=str(scan_file))
    scan = bpy.context.active_object
    bpy.ops.reflcolor.add_seed(row=2, col=3, color=(0.8, 0.3, 0.1))
    bpy.ops.reflcolor.add_seed(row=20, col=30, color=(0.1, 0.3, 0.8))
    bpy.ops.reflcolor.colorize()
    scan.location.x = 3
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="colorized")
    assert bpy.ops.reflcolor.make_light_mesh(faces=FACES) == {"FINISHED"}
    light = bpy.context.active_object
    assert light.name == "wall Light" and FACES - 10 <= len(light.data.polygons) <= FACES
    np.testing.assert_allclose(np.array(light.matrix_world), np.array(scan.matrix_world), atol=1e-6)
    assert scan.hide_get() and scan.hide_render and len(scan.data.vertices) == SHAPE[0] * SHAPE[1]

    # Numbers are those of returns, at the vertices' own places.
    pixel = values(light, "grid_row", np.int32) * SHAPE[1] + values(light, "grid_col", np.int32)
    for name, dtype in (("confidence", np.float32), ("observed", np.float32), ("photo", np.int32)):
        np.testing.assert_array_equal(values(light, name, dtype), values(scan, name, dtype)[pixel])
    np.testing.assert_array_equal(
        values(light, "nearest_seed", np.int32), values(scan, "nearest_seed", np.int32)[pixel]
    )
    np.testing.assert_array_equal(srgb(light, "Colorized"), srgb(scan, "Colorized")[pixel])
    shader = next(node for node in light.active_material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    image = shader.inputs["Base Color"].links[0].from_node.image
    assert tuple(image.size) == SHAPE[::-1]

    # What works on scans is refused; what shows them goes on.
    for act in (bpy.ops.reflcolor.colorize, bpy.ops.reflcolor.make_texture, bpy.ops.reflcolor.add_seed):
        assert not act.poll()
    bpy.ops.reflcolor.show_look(look="confidence")
    bpy.ops.reflcolor.show_look(look="colorized")
    bpy.ops.reflcolor.set_up_render()
    bpy.ops.reflcolor.export_scan(filepath=str(tmp_path / "light.usd"))
    bpy.ops.reflcolor.export_scan(filepath=str(tmp_path / "light.glb"))
    glb = Glb(tmp_path / "light.glb")
    assert "TEXCOORD_0" in glb.primitive()["attributes"]
    assert glb.bytes_of(glb.document["images"][0]["bufferView"]) == image.packed_file.data
    assert len(glb.array(glb.primitive()["indices"])) == 3 * len(light.data.polygons)
    with pytest.raises(RuntimeError, match="is a light mesh"):
        bpy.ops.reflcolor.export_scan(filepath=str(tmp_path / "light.ptx"))

    bpy.ops.ed.undo_push(message="made light")
    bpy.ops.ed.undo()
    assert "wall Light" not in bpy.data.objects
    assert not bpy.data.objects["wall"].hide_render and not bpy.data.objects["wall"].hide_get()


def test_what_is_temporary_lies_where_blender_keeps_its_own(installed_blender, tmp_path):
    module = importlib.import_module(f"{EXTENSION}.operators.scene.temporary")
    paths = installed_blender.context.preferences.filepaths
    before, paths.temporary_directory = paths.temporary_directory, str(tmp_path)
    try:
        with module.temporary_folder() as folder:
            assert folder.is_dir() and folder.parent == tmp_path
    finally:
        paths.temporary_directory = before
    assert not folder.exists()
