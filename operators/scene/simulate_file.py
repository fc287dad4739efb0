"""The virtual scanner over a scene in a .blend, for the command line."""

import bpy

from ...reflcolor_addon.batch.paths import tracked
from ...reflcolor_addon.errors import ReflcolorError, UsageError
from .blender_errors import blender_reason
from .simulation import Simulation, leveled_pose, photo_cameras, simulation_steps


def simulate_file(request, progress, written):
    """Open a .blend and scan its scene.

    Parameters
    ----------
    request : SimulationRequest
    progress : callable
        Called as ``progress(fraction, text)``.
    written : list of Path
        Every file that was written is added.

    Raises
    ------
    ReflcolorError
        If the file is no scene, the scene has no camera to stand at, or a file cannot be written.
    UsageError
        If the station that was named is not there, there is no camera to take photos from, or two files would have the
        same name.
    """
    progress(0.0, f"Opening {request.scene.name}")
    try:
        # Scripts in the file must not run.
        bpy.ops.wm.open_mainfile(filepath=str(request.scene), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        reason = blender_reason(error)
        raise ReflcolorError(
            "{file}: Blender could not open it: {reason}", file=request.scene, reason=reason
        ) from error
    scene = bpy.context.scene
    bpy.context.view_layer.update()
    station, item = _station(scene, request)
    cameras = photo_cameras(scene, item) if request.photos else ()
    if request.photos and not cameras:
        raise UsageError(
            f"--photos: the scene {scene.name} of {request.scene} has no other camera to take photos from; "
            "add one, or leave out --photos"
        )
    simulation = Simulation(
        path=request.output,
        pose=leveled_pose(scene, station, item),
        model=request.model,
        truth=request.truth,
        cameras=cameras,
        samples=request.photo_samples,
        own_look=request.own_look,
    )
    with tracked(simulation.files(), written):
        for fraction, text in simulation_steps(scene, simulation):
            progress(fraction, text)


def _station(scene, request):
    """What `leveled_pose` wants to know: the kind of station, and the object that is it."""
    if request.item is None and request.camera is None:
        return "CAMERA", scene.camera
    name = request.item if request.camera is None else request.camera
    item = scene.objects.get(name)
    kind = "object" if request.camera is None else "camera"
    if item is None or (kind == "camera" and item.type != "CAMERA"):
        there = sorted(other.name for other in scene.objects if kind == "object" or other.type == "CAMERA")
        raise UsageError(
            f"--{kind} {name}: {request.scene}: there is no {kind} {name} in the scene {scene.name}; {_listed(there)}"
        )
    return ("ACTIVE" if kind == "object" else "CAMERA"), item


def _listed(names, most=8):
    if not names:
        return "it has none"
    return "found " + ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")
