"""A photo that is recognized on one of two scans in Blender, and what it gives on both, to the byte."""

from types import SimpleNamespace

import cv2
import numpy as np
import painted_room
import pytest
from same_bytes import differing_blenders
from test_blender_import import pixels, write_small_ptx
from test_blender_site import activate, state, verdicts

from reflcolor_addon import Seeds


@pytest.fixture(scope="module")
def found_in_room(installed_blender, tmp_path_factory):
    """What a photo gives in a scan, and in another from whose corner it is not recognized without the first."""
    bpy, folder = installed_blender, tmp_path_factory.mktemp("room")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    place = {"center": (1.6, 1.5, 0.4), "yaw_deg": 25}
    corner = painted_room.scan(name="corner", **place)
    write_small_ptx(folder / "room.ptx", painted_room.scan())
    write_small_ptx(folder / "corner.ptx", corner, np.eye(4))
    photo = painted_room.photo(painted_room.camera((0.3, 0, 0), yaw_deg=8, pitch_deg=-6, focal=1.0))
    cv2.imwrite(str(folder / "view.png"), photo[..., ::-1])
    for name in ("corner", "room"):
        bpy.ops.reflcolor.import_scan(filepath=str(folder / f"{name}.ptx"))
    bpy.data.objects["corner"].location = place["center"]
    bpy.data.objects["corner"].rotation_euler.z = np.radians(place["yaw_deg"])
    bpy.data.objects["corner"].select_set(True)
    bpy.ops.reflcolor.load_photo(filepath=str(folder / "view.png"))
    bpy.ops.reflcolor.match_photos(slic_segments=150)
    activate(bpy, "corner")
    bpy.ops.reflcolor.save_seeds(filepath=str(folder / "seeds.json"))
    return SimpleNamespace(
        verdicts={name: verdicts(bpy.data.objects[name]) for name in ("room", "corner")},
        seeds=Seeds.load(folder / "seeds.json"),
        seeds_file=(folder / "seeds.json").read_bytes(),
        picture=pixels(state(bpy, "corner").matches_image).tobytes(),
        truth=corner.color,
    )


def test_a_photo_verified_on_one_scan_is_found_on_the_other_by_where_its_object_is(found_in_room):
    for name in ("room", "corner"):
        ((_, verified, _),) = found_in_room.verdicts[name]
        assert verified
    found = [index for index, reason in enumerate(found_in_room.seeds.reason) if reason == "pose"]
    assert len(found) > 20
    seeds = found_in_room.seeds
    truth = found_in_room.truth[seeds.rows[found], seeds.cols[found]].astype(float)
    error = np.abs(seeds.rgb[found] - truth).max(axis=1)
    # A few lie at the border between two patches of paint.
    assert (error < 40).mean() > 0.8


def test_seeds_and_picture_of_matches_are_the_same_bytes_in_every_blender_that_was_tested(
    installed_blender, found_in_room
):
    other = differing_blenders("matches", installed_blender, found_in_room.seeds_file, found_in_room.picture)
    assert other == []
