"""Import a scan."""

from math import degrees, radians
from pathlib import Path

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..reflcolor_addon.batch.memory import require_objects
from ..reflcolor_addon.batch.paths import scan_files
from ..reflcolor_addon.errors import ImageError, ScanError
from ..reflcolor_addon.files.images import IMAGE_SUFFIXES
from ..reflcolor_addon.files.photo_files import photos_of
from ..reflcolor_addon.files.readers import SCAN_SUFFIXES, read_scans
from ..reflcolor_addon.files.readers.e57_photos import photos_inside, read_photos
from ..reflcolor_addon.files.readers.pair_description import Pair, describe_pair, pair_and_photos, table_of
from ..reflcolor_addon.messages import Message
from ..reflcolor_addon.report.report import input_entry, scan_entry
from ..reflcolor_addon.scan.grid_mesh import MAX_INCIDENCE_DEG
from ..reflcolor_addon.scan.object_arrays import object_arrays
from .scene.add_scan import add_scan_object, scan_images
from .scene.notices import show_result
from .scene.pair_preview import draw_preview, picked_files
from .scene.photos import add_photos, photo_file
from .scene.provenance import record_import
from .scene.reading_properties import ReadingProperties
from .scene.texts import report_text
from .scene.viewpoint import show_imported
from .window.folders import open_in, was_picked
from .window.jobs import JobOperator

_PATTERN = ";".join(f"*{suffix}" for suffix in (*SCAN_SUFFIXES, *IMAGE_SUFFIXES))

_MOST_PHOTOS = 12
"""A file with more photos than this does not add them to the list by itself: each takes memory."""

_SENSOR_PROPERTIES = {
    "spherical": ("azimuth_left", "azimuth_right", "elevation_bottom", "elevation_top"),
    "pinhole": ("focal_x", "focal_y", "center_x", "center_y"),
}


