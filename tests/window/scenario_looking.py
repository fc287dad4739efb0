"""A person looks at what was made: maps with a legend, before and after, where the colors are from."""

import bpy


def scenario_maps_with_a_legend(window):
    _colorize(window)
    truth = bpy.data.images.load(window.example("truth.png"))
    window.call("reflcolor.evaluate", truth=truth.name)
    yield from window.show_sidebar()
    for look in ("confidence", "nearest_seed", "range", "error"):
        window.call("reflcolor.show_look", look=look)
        yield from window.screenshot(look)
    attributes = window.scan.data.color_attributes
    window.equal(attributes.active_color_name, "Error Map", "what the viewport shows")
    window.equal(attributes[attributes.render_color_index].name, "Colorized", "what a render shows")
    yield from window.undo()
    window.equal(window.scan.data.color_attributes.active_color_name, "Range Map", "the map after undo")


def scenario_before_and_after(window):
    _colorize(window)
    state = window.scan.reflcolor
    window.area("VIEW_3D").ui_type = "IMAGE_EDITOR"
    yield 0.3
    area = window.area("IMAGE_EDITOR")
    area.spaces.active.image = state.reflectance_image
    yield 0.3
    bpy.context.window_manager.reflcolor_wipe.show = True
    with window.at(area):
        bpy.ops.image.view_all(fit_view=True)
    yield from window.screenshot("half")
    rows, cols = window.scan.reflcolor.rows, window.scan.reflcolor.cols
    start = window.place_of_pixel(area, rows // 2, cols // 2)
    end = window.place_of_pixel(area, rows // 2, cols // 5)
    yield from window.drag(start, end)
    position = bpy.context.window_manager.reflcolor_wipe.position
    window.check(abs(position - 0.2) < 0.02, f"the line was dragged to 0.2 of the width, is at {position:.3f}")
    yield from window.screenshot("dragged")
    yield from window.wheel(end, 6)
    yield from window.screenshot("zoomed")
    area.spaces.active.image = window.scan.reflcolor.colorized_image
    yield 0.2
    yield from window.screenshot("over the colors")
    bpy.context.window_manager.reflcolor_wipe.show = False
    yield 0.2
    yield from window.screenshot("off")


def _colorize(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.load_seeds", filepath=window.example("cones.seeds.json"))
    window.call("reflcolor.colorize")
    with window.at(window.area("VIEW_3D")):
        bpy.ops.view3d.view_selected()
