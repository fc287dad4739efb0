"""Export colorized scans as files that other programs read."""

from pathlib import Path

import bpy
from bpy.props import EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from ..reflcolor_addon.batch.paths import check_outputs
from ..reflcolor_addon.errors import OutputError, ScanError
from ..reflcolor_addon.files.atomic import written_atomically
from ..reflcolor_addon.files.writers import MESH_WRITERS
from ..reflcolor_addon.files.writers.scans_back import SCAN_FILES, write_scans_back
from .scene import polls
from .scene.colored_scan import colored_scans_reader
from .scene.object_surface import surface_of_object
from .scene.photo_texture import texture_file
from .scene.provenance import import_record
from .scene.texts import report_text, shown
from .scene.usd import write_usd
from .window.jobs import JobOperator

_SUFFIXES = (*MESH_WRITERS, ".usd", *SCAN_FILES)


class REFLCOLOR_OT_export_scan(JobOperator, bpy.types.Operator, ExportHelper):
    """Write the selected scans with the colors that renders show, exactly as they are"""

    bl_idname = "reflcolor.export_scan"
    bl_label = "Export Colorized Scan"
    bl_options = {"REGISTER", "PRESET"}
    job_name = "Export Colorized Scan"

    filter_glob: StringProperty(default=";".join(f"*{suffix}" for suffix in _SUFFIXES), options={"HIDDEN"})
    file_format: EnumProperty(
        name="File Format",
        description="What to write; a suffix that is typed decides otherwise",
        items=(
            (
                ".ply",
                "PLY",
                "Every return once, in the order of the scan's grid: for CloudCompare, MeshLab and scripts",
            ),
            (".glb", "glTF (GLB)", "For viewers on the web and game engines"),
            (".usd", "USD", "For film and visual effects"),
            (".e57", "E57", "The scanned file with colors, if it is one: for CloudCompare, ReCap and Cyclone"),
            (".ptx", "PTX", "The scanned file with colors, if it is one: for Cyclone and CloudCompare"),
        ),
    )

    @classmethod
    def poll(cls, context):
        return polls.has_scan(cls, context)

    @property
    def filename_ext(self):
        """The suffix that the file browser adds to a name."""
        return self.file_format

    def invoke(self, context, event):
        return self.browse(ExportHelper, context, event)

    def prepare(self, context):
        path = Path(bpy.path.abspath(self.filepath))
        suffix = path.suffix.lower()
        if suffix not in _SUFFIXES:
            raise OutputError(
                "{file}: the suffix tells what to write; expected one of {known}",
                file=path.name,
                known=", ".join(_SUFFIXES),
            )
        objects = polls.scan_objects(context)
        read = [Path(entry["path"]) for obj in objects for entry in import_record(obj).get("inputs", [])]
        check_outputs([("Export", path)], read)
        if suffix == ".usd":
            for obj in objects:
                if reason := polls.closed_mesh(obj):
                    raise ScanError("{object}: cannot be exported ({reason})", object=obj.name, reason=reason)
            # Blender's own exporter, which no thread may call: it is `finish` that does it.
            return lambda _progress, _cancelled: (path, [])
        if suffix in SCAN_FILES:
            read_scans = colored_scans_reader(objects)
            return lambda progress, cancelled: (
                path,
                write_scans_back(read_scans(cancelled), path, progress=progress, cancelled=cancelled),
            )
        textures = [texture_file(obj) if suffix == ".glb" else None for obj in objects]
        surfaces = [
            surface_of_object(context, obj, textured=texture is not None)
            for obj, texture in zip(objects, textures, strict=True)
        ]
        options = {"textures": textures} if suffix == ".glb" else {}

        def work(progress, cancelled):
            MESH_WRITERS[suffix](surfaces, path, progress=progress, cancelled=cancelled, **options)
            return path, []

        return work

    def finish(self, context, result):
        path, warnings = result
        if path.suffix.lower() == ".usd":
            with written_atomically(path) as temporary:
                write_usd(context, polls.scan_objects(context), temporary)
        for warning in warnings:
            self.report({"WARNING"}, shown(warning))
        self.report({"INFO"}, report_text("Exported {path}", path=path))

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "file_format")


def draw_menu(self, _context):
    """Entry of File > Export."""
    self.layout.operator(REFLCOLOR_OT_export_scan.bl_idname, text="Colorized Laser Scan (.ply, .glb, .usd, .e57, .ptx)")


classes = (REFLCOLOR_OT_export_scan,)
menus = ((bpy.types.TOPBAR_MT_file_export, draw_menu),)
