"""Finds buttons by what they do, as Blender itself tells it of the button under the mouse, and clicks them."""

import bpy

# Buttons are 20 pixels high; the mouse goes down a region by this much.
_STEP_PX = 18
# At a region's lower edge the mouse takes hold of the edge, not of a button there.
_EDGE_PX = 24
# Where in a region's width buttons are looked for: full-width ones and the right of two in a row, the left of two; then
# the icons on the right, the middle of three.
_COLUMNS, _RARE_COLUMNS = (0.75, 0.25), (0.93, 0.5)
# Turns of the wheel that bring the most of a region into view that was not; so often down, and from the top.
_TURNS, _SCROLLS = 8, 4
# Names of files are this far apart in the file browser.
_FILE_PX = 10
# Where a property's field is in the redo panel, from the mouse that it was opened at: to the right, and row by row.
_FIELD_PX, _ROW_PX, _ROWS = 200, 11, 26


class Buttons:
    """Buttons are named by operator, "reflcolor.colorize", with its arguments if need be, or by property, "alpha"."""

    def show_sidebar(self, kind="VIEW_3D", tab="Reflectance", index=0):
        """Open an area's sidebar and bring a tab of it to the front."""
        area = self.area(kind, index)
        area.spaces.active.show_region_ui = True
        for _ in range(100):
            area = self.area(kind, index)
            try:
                # Raises until the region was drawn.
                self.region(area, "UI").active_panel_category = tab
                break
            except AttributeError:
                area.tag_redraw()
                yield 0.05
        else:
            raise AssertionError(f"the sidebar of {kind} has no tab {tab}")
        yield 0.2

    def click_tab(self, tab, kind="VIEW_3D"):
        """Click a tab of an area's open sidebar, looked for from above: what is tried does not count as a press."""
        region = self.region(self.area(kind), "UI")
        pressed = self.presses
        for y in range(region.y + region.height - 10, region.y, -_STEP_PX):
            yield from self.click((region.x + region.width - 10, y))
            yield 0.05
            if self.region(self.area(kind), "UI").active_panel_category == tab:
                self.presses = pressed + 1
                yield 0.2
                return
        raise AssertionError(f"the sidebar of {kind} has no tab {tab}")

    def find_file(self, area, name):
        """Return the place of a file in the file browser, where the mouse is over it."""
        found = self.region(area, "WINDOW")
        for x in (found.x + 80, found.x + found.width // 2):
            for y in range(found.y + found.height - 10, found.y, -_FILE_PX):
                yield from self.move((x, y))
                pressed = self.presses
                yield from self.click((x, y))
                self.presses = pressed
                if area.spaces.active.params.filename == name:
                    yield 0.6
                    return x, y
        raise AssertionError(f"the file browser shows no file {name}")

    def click_button(self, name, area=None, region="UI"):
        """Look for a button in a region, scrolling it if need be, and click it."""
        place = yield from self.find_button(name, area, region)
        yield from self.click(place)

    def find_button(self, name, area=None, region="UI"):
        """Return the place of a button in a region, scrolling it if need be."""
        area = area or self.area("VIEW_3D")
        # At the edge: over a list of many rows the wheel would turn the list.
        edge = self.place_in(area, 0.02, 0.5, region)
        # Most buttons are looked for below the last one.
        down = [-_TURNS] * _SCROLLS
        for turns, columns in (
            (0, _COLUMNS + _RARE_COLUMNS),
            *((turns, _COLUMNS) for turns in (*down, 2 * _TURNS * _SCROLLS, *down)),
            *((turns, _RARE_COLUMNS) for turns in (2 * _TURNS * _SCROLLS, *down)),
        ):
            if turns:
                yield from self.wheel(edge, turns)
                yield 0.1
            for column in columns:
                place = yield from self._look_down(name, area, region, column)
                if place is not None:
                    return place
        raise AssertionError(f"there is no button {name} in {area.ui_type} {region}")

    def button_under_mouse(self, area, region="UI"):
        """Return what the button under the mouse does: Python that calls it or the property's path; "" for none."""
        manager = bpy.context.window_manager
        with self.at(area, region):
            for tell, arguments in (
                (bpy.ops.ui.copy_python_command_button, {}),
                (bpy.ops.ui.copy_data_path_button, {"full_path": True}),
            ):
                if tell.poll():
                    tell(**arguments)
                    return manager.clipboard
        return ""

    def change_last_act(self):
        """Open the redo panel of what was done last and change the first value that can be; return its name.

        Numbers and choices are turned by the wheel, boxes are clicked.
        """
        before = _last_values()
        corner = self.place_in(self.area("VIEW_3D"), 0.2, 0.85)
        for change in (lambda place: self.wheel(place, -1, ctrl=True), self.click):
            yield from self.move(corner)
            yield from self.key("F9")
            yield 0.2
            for row in range(2, _ROWS):
                yield from change((corner[0] + _FIELD_PX, corner[1] - row * _ROW_PX))
                yield 0.02
                after = _last_values()
                if changed := [name for name in after if after[name] != before.get(name)]:
                    yield from self.key("ESC")
                    return changed[0]
            yield from self.key("ESC")
        raise AssertionError(f"nothing in the redo panel of {bpy.context.window_manager.operators[-1].name} changes")

    def _look_down(self, name, area, region, column):
        found = self.region(area, region)
        x, first = found.x + column * found.width, None
        for y in range(found.y + found.height - 4, found.y + _EDGE_PX, -_STEP_PX):
            # One turn will do: Blender is believed only where the mouse stays. A turn over buttons draws them all.
            yield from self.move((x, y), turns=1)
            told = self.button_under_mouse(area, region)
            if _is_button(told, name):
                first = y
                break
        if first is None:
            return None
        # The mouse may be at the button's edge, and Blender a turn behind: believe it where it stays.
        for step in (0, 1, -1, 2, -2, 3, 4):
            y = first + step * _STEP_PX // 2
            yield from self.move((x, y))
            yield 0.05
            if _is_button(self.button_under_mouse(area, region), name):
                return x, y
        return None


def _is_button(told, name):
    """Whether what Blender tells of a button is the one meant: the operator, or a property of that name."""
    if told.startswith("bpy.ops."):
        call = told.removeprefix("bpy.ops.")
        return call == name or call.startswith(f"{name}(")
    return bool(told) and (told.endswith(f".{name}") or f".{name}[" in told)


def _last_values():
    """The values of the operator that the redo panel is of."""
    values = bpy.context.window_manager.operators[-1].properties
    names = [prop.identifier for prop in values.bl_rna.properties if prop.type in {"BOOLEAN", "INT", "FLOAT", "ENUM"}]
    return {name: _plain(getattr(values, name)) for name in names}


def _plain(value):
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str | set) else value
