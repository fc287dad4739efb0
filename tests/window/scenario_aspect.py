"""Scans whose pixels are not square are shown in their true shape, and picked there."""

from scenario_picking import at_pixel, laid_out, near

LIMIT_S = 300


def scenario_a_scan_of_tall_pixels_is_shown_in_shape(window):
    path = window.data("pumpA/pumpAVisualReferenceImage.e57")
    window.call("reflcolor.import_scan", filepath=path)
    window.call("reflcolor.load_photo", filepath=window.data("pumpA/pumpA_photo.jpg"))
    window.call("reflcolor.open_seed_picking")
    yield from window.until(lambda: laid_out(window), 60, "the workspace is laid out")
    yield 1.0
    rows, cols = window.scan.reflcolor.rows, window.scan.reflcolor.cols
    (left, top), (right, bottom) = at_pixel(window, 0, 0), at_pixel(window, rows - 1, cols - 1)
    shape = (right - left) / (top - bottom)
    window.check(abs(shape - 0.25 * cols / (0.0676 * rows)) < 0.1, f"the image is as wide as its angles: {shape:.2f}")
    yield from window.click(at_pixel(window, rows // 2, cols // 2))
    window.equal(len(window.scan.reflcolor.seeds), 1, "a click places a seed")
    window.check(
        near(window, 0, rows // 2, cols // 2) or not window.scan.reflcolor.seeds[0].has_color, "near the mouse"
    )
    yield from window.screenshot("pump")
