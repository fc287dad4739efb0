"""Colors from memory: the tool has a color of its own, and the marks of seeds show the seeds' own colors."""

import bpy
import gpu
from gpu_extras.batch import batch_for_shader
from scenario_picking import at_pixel, image_areas, laid_out

LIMIT_S = 400
COLORS = ((0.2, 0.6, 0.9), (0.75, 0.25, 0.1), (0.5, 0.5, 0.5), (0.1, 0.35, 0.15), (0.9, 0.85, 0.6), (0.3, 0.2, 0.45))
PLACES = ((240, 225), (150, 380), (60, 100), (200, 60), (280, 420), (100, 250))


def opened(window):
    """The example that comes with the extension, in the layout to pick seeds in; generator."""
    window.invoke("reflcolor.open_example")
    yield from window.until(lambda: bpy.context.active_object and bpy.context.active_object.name == "cones", 60, "open")
    yield 0.5
    window.invoke("reflcolor.open_seed_picking")
    yield from window.until(lambda: laid_out(window), 40, "two Image Editors and a 3D View are laid out")
    yield 0.7


def scenario_six_colors_from_memory_become_a_picture(window):
    yield from opened(window)
    image_areas(window)[1].spaces.active.image = None
    yield from window.screenshot("opened")
    for number, ((row, col), color) in enumerate(zip(PLACES, COLORS, strict=True), 1):
        window.scene.reflcolor.picked_color = color
        window.push("Seed Color")
        yield from window.click(at_pixel(window, row, col))
        window.equal(len(window.scan.reflcolor.seeds), number, "seeds")
    yield from window.screenshot("picked")
    for number in (5, 4):
        for _ in range(2):
            yield from window.undo()
        window.equal(len(window.scan.reflcolor.seeds), number, "seeds after a color and a place were undone")
    for _ in range(4):
        yield from window.undo(redo=True)
    window.equal(len(window.scan.reflcolor.seeds), 6, "seeds after redo")
    yield from window.click_button("reflcolor.colorize")
    yield from window.until(lambda: "Colorized" in window.scan.data.color_attributes, 60, "the scan is colorized")
    yield from window.click_button("reflcolor.set_up_render")
    yield from window.until(lambda: window.scene.camera and "Laser" in window.scene.camera.name, 60, "a camera")
    yield 0.5
    yield from window.screenshot("set_up")


def scenario_a_seed_that_waits_is_given_the_tools_color(window):
    yield from opened(window)
    yield from window.click(at_pixel(window, *PLACES[0]))
    window.equal([seed.has_color for seed in window.scan.reflcolor.seeds], [False], "seeds that have a color")
    yield from window.screenshot("waiting")
    window.scene.reflcolor.picked_color = COLORS[0]
    window.equal([seed.has_color for seed in window.scan.reflcolor.seeds], [True], "seeds that have a color")


def scenario_marks_have_the_colors_of_their_seeds(window):
    yield from opened(window)
    for (row, col), color in zip(PLACES, COLORS, strict=True):
        window.call("reflcolor.add_seed", row=row, col=col, color=color)
    window.call("reflcolor.select_all_seeds", which="none")
    obj, view = window.scan, window.area("VIEW_3D")
    rows, cols = (obj.data.attributes[name].data for name in ("grid_row", "grid_col"))
    vertices = {(rows[i].value, cols[i].value): i for i in range(len(rows))}
    images = [at_pixel(window, *place) for place in PLACES]
    meshes = [window.place_of_point(view, obj.matrix_world @ obj.data.vertices[vertices[place]].co) for place in PLACES]
    # Software OpenGL shows dark colors a few levels too bright: Blender's own shader tells how a color looks here.
    patches, handler = drawn_by_blender(window, view, COLORS)
    yield from window.screenshot("marks")
    found = yield from window.colors_at([*patches, *images, *meshes])
    bpy.types.SpaceView3D.draw_handler_remove(handler, "WINDOW")
    wanted, marks = found[: len(COLORS)], found[len(COLORS) :]
    for shown, color in zip(wanted, COLORS, strict=True):
        window.check(apart(shown, color) <= 8, f"Blender itself shows {color} as {shown}")
    for number, shown in enumerate(marks):
        mark, where = number % len(COLORS), "in the image" if number < len(COLORS) else "on the mesh"
        off = max(abs(one - other) for one, other in zip(shown, wanted[mark], strict=True))
        window.check(off <= 1, f"mark {mark + 1} {where}: expected {wanted[mark]}, the screen shows {shown}")


def apart(shown, color):
    """Levels between an (r, g, b) of 0..255 and a color of 0..1."""
    return max(abs(one - 255 * other) for one, other in zip(shown, color, strict=True))


def drawn_by_blender(window, view, colors):
    """Draw a square of each color at the bottom of a view with Blender's own shader; return centers and handler."""
    region = window.region(view)
    places = [(30 + 20 * number, 20) for number in range(len(colors))]

    def draw():
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        for (x, y), color in zip(places, colors, strict=True):
            shader.uniform_float("color", (*color, 1.0))
            corners = [(x + across, y + up, 0.0) for up in (-8, 8) for across in (-8, 8)]
            batch_for_shader(shader, "TRI_STRIP", {"pos": corners}).draw(shader)

    handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_PIXEL")
    view.tag_redraw()
    return [(region.x + x, region.y + y) for x, y in places], handler
