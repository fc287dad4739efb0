"""Scan and photograph the scene with the virtual scanner."""

from math import degrees, radians
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from ..reflcolor_addon.simulation.virtual_scanner import ScannerModel
from .scene.simulation import Simulation, leveled_pose, photo_cameras, simulation_steps
from .scene.texts import report_text
from .window.jobs import JobOperator, StepJob

_DEFAULT = ScannerModel()


class REFLCOLOR_OT_simulate(JobOperator, bpy.types.Operator, ExportHelper):
    """Scan the scene with a virtual laser scanner and take photos of it, for teaching, planning and tests"""

    bl_idname = "reflcolor.simulate"
    bl_label = "Simulate Laser Scan"
    bl_options = {"REGISTER", "PRESET"}
    job_name = "Simulate Laser Scan"
    job_type = StepJob
    blocks_events = True

    filename_ext = ".e57"
    # The suffix that a person types chooses the format.
    check_extension = None
    filter_glob: StringProperty(default="*.ptx;*.e57;*.scan.json", options={"HIDDEN"})

    station: EnumProperty(
        name="Scanner At",
        description="Where the scanner stands; it is leveled and looks as that does",
        items=(
            ("CAMERA", "Scene Camera", "At the camera of the scene, looking as it does"),
            ("ACTIVE", "Active Object", "At the origin of the active object, looking along its Y axis"),
            ("CURSOR", "3D Cursor", "At the 3D cursor, looking along its Y axis"),
        ),
    )
    rows: IntProperty(name="Rows", description="Pixels from top to bottom", default=_DEFAULT.rows, min=1, max=65536)
    columns: IntProperty(
        name="Columns", description="Pixels from left to right", default=_DEFAULT.columns, min=1, max=65536
    )
    full_turn: BoolProperty(name="Full Turn", description="Scan all around", default=False)
    azimuth: FloatProperty(
        name="Width",
        description="Angle from the left to the right edge of the scan",
        subtype="ANGLE",
        default=radians(_DEFAULT.azimuth_deg[1] - _DEFAULT.azimuth_deg[0]),
        min=radians(0.1),
        max=radians(360),
    )
    elevation_bottom: FloatProperty(
        name="Bottom Edge",
        description="Direction of the bottom edge, up from the horizon",
        subtype="ANGLE",
        default=radians(_DEFAULT.elevation_deg[0]),
        min=radians(-90),
        max=radians(90),
    )
    elevation_top: FloatProperty(
        name="Top Edge",
        description="Direction of the top edge, up from the horizon",
        subtype="ANGLE",
        default=radians(_DEFAULT.elevation_deg[1]),
        min=radians(-90),
        max=radians(90),
    )
    greatest_range: FloatProperty(
        name="Greatest Range",
        description="Nothing is measured beyond, in meters",
        default=_DEFAULT.range_limits_m[1],
        min=0.5,
        soft_max=500,
    )
    range_noise: FloatProperty(
        name="Range Noise",
        description="Standard deviation of the range of a bright surface, in meters",
        default=_DEFAULT.range_noise_m,
        min=0,
        soft_max=0.05,
        precision=4,
    )
    reflectance_noise: FloatProperty(
        name="Reflectance Noise",
        description="Standard deviation of the reflectance, relative to it",
        default=_DEFAULT.reflectance_noise,
        min=0,
        soft_max=0.5,
    )
    beam: FloatProperty(
        name="Beam Width",
        description="Width of the laser beam; surfaces that share a beam at an edge become one point between them",
        subtype="ANGLE",
        default=radians(_DEFAULT.beam_deg),
        min=0,
        max=radians(5),
    )
    dropouts: FloatProperty(
        name="Dropouts",
        description="Share of the pixels that give no return for no reason",
        subtype="FACTOR",
        default=_DEFAULT.dropout_rate,
        min=0,
        max=1,
        precision=4,
    )
    seed: IntProperty(
        name="Seed", description="Start of the random numbers; the same start gives the same scan", default=0, min=0
    )
    photos: BoolProperty(
        name="Photos", description="Take a photo from every camera of the scene but the scanner's", default=False
    )
    photo_samples: IntProperty(
        name="Photo Samples", description="Light paths for each pixel of a photo", default=32, min=1, soft_max=1024
    )
    own_look: BoolProperty(
        name="Own Look",
        description="Give each photo an exposure, white balance, lens distortion and noise of its own",
        default=True,
    )
    truth: BoolProperty(
        name="True Colors", description="Write an image of the true color of every pixel of the scan", default=True
    )

    def invoke(self, context, event):
        return self.browse(ExportHelper, context, event)

    def prepare(self, context):
        return simulation_steps(context.scene, self._simulation(context))

    def finish(self, _context, _result):
        self.report({"INFO"}, report_text("Simulated {path}", path=self.filepath))

    def _simulation(self, context):
        scene = context.scene
        item = {"CAMERA": scene.camera, "ACTIVE": context.active_object, "CURSOR": None}[self.station]
        half = 180.0 if self.full_turn else degrees(self.azimuth) / 2
        model = ScannerModel(
            rows=self.rows,
            columns=self.columns,
            azimuth_deg=(-half, half),
            elevation_deg=(degrees(self.elevation_bottom), degrees(self.elevation_top)),
            range_limits_m=(_DEFAULT.range_limits_m[0], self.greatest_range),
            range_noise_m=self.range_noise,
            reflectance_noise=self.reflectance_noise,
            beam_deg=degrees(self.beam),
            dropout_rate=self.dropouts,
            seed=self.seed,
        )
        return Simulation(
            path=Path(bpy.path.abspath(self.filepath)),
            pose=leveled_pose(scene, self.station, item),
            model=model,
            truth=self.truth,
            cameras=photo_cameras(scene, item) if self.photos else (),
            samples=self.photo_samples,
            own_look=self.own_look,
        )

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "station")
        for names in (("rows", "columns"), ("full_turn", "azimuth", "elevation_bottom", "elevation_top")):
            column = layout.column(align=True)
            for name in names:
                row = column.row()
                row.enabled = not (name == "azimuth" and self.full_turn)
                row.prop(self, name)
        layout.prop(self, "truth")
        layout.prop(self, "photos")
        column = layout.column(align=True)
        column.enabled = self.photos
        column.prop(self, "photo_samples")
        column.prop(self, "own_look")
        header, body = layout.panel("REFLCOLOR_simulate_sensor", default_closed=True)
        header.label(text="Sensor")
        if body is not None:
            for name in ("greatest_range", "range_noise", "reflectance_noise", "beam", "dropouts", "seed"):
                body.prop(self, name)


def draw_menu(self, _context):
    """Entry of File > Export."""
    self.layout.operator(REFLCOLOR_OT_simulate.bl_idname, text="Simulated Laser Scan (.e57, .ptx, .scan.json)")


classes = (REFLCOLOR_OT_simulate,)
menus = ((bpy.types.TOPBAR_MT_file_export, draw_menu),)
