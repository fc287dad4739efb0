"""A person looks at what was made: maps with a legend, before and after, where the colors are from."""

import bpy


def scenario_what_is_imported_is_in_view_and_nothing_before_it(window):
    eye = lambda: window.area("VIEW_3D").spaces.active.region_3d  # noqa: E731
    view = lambda: eye().view_matrix.copy()  # noqa: E731
    alone = lambda obj: obj.local_view_get(window.area("VIEW_3D").spaces.active)  # noqa: E731
    before, objects = view(), set(bpy.data.objects.keys())
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    yield 0.3
    first = view()
    window.check(first != before, "the view turned to the scan")
    window.check(objects < set(bpy.data.objects.keys()), "what was there is still there")
    window.check(alone(window.scan) and not alone(bpy.data.objects["Cube"]), "the scan alone is shown")
    yield from window.show_sidebar()
    yield from window.screenshot("first")
    eye().view_distance *= 5
    yield 0.1
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    yield 0.3
    eye().update()
    window.check(eye().view_distance < 1.2 * first.translation.length + 10, "a second scan is in view")
    window.check(alone(window.scan), "and shown beside the first")
    yield from window.screenshot("second")
    yield from window.undo()
    yield from window.undo()
    window.check(window.area("VIEW_3D").spaces.active.local_view is None, "without scans all the rest is shown again")
    window.equal(set(bpy.data.objects.keys()), objects, "objects after undo")


def scenario_maps_with_a_legend(window):
    _colorize(window)
    truth = bpy.data.images.load(window.example("truth.png"))
    window.call("reflcolor.evaluate", truth=truth.name)
    yield from window.show_sidebar()
    for look in ("confidence", "nearest_seed", "range", "error"):
        window.call("reflcolor.show_look", look=look)
        yield from window.screenshot(look)
    attributes = window.scan.data.color_attributes
    window.equal(attributes.active_color_name, "Error_Map", "what the viewport shows")
    window.equal(attributes[attributes.render_color_index].name, "Colorized", "what a render shows")
    yield from window.undo()
    window.equal(window.scan.data.color_attributes.active_color_name, "Range_Map", "the map after undo")


def scenario_before_and_after(window):
    _colorize(window)
    area = yield from _scan_editor(window)
    bpy.context.window_manager.reflcolor_wipe.show = True
    yield from window.screenshot("half")
    rows, cols = window.scan.reflcolor.rows, window.scan.reflcolor.cols
    start = window.place_of_pixel(area, rows // 2, cols // 2)
    end = window.place_of_pixel(area, rows // 2, cols // 5)
    yield from window.drag(start, end)
    position = bpy.context.window_manager.reflcolor_wipe.position
    window.check(abs(position - 0.2) < 0.02, f"the line was dragged to 0.2 of the width, is at {position:.3f}")
    window.equal(len(window.scan.reflcolor.seeds), 31, "seeds, of which dragging the line adds none")
    yield from window.screenshot("dragged")
    yield from window.wheel(end, 4)
    yield from window.screenshot("zoomed")
    area.spaces.active.image = window.scan.reflcolor.colorized_image
    yield 0.2
    yield from window.screenshot("over the colors")
    bpy.context.window_manager.reflcolor_wipe.show = False
    yield 0.2
    yield from window.screenshot("off")


def scenario_a_message_leads_to_its_seed(window):
    _colorize(window, seed_without_return=True)
    area = yield from _scan_editor(window)
    state = window.scan.reflcolor
    window.check(state.notices[1].text.startswith("seed 32: no return"), "the warning is listed")
    state.active_seed = 0
    yield from window.show_sidebar("IMAGE_EDITOR")
    yield from window.wheel(window.place_in(area), 4)
    window.call("reflcolor.show_notice", area=area, index=1)
    window.equal(window.scan.reflcolor.active_seed, 31, "the seed that is selected")
    yield 0.2
    notice = window.scan.reflcolor.notices[1]
    (x, y), (middle_x, middle_y) = window.place_of_pixel(area, notice.row, notice.col), window.place_in(area)
    window.check(abs(x - middle_x) < 40 and abs(y - middle_y) < 40, "the seed is in the middle of the editor")
    yield from window.screenshot("centered")
    yield from window.move(window.place_in(area))
    window.invoke("reflcolor.read_notice", area=area, index=1)
    yield 0.3
    yield from window.screenshot("in full")


def _scan_editor(window):
    """Lay out the workspace to pick seeds in, and return the Image Editor that shows the scan; generator."""
    window.call("reflcolor.open_seed_picking")
    yield from window.until(lambda: len(_image_areas(window)) == 2, 30, "two Image Editors are laid out")
    yield 1.0
    return max(_image_areas(window), key=lambda area: area.y)


def _image_areas(window):
    return [area for area in window.bpy_window.screen.areas if area.type == "IMAGE_EDITOR"]


def _colorize(window, *, seed_without_return=False):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.load_seeds", filepath=window.example("cones.seeds.json"))
    if seed_without_return:
        # A window pane, which gives no return.
        window.call("reflcolor.add_seed", row=60, col=340, color=(0.2, 0.2, 0.2))
    window.call("reflcolor.colorize")
