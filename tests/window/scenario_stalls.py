"""How long the window stands still while the extension works on a scan of the paper's size, 760 x 1135.

First with Image Editors only, whose drawing costs little without a graphics card: what stands still there is the
extension. Then with the 3D View, beside what that costs while nothing but the view turns.
"""

import bpy
from inside.scans import PAPER_SIZE, shown_colors, write_large_scan, write_seeds

LIMIT_S = 600
ORBIT_STEPS = 8


def orbit(window):
    """Turn the view, as a hand on the middle mouse button does."""
    start = window.place_in(window.area("VIEW_3D"), 0.4, 0.5)
    yield from window.drag(start, (start[0] + 120, start[1] + 40), "MIDDLE", steps=ORBIT_STEPS)


def is_colorized(window):
    return window.running() is None and shown_colors(window.scan)[0] == "Colorized"


def scenario_stalls_without_a_3d_view(window):
    path = write_large_scan(window)
    view = window.area("VIEW_3D")
    view.ui_type = "IMAGE_EDITOR"
    yield 1.0
    with window.stalls("nothing is done"):
        yield 1.0
    with window.stalls("importing 760 x 1135"):
        window.invoke("reflcolor.import_scan", area=view, filepath=path)
        yield from window.until(lambda: "large" in bpy.data.objects, 120, "the scan is imported")
        yield 0.5
    window.call("reflcolor.load_seeds", area=view, filepath=write_seeds(window, PAPER_SIZE, 50))
    view.spaces.active.image = window.scan.reflcolor.reflectance_image
    yield 0.5
    with window.stalls("colorizing from 50 seeds"):
        window.invoke("reflcolor.colorize", area=view)
        window.check(window.running() is not None, "it runs")
        yield from window.until(lambda: is_colorized(window), 200, "the scan is colorized")
        yield 0.5
    window.call("reflcolor.load_photo", area=view, filepath=window.example("photo.jpg"))
    with window.stalls("drawing a loaded photo"):
        yield 1.0
    with window.stalls("matching a photo"):
        window.invoke("reflcolor.match_photos", area=view)
        yield from window.until(lambda: window.running() is None, 300, "it ends")
        yield 0.5
    window.check(len(window.scan.reflcolor.seeds) > 50, "seeds were found")
    yield from window.screenshot("matched")


def scenario_stalls_with_a_3d_view(window):
    window.call("reflcolor.import_scan", filepath=write_large_scan(window))
    window.call("reflcolor.load_seeds", filepath=write_seeds(window, PAPER_SIZE, 50))
    yield 0.5
    with window.stalls("3D View: only turning it, gray"):
        yield from orbit(window)
    with window.stalls("3D View: colorizing from 50 seeds"):
        window.invoke("reflcolor.colorize")
        yield from window.until(lambda: is_colorized(window), 200, "the scan is colorized")
        yield 0.5
    with window.stalls("3D View: only turning it, colors"):
        yield from orbit(window)
    yield from window.screenshot("colors")
