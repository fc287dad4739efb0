"""What the extension stores in a .blend: seeds on the scan's object, settings on the scene."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ...reflcolor_addon.seeds.sources import SOURCES
from ...reflcolor_addon.view.picture import LOOKS, Picture
from . import polls
from .editors import redraw_editors, select_only
from .notices import ReflcolorNotice
from .quiet import write_quietly
from .render import follow_picture
from .seed_colors import give_waiting
from .setting_properties import ColorizeSettings, MatchSettings


def _color_was_given(seed, _context):
    seed.has_color = True
    redraw_editors()


def _seed_was_chosen(state, _context):
    """Keep the list's active seed and the selection in the images the same."""
    select_only(state.seeds, [state.active_seed])
    redraw_editors()


class ReflcolorSeed(bpy.types.PropertyGroup):
    """A pixel of the scan whose color is known"""

    row: IntProperty(name="Row", description="Row of the scan's grid, 0 at the top", min=0)
    col: IntProperty(name="Column", description="Column of the scan's grid, 0 at the left", min=0)
    color: FloatVectorProperty(
        name="Color",
        description="Color of the scan at this pixel",
        subtype="COLOR_GAMMA",
        min=0,
        max=1,
        size=3,
        update=_color_was_given,
    )
    has_color: BoolProperty(
        name="Has a Color", description="A seed whose color was not picked yet colors nothing", default=True
    )
    select: BoolProperty(name="Selected", description="Whether the seed is selected in the Image Editors")
    locked: BoolProperty(name="Locked", description="Keep the seed when the photos are matched again")
    photo: PointerProperty(name="Photo", description="Photo that the color was taken from", type=bpy.types.Image)
    photo_xy: FloatVectorProperty(
        name="Point", description="Place in the photo, in pixels from its top left corner", size=2
    )
    reason: EnumProperty(
        name="Found By",
        description="How the seed came by its color",
        items=tuple((source.name, source.label, source.help) for source in SOURCES.values()),
    )
    confidence: FloatProperty(
        name="Confidence", description="How sure the color is", subtype="FACTOR", default=1, min=0, max=1
    )


class ReflcolorPhoto(bpy.types.PropertyGroup):
    """A photo that colors are taken from"""

    image: PointerProperty(name="Image", description="The photo's picture", type=bpy.types.Image)


class ReflcolorVerdict(bpy.types.PropertyGroup):
    """Whether a photo shows the scan, as it was found when they were matched last"""

    image: PointerProperty(name="Image", description="The photo's picture", type=bpy.types.Image)
    verified: BoolProperty(name="Verified", description="Whether the photo's camera was found and confirmed")
    note: StringProperty(name="Note", description="What was found")


class ReflcolorScan(bpy.types.PropertyGroup):
    """What an object knows of the scan that it was made from"""

    rows: IntProperty(name="Rows", description="Height of the scan's grid in pixels")
    cols: IntProperty(name="Columns", description="Width of the scan's grid in pixels")
    source: StringProperty(name="Source", description="File that the scan was read from")
    seeds: CollectionProperty(
        name="Seeds",
        description="Pixels whose color is known",
        type=ReflcolorSeed,
        override={"LIBRARY_OVERRIDABLE", "USE_INSERTION"},
    )
    active_seed: IntProperty(
        name="Active Seed",
        description="Seed that is selected in the list",
        update=_seed_was_chosen,
        override={"LIBRARY_OVERRIDABLE"},
    )
    reflectance_image: PointerProperty(
        name="Reflectance Image", description="The scan's reflectance as a picture", type=bpy.types.Image
    )
    range_image: PointerProperty(name="Range Image", description="The scan's range as a picture", type=bpy.types.Image)
    colorized_image: PointerProperty(
        name="Colorized Image", description="The colors that were spread from the seeds", type=bpy.types.Image
    )
    preview_image: PointerProperty(
        name="Live Preview", description="Colors that follow the seeds until they are kept", type=bpy.types.Image
    )
    texture_image: PointerProperty(
        name="Texture Image",
        description="The colors with the detail of the photos",
        type=bpy.types.Image,
    )
    matches_image: PointerProperty(
        name="Matches", description="Where each seed's color comes from", type=bpy.types.Image
    )
    verdicts: CollectionProperty(
        name="Verdicts", description="What was found of each photo on this scan", type=ReflcolorVerdict
    )
    notices: CollectionProperty(
        name="Messages", description="Results and warnings of the last operation", type=ReflcolorNotice
    )
    active_notice: IntProperty(name="Active Message", description="Message that is selected in the list")
    truth_image: PointerProperty(
        name="True Colors",
        description="Image with one pixel per pixel of the scan, to compare the colors with; "
        "if empty, the colors that came with the scan",
        type=bpy.types.Image,
    )


