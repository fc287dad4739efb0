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

from ...reflcolor_addon import settings
from .editors import redraw_editors, select_only
from .notices import ReflcolorNotice


def _color_was_given(seed, _context):
    seed.has_color = True
    redraw_editors()


def _seed_was_chosen(state, _context):
    """What is chosen in the list is what is selected in the images."""
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
        items=(
            ("hand", "Hand", "Picked by a person"),
            ("pose", "Camera", "Where a photo's verified camera saw the pixel"),
            ("homography", "Homography", "Where a verified photo shows the pixel"),
            ("appearance", "Appearance", "By likeness with what a photo shows"),
        ),
    )
    confidence: FloatProperty(
        name="Confidence", description="How sure the color is", subtype="FACTOR", default=1, min=0, max=1
    )


class ReflcolorPhoto(bpy.types.PropertyGroup):
    """A photo that colors are taken from"""

    image: PointerProperty(name="Image", description="The photo's picture", type=bpy.types.Image)
    note: StringProperty(name="Note", description="What became of the photo when it was matched")
    verified: BoolProperty(name="Verified", description="Whether its camera was found and stood the test")


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
    matches_image: PointerProperty(
        name="Matches", description="Where each seed's color comes from", type=bpy.types.Image
    )
    notices: CollectionProperty(name="Messages", description="What the last operation had to say", type=ReflcolorNotice)
    active_notice: IntProperty(name="Active Message", description="Message that is selected in the list")
    truth_image: PointerProperty(
        name="True Colors",
        description="Image with one pixel per pixel of the scan, to compare the colors with; "
        "if empty, the colors that came with the scan",
        type=bpy.types.Image,
    )


_PAPER = settings.Settings()
_COLOR_SPACE_ITEMS = (
    ("ycbcr", "YCbCr", "Luminance and two color differences, ITU-R BT.601; the paper's choice"),
    ("yuv", "YUV", "Luminance and two color differences, as in analog television"),
    ("lalphabeta", "L-Alpha-Beta", "Logarithms of cone responses, decorrelated over natural images"),
    ("cielab", "CIELAB", "Perceptual lightness and two opponent colors"),
)
_NEIGHBOR_ITEMS = (
    ("4", "4", "Paths step to the pixels above, below, left and right"),
    ("8", "8", "Paths step diagonally too"),
)
_BLEND_ITEMS = (
    ("auto", "Automatic", "All seeds where that takes about two seconds, else as many as it takes to be close to that"),
    ("all", "All Seeds", "Every seed colors every pixel, as the paper has it"),
    ("nearest", "Nearest", "Only a pixel's nearest seeds color it; quick with very many seeds"),
)


class ColorizeSettings:
    """The settings of a colorization, as properties of whatever holds them."""

    alpha: FloatProperty(
        name="Alpha",
        description="How fast a seed's influence falls with the geodesic distance; higher makes borders sharper",
        default=_PAPER.alpha,
        min=settings.ALPHA_RANGE[0],
        max=settings.ALPHA_RANGE[1],
        soft_max=12,
    )
    beta: FloatProperty(
        name="Beta",
        description="How strongly steps in range hold colors back; 0 looks at the reflectance alone (Yatziv)",
        default=_PAPER.beta,
        min=settings.BETA_RANGE[0],
        max=settings.BETA_RANGE[1],
        soft_max=10,
    )
    color_space: EnumProperty(
        name="Color Space",
        description="Where the two chrominance channels are blended",
        items=_COLOR_SPACE_ITEMS,
        default=_PAPER.color_space,
    )
    neighbors: EnumProperty(
        name="Neighbors",
        description="Which pixels a path may step to",
        items=_NEIGHBOR_ITEMS,
        default=str(_PAPER.neighbors),
    )
    blend: EnumProperty(
        name="Blend",
        description="Which seeds color a pixel",
        items=_BLEND_ITEMS,
        default="auto",
    )
    nearest: IntProperty(
        name="Nearest Seeds",
        description="How many of its nearest seeds color a pixel, if Blend is Nearest",
        default=8,
        min=1,
        max=settings.MAX_NEAREST,
        soft_max=64,
    )
    smoothing: FloatProperty(
        name="Smoothing",
        description="Pixels by which the reflectance is smoothed before distances are measured on it; not in the paper",
        default=_PAPER.smoothing,
        min=0,
        max=settings.MAX_SMOOTHING,
        soft_max=4,
    )
    kriging: FloatProperty(
        name="Kriging",
        description="Share of a statistical estimate from position, surface and reflectance; not in the paper",
        subtype="FACTOR",
        default=_PAPER.kriging,
        min=0,
        max=1,
    )
    tone: FloatProperty(
        name="Tone",
        description="Above 1 the colors are lighter, below 1 darker; 1 is as light as the reflectance",
        default=_PAPER.tone,
        min=settings.TONE_RANGE[0],
        max=settings.TONE_RANGE[1],
        step=10,
    )


