"""Before and after in the Image Editor: one image of a scan is laid over another, up to a line that can be moved."""

import functools

import bpy
import gpu
from bpy.props import BoolProperty, FloatProperty
from gpu_extras.batch import batch_for_shader

from ..scene.editor_images import side_in
from ..scene.editors import redraw_editors

_handles = []

_VERTEX = """
void main()
{
  place = pos;
  gl_Position = ModelViewProjectionMatrix * vec4(pos, 0.0, 1.0);
}
"""

# Texels are fetched, not filtered: the overlay is as crisp as the image under it. They are linear light, and the editor
# encodes them as it does the image under it.
_FRAGMENT = """
void main()
{
  ivec2 size = textureSize(laid, 0);
  vec3 color = texelFetch(laid, clamp(ivec2(place * vec2(size)), ivec2(0), size - 1), 0).rgb;
  seen = vec4(color, 1.0);
}
"""


class ReflcolorWipe(bpy.types.PropertyGroup):
    """Before and after in the Image Editors; of the window, so that it is neither saved nor undone"""

    show: BoolProperty(
        name="Before and After",
        description="Lay the colors over the scan's image, right of a line that can be dragged",
        options={"SKIP_SAVE"},
        update=lambda _self, _context: redraw_editors({"IMAGE_EDITOR"}),
    )
    position: FloatProperty(
        name="Line",
        description="Where the line is, from the left to the right edge of the image",
        subtype="FACTOR",
        default=0.5,
        min=0,
        max=1,
        options={"SKIP_SAVE"},
        update=lambda _self, _context: redraw_editors({"IMAGE_EDITOR"}),
    )


def overlay_image(obj):
    """Return the image of a scan's colors that is laid over its other images; None where there is none."""
    return obj.reflcolor.preview_image or obj.reflcolor.colorized_image


def overlay(obj, shown, wipe):
    """Return what is laid over an image of a scan, and over which part of it.

    Parameters
    ----------
    obj : bpy.types.Object
    shown : bpy.types.Image
        One of the scan's own images.
    wipe : ReflcolorWipe

    Returns
    -------
    (image, left, right) or None
        The part is from left to right, 0 to 1 of the image's width. A preview lies over all of it while there is no
        line; over the colors themselves, the reflectance is laid left of the line.
    """
    laid = overlay_image(obj)
    if laid is None:
        return None
    if not wipe.show:
        return (laid, 0.0, 1.0) if laid == obj.reflcolor.preview_image != shown else None
    if laid != shown:
        return laid, wipe.position, 1.0
    before = obj.reflcolor.reflectance_image
    return None if before is None else (before, 0.0, wipe.position)


def scan_side(context):
    """Return the EditorImage that the Image Editor of the context shows, if that is a scan's own image; else None."""
    side = side_in(context.area, context.region, context)
    return side if side is not None and side.is_scan else None


def register():
    """Start drawing."""
    if not bpy.app.background:
        _handles.append(bpy.types.SpaceImageEditor.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW"))


def unregister():
    """Stop drawing."""
    while _handles:
        bpy.types.SpaceImageEditor.draw_handler_remove(_handles.pop(), "WINDOW")
    _shader.cache_clear()


@functools.cache
def _shader():
    """Made when first drawn, because background mode has none."""
    passed = gpu.types.GPUStageInterfaceInfo("reflcolor_wipe")
    passed.smooth("VEC2", "place")
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC2", "pos")
    info.vertex_out(passed)
    info.push_constant("MAT4", "ModelViewProjectionMatrix")
    info.sampler(0, "FLOAT_2D", "laid")
    info.fragment_out(0, "VEC4", "seen")
    info.vertex_source(_VERTEX)
    info.fragment_source(_FRAGMENT)
    return gpu.shader.create_from_info(info)


def _draw():
    """Draw the overlay; in POST_VIEW the image reaches from 0 to 1 both ways."""
    context = bpy.context
    side = scan_side(context)
    laid = overlay(side.obj, side.image, context.window_manager.reflcolor_wipe) if side is not None else None
    if laid is None:
        return
    image, left, right = laid
    if right <= left or not min(image.size):
        return
    shader = _shader()
    corners = [(left, 0.0), (right, 0.0), (left, 1.0), (right, 1.0)]
    shader.bind()
    shader.uniform_sampler("laid", gpu.texture.from_image(image))
    batch_for_shader(shader, "TRI_STRIP", {"pos": corners}).draw(shader)


classes = (ReflcolorWipe,)
pointers = ((bpy.types.WindowManager, "reflcolor_wipe", ReflcolorWipe),)
