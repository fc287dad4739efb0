"""What the extension stores in a .blend: seeds on the scan's object, settings on the scene."""

import bpy
from bpy.props import (
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..reflcolor_addon import settings


class ReflcolorSeed(bpy.types.PropertyGroup):
    """A pixel of the scan whose color is known"""

    row: IntProperty(name="Row", description="Row of the scan's grid, 0 at the top", min=0)
    col: IntProperty(name="Column", description="Column of the scan's grid, 0 at the left", min=0)
    color: FloatVectorProperty(
        name="Color", description="Color of the scan at this pixel", subtype="COLOR_GAMMA", min=0, max=1, size=3
    )
    photo: PointerProperty(name="Photo", description="Photo that the color was taken from", type=bpy.types.Image)
    photo_xy: FloatVectorProperty(
        name="Point", description="Place in the photo, in pixels from its top left corner", size=2
    )


class ReflcolorScan(bpy.types.PropertyGroup):
    """What an object knows of the scan that it was made from"""

    rows: IntProperty(name="Rows", description="Height of the scan's grid in pixels")
    cols: IntProperty(name="Columns", description="Width of the scan's grid in pixels")
    source: StringProperty(name="Source", description="File that the scan was read from")
    seeds: CollectionProperty(name="Seeds", type=ReflcolorSeed)
    active_seed: IntProperty(name="Active Seed", description="Seed that is selected in the list")
    reflectance_image: PointerProperty(name="Reflectance Image", type=bpy.types.Image)
    range_image: PointerProperty(name="Range Image", type=bpy.types.Image)
    colorized_image: PointerProperty(name="Colorized Image", type=bpy.types.Image)


_PAPER = settings.Settings()
_COLOR_SPACE_ITEMS = (
    ("ycbcr", "YCbCr", "Luminance and two color differences, ITU-R BT.601; the paper's choice"),
    ("yuv", "YUV", "Luminance and two color differences, as in analog television"),
    ("lalphabeta", "l-alpha-beta", "Logarithms of cone responses, decorrelated over natural images"),
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


SETTING_NAMES = tuple(ColorizeSettings.__annotations__)


class ReflcolorSettings(ColorizeSettings, bpy.types.PropertyGroup):
    """Settings of the next colorization in this scene"""

    photo: PointerProperty(
        name="Photo", description="Photo that colors are taken from; any camera, any place", type=bpy.types.Image
    )


def core_settings(holder, fallback=None):
    """Return the core's Settings from properties; what is not set on ``holder`` is taken from ``fallback``."""
    chosen = {}
    for name in SETTING_NAMES:
        source = holder if fallback is None or holder.properties.is_property_set(name) else fallback
        chosen[name] = getattr(source, name)
    nearest = {"auto": "auto", "all": None, "nearest": chosen["nearest"]}[chosen.pop("blend")]
    return settings.Settings(**chosen | {"neighbors": int(chosen["neighbors"]), "nearest": nearest})


classes = (ReflcolorSeed, ReflcolorScan, ReflcolorSettings)
