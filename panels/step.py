"""What all panels have in common: the tab they are in, and the editors whose sidebar they are shown in."""

import bpy

from ..operators.scene import polls
from ..operators.scene.texts import label
from ..operators.window import jobs


class Step:
    """One step from a scan to its colors; a subclass gives ``draw_step(context, layout, obj)``."""

    bl_region_type = "UI"
    bl_category = "Reflectance"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.draw_step(context, layout, polls.scan_object(context))


def draw_act(layout, operator, name, **button):
    """Draw the button of long work or, while it runs, how far it is: in the same place, and as high.

    ``name`` is what the work is called. Returns the operator's properties, or None while the work runs.
    """
    if not is_running(name):
        return layout.operator(operator, **button)
    job = jobs.running()
    done = label("{percent:.0%} (ESC cancels)", percent=job.fraction)
    layout.progress(factor=job.fraction, text=label("Cancelling") if job.stopping else done, translate=False)
    return None


def is_running(name):
    """Whether long work of that name goes on."""
    job = jobs.running()
    return job is not None and job.name == name


def draw_selected(context, layout):
    """Say how many scans an act is for, where it is for several."""
    count = len(polls.scan_objects(context))
    if count > 1:
        layout.label(text=label("{count} scans selected", count=count), icon="MESH_GRID", translate=False)


def in_view(step):
    """Return the step as a panel of the 3D View."""
    return _panel(step, "VIEW_3D", "")


def in_images(step):
    """Return the step as a panel of the Image Editor."""
    return _panel(step, "IMAGE_EDITOR", "_image")


def in_both_editors(step):
    """Return the step as panels of the 3D View and of the Image Editor."""
    return _panel(step, "VIEW_3D", ""), _panel(step, "IMAGE_EDITOR", "_image")


def _panel(step, space, suffix):
    members = {"bl_space_type": space, "__doc__": step.__doc__, "__module__": step.__module__}
    if parent := getattr(step, "bl_parent_id", None):
        members["bl_parent_id"] = parent + suffix
    return type(f"REFLCOLOR_PT_{step.__name__.lower()}{suffix}", (step, bpy.types.Panel), members)
