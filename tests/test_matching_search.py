"""Scan and photo as maps over azimuth and elevation: the direction that a correlation of both finds."""

import painted_room
import pytest

from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews
from reflcolor_addon.matching.registration.sphere_map import PhotoMaps, SphereMap

YAW, PITCH, FOCAL = 12, -9, 1.0
KEY = FOCAL, -6.0, 0.0
REACH = 6


@pytest.fixture(scope="module")
def views():
    return ScanViews(painted_room.scan())


@pytest.fixture(scope="module")
def maps(views):
    photo = PhotoImage("photo", painted_room.photo(painted_room.camera(yaw_deg=YAW, pitch_deg=PITCH, focal=FOCAL)))
    return PhotoMaps(photo, views.step_deg)


def sphere(views, window=None):
    image = views.image(0.5)
    points, tone = image.points[image.valid], image.reflectance[image.valid]
    return SphereMap(points, tone, (0, 0, 0), views.step_deg, window)


def window_around(maps, yaw, pitch):
    """As far around a direction as the photo shows, and as it is moved."""
    patch = maps.at(*KEY)
    height, width = (length * maps.step_deg for length in patch.seen.shape)
    left, top = yaw + patch.left, patch.top + pitch - KEY[1]
    return left - REACH, left + width + REACH, top - height - REACH, top + REACH


def test_the_direction_of_a_photo_turned_on_the_spot_is_found_to_a_pixel(views, maps):
    (guess,) = sphere(views).peaks(maps, KEY, 1)
    assert guess.yaw_deg == pytest.approx(YAW, abs=1.5 * views.step_deg)
    assert guess.pitch_deg == pytest.approx(PITCH, abs=1.5 * views.step_deg)


@pytest.mark.parametrize("off", [(0, 0), (5, 4), (-5, -4)])
def test_near_a_direction_the_same_place_is_found_as_on_a_map_where_nothing_is_left_out(views, maps, off):
    near = sphere(views, window_around(maps, YAW + off[0], PITCH + off[1]))
    (everywhere,), (within_reach,) = near.peaks(maps, KEY, 1), near.peaks(maps, KEY, 1, REACH)
    assert (within_reach.yaw_deg, within_reach.pitch_deg) == (everywhere.yaw_deg, everywhere.pitch_deg)
    assert within_reach.score == pytest.approx(everywhere.score, rel=1e-4)


def test_nothing_beyond_the_reach_is_found(views, maps):
    near = sphere(views, window_around(maps, YAW + 9, PITCH))
    for guess in near.peaks(maps, KEY, 5, REACH):
        assert abs(guess.yaw_deg - (YAW + 9)) <= REACH + views.step_deg
