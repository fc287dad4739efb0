"""What a restless person may do with the extension, drawn at random, the same for the same seed."""

import random

import bpy

from inside.scans import write_large_scan, write_seeds
from inside.window import EXTENSION

SHAPE = (38, 57)


class RandomActs:
    """The acts; each may be refused, which is no failure: what is refused says so in one line.

    Those of the mouse are generators: ``yield from`` what ``act`` returns.
    """

    def __init__(self, window, seed):
        self.window = window
        self.random = random.Random(seed)
        self.done = self.refused = 0
        self.scan_file = write_large_scan(window, SHAPE)
        self.seeds_file = write_seeds(window, SHAPE, 30)
        self.blend_file = window.output("fuzz.blend")
        bpy.ops.wm.save_as_mainfile(filepath=self.blend_file)

    def act(self):
        """Do one act, chosen by weight; a generator that returns its name."""
        act = self.random.choices(*zip(*ACTS_AND_WEIGHTS, strict=True))[0]
        # Without a scan nearly everything is refused.
        if self.window.scan is None and self.random.random() < 0.2:
            act = RandomActs.import_scan
        try:
            going_on = act(self)
            if going_on is not None:
                yield from going_on
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

    def place_seed(self):
        self.window.call("reflcolor.place_seed", **self._place(), snap=self.random.random() < 0.7)

    def choose_color(self):
        self.window.scene.reflcolor.picked_color = self._color()
        self.window.push("Seed Color")

    def drop_color(self):
        self.window.call("reflcolor.drop_color")

    def take_seed_tool(self):
        self.window.invoke("reflcolor.take_seed_tool")

    def seeds_from_color(self):
        self.window.call("reflcolor.seeds_from_color", count=self.random.randrange(1, 30))

    def set_up_render(self):
        self.window.call("reflcolor.set_up_render")

    def choose_picture(self):
        settings = self.window.scene.reflcolor
        settings.picture_look = self.random.choice(("archive", "lit"))
        settings.picture_filled = self.random.random() < 0.5
        settings.picture_drop_mixed = self.random.random() < 0.5
        self.window.push("Picture")

    def make_texture(self):
        self.window.call("reflcolor.make_texture", pixels=self.random.choice((64, 128)))

    def export_scan(self):
        suffix = self.random.choice(("ply", "glb", "ptx"))
        self.window.call("reflcolor.export_scan", filepath=self.window.output(f"fuzz.{suffix}"))

    def select_seeds(self):
        which = self.random.choice(("all", "none", "found", "unsure", "uncolored"))
        self.window.call("reflcolor.select_all_seeds", which=which)

    def delete_seeds(self):
        self.window.call("reflcolor.delete_seeds")

    def lock_seeds(self):
        self.window.call("reflcolor.lock_seeds", unlock=self.random.random() < 0.5)

    def keep_gray(self):
        self.window.call("reflcolor.keep_gray")

    # ---- mouse

    def open_picking(self):
        self.window.call("reflcolor.open_seed_picking")

    def close_picking(self):
        self.window.call("reflcolor.close_seed_picking")

    def click(self):
        held = self.random.choice(({}, {}, {}, {"ctrl": True}, {"shift": True}, {"alt": True}))
        yield from self.window.click(self._spot(), **held)

    def drag(self):
        held = self.random.choice(({}, {"shift": True}, {"ctrl": True}))
        area = self._editor()
        yield from self.window.drag(self._spot(area), self._spot(area), steps=4, **held)

    def press_key(self):
        yield from self.window.move(self._spot())
        yield from self.window.key(self.random.choice(("ESC", "X")))

    def _editor(self):
        kinds = ("IMAGE_EDITOR", "VIEW_3D")
        return self._any([area for area in self.window.bpy_window.screen.areas if area.type in kinds])

    def _spot(self, area=None):
        """A place away from an area's edges, where toolbars are and areas are joined and split."""
        across, up = self.random.uniform(0.25, 0.6), self.random.uniform(0.2, 0.8)
        return self.window.place_in(area or self._editor(), across, up)

    # ---- work

    def colorize(self):
        self.window.call("reflcolor.colorize")

    def colorize_meanwhile(self):
        self.window.invoke("reflcolor.colorize")

    def apply_preset(self):
        self.window.call("reflcolor.apply_preset", preset=self.random.choice(("Natural", "Paper", "Enhanced")))

    def live_update(self):
        settings = self.window.bpy_window.id_data.reflcolor
        settings.live_update = not settings.live_update

    def leave_preview(self):
        self.window.call("reflcolor.leave_preview")

    def show_look(self):
        looks = bpy.ops.reflcolor.show_look.get_rna_type().properties["look"].enum_items.keys()
        self.window.call("reflcolor.show_look", look=self.random.choice(looks))

    def evaluate(self):
        self.window.call("reflcolor.evaluate")

    # ---- things of the file

    def import_scan(self):
        self.window.call("reflcolor.import_scan", filepath=self.scan_file)

    def load_photo(self):
        self.window.call("reflcolor.load_photo", filepath=self.window.example("photo.jpg"))

    def load_photo_meanwhile(self):
        self.window.invoke("reflcolor.load_photo", filepath=self.window.example("photo.jpg"))

    def remove_photo(self):
        self.window.call("reflcolor.remove_photo")

    def open_reflectance(self):
        # Only where there is an Image Editor: another window would not fit on the screen of the test.
        if any(area.type == "IMAGE_EDITOR" for area in self.window.bpy_window.screen.areas):
            self.window.call("reflcolor.open_reflectance")

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
    (RandomActs.add_seed, 20),
    (RandomActs.add_seed_of_photo, 6),
    (RandomActs.move_seed, 12),
    (RandomActs.remove_seed, 10),
    (RandomActs.clear_seeds, 1),
    (RandomActs.load_seeds, 3),
    (RandomActs.place_seed, 6),
    (RandomActs.choose_color, 5),
    (RandomActs.drop_color, 2),
    (RandomActs.take_seed_tool, 2),
    (RandomActs.seeds_from_color, 2),
    (RandomActs.set_up_render, 1),
    (RandomActs.choose_picture, 2),
    (RandomActs.make_texture, 1),
    (RandomActs.export_scan, 1),
    (RandomActs.select_seeds, 4),
    (RandomActs.delete_seeds, 3),
    (RandomActs.lock_seeds, 2),
    (RandomActs.keep_gray, 2),
    (RandomActs.open_picking, 3),
    (RandomActs.close_picking, 1),
    (RandomActs.click, 14),
    (RandomActs.drag, 6),
    (RandomActs.press_key, 4),
    (RandomActs.live_update, 4),
    (RandomActs.leave_preview, 2),
    (RandomActs.show_look, 4),
    (RandomActs.colorize, 4),
    (RandomActs.colorize_meanwhile, 6),
    (RandomActs.apply_preset, 3),
    (RandomActs.evaluate, 2),
    (RandomActs.import_scan, 4),
    (RandomActs.load_photo, 1),
    (RandomActs.load_photo_meanwhile, 2),
    (RandomActs.remove_photo, 1),
    (RandomActs.open_reflectance, 2),
    (RandomActs.select_another, 5),
    (RandomActs.copy_object, 2),
    (RandomActs.rename_object, 3),
    (RandomActs.rename_image, 3),
    (RandomActs.delete_image, 3),
    (RandomActs.delete_object, 1),
    (RandomActs.delete_mesh, 1),
    (RandomActs.edit_mode, 2),
    (RandomActs.undo, 22),
    (RandomActs.redo, 12),
    (RandomActs.save_file, 2),
    (RandomActs.open_file, 2),
    (RandomActs.new_file, 1),
    (RandomActs.disable_and_enable, 1),
)
