"""Acts are taken back and done again; what was made outlives the file, and is rendered."""

from pathlib import Path

import bpy
from inside.scans import shown_colors

STEPS = 20


def seeds_of(window):
    return [(seed.row, seed.col) for seed in window.scan.reflcolor.seeds]


def scenario_twenty_steps_back_and_forth(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    states = [seeds_of(window)]
    for step in range(STEPS):
        if step % 5 == 3:
            window.call("reflcolor.move_seed", index=step % 3, row=step, col=2 * step)
        elif step % 5 == 4:
            window.call("reflcolor.remove_seed", index=1)
        else:
            window.call("reflcolor.add_seed", row=10 * step + 5, col=20 * step, color=(step / STEPS, 0.5, 0.2))
        states.append(seeds_of(window))
        yield 0.0
    for state in reversed(states[:-1]):
        yield from window.undo()
        window.equal(seeds_of(window), state, "seeds after Ctrl Z")
    yield from window.undo()
    window.check("cones" not in bpy.data.objects, "the last Ctrl Z takes the scan away")
    yield from window.undo(redo=True)
    window.equal(window.scan and window.scan.name, "cones", "the active object after redo")
    for state in states[1:]:
        yield from window.undo(redo=True)
        window.equal(seeds_of(window), state, "seeds after redo")
    yield from window.screenshot("redone")


def scenario_saved_and_loaded_again(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.load_photo", filepath=window.example("photo.jpg"))
    window.call("reflcolor.load_seeds", filepath=window.example("cones.seeds.json"))
    window.call("reflcolor.colorize")
    seeds, colors = seeds_of(window), shown_colors(window.scan)
    path = window.output("kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    yield from window.start_anew()
    window.check("cones" not in bpy.data.objects, "a new file holds no scan")
    bpy.ops.wm.open_mainfile(filepath=path)
    yield 0.3
    window.equal(seeds_of(window), seeds, "seeds of the loaded file")
    name, values = shown_colors(window.scan)
    window.check(name == colors[0] and (values == colors[1]).all(), "the loaded colors are the saved ones")
    window.equal(window.scene.reflcolor.photos[0].image.name, "photo.jpg", "the photo of the loaded file")
    yield from window.show_sidebar()
    yield from window.screenshot("loaded")


def scenario_rendered_picture_shows_the_colors(window):
    window.call("reflcolor.import_scan", filepath=window.example("cones.scan.json"))
    window.call("reflcolor.load_photo", filepath=window.example("photo.jpg"))
    window.call("reflcolor.load_seeds", filepath=window.example("cones.seeds.json"))
    window.call("reflcolor.colorize")
    window.call("reflcolor.set_up_render")
    render = window.scene.render
    render.resolution_percentage, window.scene.cycles.samples = 30, 4
    render.filepath = window.output("cones.png")
    window.invoke("render.render", write_still=True)
    yield from window.until(lambda: Path(render.filepath).is_file(), 60, "the picture is written")
    yield 0.5
    picture = bpy.data.images.load(render.filepath)
    values = list(picture.pixels)
    colorful = sum(max(values[i : i + 3]) - min(values[i : i + 3]) > 0.15 for i in range(0, len(values), 4)) / (
        len(values) / 4
    )
    window.check(colorful > 0.02, f"some of the picture is colorful: {colorful:.3f}")
    yield from window.screenshot("rendered")
