"""A light mesh is made beside the scan: from its dialog, cancelled by ESC, undone."""

import importlib
from unittest import mock

import bpy
from inside.window import EXTENSION

SEEDS = ((60, 100, (0.9, 0.3, 0.1)), (240, 225, (0.2, 0.5, 0.2)), (150, 380, (0.2, 0.3, 0.8)))
LIGHT = "cones Light"


def scenario_a_light_mesh_stands_in_for_the_scan(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    for row, col, color in SEEDS:
        window.call("reflcolor.add_seed", row=row, col=col, color=color)
    window.call("reflcolor.colorize")
    yield from window.show_sidebar()
    yield from window.click_button("reflcolor.make_light_mesh")
    yield 0.5
    yield from window.screenshot("dialog", still=False)
    with endless_decimation():
        yield from window.key("RET")
        yield from window.until(lambda: window.running() is not None, 10, "the work begins after the dialog")
        yield from window.move(window.place_in(window.area("VIEW_3D")))
        yield from window.key("ESC")
        yield from window.until(lambda: window.running() is None, 10, "ESC ends the work")
    window.check(LIGHT not in bpy.data.objects, "nothing is made after ESC")
    window.invoke("reflcolor.make_light_mesh", faces=20_000)
    yield 0.5
    yield from window.key("RET")
    yield from window.until(lambda: LIGHT in bpy.data.objects, 60, "the light mesh is made")
    light = bpy.data.objects[LIGHT]
    window.check(0 < len(light.data.polygons) <= 20_000, "it has at most as many faces as asked for")
    window.check(bpy.data.objects["cones"].hide_get(), "the scan is hidden")
    yield from window.screenshot("made")
    yield from window.undo()
    window.check(LIGHT not in bpy.data.objects, "Ctrl Z takes it back")
    window.check(not bpy.data.objects["cones"].hide_get(), "and shows the scan")


def endless_decimation():
    """Let the second Blender sleep instead of work: on a fast machine the work would be done before ESC comes."""
    decimation = importlib.import_module(f"{EXTENSION}.operators.scene.decimation")
    sleeps = [bpy.app.binary_path, "-b", "--factory-startup", "--python-expr", "import time; time.sleep(600)", "--"]
    return mock.patch.object(decimation, "_blender", lambda: sleeps)
