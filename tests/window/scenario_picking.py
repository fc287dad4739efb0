"""Seeds are picked with the mouse: in the reflectance image, in a photo beside it, and on the mesh."""

import bpy

# (row, column) of the scan and (x, y) of the photo of the shipped example.
PAIRS = (((60, 100), (150, 120)), ((240, 225), (420, 460)), ((150, 380), (700, 300)), ((40, 300), (560, 90)))

LIMIT_S = 600


def open_picking(window):
    """Import the example and its photo, and open the workspace by its button; generator."""
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.load_photo", filepath=window.example("photo.jpg"))
    yield from window.show_sidebar()
    yield from window.click_button("reflcolor.open_seed_picking")
    yield from window.until(lambda: laid_out(window), 40, "two Image Editors and a 3D View are laid out")
    yield 0.7


def laid_out(window):
    """Whether the workspace is as it will be: the last that is done is to bring the steps to the front."""
    kinds = sorted(area.type for area in window.bpy_window.screen.areas)
    if kinds[-3:] != ["IMAGE_EDITOR", "IMAGE_EDITOR", "VIEW_3D"]:
        return False
    sidebar = window.region(window.area("VIEW_3D"), "UI")
    return sidebar.width > 1 and sidebar.active_panel_category == "Reflectance"


def image_areas(window):
    """(scan, photo): the two Image Editors, the upper one first."""
    areas = [area for area in window.bpy_window.screen.areas if area.type == "IMAGE_EDITOR"]
    return sorted(areas, key=lambda area: -area.y)


def at_pixel(window, row, col):
    return window.place_of_pixel(image_areas(window)[0], row, col)


def at_point(window, point):
    return window.place_of_pixel(image_areas(window)[1], point[1], point[0])


def seeds(window):
    return [(seed.has_color, seed.select) for seed in window.scan.reflcolor.seeds]


def near(window, index, row, col):
    """Whether a seed is where the mouse was, to a pixel of the screen."""
    seed = window.scan.reflcolor.seeds[index]
    return abs(seed.row - row) <= 2 and abs(seed.col - col) <= 2


def scenario_pairs_are_picked_in_both_orders(window):
    yield from open_picking(window)
    yield from window.screenshot("layout", keep_mouse=True)
    # First the place, then the color.
    (row, col), point = PAIRS[0]
    yield from window.click(at_pixel(window, row, col))
    window.equal(seeds(window), [(False, True)], "a click in the scan places a seed that waits for its color")
    window.check(near(window, 0, row, col), "where the mouse was")
    yield from window.screenshot("waiting")
    yield from window.click(at_point(window, point))
    window.equal(seeds(window), [(True, False)], "a click in the photo gives it its color")
    seed = window.scan.reflcolor.seeds[0]
    window.check(seed.photo is not None and abs(seed.photo_xy[0] - point[0]) <= 4, "and it keeps the photo's point")
    # First the color, then the places.
    (row, col), point = PAIRS[1]
    yield from window.click(at_point(window, point))
    window.check(window.scene.reflcolor.picked, "a click in the photo picks a color when no seed waits")
    yield from window.click(at_pixel(window, row, col))
    yield from window.click(at_pixel(window, row + 20, col + 30))
    found = window.scan.reflcolor.seeds
    window.equal(len(found), 3, "seeds")
    window.equal(tuple(found[1].color), tuple(found[2].color), "both places have the picked color")
    window.check(
        found[1].photo is not None and found[2].photo is None, "only the first is a pair with the photo's point"
    )
    yield from window.screenshot("picked", keep_mouse=True)
    yield from window.key("ESC")
    window.check(not window.scene.reflcolor.picked, "ESC drops the color")
    # Each act was one step: dropping the color, two places, the color, the first color, the first place.
    for expected in (3, 2, 1, 1, 1, 0):
        yield from window.undo()
        window.equal(len(window.scan.reflcolor.seeds), expected, "seeds after undo")
    for expected in (1, 1, 1, 2, 3, 3):
        yield from window.undo(redo=True)
        window.equal(len(window.scan.reflcolor.seeds), expected, "seeds after redo")


