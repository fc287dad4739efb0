"""Where results go: looked at before the work begins, so that nothing is found out at its end."""

import os
from contextlib import contextmanager

from ..errors import UsageError
from ..files.atomic import require_writable

IMAGE_SUFFIXES = (".png",)
SCENE_SUFFIXES = (".blend", ".glb", ".ply")


def scene_outputs(paths, render, blender):
    """Return those of the paths that Blender has to write.

    Parameters
    ----------
    paths : list of Path
    render : Path or None
        The picture to render.
    blender : BlenderDoor or None
        None without Blender.

    Raises
    ------
    UsageError
        If a suffix is unknown, or Blender is needed and not there.
    """
    for path in paths:
        if path.suffix.lower() not in IMAGE_SUFFIXES + SCENE_SUFFIXES:
            known = ", ".join(IMAGE_SUFFIXES + SCENE_SUFFIXES)
            raise UsageError(f"-o {path}: the suffix tells what to write; expected one of {known}")
    if render is not None and render.suffix.lower() not in IMAGE_SUFFIXES:
        raise UsageError(f"--render {render}: expected a file that ends in {' or '.join(IMAGE_SUFFIXES)}")
    scene_paths = [path for path in paths if path.suffix.lower() in SCENE_SUFFIXES]
    if scene_paths or render is not None:
        require_blender(blender, f"-o {scene_paths[0]}" if scene_paths else f"--render {render}")
    return scene_paths


def require_blender(blender, what):
    """Raise UsageError where ``blender`` is None: what was asked for can be had in Blender only."""
    if blender is None:
        raise UsageError(f"{what} needs Blender; run the same as: blender -b --command reflcolor ...")


def check_outputs(outputs, inputs):
    """See that every output can be written, and that none would overwrite another or an input.

    Parameters
    ----------
    outputs : list of (str, Path)
        The option that names it, and the path.
    inputs : list of Path

    Raises
    ------
    UsageError
        If two outputs, or an output and an input, are the same file.
    OutputError
        If a file cannot be written there.
    """
    for place, (option, path) in enumerate(outputs):
        if any(_same_file(path, other) for other in inputs):
            raise UsageError(f"{option} {path}: is an input, and would be overwritten; choose another name")
        for other_option, other in outputs[:place]:
            if _same_file(path, other):
                raise UsageError(f"{option} {path}: the same file as {other_option} {other}; choose another name")
    for _, path in outputs:
        require_writable(path)


@contextmanager
def tracked(paths, written):
    """Add to the list ``written``, when the block ends well or not, every path that it wrote.

    A path counts as written when it is another file than before, as files that are written atomically are.
    """
    before = {path: _identity(path) for path in paths}
    try:
        yield
    finally:
        written.extend(path for path in paths if _identity(path) != before[path])


def _same_file(one, other):
    try:
        return one.samefile(other)
    except OSError:
        return os.path.normcase(os.path.realpath(one)) == os.path.normcase(os.path.realpath(other))


def _identity(path):
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns
