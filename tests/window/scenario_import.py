"""A scan comes in through Blender's own doors: File > Import, the search, the panel's button."""

import shutil
from pathlib import Path

import bpy
from inside.scans import shown_colors


def browser_is_open(window):
    return any(area.ui_type == "FILES" for area in window.bpy_window.screen.areas)


def pick_file(window, name):
    """Type a file's name into the file browser that has opened, and confirm."""
    yield from window.until(lambda: browser_is_open(window), 5, "a file browser opens")
    yield 0.3
    area = window.area("FILES")
    area.spaces.active.params.directory = window.example("").encode()
    yield 0.5
    # The region holds the field of the file's name and, on the right, two buttons.
    yield from window.click(window.place_in(area, 0.3, 0.5, "EXECUTE"))
    yield from window.key("A", ctrl=True)
    yield from window.type(name)
    yield from window.key("RET")
    yield from window.screenshot("browser")
    yield from window.move(window.place_in(window.area("FILES")))
    yield from window.key("RET")


def imported(window):
    """Wait until the example is in, and look at it."""
    yield from window.until(lambda: window.scan is not None and window.scan.name == "cones", 15, "the scan is imported")
    window.equal((window.scan.reflcolor.rows, window.scan.reflcolor.cols), (300, 450), "rows and columns")
    window.equal(shown_colors(window.scan)[0], "Reflectance_Gray", "what is shown")
    window.check(not browser_is_open(window), "the file browser is gone")


def scenario_file_import_menu(window):
    yield from window.click((43, window.bpy_window.height - 14))
    yield 0.3
    yield from window.key("M")
    yield 0.5
    yield from window.screenshot("menu", keep_mouse=True)
    # From the first entry up: photo, seeds and then the scan are the last.
    for _ in range(3):
        yield from window.key("UP_ARROW")
    yield from window.key("RET")
    yield from pick_file(window, "cones.scan.json")
    yield from imported(window)
    yield from window.screenshot("imported")
    yield from window.undo()
    window.check("cones" not in bpy.data.objects, "Ctrl Z takes the scan away")


def scenario_search_by_name(window):
    yield from window.move(window.place_in(window.area("VIEW_3D")))
    yield from window.key("F3")
    yield 0.3
    yield from window.type("import laser")
    yield 0.5
    yield from window.screenshot("search", keep_mouse=True)
    yield from window.key("RET")
    yield from pick_file(window, "cones.scan.json")
    yield from imported(window)


def scenario_leaving_the_file_browser_changes_nothing(window):
    objects = bpy.data.objects.keys()
    yield from window.show_sidebar()
    yield from window.click_button("reflcolor.import_scan")
    yield from window.until(lambda: browser_is_open(window), 5, "a file browser opens")
    yield 0.3
    yield from window.move(window.place_in(window.area("FILES")))
    yield from window.key("ESC")
    yield from window.until(lambda: not browser_is_open(window), 5, "the file browser closes")
    window.equal(bpy.data.objects.keys(), objects, "objects")


def scenario_two_images_show_what_comes_of_them(window):
    folder = Path(window.output("pair"))
    folder.mkdir(exist_ok=True)
    for name in ("depth16_mm.png", "ir16.png"):
        shutil.copy(window.data(f"k4a_mug/{name}"), folder / name)
    yield from window.show_sidebar()
    yield from window.click_button("reflcolor.import_scan")
    yield from window.until(lambda: browser_is_open(window), 5, "a file browser opens")
    yield 0.3
    area = window.area("FILES")
    area.spaces.active.params.directory = str(folder).encode()
    yield 1.0
    yield from window.move(window.place_in(area))
    yield from window.key("A")
    yield 0.5
    yield from window.screenshot("two images", keep_mouse=True)
    yield from window.key("RET")
    yield from window.until(lambda: window.scan is not None and "ir16" in window.scan.name, 15, "the scan is imported")
    window.equal((window.scan.reflcolor.rows, window.scan.reflcolor.cols), (576, 640), "rows and columns")
