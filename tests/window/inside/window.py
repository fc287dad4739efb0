"""What a scenario is given: hands, eyes, checks, and the extension's data."""

import importlib
import time
from pathlib import Path

import bpy

from inside.buttons import Buttons
from inside.eyes import Eyes
from inside.hands import Hands
from inside.stalls import Stalls

# How many times longer than it takes on a quiet machine something may take.
_PATIENCE = 4
EXTENSION = "bl_ext.user_default.reflcolor"


class Missing(Exception):
    """What a scenario needs is not on this machine."""


class Window(Hands, Eyes, Buttons, Stalls):
    """The window under test.

    Attributes
    ----------
    checks : int
        How often ``check`` or ``equal`` found what was expected.
    expected_errors : list of str
        Regular expressions of lines that Blender's log may hold, though they look like errors.
    """

    def __init__(self, args, scenario):
        Hands.__init__(self)
        Eyes.__init__(self, args.out, scenario)
        Stalls.__init__(self)
        self._args = args
        self.checks = 0
        self.expected_errors = []

    # ---- checks

    def check(self, holds, what):
        """Fail the scenario unless something holds; ``what`` tells what should have been."""
        if not holds:
            raise AssertionError(what)
        self.checks += 1

    def equal(self, value, expected, what):
        """Fail the scenario unless two values are equal."""
        self.check(value == expected, f"{what}: expected {expected!r}, got {value!r}")

    def until(self, condition, seconds, what):
        """Wait until a function returns something true, and count that as a check; fail after so many seconds."""
        limit = time.monotonic() + _PATIENCE * seconds
        while not (found := condition()):
            if time.monotonic() > limit:
                raise AssertionError(f"not within {seconds} s: {what}")
            yield 0.01
        self.checks += 1
        return found

    def expect_error(self, pattern):
        """Say that the log may hold a line that matches this pattern, as Blender prints what an operator reports."""
        self.expected_errors.append(pattern)

    # ---- files

    @property
    def zip_file(self):
        """The extension's zip."""
        return self._args.zip

    def example(self, name):
        """Return the path of a file of examples/cones."""
        return str(self._args.examples / "cones" / name)

    def data(self, name):
        """Return the path of a public scan; without them the scenario is skipped."""
        if self._args.data is None:
            raise Missing("needs the public scans: set REFLCOLOR_DATA to their folder")
        return str(self._args.data / name)

    def output(self, name):
        """Return the path for a file that the scenario writes."""
        return str(self._args.out / name)

    # ---- Blender

    def start_anew(self):
        """Open Blender's factory startup file in one window, nothing of an earlier scenario left."""
        preferences = bpy.context.preferences
        preferences.view.show_splash = False
        # There is no window manager under Xvfb: what would open in a window of its own opens in this one.
        preferences.view.filebrowser_display_type = preferences.view.render_display_type = "SCREEN"
        # Without a graphics card the view would take seconds to become smooth after every change.
        preferences.system.viewport_aa = "FXAA"
        preferences.view.smooth_view = 0
        bpy.ops.wm.read_homefile(use_factory_startup=True)
        yield 0.3
        self.push("Start")
        yield from self.move((4, self.bpy_window.height // 2))

    def push(self, message):
        """End an undo step, as Blender does after an operator that a person calls; scripts do it by hand."""
        with bpy.context.temp_override(window=self.bpy_window):
            bpy.ops.ed.undo_push(message=message)

    def call(self, operator, *, area=None, **arguments):
        """Call an operator by script, "reflcolor.add_seed", in an area's context, with an undo step of its own."""
        group, name = operator.split(".")
        function = getattr(getattr(bpy.ops, group), name)
        with self.at(area or self.area("VIEW_3D")):
            # Not with Blender's own argument for undo: with it, what is not given is taken from the last call.
            result = function("EXEC_DEFAULT", **arguments)
        if "UNDO" in function.bl_options and "FINISHED" in result:
            self.push(operator)
        return result

    def invoke(self, operator, *, area=None, **arguments):
        """Call an operator as a button does: with its dialog or file browser, or going on in the window."""
        group, name = operator.split(".")
        with self.at(area or self.area("VIEW_3D")):
            return getattr(getattr(bpy.ops, group), name)("INVOKE_DEFAULT", True, **arguments)

    def press(self, operator, **arguments):
        """Call an operator by a key over the 3D View, as an entry of a menu does: Blender itself calls it."""
        keymap = bpy.context.window_manager.keyconfigs.addon.keymaps.new("3D View", space_type="VIEW_3D")
        item = keymap.keymap_items.new(operator, "F19", "PRESS")
        for name, value in arguments.items():
            setattr(item.properties, name, value)
        yield from self.move(self.place_in(self.area("VIEW_3D"), 0.3, 0.5))
        yield from self.key("F19")
        keymap.keymap_items.remove(item)

    def drop(self, *paths, area=None):
        """Drop files on an area: call what Blender calls when it gets them from another program."""
        folders = {str(Path(path).parent) for path in paths}
        self.equal(len(folders), 1, "folders of what is dropped at once")
        files = [{"name": Path(path).name} for path in paths]
        return self.invoke("wm.drop_import_file", area=area, directory=folders.pop(), files=files)

    def undo(self, redo=False):
        """Press Ctrl Z, or Shift Ctrl Z, with the mouse over the 3D View."""
        yield from self.move(self.place_in(self.area("VIEW_3D")))
        yield from self.key("Z", ctrl=True, shift=redo)
        yield 0.02

    @property
    def scan(self):
        """The active object; ask again after anything that may have undone or loaded: never keep it."""
        return self.bpy_window.view_layer.objects.active

    def running(self):
        """Return the extension's job that runs in the window, or None."""
        return importlib.import_module(f"{EXTENSION}.operators.window.jobs").running()

    @property
    def scene(self):
        """The window's scene."""
        return self.bpy_window.scene


def install(zip_file):
    """Install and enable the zip; where an earlier start has put it into this user folder, only enable it."""
    repository = next(repo for repo in bpy.context.preferences.extensions.repos if repo.module == "user_default")
    if (Path(repository.directory) / "reflcolor").is_dir():
        bpy.ops.preferences.addon_enable(module=EXTENSION)
    else:
        bpy.ops.extensions.package_install_files(repo=repository.module, filepath=str(zip_file), enable_on_install=True)
    if EXTENSION not in bpy.context.preferences.addons:
        raise RuntimeError("Blender did not install and enable the extension")
