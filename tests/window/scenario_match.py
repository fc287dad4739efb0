"""Seeds are found in a photo, by the panel's button, and ESC in the middle changes nothing."""

import bpy
from inside.scans import state_of


def prepared(window):
    """The example with its photo and a seed picked by hand, the sidebar open."""
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.load_photo", filepath=window.example("photo.jpg"))
    window.call("reflcolor.add_seed", row=10, col=20, color=(0.1, 0.2, 0.9))
    yield from window.show_sidebar()


def scenario_match_finds_seeds_and_keeps_picked_ones(window):
    yield from prepared(window)
    yield from window.click_button("reflcolor.match_photos")
    yield from window.until(
        lambda: window.running() is None and len(window.scan.reflcolor.seeds) > 100,
        200,
        "more than 100 seeds are found",
    )
    seeds = window.scan.reflcolor.seeds
    window.equal((seeds[0].row, seeds[0].col, seeds[0].reason), (10, 20, "hand"), "the seed picked by hand")
    (verdict,) = window.scan.reflcolor.verdicts
    window.check(verdict.verified and verdict.image.name == "photo.jpg", "the scan keeps that the photo was verified")
    yield from window.screenshot("found")
    view = window.area("VIEW_3D")
    view.ui_type = "IMAGE_EDITOR"
    view.spaces.active.image = window.scan.reflcolor.matches_image
    yield 0.2
    with window.at(view):
        bpy.ops.image.view_all(fit_view=True)
    yield from window.screenshot("matches")
    view.ui_type = "VIEW_3D"
    yield 0.2
    yield from window.undo()
    window.equal(len(window.scan.reflcolor.seeds), 1, "seeds after Ctrl Z")


def scenario_esc_while_matching_changes_nothing(window):
    yield from prepared(window)
    before = state_of(window.scan)
    yield from window.click_button("reflcolor.match_photos")
    yield from window.until(lambda: window.running() and window.running().fraction > 0, 20, "the work begins")
    yield from window.screenshot("running", still=False)
    window.check(window.running() is not None, "it still runs when ESC is pressed")
    yield from window.move(window.place_in(window.area("VIEW_3D")))
    yield from window.key("ESC")
    yield from window.until(lambda: window.running() is None, 10, "ESC ends the work")
    yield 0.2
    window.equal(state_of(window.scan), before, "seeds, colors, attributes and images after ESC")
    window.equal(len(window.scan.reflcolor.verdicts), 0, "verdicts on photos")
