"""A new user's ways from Blender's factory startup file to a rendered picture: every click and key counted."""

import shutil
from pathlib import Path

import bpy
from scenario_import import browser_is_open

LIMIT_S = 900
MOST = 9


def open_steps(window):
    """Open the sidebar by its key, and its tab by a click; generator."""
    view = window.area("VIEW_3D")
    yield from window.move(window.place_in(view, 0.4, 0.5))
    yield from window.key("N")
    yield from window.until(lambda: window.region(window.area("VIEW_3D"), "UI").width > 1, 5, "the sidebar opens")
    yield 0.3
    yield from window.click_tab("Reflectance")


def browse(window, folder):
    """Show a folder in the file browser that opens; returns its area; generator."""
    yield from window.until(lambda: browser_is_open(window), 5, "a file browser opens")
    yield 0.3
    area = window.area("FILES")
    area.spaces.active.params.directory = folder.encode()
    yield 1.0
    yield from window.move(window.place_in(area))
    return area


def open_file(window, folder, name):
    """Pick a file in the file browser that opens, by a click and Enter; generator."""
    area = yield from browse(window, folder)
    place = yield from window.find_file(area, name)
    yield from window.click(place)
    yield from window.screenshot("browser", keep_mouse=True)
    yield from window.key("RET")


def open_files(window, folder):
    """Pick all files of a folder in the file browser that opens, by A and Enter; generator."""
    yield from browse(window, folder)
    yield from window.key("A")
    yield 0.5
    yield from window.screenshot("browser", keep_mouse=True)
    yield from window.key("RET")


def color_and_render(window):
    """The last clicks: Colorize, Set Up Render, Render; generator."""
    yield from window.click_button("reflcolor.colorize")
    yield from window.until(lambda: "Colorized" in window.scan.data.color_attributes, 120, "the scan is colorized")
    yield from window.screenshot("colorized")
    yield from window.click_button("reflcolor.set_up_render")
    yield from window.until(lambda: window.running() is None and window.scene.camera.name != "Camera", 60, "a camera")
    yield from window.screenshot("set_up")
    # A quarter of the pixels, for the tests' sake.
    window.scene.render.resolution_percentage = 50
    rendered = []
    bpy.app.handlers.render_complete.append(lambda *_: rendered.append(True))
    yield from window.click_button("render.render")
    yield from window.until(lambda: rendered, 120, "the picture is rendered")
    bpy.app.handlers.render_complete.pop()
    yield 0.5
    yield from window.screenshot("rendered")
    bpy.data.images["Render Result"].save_render(window.output(f"{window.scan.name}.png"))
    window.check(window.presses <= MOST, f"at most {MOST} clicks and keys, here {window.presses}")
    window.notes.append({"measure": "from the startup file to a picture", "clicks and keys": window.presses})


def imported(window, name):
    """Wait until a scan is in and look at it; generator."""
    yield from window.until(lambda: window.scan is not None and name in window.scan.name, 60, "the scan is imported")
    yield 0.3
    yield from window.screenshot("imported")


def scenario_example_with_its_photo(window):
    yield from open_steps(window)
    yield from window.screenshot("opened")
    yield from window.click_button("reflcolor.open_example")
    yield from imported(window, "cones")
    yield from window.click_button("reflcolor.match_photos")
    yield from window.until(
        lambda: window.running() is None and len(window.scan.reflcolor.seeds) > 100, 200, "seeds are found in the photo"
    )
    yield from window.screenshot("matched")
    yield from color_and_render(window)


def scenario_e57_with_colors_of_its_own(window):
    folder = window.data("pumpA")
    yield from open_steps(window)
    yield from window.click_button("reflcolor.import_scan")
    yield from open_file(window, folder, "pumpAVisualReferenceImage.e57")
    yield from imported(window, "pumpA")
    yield from window.click_button("reflcolor.seeds_from_color")
    yield from window.until(lambda: len(window.scan.reflcolor.seeds) > 0, 20, "seeds are taken")
    yield from color_and_render(window)


def scenario_ptx_with_colors_of_its_own(window):
    folder = window.data("doria_ptx")
    yield from open_steps(window)
    yield from window.click_button("reflcolor.import_scan")
    yield from open_file(window, folder, "1.ptx")
    yield from imported(window, "1")
    yield from window.click_button("reflcolor.seeds_from_color")
    yield from window.until(lambda: len(window.scan.reflcolor.seeds) > 0, 20, "seeds are taken")
    yield from color_and_render(window)


def scenario_image_pair_with_colors_of_its_own(window):
    folder = Path(window.output("pair"))
    folder.mkdir(exist_ok=True)
    for name in ("depth16_mm.png", "ir16.png", "color_aligned_to_depth.png"):
        shutil.copy(window.data(f"k4a_mug/{name}"), folder / name)
    yield from open_steps(window)
    yield from window.click_button("reflcolor.import_scan")
    yield from open_files(window, str(folder))
    yield from imported(window, "ir16")
    yield from window.click_button("reflcolor.seeds_from_color")
    yield from window.until(lambda: len(window.scan.reflcolor.seeds) > 0, 20, "seeds are taken")
    yield from color_and_render(window)


def scenario_image_pair_with_a_photo_of_its_own(window):
    folder = Path(window.output("pair_and_photo"))
    folder.mkdir(exist_ok=True)
    for name in ("cones.scan.json", "cones.range.png", "cones.reflectance.png", "photo.jpg"):
        shutil.copy(window.example(name), folder / name)
    yield from open_steps(window)
    yield from window.click_button("reflcolor.import_scan")
    yield from open_files(window, str(folder))
    yield from imported(window, "cones")
    window.equal([photo.image.name for photo in window.scene.reflcolor.photos], ["photo.jpg"], "photos")
    yield from window.click_button("reflcolor.match_photos")
    yield from window.until(
        lambda: window.running() is None and len(window.scan.reflcolor.seeds) > 50, 200, "seeds are found in the photo"
    )
    yield from window.screenshot("matched")
    yield from color_and_render(window)
