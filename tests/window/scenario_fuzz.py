"""A thousand random acts, the same ones every time: no Python error, no crash, and the seeds stay inside the grid."""

import random

import bpy
from inside.scans import write_large_scan, write_seeds
from inside.window import EXTENSION

LIMIT_S = 900
ACTS = 1000
SHAPE = (38, 57)


class Fuzz:
    """The acts; each may be refused, which is no failure: what is refused says so in one line."""

    def __init__(self, window):
        self.window = window
        self.random = random.Random(20130506)
        self.done = self.refused = 0
        self.scan_file = write_large_scan(window, SHAPE)
        self.seeds_file = write_seeds(window, SHAPE, 30)
        self.blend_file = window.output("fuzz.blend")
        bpy.ops.wm.save_as_mainfile(filepath=self.blend_file)

    def act(self):
        """Do one act, chosen by weight; return its name."""
        act = self.random.choices(*zip(*ACTS_AND_WEIGHTS, strict=True))[0]
        try:
            act(self)
            self.done += 1
        except RuntimeError as error:
            # Blender raises this for an operator's one-line report, and for a traceback inside it.
            if "Traceback" in str(error):
                raise
            self.refused += 1
        return act.__name__

    # ---- seeds

    def _place(self):
        return {"row": self.random.randrange(SHAPE[0] + 2), "col": self.random.randrange(SHAPE[1] + 2)}

    def _color(self):
        return tuple(self.random.random() for _ in range(3))

    def add_seed(self):
        self.window.call("reflcolor.add_seed", **self._place(), color=self._color())

    def add_seed_of_photo(self):
        photo = self._any(self.window.scene.reflcolor.photos)
        name = photo.image.name if photo and photo.image else "gone"
        xy = self.random.uniform(-20, 1300), self.random.uniform(-20, 950)
        self.window.call("reflcolor.add_seed", **self._place(), photo=name, photo_xy=xy)

    def move_seed(self):
        self.window.call("reflcolor.move_seed", index=self.random.randrange(-1, 8), **self._place())

    def remove_seed(self):
        self.window.call("reflcolor.remove_seed", index=self.random.randrange(-1, 8))

    def clear_seeds(self):
        self.window.call("reflcolor.clear_seeds")

    def load_seeds(self):
        self.window.call("reflcolor.load_seeds", filepath=self.seeds_file)

    # ---- work

    def colorize(self):
        self.window.call("reflcolor.colorize")

    def colorize_meanwhile(self):
        self.window.invoke("reflcolor.colorize")

    def apply_preset(self):
        self.window.call("reflcolor.apply_preset", preset=self.random.choice(("Paper", "Enhanced")))

    def evaluate(self):
        self.window.call("reflcolor.evaluate")

    # ---- things of the file

    def import_scan(self):
        self.window.call("reflcolor.import_scan", filepath=self.scan_file)

    def load_photo(self):
        self.window.call("reflcolor.load_photo", filepath=self.window.example("photo.jpg"))

    def remove_photo(self):
        self.window.call("reflcolor.remove_photo")

    def open_reflectance(self):
        # Only where there is an Image Editor: another window would not fit on the screen of the test.
        self.window.area("TIMELINE").ui_type = "IMAGE_EDITOR"
        try:
            self.window.call("reflcolor.open_reflectance")
        finally:
            self.window.area("IMAGE_EDITOR").ui_type = "TIMELINE"

    def select_another(self):
        self.window.bpy_window.view_layer.objects.active = self._any(self.window.bpy_window.view_layer.objects)
        self.window.push("Select")

    def copy_object(self):
        self.window.call("object.duplicate")

    def rename_object(self):
        if thing := self._any(bpy.data.objects):
            thing.name = f"Renamed {self.random.randrange(100)}"
            self.window.push("Rename")

    def rename_image(self):
        if thing := self._any(bpy.data.images):
            thing.name = f"Picture {self.random.randrange(100)}"
            self.window.push("Rename")

    def delete_image(self):
        if thing := self._any(bpy.data.images):
            bpy.data.images.remove(thing)
            self.window.push("Delete Image")

    def delete_object(self):
        self.window.call("object.delete")

    def delete_mesh(self):
        if thing := self._any(bpy.data.meshes):
            bpy.data.meshes.remove(thing)
            self.window.push("Delete Mesh")

    def edit_mode(self):
        self.window.call("object.editmode_toggle")

    # ---- time and files

    def undo(self):
        with bpy.context.temp_override(window=self.window.bpy_window):
            bpy.ops.ed.undo()

    def redo(self):
        with bpy.context.temp_override(window=self.window.bpy_window):
            bpy.ops.ed.redo()

    def save_file(self):
        bpy.ops.wm.save_as_mainfile(filepath=self.blend_file)

    def open_file(self):
        bpy.ops.wm.open_mainfile(filepath=self.blend_file)

    def new_file(self):
        bpy.ops.wm.read_homefile(use_factory_startup=True)

    def disable_and_enable(self):
        bpy.ops.preferences.addon_disable(module=EXTENSION)
        bpy.ops.preferences.addon_enable(module=EXTENSION)

    def _any(self, things):
        return self.random.choice(list(things)) if len(things) else None


ACTS_AND_WEIGHTS = (
    (Fuzz.add_seed, 20),
    (Fuzz.add_seed_of_photo, 6),
    (Fuzz.move_seed, 12),
    (Fuzz.remove_seed, 10),
    (Fuzz.clear_seeds, 1),
    (Fuzz.load_seeds, 3),
    (Fuzz.colorize, 4),
    (Fuzz.colorize_meanwhile, 6),
    (Fuzz.apply_preset, 3),
    (Fuzz.evaluate, 2),
    (Fuzz.import_scan, 4),
    (Fuzz.load_photo, 2),
    (Fuzz.remove_photo, 1),
    (Fuzz.open_reflectance, 2),
    (Fuzz.select_another, 5),
    (Fuzz.copy_object, 2),
    (Fuzz.rename_object, 3),
    (Fuzz.rename_image, 3),
    (Fuzz.delete_image, 3),
    (Fuzz.delete_object, 1),
    (Fuzz.delete_mesh, 1),
    (Fuzz.edit_mode, 2),
    (Fuzz.undo, 22),
    (Fuzz.redo, 12),
    (Fuzz.save_file, 2),
    (Fuzz.open_file, 2),
    (Fuzz.new_file, 1),
    (Fuzz.disable_and_enable, 2),
)


def scenario_a_thousand_random_acts(window):
    # Refusals in one line; a traceback's last line begins otherwise.
    window.expect_error(r"^Error: (?!Python)")
    fuzz = Fuzz(window)
    yield from window.show_sidebar()
    for number in range(ACTS):
        name = fuzz.act()
        # The last line of the log of a crash tells which act it was.
        print(f"window-test: act {number} {name}", flush=True)
        yield 0.0
        for obj in bpy.data.objects:
            state = obj.reflcolor
            inside = all(seed.row < state.rows and seed.col < state.cols for seed in state.seeds)
            window.check(inside, f"seeds of {obj.name} are inside its grid after act {number}, {name}")
        if not window.area("VIEW_3D").spaces.active.show_region_ui:
            yield from window.show_sidebar()
    window.check(fuzz.done > ACTS / 2, f"most acts are done: {fuzz.done} done, {fuzz.refused} refused")
    yield from window.screenshot("after")
