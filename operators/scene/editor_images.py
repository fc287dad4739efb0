"""What an Image Editor shows: a scan, in which seeds lie, or a photo, from which their colors are."""

from dataclasses import dataclass

import bpy
import numpy as np

from ...reflcolor_addon.view.picking import ImageView, centers, clamped_pixel, nearest_within
from . import polls
from .seed_arrays import seed_arrays

# How many image sizes beyond its edges a view is measured over: an editor gives places in whole pixels only.
_MARGIN = 10
_SCAN_IMAGES = ("reflectance_image", "range_image", "colorized_image", "preview_image")
# Pixels of the screen, at a scale of 1, within which a click hits a seed.
HIT_RADIUS = 10


@dataclass(frozen=True)
class EditorImage:
    """One image of a pair, as an editor shows it.

    Parameters
    ----------
    is_scan : bool
        Whether it is a scan's own image; else a photo.
    obj : bpy.types.Object
        The scan whose seeds are meant.
    image : bpy.types.Image
    view : ImageView
    """

    is_scan: bool
    obj: bpy.types.Object
    image: bpy.types.Image
    view: ImageView

    def activate(self, context):
        """Make the scan the active object. If it is already, nothing is set: Blender would draw the mesh again."""
        if context.view_layer.objects.active != self.obj:
            context.view_layer.objects.active = self.obj

    def marks(self, seeds=None):
        """Return (S, 2) places of the object's seeds in the image, in its pixels from the top left, and where they are.

        The second array, (S,) bool, is False where a seed has no place in this image. ``seeds`` are the object's
        SeedArrays, if they were read already.
        """
        seeds = seeds or seed_arrays(self.obj)
        if self.is_scan:
            return centers(seeds.rows, seeds.cols), np.ones(len(seeds.rows), bool)
        return seeds.photo_xy, seeds.photo_names == self.image.name

    def hit(self, place):
        """Return the index of the seed at a place of the region; None if there is none."""
        points, here = self.marks()
        indices = np.flatnonzero(here)
        radius = HIT_RADIUS * bpy.context.preferences.system.ui_scale
        found = nearest_within(self.view.to_region(points[indices]), place, radius)
        return None if found is None else int(indices[found])

    def pixel(self, place):
        """Return the (row, column) of the image at, or nearest to, a place of the region."""
        width, height = self.image.size
        return clamped_pixel(self.view.to_image(place), (height, width))


def side_in(area, region, context):
    """Return the EditorImage that an Image Editor's region shows; None if it shows neither a scan nor a photo."""
    image = area.spaces.active.image if area.type == "IMAGE_EDITOR" else None
    if image is None or not min(image.size):
        return None
    owner = scan_of_image(image, context)
    obj = owner or polls.scan_object(context)
    if obj is None:
        return None
    return EditorImage(owner is not None, obj, image, _view(region, image))


def scan_of_image(image, context):
    """Return the object of the scan that an image belongs to, the active one first; None for any other image."""
    active = polls.scan_object(context)
    for obj in filter(None, (active, *context.scene.objects)):
        if obj.reflcolor.rows and any(getattr(obj.reflcolor, name) == image for name in _SCAN_IMAGES):
            return obj
    return None


def show_image(context, image):
    """Show an image in an Image Editor of the window; return whether there was one.

    A photo takes no editor from a scan while there is another, nor a scan's own image one from a photo.
    """
    if context.window is None:
        return False
    is_scan = scan_of_image(image, context) is not None

    def suits(area):
        shown = area.spaces.active.image
        alike = shown is not None and (scan_of_image(shown, context) is not None) == is_scan
        return shown == image, alike, shown is None, area == context.area

    editors = [area for area in context.window.screen.areas if area.type == "IMAGE_EDITOR"]
    if editors:
        max(editors, key=suits).spaces.active.image = image
    return bool(editors)


def event_side(context):
    """Return the EditorImage under the pointer; None if it is over another region than an Image Editor's image."""
    if context.area is None or context.region is None or context.region.type != "WINDOW":
        return None
    return side_in(context.area, context.region, context)


def _view(region, image):
    to_region = region.view2d.view_to_region
    first = to_region(-_MARGIN, -_MARGIN, clip=False)
    second = to_region(1 + _MARGIN, 1 + _MARGIN, clip=False)
    return ImageView.through(image.size, first, second, _MARGIN)


def center_images(context, obj, row, col):
    """Move the view of every Image Editor that shows an image of the scan so that a pixel is in its middle."""
    if context.window is None:
        return
    for area in context.window.screen.areas:
        region = next((region for region in area.regions if region.type == "WINDOW"), None)
        if area.type != "IMAGE_EDITOR" or region is None:
            continue
        side = side_in(area, region, context)
        if side is None or not side.is_scan or side.obj != obj:
            continue
        x, y = side.view.to_region((col + 0.5, row + 0.5))
        # A border as large as the region moves the view but keeps its zoom.
        left, bottom = round(x - region.width / 2), round(y - region.height / 2)
        border = {"xmin": left, "xmax": left + region.width, "ymin": bottom, "ymax": bottom + region.height}
        with context.temp_override(area=area, region=region):
            bpy.ops.image.view_zoom_border(**border)
