"""Checks what a manifest says before the work begins, so that all of its errors are reported at once."""

from ...errors import ReflcolorError, UsageError
from ...messages import Message
from ..check import check_has_mesh, load_seeds
from ..paths import files_of_each, output_faults
from ..plan import PLACEHOLDER, RENDER
from .folder import is_there


def check_manifest(manifest, blender, refuse):
    """Look at the seeds that a manifest names, and at where its results go; `check_files` looks at scans and photos.

    Parameters
    ----------
    manifest : Manifest
    blender : BlenderTasks or None
    refuse : callable
        Given a UsageError for each thing that is wrong, with its line.
    """
    said = set()
    for item in manifest.items:

        def wrong(problem, line=item.line):
            # What is wrong for all scans is said once.
            if (line, str(problem)) not in said:
                said.add((line, str(problem)))
                refuse(UsageError("{file}: line {line}: {problem}", file=manifest.path, line=line, problem=problem))

        for given in filter(None, (item.plan.seeds, item.plan.hand)):
            for path in files_of_each(given, item.name):
                _attempt(wrong, load_seeds, path, item.plan.photos)
        needing = [output for output in item.plan.outputs if output.needs_blender]
        if item.plan.needs_blender and (blender is None or blender.command is None):
            what = _what(needing)
            told = Message(
                "{what} needs Blender; run the batch as: blender -b --command reflcolor batch ...", what=what
            )
            wrong(told, item.blender_line)
        _attempt(wrong, check_has_mesh, item.plan)
    _check_outputs(manifest, refuse)


def _what(outputs):
    """Names what needs Blender."""
    if not outputs:
        return "faces"
    return "render" if outputs[0].kind == RENDER else f"write {outputs[0].path.suffix}"


def _check_outputs(manifest, refuse):
    """No result may overwrite an input, and the folder must be writable."""
    root, read = manifest.folder.root, set()
    for item in manifest.items:
        read.update(path.resolve() for path in (*item.plan.scans, *item.plan.photos))
    outputs = [
        (output.option, output.of(item.name).path)
        for item in manifest.items
        for output in item.plan.outputs
        if PLACEHOLDER in str(output.path)
    ]
    for option, path in outputs:
        if path.resolve() in read:
            refuse(
                UsageError(
                    "{file}: {option} {path}: is an input, and would be overwritten; choose another folder",
                    file=manifest.path,
                    option=option,
                    path=path,
                )
            )
    existing = next(folder for folder in (root, *root.absolute().parents) if is_there(folder))
    for fault in output_faults([("output", existing / ".reflcolor-try")], []):
        refuse(UsageError("{file}: {problem}", file=manifest.path, problem=fault.message))


def _attempt(wrong, act, *arguments):
    try:
        act(*arguments)
    except (ReflcolorError, UsageError) as error:
        wrong(error.message)
