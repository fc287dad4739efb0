"""What seeds look like in an editor: marks, lines and outlines, in colors of the screen."""

import functools
import itertools

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

# Bits of a mark's style, as the shader reads them.
SELECTED, ACTIVE, FOUND, UNCOLORED, LOCKED = 1, 2, 4, 8, 16

_VERTEX = """
void main()
{
  vec4 place = vec4(corner + pos.xy * scale, 0.0, 1.0);
  gl_Position = ModelViewProjectionMatrix * (flat_image > 0.5 ? place : vec4(pos, 1.0));
  if (flat_image < 0.5) {
    // Before the surface that the seed lies on.
    gl_Position.z -= 0.0005 * gl_Position.w;
  }
  gl_PointSize = size * 2.0;
  fill = color;
  flags = int(style + 0.5);
}
"""

# A disk for a seed picked by hand, a diamond for one found in photos; a dark and a light ring set it off from any
# image. Editors encode drawn colors as sRGB, so the shader writes linear light.
_FRAGMENT = """
vec3 linear_light(vec3 srgb)
{
  return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)), step(vec3(0.04045), srgb));
}

void main()
{
  vec2 place = (gl_PointCoord * 2.0 - 1.0) * size;
  bool found = (flags & 4) != 0;
  float reach = found ? (abs(place.x) + abs(place.y)) * 0.78 : length(place);
  float radius = size * ((flags & 3) != 0 ? 0.62 : 0.5);
  float edge = reach - radius;
  vec4 shown = vec4(fill.rgb, 1.0);
  if ((flags & 8) != 0) {
    shown = vec4(0.0, 0.0, 0.0, 0.35);
    if (min(abs(place.x), abs(place.y)) < 0.8) {
      shown = vec4(1.0);
    }
  }
  if ((flags & 16) != 0 && length(place) < radius * 0.4) {
    shown = vec4(vec3(dot(fill.rgb, vec3(0.3, 0.6, 0.1)) > 0.5 ? 0.0 : 1.0), 1.0);
  }
  vec4 ring = vec4(vec3(1.0), fill.a);
  if ((flags & 1) != 0) {
    ring = vec4(1.0, 0.55, 0.05, 1.0);
  }
  if ((flags & 2) != 0) {
    ring = vec4(1.0, 0.8, 0.4, 1.0);
  }
  float width = max(size * 0.16, 1.2);
  shown = mix(shown, ring, smoothstep(-0.6, 0.6, edge + width * 0.5));
  shown = mix(shown, vec4(0.0, 0.0, 0.0, max(fill.a, 0.5)), smoothstep(-0.6, 0.6, edge - width));
  shown.a *= 1.0 - smoothstep(-0.6, 0.6, edge - width * 2.0);
  if (shown.a < 0.01) {
    discard;
  }
  seen = vec4(linear_light(shown.rgb), shown.a);
}
"""


@functools.cache
def _mark_shader():
    """The shader of the marks; made when first drawn, because background mode has none."""
    passed = gpu.types.GPUStageInterfaceInfo("reflcolor_mark")
    passed.flat("VEC4", "fill")
    passed.flat("INT", "flags")
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC3", "pos")
    info.vertex_in(1, "VEC4", "color")
    info.vertex_in(2, "FLOAT", "style")
    info.vertex_out(passed)
    info.push_constant("MAT4", "ModelViewProjectionMatrix")
    info.push_constant("VEC2", "corner")
    info.push_constant("VEC2", "scale")
    info.push_constant("FLOAT", "size")
    info.push_constant("FLOAT", "flat_image")
    info.fragment_out(0, "VEC4", "seen")
    info.vertex_source(_VERTEX)
    info.fragment_source(_FRAGMENT)
    return gpu.shader.create_from_info(info)


def forget_shaders():
    """Drop cached drawing data; called before the extension is unregistered."""
    _mark_shader.cache_clear()