class MatchSettings:
    """The settings of the search for seeds in photos, as properties of whatever holds them."""

    matching: EnumProperty(
        name="Matching",
        description="How seeds are found in photos",
        items=(
            ("verified", "Verified", "By each photo's camera, accepted only if it stands a test; else by appearance"),
            ("paper", "Paper", "By the most similar superpixels, as published; often wrong on real scans"),
        ),
        default=_PAPER.matching,
    )
    slic_segments: IntProperty(
        name="Superpixels",
        description="Superpixels that the scan, and each photo, is divided into; there is one seed in each at most",
        default=_PAPER.slic_segments,
        min=1,
        max=20_000,
        soft_max=2000,
    )
    slic_compactness: FloatProperty(
        name="Compactness",
        description="How square superpixels are; less lets them follow edges",
        default=_PAPER.slic_compactness,
        min=0.001,
        max=100,
        precision=3,
    )
    slic_sigma: FloatProperty(
        name="Sigma",
        description="Pixels by which the image is smoothed before it is divided",
        default=_PAPER.slic_sigma,
        min=0,
        max=20,
    )
    hog_cell: IntProperty(
        name="Cell", description="Pixels of a cell of the descriptor", default=_PAPER.hog_cell, min=2, max=64
    )
    hog_block: IntProperty(
        name="Block", description="Cells of a block of the descriptor", default=_PAPER.hog_block, min=1, max=8
    )
    hog_orientations: IntProperty(
        name="Orientations",
        description="Directions that the descriptor tells apart",
        default=_PAPER.hog_orientations,
        min=2,
        max=36,
    )
    hog_window: IntProperty(
        name="Window",
        description="Pixels of the descriptor's window around a superpixel's center",
        default=_PAPER.hog_window,
        min=2,
        max=256,
    )


COLORIZE_NAMES = tuple(ColorizeSettings.__annotations__)
MATCH_NAMES = tuple(MatchSettings.__annotations__)


def _color_was_picked(settings, _context):
    settings.picked = True
    settings.picked_photo = None


class ReflcolorSettings(ColorizeSettings, MatchSettings, bpy.types.PropertyGroup):
    """Settings of the next colorization in this scene"""

    photos: CollectionProperty(name="Photos", description="Photos that colors are taken from", type=ReflcolorPhoto)
    picked: BoolProperty(name="Picked", description="The next seed is given the picked color")
    picked_color: FloatVectorProperty(
        name="Picked Color",
        description="Color that the next seeds are given; pick it in a photo",
        subtype="COLOR_GAMMA",
        min=0,
        max=1,
        size=3,
        default=(0.5, 0.5, 0.5),
        update=_color_was_picked,
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
    active_photo: IntProperty(name="Active Photo", description="Photo that is selected in the list")


def core_settings(holder, fallback, names):
    """Return the core's Settings from properties; what is not set on the operator is taken from ``fallback``."""
    return _settings(
        {name: getattr(holder if holder.properties.is_property_set(name) else fallback, name) for name in names}
    )


def scene_settings(scene, names):
    """Return the core's Settings from the properties of a scene."""
    return _settings({name: getattr(scene.reflcolor, name) for name in names})


def _settings(chosen):
    if "blend" in chosen:
        chosen["nearest"] = {"auto": "auto", "all": None, "nearest": chosen["nearest"]}[chosen.pop("blend")]
        chosen["neighbors"] = int(chosen["neighbors"])
    return settings.Settings(**chosen)


def take_over(holder, chosen):
    """Set properties to the core's Settings; the paper's exact blending becomes Automatic, which is it where quick."""
    for name, value in chosen.as_dict().items():
        if name == "nearest":
            holder.blend = "nearest" if isinstance(value, int) else "auto"
            holder.nearest = value if isinstance(value, int) else holder.nearest
        elif name in COLORIZE_NAMES:
            setattr(holder, name, str(value) if name == "neighbors" else value)


classes = (ReflcolorSeed, ReflcolorPhoto, ReflcolorNotice, ReflcolorScan, ReflcolorSettings)