def _color_was_picked(settings, context):
    """The next seeds have this color, and the selected ones that wait for theirs are given it."""
    settings.picked = True
    settings.picked_photo = None
    obj = polls.scan_object(context)
    if obj is not None:
        give_waiting(obj.reflcolor.seeds, settings.picked_color, settings.last_picked_color)
    write_quietly(settings, last_picked_color=tuple(settings.picked_color))
    redraw_editors()


def _picture_was_changed(settings, _context):
    follow_picture(settings.id_data, scene_picture(settings.id_data))


def scene_picture(scene):
    """Return the Picture that the settings of a scene say."""
    chosen = scene.reflcolor
    return Picture(look=chosen.picture_look, filled=chosen.picture_filled, drop_mixed=chosen.picture_drop_mixed)


class ReflcolorSettings(ColorizeSettings, MatchSettings, bpy.types.PropertyGroup):
    """Settings of the next colorization in this scene"""

    photos: CollectionProperty(name="Photos", description="Photos that colors are taken from", type=ReflcolorPhoto)
    picked: BoolProperty(name="Picked", description="The next seed is given the picked color")
    picked_color: FloatVectorProperty(
        name="Picked Color",
        description="Color of the next seeds, and of selected ones without a color; choose it, or pick it in a photo",
        subtype="COLOR_GAMMA",
        min=0,
        max=1,
        size=3,
        default=(0.5, 0.5, 0.5),
        update=_color_was_picked,
    )
    last_picked_color: FloatVectorProperty(
        name="Last Picked Color",
        description="What the picked color was before; seeds that it was given to follow while it is chosen",
        size=3,
        options={"HIDDEN"},
    )
    picked_photo: PointerProperty(
        name="Picked In", description="Photo that the picked color is from", type=bpy.types.Image
    )
    picked_xy: FloatVectorProperty(
        name="Picked At", description="Place in that photo, in pixels from its top left corner", size=2
    )
    stroke_spacing: IntProperty(
        name="Spacing",
        description="Pixels of the scan from one seed to the next when a stroke is drawn",
        subtype="PIXEL",
        default=16,
        min=1,
        soft_max=100,
    )
    show_matches: BoolProperty(
        name="Match Lines",
        description="Join every seed in the reflectance image with its point in the photo beside it; "
        "else only selected ones",
        update=lambda _settings, _context: redraw_editors(),
    )
    picture_look: EnumProperty(
        name="Look",
        description="How pictures of the scans look",
        items=tuple((look, look.title(), description) for look, description in LOOKS.items()),
        update=_picture_was_changed,
    )
    picture_filled: BoolProperty(
        name="Fill Holes",
        description="Fill small holes and smooth outlines in pictures; the scan's mesh stays as it was measured",
        default=Picture().filled,
        update=_picture_was_changed,
    )
    picture_drop_mixed: BoolProperty(
        name="Drop Mixed Returns",
        description="Leave out of pictures where the beam met two surfaces, and measured between them",
        default=Picture().drop_mixed,
        update=_picture_was_changed,
    )
    active_photo: IntProperty(name="Active Photo", description="Photo that is selected in the list")


classes = (ReflcolorSeed, ReflcolorPhoto, ReflcolorVerdict, ReflcolorNotice, ReflcolorScan, ReflcolorSettings)
pointers = ((bpy.types.Object, "reflcolor", ReflcolorScan), (bpy.types.Scene, "reflcolor", ReflcolorSettings))
