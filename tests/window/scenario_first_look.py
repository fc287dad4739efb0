"""A person installs the zip, opens the sidebar and sees the steps."""

import bpy
from footprint import footprint
from inside.window import EXTENSION, install

FRESH = True


def scenario_install_from_disk(window):
    bare = footprint(bpy)
    install(window.zip_file)
    yield 0.2
    window.check(EXTENSION in bpy.context.preferences.addons, "the extension is enabled")
    window.check(footprint(bpy) != bare, "enabling registers something")
    yield from window.show_sidebar()
    yield from window.screenshot("empty")
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.equal(window.scan.name, "cones", "the active object")
    yield from window.screenshot("imported")


def scenario_disable_leaves_nothing(window):
    bpy.ops.preferences.addon_disable(module=EXTENSION)
    yield 0.2
    bare = footprint(bpy)
    bpy.ops.preferences.addon_enable(module=EXTENSION)
    yield from window.show_sidebar()
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.add_seed", row=150, col=200, color=(0.8, 0.3, 0.1))
    yield 0.2
    bpy.ops.preferences.addon_disable(module=EXTENSION)
    yield 0.2
    window.equal(footprint(bpy), bare, "what is registered")
    yield from window.screenshot("disabled")
    bpy.ops.preferences.addon_enable(module=EXTENSION)
    yield 0.2
    window.equal(len(window.scan.reflcolor.seeds), 1, "seeds after enabling again")