def mark_batch(points, colors, opacity, styles):
    """Return a batch of marks; None where there are none.

    Parameters
    ----------
    points : (S, 2) or (S, 3) float
        Pixels of an image from its top left corner, or places in the world.
    colors : (S, 3) float of 0..1
    opacity : (S,) float of 0..1
        Of the ring.
    styles : (S,) int
        Sums of SELECTED, ACTIVE, FOUND, UNCOLORED, LOCKED.
    """
    count = len(points)
    if not count:
        return None
    places = np.zeros((count, 3), np.float32)
    places[:, : np.shape(points)[1]] = points
    content = {
        "pos": places,
        "color": np.column_stack([colors, opacity]).astype(np.float32),
        "style": np.asarray(styles, np.float32).reshape(count),
    }
    return batch_for_shader(_mark_shader(), "POINTS", content)


def draw_marks(batch, size, view=None):
    """Draw what `mark_batch` made, in the view of an image or, without one, in the world."""
    if batch is None:
        return
    shader = _mark_shader()
    gpu.state.blend_set("ALPHA")
    gpu.state.program_point_size_set(True)
    shader.bind()
    if view is not None:
        # Rows of the image run down, those of the region up.
        corner = view.to_region((0.0, 0.0))
        shader.uniform_float("corner", (corner[0], corner[1]))
        shader.uniform_float("scale", (view.scale[0], -view.scale[1]))
    shader.uniform_float("size", size)
    shader.uniform_float("flat_image", 0.0 if view is None else 1.0)
    gpu.state.depth_test_set("LESS_EQUAL" if view is None else "NONE")
    batch.draw(shader)
    gpu.state.depth_test_set("NONE")
    gpu.state.program_point_size_set(False)
    gpu.state.blend_set("NONE")


def draw_lines(starts, ends, colors):
    """Draw lines between (L, 2) places of the region in (L, 4) colors."""
    count = len(starts)
    if not count:
        return
    places = np.zeros((2 * count, 3), np.float32)
    places[0::2, :2], places[1::2, :2] = starts, ends
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    content = {"pos": places, "color": np.repeat(np.asarray(colors, np.float32), 2, axis=0)}
    gpu.state.blend_set("ALPHA")
    batch_for_shader(shader, "LINES", content).draw(shader)
    gpu.state.blend_set("NONE")


def draw_outline(outline):
    """Draw a closed outline through (x, y) places of the region: dark and light, so that it shows on any image."""
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    for shift, color in ((0, (1.0, 1.0, 1.0, 0.9)), (1, (0.0, 0.0, 0.0, 0.9))):
        places = [(x + shift, y - shift, 0.0) for x, y in (*outline, outline[0])]
        shader.bind()
        shader.uniform_float("color", color)
        batch_for_shader(shader, "LINE_STRIP", {"pos": places}).draw(shader)
    gpu.state.blend_set("NONE")


def draw_bar(x, bottom, top, width):
    """Draw an upright line in pixels of the region: light with dark edges, so that it shows on any image."""
    gpu.state.blend_set("ALPHA")
    for half, color in ((width / 2 + 1, (0.0, 0.0, 0.0, 0.6)), (width / 2, (1.0, 1.0, 1.0, 0.95))):
        _draw_strip([(x - half, bottom), (x + half, bottom), (x - half, top), (x + half, top)], color)
    gpu.state.blend_set("NONE")


def draw_handle(x, y, radius, *, bright):
    """Draw a disk with arrows to the left and to the right, in pixels of the region."""
    angles = np.linspace(0, 2 * np.pi, 33)
    gpu.state.blend_set("ALPHA")
    for size, color in (
        (radius + 1.5, (0.0, 0.0, 0.0, 0.6)),
        (radius, (1.0,) * 4 if bright else (0.9, 0.9, 0.9, 0.95)),
    ):
        rim = np.stack([x + size * np.cos(angles), y + size * np.sin(angles)], axis=-1)
        fan = [corner for one, two in itertools.pairwise(rim) for corner in ((x, y), one, two)]
        _draw_strip(fan, color, kind="TRIS")
    for side in (-1, 1):
        tip, foot, half = x + side * radius * 0.75, x + side * radius * 0.25, radius * 0.35
        _draw_strip([(tip, y), (foot, y + half), (foot, y - half)], (0.15, 0.15, 0.15, 1.0), kind="TRIS")
    gpu.state.blend_set("NONE")


def _draw_strip(corners, color, kind="TRI_STRIP"):
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("color", color)
    places = [(float(px), float(py), 0.0) for px, py in corners]
    batch_for_shader(shader, kind, {"pos": places}).draw(shader)