class REFLCOLOR_OT_import_scan(JobOperator, ReadingProperties, bpy.types.Operator, ImportHelper):
    """Import a structured laser scan (E57, PTX, PCD and others, or a range and a reflectance image) as a mesh"""

    bl_idname = "reflcolor.import_scan"
    bl_label = "Import Laser Scan"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    job_name = "Import Laser Scan"

    filter_glob: StringProperty(default=_PATTERN, options={"HIDDEN"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    max_incidence: FloatProperty(
        name="Grazing Angle",
        description="Faces steeper than this against the viewing ray are jumps between surfaces and are left out",
        subtype="ANGLE",
        default=radians(MAX_INCIDENCE_DEG),
        min=radians(45),
        max=radians(90),
    )
    sensor: EnumProperty(
        name="Sensor",
        description="How the pixels of a range image look into the scene",
        items=(
            ("auto", "Automatic", "A guess from the shape of the images; what comes of it is shown below"),
            ("spherical", "Spherical", "Equal angles from pixel to pixel, as a turning laser scanner has them"),
            ("pinhole", "Pinhole", "A camera's perspective, as a time-of-flight camera has it"),
        ),
    )
    range_scale: FloatProperty(
        name="Range Scale",
        description="Meters for one unit of the range image, 0.001 for millimeters; 0 to guess it from its values",
        default=0,
        min=0,
        soft_max=1,
        precision=6,
    )
    range_table: StringProperty(
        name="Range Table",
        description="For range images that are no linear measure, instead of the scale: pairs of a value and meters, "
        "such as 0 0.5, 128 3, 255 12",
    )
    color_order: EnumProperty(
        name="Color Order",
        description="How a third image, of colors, stores them",
        items=(
            ("rgb", "Red, Green, Blue", "As most images"),
            ("bgr", "Blue, Green, Red", "For images whose red and blue come in swapped"),
        ),
    )
    azimuth_left: FloatProperty(
        name="Left Edge",
        description="Direction of the image's left edge, to the right from straight ahead",
        subtype="ANGLE",
        default=radians(-180),
    )
    azimuth_right: FloatProperty(
        name="Right Edge",
        description="Direction of the image's right edge, to the right from straight ahead",
        subtype="ANGLE",
        default=radians(180),
    )
    elevation_bottom: FloatProperty(
        name="Bottom Edge",
        description="Direction of the image's bottom edge, up from the horizon",
        subtype="ANGLE",
        default=radians(-45),
        min=radians(-90),
        max=radians(90),
    )
    elevation_top: FloatProperty(
        name="Top Edge",
        description="Direction of the image's top edge, up from the horizon",
        subtype="ANGLE",
        default=radians(90),
        min=radians(-90),
        max=radians(90),
    )
    focal_x: FloatProperty(name="Focal Length X", description="Focal length across, in pixels", default=500, min=1e-3)
    focal_y: FloatProperty(name="Focal Length Y", description="Focal length down, in pixels", default=500, min=1e-3)
    center_x: FloatProperty(
        name="Center X",
        description="Principal point across, in pixels from the center of the first column",
        default=320,
    )
    center_y: FloatProperty(
        name="Center Y", description="Principal point down, in pixels from the center of the first row", default=240
    )
    outside_files: BoolProperty(
        name="Outside Files",
        description="Let a .scan.json name images outside of its own folder, for files whose sender is trusted",
    )
    photos_inside: BoolProperty(
        name="Photos Inside",
        description="Put the photos that an E57 holds on the list of photos, to take colors from",
        default=True,
    )
    swap_images: BoolProperty(name="Swap Images", description="Take the other one of the two images as the range image")

    def invoke(self, context, event):
        # Set by drag and drop or a script; the files picked last time do not count.
        if self.properties.is_property_set("filepath"):
            return self.start(context)
        open_in(self)
        return self.browse(ImportHelper, context, event)

    def prepare(self, context):
        was_picked(self)
        paths = [Path(self.directory, file.name) for file in self.files if file.name] or [Path(self.filepath)]
        images = [path for path in paths if path.suffix.lower() in IMAGE_SUFFIXES]
        files = [path for path in paths if path not in images]
        # Beside a scan's file all images are photos, but those that it names itself.
        pair, photos = ((), images) if files else pair_and_photos(images)
        picked = self._pair(pair)
        outside, inside = self.outside_files, self.photos_inside
        reading = self.read_options()
        options = {
            "max_incidence_deg": degrees(self.max_incidence),
            "units_per_meter": 1 / context.scene.unit_settings.scale_length,
        }
        if pair and len(pair) not in (2, 3):
            raise ScanError(
                "{name}: pick two images together, one of range and one of reflectance, and a third of colors if there "
                "is one",
                name=pair[0].name,
            )

        def work(progress, cancelled):
            described, doubts = describe_pair(picked) if pair else (None, ())
            read_files = [described] if pair else files
            scans = [imported for path in read_files for imported in read(path, doubts, progress, cancelled)]
            named = {file for path in read_files for file in scan_files(path)}
            beside = [
                photo_file(photos_of(path, cancelled=cancelled), path, cancelled=cancelled)
                for path in photos
                if path not in named
            ]
            return scans, photos_in(files, cancelled), beside

        def photos_in(paths, cancelled):
            """(PhotoFile, warnings) of each file that has photos inside; what is wrong with them stops no import."""
            found = []
            for path in paths if inside else ():
                warnings, photos = [], []
                try:
                    count = sum(photo.usable for photo in photos_inside(path))
                    if count > _MOST_PHOTOS:
                        warnings.append(
                            Message(
                                "{file} holds {count} photos; Load Photo puts all of them on the list",
                                file=path.name,
                                count=count,
                            )
                        )
                    elif count:
                        photos = read_photos(path, warnings, cancelled=cancelled)
                except ImageError as error:
                    warnings.append(error.message)
                if photos or warnings:
                    found.append((photo_file(photos, path, cancelled=cancelled), warnings))
            return found

        def read(path, doubts, progress, cancelled):
            scans = read_scans(path, options=reading, outside=outside, progress=progress, cancelled=cancelled)
            require_objects(scans, path)
            inputs = [input_entry("scan", file, cancelled) for file in scan_files(path)]
            for index, scan in enumerate(scans, 1):
                entry = scan_entry(scan, index, reading=reading)
                arrays = object_arrays(scan, **options)
                yield arrays, scan_images(arrays), entry, inputs, (*scan.warnings, *doubts)

        return work

    def finish(self, context, result):
        added, (scans, photos, beside) = [], result
        inside, doubts = [], []
        for file in beside:
            for image, photo in zip(add_photos(context, file), file.photos, strict=True):
                height, width = photo.rgb.shape[:2]
                inside.append(
                    report_text("Loaded {name}: {width} x {height} pixels", name=image.name, width=width, height=height)
                )
        for file, warnings in photos:
            doubts += warnings
            if images := add_photos(context, file):
                name, count = Path(file.entry["path"]).name, len(images)
                inside.append(
                    report_text("Photos inside {name}, now on the list of photos: {count}", name=name, count=count)
                )
        for arrays, images, entry, inputs, warnings in scans:
            obj = add_scan_object(context, arrays, images)
            record_import(obj, entry, inputs, warnings)
            # Messages about the rest of the file are reported with its first scan.
            show_result(
                self, obj, report_text("Imported {name}", name=arrays.name), (*warnings, *doubts), details=inside
            )
            added.append(obj)
            inside, doubts = [], []
        for obj in added:
            obj.select_set(True)
        show_imported(context, added)

    def _pair(self, images):
        """What is said of images that are picked together."""
        return Pair(
            images=tuple(images),
            model=self._sensor_model(),
            range_scale=self.range_scale or None,
            range_table=table_of(self.range_table),
            color_order=self.color_order,
            swap=self.swap_images,
        )

    def _sensor_model(self):
        if self.sensor == "auto":
            return None
        if self.sensor == "pinhole":
            values = {"fx": self.focal_x, "fy": self.focal_y, "cx": self.center_x, "cy": self.center_y}
        else:
            values = {
                "azimuth_deg": (degrees(self.azimuth_left), degrees(self.azimuth_right)),
                "elevation_deg": (degrees(self.elevation_bottom), degrees(self.elevation_top)),
            }
        return {"type": self.sensor, **values}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        images = [path for path in picked_files(context) if path.suffix.lower() in IMAGE_SUFFIXES]
        if len(images) >= 2 and len(images) == len(picked_files(context)):
            draw_preview(layout.box(), images, self._pair)
        layout.prop(self, "max_incidence")
        self.draw_reading(layout)
        layout.prop(self, "photos_inside")
        layout.prop(self, "outside_files")
        header, body = layout.panel("REFLCOLOR_import_image_pair", default_closed=True)
        header.label(text="Image Pair")
        if body is None:
            return
        body.label(text="For a range and a reflectance image picked together", icon="INFO")
        body.prop(self, "sensor")
        for name in _SENSOR_PROPERTIES.get(self.sensor, ()):
            body.prop(self, name)
        for name in ("range_scale", "range_table", "color_order", "swap_images"):
            body.prop(self, name)


def draw_menu(self, _context):
    """Entry of File > Import."""
    self.layout.operator(
        REFLCOLOR_OT_import_scan.bl_idname, text="Laser Scan (.e57, .ptx, .pcd and others, image pair)"
    )


classes = (REFLCOLOR_OT_import_scan,)
menus = ((bpy.types.TOPBAR_MT_file_import, draw_menu),)
