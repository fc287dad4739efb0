"""The bpy wheel as a Blender that has the extension installed from its zip, with a user folder of its own.

The Python that bpy runs in has the packages that the extension bundles, too, for the tests that need no Blender. They
are hidden here: what the extension imports must come from its zip, as in a user's Blender.
"""

import os
import shutil
import site
import sys
import tempfile
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import PathFinder
from pathlib import Path

EXTENSION = "bl_ext.user_default.reflcolor"
BUNDLED = (
    "OpenEXR",
    "cv2",
    "laspy",
    "lazrs",
    "lazy_loader",
    "pye57",
    "pyquaternion",
    "reflcolor_kernel",
    "scipy",
    "skimage",
)


class _BundledOnly(MetaPathFinder):
    """Finds the bundled packages anywhere but among the packages of this Python."""

    def find_spec(self, fullname, path=None, target=None):
        if path is not None or fullname not in BUNDLED:
            return None
        own = set(site.getsitepackages())
        spec = PathFinder.find_spec(fullname, [entry for entry in sys.path if entry not in own])
        if spec is None:
            raise ModuleNotFoundError(f"the extension's zip brings no {fullname}", name=fullname)
        return spec


def start(zip_file: Path, resources: Path):
    """Import bpy with `resources` as its user folder and the zip installed and enabled there; once per process."""
    bpy = open_blender(resources)
    enable(bpy, zip_file)
    return bpy


def open_blender(resources: Path):
    """Import bpy with `resources` as its user folder, made if it is not there."""
    os.environ["BLENDER_USER_RESOURCES"] = str(resources)
    resources.mkdir(parents=True, exist_ok=True)
    sys.meta_path.insert(0, _BundledOnly())
    with _output_aside():
        import bpy
    return bpy


def enable(bpy, zip_file: Path) -> None:
    """Install the zip, or take what an earlier process installed in this user folder, and enable the extension.

    What Blender says meanwhile is told only where it does not end well.
    """
    installed = Path(os.environ["BLENDER_USER_RESOURCES"], "extensions", "user_default", "reflcolor")
    problem = ""
    with _output_aside() as output:
        try:
            if installed.is_dir():
                bpy.ops.preferences.addon_enable(module=EXTENSION)
            else:
                bpy.ops.extensions.package_install_files(
                    repo="user_default", filepath=str(zip_file), enable_on_install=True
                )
        except RuntimeError as error:
            problem = str(error)
    if problem or EXTENSION not in bpy.context.preferences.addons:
        raise RuntimeError(f"Blender did not install and enable {zip_file}: {problem}\n{''.join(output)}")


def end(status: int) -> None:
    """End the process with everything written; the interpreter's own way out can hang in a sound thread of bpy 4.5."""
    if "bpy" in sys.modules:
        scratch = Path(sys.modules["bpy"].app.tempdir)
        # Blender makes this folder for itself; where it could not, the path is that of everyone's temporary folder.
        if scratch.name.startswith("blender_"):
            shutil.rmtree(scratch, ignore_errors=True)
    _flush()
    os._exit(status)


@contextmanager
def _output_aside():
    """Keep from the terminal what Python and Blender write; gives a list that holds the text afterwards."""
    text = []
    kept = [os.dup(1), os.dup(2)]
    with tempfile.TemporaryFile() as file:
        _flush()
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        try:
            yield text
        finally:
            _flush()
            for number, copy in zip((1, 2), kept, strict=True):
                os.dup2(copy, number)
                os.close(copy)
            file.seek(0)
            text.append(file.read().decode(errors="replace"))


def _flush():
    sys.stdout.flush()
    sys.stderr.flush()
