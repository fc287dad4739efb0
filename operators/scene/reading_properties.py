"""How to read a scan file, as properties of the operators that do."""

from bpy.props import BoolProperty, EnumProperty, FloatVectorProperty, IntProperty

from ...reflcolor_addon.files.readers.options import ANGLE, STORED, ReadOptions


class ReadingProperties:
    """What the user knows better than the file."""

    turn: EnumProperty(
        name="Turn",
        description="Turn the scan's image clockwise, where the file's order is misread",
        items=(
            ("0", "None", "Leave it as the points tell"),
            ("90", "Right", "By a quarter to the right"),
            ("180", "Half", "Upside down"),
            ("270", "Left", "By a quarter to the left"),
        ),
    )
    flip_vertical: BoolProperty(
        name="Flip Vertically", description="Turn the scan's grid upside down, where the file's order is misread"
    )
    flip_horizontal: BoolProperty(
        name="Flip Horizontally", description="Mirror the scan's grid, where the file's order is misread"
    )
    unit: EnumProperty(
        name="File's Unit",
        description="What the coordinates in the file count",
        items=(
            ("auto", "Automatic", "Meters, unless the points tell otherwise"),
            ("m", "Meters", "Meters"),
            ("mm", "Millimeters", "As depth cameras count"),
            ("cm", "Centimeters", "Centimeters"),
            ("ft", "Feet", "International feet"),
            ("in", "Inches", "Inches"),
        ),
    )
    step: IntProperty(
        name="Every",
        description="Read only every so many rows and columns of the file, which saves time and memory on large scans",
        default=1,
        min=1,
        soft_max=16,
    )
    returns: EnumProperty(
        name="Returns",
        description="Which of several returns of a pixel to take",
        items=(
            ("first", "First", "The nearest one"),
            ("strongest", "Strongest", "The one with the most reflectance"),
            ("last", "Last", "The farthest one"),
        ),
    )
    grid_by_angle: BoolProperty(
        name="Grid by Angle",
        description="Lay a grid over the points by the angles at which the scanner saw them, for files without one",
    )
    position_is_known: BoolProperty(
        name="Scanner Position", description="Say where the scanner stood, for points that are not measured from it"
    )
    position: FloatVectorProperty(
        name="Position", description="Where the scanner stood, in the file's coordinates and unit", size=3, precision=4
    )

    def read_options(self):
        """Return the ReadOptions that the properties say."""
        return ReadOptions(
            turn_deg=int(self.turn),
            flip_vertical=self.flip_vertical,
            flip_horizontal=self.flip_horizontal,
            unit=self.unit,
            step=self.step,
            returns=self.returns,
            grid=ANGLE if self.grid_by_angle else STORED,
            position=tuple(self.position) if self.position_is_known else None,
        )

    def draw_reading(self, layout):
        """Draw them: what is used most first, the rest in a closed panel."""
        for name in ("turn", "flip_vertical", "flip_horizontal", "unit"):
            layout.prop(self, name)
        header, body = layout.panel("REFLCOLOR_import_reading", default_closed=True)
        header.label(text="Points")
        if body is None:
            return
        for name in ("step", "returns", "grid_by_angle", "position_is_known"):
            body.prop(self, name)
        column = body.column()
        column.enabled = self.position_is_known
        column.prop(self, "position", text="")
