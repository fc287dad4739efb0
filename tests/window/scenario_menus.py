"""A person drops files, clicks right, and searches by F3."""

import bpy

LIMIT_S = 240


def scenario_a_dropped_scan_is_imported(window):
    _drop(window, window.area("VIEW_3D"), "cones.scan.json")
    yield from window.until(lambda: window.scan is not None and window.scan.reflcolor.rows, 20, "the scan is imported")
    window.equal(window.scan.name, "cones", "the active object")


def scenario_a_dropped_photo_is_loaded_where_the_person_says_so(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.open_seed_picking")
    yield from window.until(lambda: _image_areas(window), 30, "an Image Editor is laid out")
    yield 1.0
    area = _image_areas(window)[0]
    yield from window.move(window.place_in(area))
    # Blender opens images, too, so it asks which is meant.
    _drop(window, area, "photo.jpg")
    yield 0.5
    yield from window.screenshot("asked")
    yield from window.key("ESC")


def scenario_a_right_click_in_the_image_editor_offers_everything(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.open_seed_picking")
    yield from window.until(lambda: _image_areas(window), 30, "an Image Editor is laid out")
    yield 1.0
    yield from window.click(window.place_in(_image_areas(window)[0], 0.5, 0.8), "RIGHT")
    yield 0.3
    yield from window.screenshot("menu")
    window.equal(len(window.scan.reflcolor.seeds), 0, "seeds after a right click")
    yield from window.key("ESC")


def scenario_search_finds_an_act_by_its_verb(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.add_seed", row=150, col=200, color=(0.8, 0.3, 0.1))
    yield from window.move(window.place_in(window.area("VIEW_3D")))
    yield from window.key("F3")
    yield 0.5
    yield from window.type("clear seeds")
    yield 0.5
    yield from window.screenshot("found")
    yield from window.key("RET")
    yield from window.until(lambda: not window.scan.reflcolor.seeds, 5, "the seeds are cleared")


def _drop(window, area, name):
    """Do what Blender does once a file is let go over an editor."""
    folder = window.example("")
    with window.at(area):
        bpy.ops.wm.drop_import_file("INVOKE_DEFAULT", directory=folder, files=[{"name": name}])


def _image_areas(window):
    return [area for area in window.bpy_window.screen.areas if area.type == "IMAGE_EDITOR"]
