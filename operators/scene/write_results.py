"""The files that only Blender writes: .blend, .usd and a rendered picture."""

import bpy

from ...reflcolor_addon.errors import OutputError
from ...reflcolor_addon.files.atomic import written_atomically
from ...reflcolor_addon.files.memory import give_back
from ...reflcolor_addon.messages import Message
from ...reflcolor_addon.scan.object_arrays import object_arrays
from ...reflcolor_addon.view.shown_surface import shown_surface
from .add_scan import add_scan_object
from .blender_errors import blender_reason, path_fault
from .colorized_object import show_colorization
from .light_object import add_light_object
from .photo_colors import keep_cameras, keep_observed, observed_cameras, use_cameras
from .photo_texture import show_texture
from .picture_only import leave_picture_only, render_in_tiles
from .provenance import record_provenance
from .render import set_up_picture
from .scan_object import COLORIZED
from .seed_list import append_seeds
from .usd import write_usd


def write_results(jobs, paths, render_path, picture, progress):
    """Write colorized scans to every path, in the format of its suffix, and render a picture of them.

    Parameters
    ----------
    jobs : iterable of ScanJob
        Each is colorized and has its report, which is kept with the scan's object.
    paths : list of Path
        Files to write: .blend or .usd.
    render_path : Path or None
        PNG file to render.
    picture : Picture
    progress : callable
        Called as ``progress(fraction, text)``.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    context = bpy.context
    pictured = render_path is not None or any(path.suffix.lower() == ".blend" for path in paths)
    objects, surfaces = [], {}
    for job in jobs:
        progress(0.0, "Building the scene")
        give_back()
        # A light mesh has its holes filled already.
        filled = pictured and picture.filled and job.light is None
        surface = shown_surface(job.scan, drop_mixed=picture.drop_mixed) if filled else None
        obj = _add_object(context, job)
        objects.append(obj)
        if surface is not None:
            surfaces[obj.name] = surface
    for obj in objects:
        obj.select_set(True)
    context.view_layer.objects.active = objects[0]
    steps = [(path, _WRITERS[path.suffix.lower()]) for path in paths]
    if pictured:
        # A view of all scans of a site together would be from far above.
        set_up_picture(context, objects[0], picture, surfaces)
        surfaces.clear()
    if render_path is not None:
        steps.append((render_path, lambda path: _render(context, objects, path)))
    for done, (path, write) in enumerate(steps):
        progress(done / len(steps), Message("Writing {name}", name=path.name))
        _write(path, write)


def _add_object(context, job):
    if job.light is not None:
        return _add_light_object(context, job)
    obj = add_scan_object(context, object_arrays(job.scan))
    append_seeds(obj, job.colorization.seeds)
    keep_observed(obj, job.seen())
    if job.matching is not None:
        keep_cameras(obj, job.matching.photos)
    use_cameras(obj, observed_cameras(obj))
    show_colorization(obj, job.colorization)
    if job.texture is not None:
        show_texture(obj, job.texture)
    record_provenance(obj, job.report)
    return obj


def _add_light_object(context, job):
    found = job.colorization
    obj = add_light_object(context, job.light, {COLORIZED: found.rgb}, found.values, job.texture, shown=COLORIZED)
    record_provenance(obj, job.report)
    return obj


def _write(path, write):
    with written_atomically(path) as temporary:
        if fault := path_fault(temporary):
            raise OutputError("{file}: cannot be written ({reason}); choose another folder", file=path, reason=fault)
        try:
            write(temporary)
        except RuntimeError as error:
            raise OutputError(
                "{file}: cannot be written ({reason}); choose another folder", file=path, reason=blender_reason(error)
            ) from error


def _render(context, objects, path):
    # Everything else is written; the scene ends with its picture.
    leave_picture_only(context, objects)
    render_in_tiles(context, path)


def _write_blend(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True, check_existing=False)


def _write_usd(path):
    write_usd(bpy.context, bpy.context.selected_objects, path)


_WRITERS = {".blend": _write_blend, ".usd": _write_usd}
