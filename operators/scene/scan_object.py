"""A scan as an object of Blender, and back."""

from dataclasses import replace

import bpy
import numpy as np

from ...reflcolor_addon.errors import ScanError
from ...reflcolor_addon.scan.georeference import rigid_pose
from ...reflcolor_addon.scan.object_arrays import on_grid
from ...reflcolor_addon.scan.scan import Scan
from .nodes import show_image_again, show_in_material

GRAY = "Reflectance_Gray"
COLORIZED = "Colorized"
SCANNED = "Scanned_Color"
UV_MAP = "Scan_Grid"
# The material shows one of these.
SHOWN_IN_RENDERS = (GRAY, COLORIZED, SCANNED)
CONFIDENCE = "confidence"
NEAREST_SEED = "nearest_seed"
OBSERVED = "observed"
PHOTO = "photo"
ERROR = "error"
SHIFT = "reflcolor_shift"
# Custom properties of meshes: the origin of their coordinates, meters in the scanner's frame; degrees, as in
# `grid_mesh`.
CENTER, MAX_INCIDENCE = "reflcolor_center", "reflcolor_max_incidence"
# Custom property of meshes: how many vertices the scan has.
RETURNS = "reflcolor_returns"
# Custom property of light meshes: how many returns the scan has that one was made of.
LIGHT = "reflcolor_light"
# The same: which of its colors the image has that is shown instead of them.
IMAGE_OF = "reflcolor_image_of"
# Custom property of objects whose colors are all guesses, not seen by any verified photo.
GUESSED = "reflcolor_guessed"
KINDS = {np.float32: "FLOAT", np.int32: "INT"}


def scan_of(obj, *, colors=None):
    """Return the Scan that an object was made from, read back from its mesh; raises as `scan_reader`.

    ``colors`` names the color attribute that it has its colors from.
    """
    scan = scan_reader(obj)()
    if colors is None:
        return scan
    return replace(scan, color=on_grid(colors_of(obj, colors), grid_indices(obj), scan.shape))


def scan_reader(obj):
    """Return a function that makes the Scan that an object was made from; it touches no bpy, a thread may call it.

    The scan's pose is where the object is now, without its scale and without the kilometers of `SHIFT`.

    Raises
    ------
    ScanError
        If the mesh has lost the attributes that tie its vertices to the scan's grid.
    """
    mesh, name, shape = obj.data, obj.name, (obj.reflcolor.rows, obj.reflcolor.cols)
    place = grid_indices(obj)
    measured = values_of(obj, "reflectance", np.float32)
    coordinates = coordinates_of(mesh)
    meters = bpy.context.scene.unit_settings.scale_length
    center = np.array(mesh.get(CENTER, (0, 0, 0)))
    pose = rigid_pose(obj.matrix_world, meters, center)

    def read():
        points = on_grid(coordinates.astype(np.float64) * meters + center, place, shape)
        valid = on_grid(np.ones(len(measured), bool), place, shape)
        return Scan(name=name, points=points, reflectance=on_grid(measured, place, shape), valid=valid, pose=pose)

    return read


def grid_indices(obj):
    """Return (N,) rows and (N,) columns of the scan's grid, one of each per vertex.

    Raises
    ------
    ScanError
        If the attributes are gone or point outside the grid, if the mesh is a light one, or if vertices of another
        mesh were joined to it.
    """
    if is_light(obj):
        raise ScanError(
            "{name}: is a light mesh, which can be shown and exported; select the scan itself", name=obj.name
        )
    if is_joined(obj):
        raise ScanError(
            "{name}: another mesh was joined to the scan; undo that, or separate them by material", name=obj.name
        )
    rows, cols = (values_of(obj, name, np.int32) for name in ("grid_row", "grid_col"))
    state = obj.reflcolor
    if rows.size and (rows.min() < 0 or cols.min() < 0 or rows.max() >= state.rows or cols.max() >= state.cols):
        raise ScanError("{name}: grid_row and grid_col point outside the scan; import the scan again", name=obj.name)
    return rows, cols


def is_light(obj):
    """Whether an object has a light mesh instead of a scan's own."""
    return LIGHT in obj.data


def is_joined(obj):
    """Whether another mesh was joined to a scan's."""
    return len(obj.data.vertices) > obj.data.get(RETURNS, len(obj.data.vertices))


def own_image(obj, name):
    """Return the image that the object's state names; None where there is none or a copy of the object has the same."""
    image = getattr(obj.reflcolor, name)
    shared = any(other != obj and getattr(other.reflcolor, name) == image for other in bpy.data.objects)
    return None if shared else image


def show_like_reflectance(obj, image):
    """Have an image of the scan's grid shown with pixels of the same shape as the reflectance image."""
    reflectance = obj.reflcolor.reflectance_image
    if reflectance is not None:
        image.display_aspect = reflectance.display_aspect


def coordinates_of(mesh):
    """Return (N, 3) float32, where the vertices of a mesh are."""
    coordinates = np.empty(3 * len(mesh.vertices), np.float32)
    # Many times faster than one by one, but empty in Edit Mode.
    if mesh.is_editmode:
        mesh.vertices.foreach_get("co", coordinates)
    else:
        mesh.attributes["position"].data.foreach_get("vector", coordinates)
    return coordinates.reshape(-1, 3)