def scenario_twelve_pairs_in_both_orders(window):
    yield from open_picking(window)
    places = [((80 + 60 * (k // 4), 60 + 80 * (k % 4)), (200 + 230 * (k % 4), 200 + 220 * (k // 4))) for k in range(12)]
    for number, ((row, col), point) in enumerate(places):
        if number % 2:
            yield from window.click(at_point(window, point))
            yield from window.click(at_pixel(window, row, col))
            yield from window.key("ESC")
        else:
            yield from window.click(at_pixel(window, row, col))
            yield from window.click(at_point(window, point))
    found = window.scan.reflcolor.seeds
    window.equal(len(found), 12, "seeds")
    for number, ((row, col), point) in enumerate(places):
        seed = found[number]
        window.check(near(window, number, row, col), f"pair {number + 1}: the place")
        window.check(seed.photo is not None and abs(seed.photo_xy[0] - point[0]) <= 4, f"pair {number + 1}: the point")
    yield from window.screenshot("twelve")
    for _ in range(20):
        yield from window.undo()
    window.equal(len(window.scan.reflcolor.seeds), 4, "seeds after 20 of 30 steps back")
    for _ in range(20):
        yield from window.undo(redo=True)
    window.equal(len(window.scan.reflcolor.seeds), 12, "seeds after 20 steps forth")


def scenario_seeds_are_dragged_and_deleted(window):
    yield from open_picking(window)
    for (row, col), _ in PAIRS:
        window.call("reflcolor.add_seed", row=row, col=col, color=(0.8, 0.3, 0.2))
    yield 0.3
    (row, col), _ = PAIRS[0]
    yield from window.drag(at_pixel(window, row, col), at_pixel(window, row + 30, col + 40))
    window.check(near(window, 0, row + 30, col + 40), "a seed is dragged")
    yield from window.undo()
    window.equal((window.scan.reflcolor.seeds[0].row, window.scan.reflcolor.seeds[0].col), (row, col), "undone")
    (row, col), _ = PAIRS[1]
    yield from window.click(at_pixel(window, row, col), ctrl=True)
    window.equal(len(window.scan.reflcolor.seeds), 3, "Ctrl-click deletes the seed")
    yield from window.drag(at_pixel(window, 30, 60), at_pixel(window, 170, 420), shift=True)
    chosen = [seed.select for seed in window.scan.reflcolor.seeds]
    window.equal(chosen, [True, True, True], "Shift-drag selects in a box")
    yield from window.screenshot("selected", keep_mouse=True)
    yield from window.key("X")
    window.equal(len(window.scan.reflcolor.seeds), 0, "X deletes what is selected")
    yield from window.undo()
    window.equal(len(window.scan.reflcolor.seeds), 3, "and undo brings it back")


def scenario_a_stroke_lays_a_line_of_seeds(window):
    yield from open_picking(window)
    yield from window.click(at_point(window, PAIRS[0][1]))
    yield from window.drag(at_pixel(window, 250, 100), at_pixel(window, 250, 400))
    count = len(window.scan.reflcolor.seeds)
    window.check(8 <= count <= 25, f"a stroke over 300 pixels lays a line of seeds, here {count}")
    yield from window.screenshot("stroke")
    yield from window.undo()
    window.equal(len(window.scan.reflcolor.seeds), 0, "a stroke is one step to undo")


def scenario_a_stroke_in_edit_mode_is_refused_in_one_line(window):
    yield from open_picking(window)
    yield from window.click(at_point(window, PAIRS[0][1]))
    window.call("object.editmode_toggle")
    yield 0.3
    window.expect_error("cones: leave Edit Mode first")
    yield from window.drag(at_pixel(window, 200, 60), at_pixel(window, 200, 300))
    window.equal(len(window.scan.reflcolor.seeds), 0, "no seeds in Edit Mode")
    window.call("object.editmode_toggle")
    yield 0.3
    # Blender's message stands under the pointer and takes what is clicked until the pointer has left it.
    for place in ((150, 100), (120, 130)):
        yield from window.click(at_pixel(window, *place))
        yield 0.3
    before = len(window.scan.reflcolor.seeds)
    yield from window.drag(at_pixel(window, 250, 100), at_pixel(window, 250, 400))
    laid = len(window.scan.reflcolor.seeds) - before
    window.check(laid > 7, f"out of Edit Mode a stroke lays a line of seeds, here {laid}")


def scenario_live_update_shows_a_preview(window):
    yield from open_picking(window)
    window.bpy_window.id_data.reflcolor.live_update = True
    before = window.scan.data.color_attributes.active_color_name
    for (row, col), point in PAIRS:
        yield from window.click(at_pixel(window, row, col))
        yield from window.click(at_point(window, point))
    yield from window.until(lambda: window.scan.reflcolor.preview_image is not None, 5, "a preview is there")
    yield 1.5
    yield from window.screenshot("preview")
    window.equal(window.scan.data.color_attributes.active_color_name, before, "the scan's own colors are left alone")
    yield from window.move(at_pixel(window, 100, 100))
    yield from window.key("ESC")
    yield 0.3
    window.check(window.scan.reflcolor.preview_image is None, "ESC takes the preview off")
    yield from window.screenshot("left")


def scenario_every_gesture_does_what_the_manual_says(window):
    yield from open_picking(window)
    for (row, col), _ in PAIRS:
        window.call("reflcolor.add_seed", row=row, col=col, color=(0.8, 0.3, 0.2))
    yield 0.3
    chosen = lambda: [seed.select for seed in window.scan.reflcolor.seeds]  # noqa: E731
    yield from window.click(at_pixel(window, *PAIRS[2][0]))
    window.equal(chosen(), [False, False, True, False], "a click on a seed selects it alone")
    yield from window.click(at_pixel(window, *PAIRS[0][0]), shift=True)
    window.equal(chosen(), [True, False, True, False], "Shift-click adds one")
    yield from window.move(at_pixel(window, 200, 200))
    yield from window.key("A", alt=True)
    window.equal(chosen(), [False] * 4, "Alt A selects none")
    yield from window.key("B")
    yield from window.drag(at_pixel(window, 30, 280), at_pixel(window, 160, 400))
    window.equal(chosen(), [False, False, True, True], "B and a drag select in a box")
    around = [at_pixel(window, row, col) for row, col in ((40, 130), (80, 130), (80, 70))]
    yield from window.drag(at_pixel(window, 40, 70), at_pixel(window, 42, 70), ctrl=True, through=around)
    window.equal(chosen(), [True, False, False, False], "Ctrl-drag selects by a lasso")
    yield from window.key("L")
    window.check(window.scan.reflcolor.seeds[0].locked, "L locks it")
    yield from window.key("A")
    window.equal(chosen(), [True] * 4, "A selects all")
    yield from window.key("A", alt=True)
    yield from window.click(at_point(window, (300, 200)), alt=True)
    window.check(window.scene.reflcolor.picked and not window.scene.reflcolor.picked_photo, "Alt-click takes a color")
    yield from window.move(at_pixel(window, 200, 200))
    yield from window.key("ESC")
    window.check(not window.scene.reflcolor.picked, "ESC lets go of it")
    # A pair, whose point in the photo is dragged to another color.
    yield from window.click(at_pixel(window, 280, 60))
    yield from window.click(at_point(window, (300, 300)))
    before = tuple(window.scan.reflcolor.seeds[4].color)
    yield from window.drag(at_point(window, (300, 300)), at_point(window, (728, 740)))
    seed = window.scan.reflcolor.seeds[4]
    window.check(abs(seed.photo_xy[0] - 728) < 8 and tuple(seed.color) != before, "the point and its color follow")
    # On the mesh.
    view = window.area("VIEW_3D")
    with window.at(view):
        bpy.ops.wm.tool_set_by_id(name="reflcolor.seed_tool_3d", space_type="VIEW_3D")
    yield 0.3
    corner = window.scan.matrix_world @ window.scan.data.vertices[len(window.scan.data.vertices) // 3].co
    yield from window.click(window.place_of_point(view, corner))
    window.equal(len(window.scan.reflcolor.seeds), 6, "a click on the mesh places a seed")
    yield from window.screenshot("gestures", keep_mouse=True)
    yield from window.click(window.place_of_point(view, corner), ctrl=True)
    window.equal(len(window.scan.reflcolor.seeds), 5, "Ctrl-click there deletes it")
