"""The example colored from six pairs picked by hand, by way of the panel and back through undo."""

import bpy
from scenario_picking import at_pixel, at_point, laid_out

LIMIT_S = 600
# (row, column) of the scan and (x, y) of the photo: wall, floor, orange cone, blue cone, bucket, box.
PAIRS = (
    ((90, 130), (250, 150)),
    ((262, 60), (330, 780)),
    ((222, 147), (450, 601)),
    ((232, 295), (728, 720)),
    ((222, 380), (1020, 640)),
    ((215, 60), (290, 540)),
)


def scenario_six_pairs_by_hand_color_the_example(window):
    clicks = 0
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.load_photo", filepath=window.example("photo.jpg"))
    yield from window.show_sidebar()
    yield from window.click_button("reflcolor.open_seed_picking")
    yield from window.until(lambda: laid_out(window), 40, "the workspace is laid out")
    yield 0.7
    window.bpy_window.id_data.reflcolor.live_update = True
    for number, ((row, col), point) in enumerate(PAIRS):
        places = [at_pixel(window, row, col), at_point(window, point)]
        # Either order will do.
        for place in places if number % 2 else reversed(places):
            yield from window.click(place)
            clicks += 1
        if number % 2 == 0:
            yield from window.move(at_pixel(window, 150, 200))
            yield from window.key("ESC")
    window.equal(len(window.scan.reflcolor.seeds), 6, "seeds")
    window.check(all(seed.has_color and seed.photo for seed in window.scan.reflcolor.seeds), "each is a pair")
    window.equal(clicks, 12, "clicks")
    module = "bl_ext.user_default.reflcolor.operators.window.live_update"
    live = __import__(module, fromlist=["_live"])
    yield from window.until(lambda: live._live is not None and live._live.settled(), 30, "the preview is whole")
    yield 0.5
    window.scene.reflcolor.show_matches = True
    yield from window.screenshot("pairs")
    window.scene.reflcolor.show_matches = False
    # Turn Live Update off by ESC: nothing of it stays.
    yield from window.move(at_pixel(window, 150, 200))
    yield from window.key("ESC")
    yield 0.3
    window.check(window.scan.reflcolor.preview_image is None, "ESC leaves the preview")
    window.invoke("reflcolor.colorize")
    yield from window.until(lambda: "Colorized" in window.scan.data.color_attributes, 60, "the scan is colorized")
    for _ in range(20):
        yield from window.undo()
    window.equal(len(window.scan.reflcolor.seeds) if window.scan else 0, 0, "seeds after 20 steps back")
    for _ in range(20):
        yield from window.undo(redo=True)
    window.check("Colorized" in window.scan.data.color_attributes, "20 steps forth bring the colors back")
    window.equal(len(window.scan.reflcolor.seeds), 6, "and the seeds")
    path = window.output("kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    yield from window.click_button("reflcolor.close_seed_picking")
    yield from window.until(
        lambda: window.bpy_window.workspace.name == "Layout", 20, "the workspace from before is back"
    )
    yield 0.5
    window.check("Seed Picking" not in bpy.data.workspaces.keys(), "the other one is gone")  # noqa: SIM118
    yield from window.screenshot("back")
