"""Everything the extension does, in menus: a person finds it by a right click, and by F3 and its verb."""

import bpy

from ..operators.scene import polls

# By theme, with a line between; what needs a place or a stroke of the mouse is in the tools instead.
ACTS = (
    ("import_scan", "open_example", "open_seed_picking", "close_seed_picking", "open_reflectance"),
    ("load_photo", "remove_photo", "match_photos", "seeds_from_color"),
    ("take_seed_tool", "add_seed", "move_seed", "keep_gray", "lock_seeds", "select_all_seeds"),
    ("remove_seed", "delete_seeds", "clear_seeds"),
    ("load_seeds", "save_seeds"),
    ("colorize", "make_texture", "make_light_mesh", "evaluate", "leave_preview", "set_up_render"),
    ("read_notice", "read_verdict", "copy_provenance"),
    ("export_scan", "simulate"),
)


class REFLCOLOR_MT_scan(bpy.types.Menu):
    """Acts on the active laser scan"""

    bl_idname = "REFLCOLOR_MT_scan"
    bl_label = "Laser Scan"

    def draw(self, _context):
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        for number, names in enumerate(ACTS):
            if number:
                layout.separator()
            for name in names:
                layout.operator(f"reflcolor.{name}")
        layout.separator()
        layout.operator_menu_enum("reflcolor.show_look", "look", icon="SHADING_SOLID")
        layout.operator_menu_enum("reflcolor.apply_preset", "preset", icon="PRESET")


def draw_submenu(self, _context):
    """Entry of the menus Object and Image, in which F3 looks, too."""
    self.layout.separator()
    self.layout.menu(REFLCOLOR_MT_scan.bl_idname, icon="MESH_GRID")


def draw_context_menu(self, context):
    """Entry of the menu of a right click on objects, where the active one is a scan."""
    if polls.scan_object(context) is not None:
        draw_submenu(self, context)


def draw_import(self, _context):
    """Entries of File > Import, besides the scan's own."""
    self.layout.operator("reflcolor.load_seeds", text="Laser Scan Seeds (.json)")
    self.layout.operator("reflcolor.load_photo", text="Photo for Laser Scan (.jpg, .png, .tif)")


def draw_export(self, _context):
    """Entry of File > Export."""
    self.layout.operator("reflcolor.save_seeds", text="Laser Scan Seeds (.json)")


classes = (REFLCOLOR_MT_scan,)
menus = (
    (bpy.types.VIEW3D_MT_object, draw_submenu),
    (bpy.types.IMAGE_MT_image, draw_submenu),
    (bpy.types.VIEW3D_MT_object_context_menu, draw_context_menu),
    (bpy.types.TOPBAR_MT_file_import, draw_import),
    (bpy.types.TOPBAR_MT_file_export, draw_export),
)
