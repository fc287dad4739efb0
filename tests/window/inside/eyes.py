"""Pictures of the screen, and where things are on it."""

import subprocess
import tempfile
import time
from pathlib import Path

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d

_STILL_S = 0.3
_STILL_LIMIT_S = 8


class Eyes:
    """What a scenario sees; ``out`` is the folder for its pictures and ``scenario`` its name."""

    def __init__(self, out, scenario):
        self._out = out
        self._scenario = scenario.removeprefix("scenario_")
        self.pictures = []

    # ---- pictures

    def screenshot(self, name, keep_mouse=False, still=True):
        """Take a picture of the screen once it stands still, or, while work goes on, as it is.

        The mouse is taken aside first, so that no tooltip shows, unless it is to be kept.
        """
        if not keep_mouse:
            yield from self.move((self.bpy_window.width * 0.75, 4))
        if not still:
            yield 0.1
            self.picture_now(name)
            return
        with tempfile.TemporaryDirectory() as folder:
            last, until = b"", time.monotonic() + _STILL_LIMIT_S
            while time.monotonic() < until:
                yield _STILL_S
                now = _shoot(Path(folder) / "look.png").read_bytes()
                if now == last:
                    break
                last = now
        self.picture_now(name)

    def picture_now(self, name):
        """Take a picture of the screen as it is; there is none where the screen cannot be read."""
        path = self._out / f"{self._scenario}-{name}.png"
        try:
            _shoot(path)
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"window-test: no picture {path.name}: {error}", flush=True)
            return
        self.pictures.append(path.name)

    def colors_at(self, places):
        """Return the (r, g, b) of 0..255 that the screen shows at places of the window; a generator."""
        yield from self.move((self.bpy_window.width * 0.75, 4))
        yield _STILL_S
        with tempfile.TemporaryDirectory() as folder:
            image = bpy.data.images.load(str(_shoot(Path(folder) / "look.png")))
            (width, _), pixels = image.size, image.pixels[:]
            bpy.data.images.remove(image)
        firsts = [4 * (int(y) * width + int(x)) for x, y in places]
        return [tuple(round(255 * value) for value in pixels[first : first + 3]) for first in firsts]

    # ---- places

    def area(self, kind="VIEW_3D", index=0):
        """Return the window's area of a kind (``area.ui_type``), the largest first."""
        areas = [area for area in self.bpy_window.screen.areas if area.ui_type == kind]
        areas.sort(key=lambda area: -area.width * area.height)
        if index >= len(areas):
            raise AssertionError(f"the window has {len(areas)} areas {kind}, needs {index + 1}")
        return areas[index]

    def region(self, area, kind="WINDOW"):
        """Return an area's region of a kind."""
        return next(region for region in area.regions if region.type == kind)

    def place_in(self, area, across=0.5, up=0.5, region="WINDOW"):
        """Return the place at a fraction of a region's width and height."""
        found = self.region(area, region)
        return found.x + across * found.width, found.y + up * found.height

    def place_of_pixel(self, area, row, col):
        """Return the place of an image's pixel, counted from the top left, in an Image Editor."""
        region, (width, height) = self.region(area), area.spaces.active.image.size
        x, y = region.view2d.view_to_region((col + 0.5) / width, 1 - (row + 0.5) / height, clip=False)
        return region.x + x, region.y + y

    def place_of_point(self, area, point):
        """Return the place of a point of the world in a 3D View; None where it is behind the viewer."""
        region = self.region(area)
        at = location_3d_to_region_2d(region, area.spaces.active.region_3d, point)
        return None if at is None else (region.x + at.x, region.y + at.y)

    def at(self, area, region="WINDOW"):
        """A context in which operators run as if called from an area."""
        return bpy.context.temp_override(window=self.bpy_window, area=area, region=self.region(area, region))


def _shoot(path):
    subprocess.run(["scrot", "-o", str(path)], check=True, timeout=20)
    return path
