"""Seeds are spread over a scan: by the panel's button, cancelled by ESC, undone."""

from inside.scans import PAPER_SIZE, shown_colors, state_of, write_large_scan, write_seeds

SEEDS = (
    (60, 100, (0.9, 0.3, 0.1)),
    (240, 225, (0.2, 0.5, 0.2)),
    (150, 380, (0.2, 0.3, 0.8)),
    (40, 300, (0.7, 0.7, 0.6)),
)


def scenario_button_colors_the_scan(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    for row, col, color in SEEDS:
        window.call("reflcolor.add_seed", row=row, col=col, color=color)
    yield from window.show_sidebar()
    yield from window.click_button("reflcolor.colorize")
    yield from window.until(lambda: shown_colors(window.scan)[0] == "Colorized", 20, "the scan is colorized")
    rgb = shown_colors(window.scan)[1].astype(int)
    window.check((rgb.max(axis=1) > rgb.min(axis=1) + 20).mean() > 0.1, "the colors are no grays")
    yield from window.screenshot("done")
    yield from window.undo()
    window.equal(shown_colors(window.scan)[0], "Reflectance_Gray", "what is shown after Ctrl Z")
    window.equal(len(window.scan.reflcolor.seeds), 4, "seeds after Ctrl Z")
    yield from window.undo(redo=True)
    name, again = shown_colors(window.scan)
    window.check(name == "Colorized" and (again == rgb).all(), "redo brings the same colors back")


def scenario_esc_leaves_all_as_it_was(window):
    window.call("reflcolor.import_scan", filepath=write_large_scan(window))
    window.call("reflcolor.load_seeds", filepath=write_seeds(window, PAPER_SIZE, 400))
    window.scene.reflcolor.blend = "all"
    yield from window.show_sidebar()
    before = state_of(window.scan)
    yield from window.click_button("reflcolor.colorize")
    yield from window.until(lambda: window.running() and window.running().fraction > 0, 20, "the work begins")
    yield from window.screenshot("running", still=False)
    window.check(window.running() is not None, "it still runs when ESC is pressed")
    yield from window.move(window.place_in(window.area("VIEW_3D")))
    yield from window.key("ESC")
    yield from window.until(lambda: window.running() is None, 5, "ESC ends the work")
    yield 0.2
    window.equal(state_of(window.scan), before, "seeds, colors, attributes and images after ESC")
    yield from window.screenshot("cancelled")
