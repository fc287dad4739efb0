"""Live Update on a scan of the paper's size, 760 x 1135, with 50 seeds: how soon colors come, and what stands still."""

import importlib
import statistics
import time

import bpy
from inside.scans import PAPER_SIZE, write_large_scan, write_seeds
from inside.window import EXTENSION
from scenario_picking import at_pixel, image_areas, laid_out

LIMIT_S = 600


class Watch:
    """Notes when results are shown, and how long the window's thread is taken by it."""

    def __init__(self):
        self.module = importlib.import_module(f"{EXTENSION}.operators.window.live_update")
        self.shown, self.busy_ms = [], []
        self._show, self._follow = self.module._show, self.module._follow

    def __enter__(self):
        def show(obj, result):
            self._show(obj, result)
            self.shown.append((time.perf_counter(), result.colorization is not None))

        def follow(obj):
            start = time.perf_counter()
            self._follow(obj)
            self.busy_ms.append(1000 * (time.perf_counter() - start))

        self.module._show, self.module._follow = show, follow
        return self

    def __exit__(self, *_):
        self.module._show, self.module._follow = self._show, self._follow

    def full(self):
        return any(whole for _, whole in self.shown)


def add_seeds(window, watch, what, start, count):
    """Add seeds by clicks, and note how long their colors took; generator."""
    first, full, busy = [], [], []
    for number in range(start, start + count):
        watch.shown.clear()
        watch.busy_ms.clear()
        # In the middle between those that are there.
        place = at_pixel(window, 253 if number < 5 else 379, 252 + 126 * (number % 5))
        yield from window.move(place)
        begun = time.perf_counter()
        with window.stalls(f"live update, {what}, seed {number + 1}"):
            yield from window.click(place)
            yield from window.until(watch.full, 60, "the full result is shown")
        first.append(watch.shown[0][0] - begun)
        full.append(next(when for when, whole in watch.shown if whole) - begun)
        busy.append(max(watch.busy_ms))
        yield 0.5
    window.notes.append(
        {
            "measure": f"live update, one seed more where 50 are, 760 x 1135, {what}: from the click",
            "first colors, s": statistics.median(first),
            "full result, s": statistics.median(full),
            "longest work of the extension in the window's thread, ms": max(busy),
        }
    )


def scenario_a_seed_more_colors_at_once(window):
    window.call("reflcolor.import_scan", filepath=write_large_scan(window))
    window.call("reflcolor.load_photo", filepath=window.example("photo.jpg"))
    window.call("reflcolor.load_seeds", filepath=write_seeds(window, PAPER_SIZE, 50))
    window.call("reflcolor.open_seed_picking")
    yield from window.until(lambda: laid_out(window), 40, "the workspace is laid out")
    yield 1.5
    window.scene.reflcolor.picked_color = (0.8, 0.2, 0.1)
    with Watch() as watch:
        window.bpy_window.id_data.reflcolor.live_update = True
        yield from window.until(watch.full, 60, "the preview is there")
        yield 1.0
        yield from add_seeds(window, watch, "with the mesh in view", 0, 5)
        # What software OpenGL takes to draw so large a mesh is not the extension's.
        view = window.area("VIEW_3D")
        view.ui_type = "TEXT_EDITOR"
        yield 0.5
        yield from add_seeds(window, watch, "the images alone in view", 5, 3)
        window.area("TEXT_EDITOR").ui_type = "VIEW_3D"
        yield 1.0
    yield from window.screenshot("live")
    window.equal(len(window.scan.reflcolor.seeds), 58, "seeds")
    window.check("Colorized" not in window.scan.data.color_attributes, "the preview is no result yet")
    window.invoke("reflcolor.colorize")
    yield from window.until(lambda: "Colorized" in window.scan.data.color_attributes, 20, "Colorize keeps the preview")
    window.bpy_window.id_data.reflcolor.live_update = False
    yield 0.5
    window.check(window.scan.reflcolor.preview_image is None, "the preview is off")
    window.check("Live Preview" not in bpy.data.images.keys(), "and gone")  # noqa: SIM118
    yield from window.screenshot("kept")


def scenario_thousands_of_seeds_cost_no_time_to_draw(window):
    window.call("reflcolor.import_scan", filepath=write_large_scan(window))
    window.call("reflcolor.load_seeds", filepath=write_seeds(window, PAPER_SIZE, 5000))
    window.call("reflcolor.open_seed_picking")
    yield from window.until(lambda: laid_out(window), 40, "the workspace is laid out")
    yield 2.0
    area = image_areas(window)[0]
    area.spaces.active.show_region_ui = False
    milliseconds = {}
    for marks in (False, True, False, True):
        area = image_areas(window)[0]
        area.spaces.active.overlay.show_overlays = marks
        yield 0.3
        with window.at(area):
            bpy.ops.wm.redraw_timer(type="DRAW", iterations=3)
            start = time.perf_counter()
            bpy.ops.wm.redraw_timer(type="DRAW", iterations=20)
        milliseconds.setdefault(marks, []).append(1000 * (time.perf_counter() - start) / 20)
    without, given = (min(milliseconds[marks]) for marks in (False, True))
    window.notes.append(
        {"measure": "drawing the Image Editor, ms", "without seeds": without, "with 5,000 seeds": given}
    )
    window.check(len(window.scan.reflcolor.seeds) == 5000, "5,000 seeds are there")
    yield from window.screenshot("five_thousand")
