"""How long the window stands still while the extension works on a scan of the paper's size, 760 x 1135.

The first figure, taken while nothing but the view turns, is what drawing alone costs here.
"""

import bpy
from inside.scans import PAPER_SIZE, shown_colors, write_large_scan, write_seeds

LIMIT_S = 240
ORBIT_S = 2


def orbit(window, seconds=ORBIT_S):
    """Turn the view for a time, as a hand on the middle mouse button does."""
    start = window.place_in(window.area("VIEW_3D"), 0.4, 0.5)
    end = (start[0] + 120, start[1] + 40)
    yield from window.drag(start, end, "MIDDLE", steps=int(seconds * 15))


def scenario_stalls_are_measured(window):
    path = write_large_scan(window)
    yield from window.show_sidebar()
    with window.stalls("importing 760 x 1135"):
        window.invoke("reflcolor.import_scan", filepath=path)
        yield from window.until(lambda: "large" in bpy.data.objects, 60, "the scan is imported")
        yield 0.5
    with window.stalls("only turning the view, gray"):
        yield from orbit(window)
    window.call("reflcolor.load_seeds", filepath=write_seeds(window, PAPER_SIZE, 50))
    yield 0.5
    with window.stalls("colorizing from 50 seeds"):
        yield from window.click_button("reflcolor.colorize")
        yield from window.until(lambda: shown_colors(window.scan)[0] == "Colorized", 60, "the scan is colorized")
        yield 0.5
    with window.stalls("only turning the view, colors"):
        yield from orbit(window)
    with window.stalls("colorizing again, the view turning"):
        window.invoke("reflcolor.colorize")
        window.check(window.running() is not None, "it runs")
        yield from orbit(window)
        yield from window.until(lambda: window.running() is None, 60, "it ends")
        yield 0.5
    window.call("reflcolor.load_photo", filepath=window.example("photo.jpg"))
    with window.stalls("matching a photo"):
        window.invoke("reflcolor.match_photos")
        yield from window.until(lambda: window.running() is None, 100, "it ends")
        yield 0.5
    window.check(len(window.scan.reflcolor.seeds) > 50, "seeds were found")
    yield from window.screenshot("matched")