def vertex_of_pixels(obj):
    """Return (H W,) int32: the vertex of every pixel of the scan's grid, in reading order; -1 where there is none."""
    rows, cols = grid_indices(obj)
    vertex = np.full(obj.reflcolor.rows * obj.reflcolor.cols, -1, np.int32)
    vertex[rows * obj.reflcolor.cols + cols] = np.arange(len(rows))
    return vertex


def seed_vertices(obj, rows, cols):
    """Return where pixels of the scan are in the world, and which of them have a vertex.

    Parameters
    ----------
    rows, cols : (S,) int

    Returns
    -------
    places : (S, 3) float32
    known : (S,) bool
    """
    mesh, width = obj.data, obj.reflcolor.cols
    vertex = vertex_of_pixels(obj)
    inside = (rows < obj.reflcolor.rows) & (cols < width)
    index = np.where(inside, vertex[np.where(inside, rows * width + cols, 0)], -1)
    known = index >= 0
    local = coordinates_of(mesh)[np.where(known, index, 0)]
    return local @ np.array(obj.matrix_world.to_3x3(), np.float32).T + np.array(obj.matrix_world.translation), known


def color_values(rgb):
    """Return (N, 3) uint8 sRGB as `write_colors` takes them; touches no bpy."""
    rgba = np.ones((len(rgb), 4), np.float32)
    rgba[:, :3] = rgb / np.float32(255)
    return rgba.ravel()


def add_colors(obj, name, rgb):
    """Write (N, 3) uint8 sRGB, one per vertex, as a color attribute of that name; one that is there is replaced."""
    write_colors(obj, name, color_values(rgb))


def write_colors(obj, name, values):
    """Write `color_values` of all vertices as a color attribute of that name; one that is there is replaced."""
    _check_readable(obj)
    mesh = obj.data
    attribute = mesh.color_attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", "BYTE_COLOR"):
        mesh.color_attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.color_attributes.new(name, "BYTE_COLOR", "POINT")
    attribute.data.foreach_set("color_srgb", values)
    mesh.update()


def colors_of(obj, name):
    """Return (N, 3) uint8 sRGB, one per vertex, of the color attribute of that name.

    Raises
    ------
    ScanError
        If it is there no more, or has other than one color per vertex.
    """
    _check_readable(obj)
    attribute = obj.data.color_attributes.get(name)
    if attribute is None or attribute.domain != "POINT":
        raise ScanError(
            "{object}: the mesh has no color attribute {name} with one color per vertex", object=obj.name, name=name
        )
    rgba = np.empty(4 * len(attribute.data), np.float32)
    attribute.data.foreach_get("color_srgb", rgba)
    return np.rint(np.clip(rgba.reshape(-1, 4)[:, :3], 0, 1) * 255).astype(np.uint8)


def add_values(obj, name, values):
    """Write (N,) numbers, one per vertex, as an attribute of that name; one that is there is replaced.

    Whole numbers are kept as int32, others as float32.
    """
    _check_readable(obj)
    values = np.asarray(values)
    dtype = np.int32 if values.dtype.kind in "iu" else np.float32
    attribute = obj.data.attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", KINDS[dtype]):
        obj.data.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = obj.data.attributes.new(name, KINDS[dtype], "POINT")
    attribute.data.foreach_set("value", np.ascontiguousarray(values, dtype))
    obj.data.update()


def values_of(obj, name, dtype):
    """Return the (N,) float32 or int32, one per vertex, of the attribute of that name.

    Raises
    ------
    ScanError
        If it is there no more, or holds something else.
    """
    _check_readable(obj)
    attribute = obj.data.attributes.get(name)
    if attribute is None or (attribute.domain, attribute.data_type) != ("POINT", KINDS[dtype]):
        raise ScanError(
            "{object}: the mesh has lost its attribute {name}; undo what removed it, or import again",
            object=obj.name,
            name=name,
        )
    values = np.empty(len(attribute.data), dtype)
    attribute.data.foreach_get("value", values)
    return values


def show_colors(obj, name):
    """Make a color attribute the one that is seen: in viewports, renders and exports."""
    mesh = obj.data
    look_at(obj, name)
    mesh.color_attributes.render_color_index = mesh.color_attributes.find(name)
    for material in filter(None, mesh.materials):
        show_in_material(material, name, instead_of=SHOWN_IN_RENDERS)
        if mesh.get(IMAGE_OF) == name:
            show_image_again(material)


def shown_in_renders(obj):
    """Return the name of the color attribute that renders and exports take."""
    attributes = obj.data.color_attributes
    name = attributes[attributes.render_color_index].name if len(attributes) else GRAY
    return name if name in SHOWN_IN_RENDERS else GRAY


def look_at(obj, name):
    """Make a color attribute the one that solid viewports show; renders and exports keep theirs."""
    obj.data.color_attributes.active_color_name = name
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type != "VIEW_3D":
                continue
            shading = area.spaces.active.shading
            # Solid views show the material's one color unless told otherwise.
            if shading.color_type == "MATERIAL":
                shading.color_type = "VERTEX"
            # Studio light darkens colors to a half of what they are; without them it shows the shape.
            if name in (COLORIZED, SCANNED) and shading.light == "STUDIO":
                shading.light = "FLAT"
            elif name == GRAY and shading.light == "FLAT":
                shading.light = "STUDIO"


def _check_readable(obj):
    """Raise ScanError in Edit Mode, where Blender keeps the mesh elsewhere and shows its attributes as empty."""
    if obj.data.is_editmode:
        raise ScanError("{name}: leave Edit Mode first", name=obj.name)
