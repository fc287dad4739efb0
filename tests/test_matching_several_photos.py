"""Transfer of colors, and several photos of one site."""

from dataclasses import replace

import cv2
import numpy as np
import painted_room
import pytest

from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.transfer.fusion import fused
from reflcolor_addon.matching.transfer.rims import islands
from reflcolor_addon.matching.transfer.several_photos import gains
from reflcolor_addon.matching.transfer.sharing import shared
from reflcolor_addon.matching.transfer.surface import GridSurface
from reflcolor_addon.matching.transfer.views import seen_by

SIDES = ((0.0, 0.0, 0.0), (1.2, 0.4, 0.3), (-1.0, 0.2, 0.1))


@pytest.fixture(scope="module")
def room():
    return painted_room.scan()


@pytest.fixture(scope="module")
def surface(room):
    return GridSurface(room)


def view(surface, camera, gain=1.0, changed=None, seed=0):
    """What a camera sees; ``changed(photo)`` paints on its photo."""
    photo = painted_room.photo(camera, gain=gain, seed=seed)
    if changed is not None:
        changed(photo)
    return seen_by(PhotoImage("photo", photo), camera, surface)


def blended(surface, views):
    return fused(views, gains([views]), surface)


def errors(observed, room, where):
    return np.abs(observed.rgb.astype(int) - room.color).max(axis=-1)[where]


def test_what_a_camera_beside_the_scanner_saw_has_its_true_color(room, surface):
    seen = view(surface, painted_room.camera((1.2, 0.4, 0.3), yaw_deg=-10))
    assert seen.usable.mean() > 0.3
    error = np.abs(seen.rgb.astype(int) - room.color).max(axis=-1)[seen.usable]
    # Off by much only at the borders between patches.
    assert np.median(error) <= 2
    assert (error < 40).mean() > 0.85


def test_what_the_box_hides_from_the_camera_gets_no_color(room, surface):
    camera = painted_room.camera((-1.8, 1.0, 0.0), yaw_deg=35)
    seen = view(surface, camera)
    # Points behind the box, seen from the camera: the way to them passes its front.
    behind = room.valid & (room.points[..., 1] > 4.99)
    share = (3.4 - camera.center[1]) / (room.points[..., 1] - camera.center[1] + 1e-9)
    x = camera.center[0] + share * (room.points[..., 0] - camera.center[0])
    z = camera.center[2] + share * (room.points[..., 2] - camera.center[2])
    hidden = behind & (x > 0.5) & (x < 1.3) & (z < 0.0)
    assert hidden.sum() > 50
    assert seen.usable[hidden].mean() < 0.05


def test_a_coarse_surface_hides_what_is_behind_it_between_its_points():
    coarse = painted_room.scan(rows=30, columns=44, step_deg=1.5)
    camera = painted_room.camera((-1.8, 1.0, 0.0), yaw_deg=35)
    seen = view(GridSurface(coarse), camera)
    behind = coarse.valid & (coarse.points[..., 1] > 4.99)
    share = (3.4 - camera.center[1]) / (coarse.points[..., 1] - camera.center[1] + 1e-9)
    x = camera.center[0] + share * (coarse.points[..., 0] - camera.center[0])
    hidden = behind & (x > 0.5) & (x < 1.3) & (coarse.points[..., 2] < -0.4)
    assert hidden.sum() > 5
    assert not seen.usable[hidden].any()


def test_what_may_lie_behind_a_pane_of_glass_is_doubtful(room):
    # A window in the back wall, without a return, and beside it pixels of what a camera would see through it.
    camera = painted_room.camera((-1.0, 1.0, 0.0), yaw_deg=0)
    wall = room.valid & (room.points[..., 1] > 4.99)
    rows, cols = (np.arange(length) for length in room.shape)
    window = wall & (np.abs(rows - 50) < 8)[:, None] & (np.abs(cols - 80) < 10)
    beyond = wall & (np.abs(rows - 50) < 4)[:, None] & (np.abs(cols - 120) < 6)
    assert window.sum() > 200 and beyond.sum() > 50
    points = room.points.copy()
    pane = room.points[window].mean(axis=0)
    points[beyond] = camera.center + 1.4 * (pane - camera.center) + 0.1 * (points[beyond] - points[beyond].mean(axis=0))
    seen = view(GridSurface(replace(room, points=points, valid=room.valid & ~window)), camera)
    assert (seen.doubtful | ~seen.usable)[beyond].mean() > 0.95
    inner = wall & ~beyond & (np.abs(cols - 55) < 10)
    assert seen.sure[inner].mean() > 0.6


def test_pixels_beside_a_jump_are_doubtful(room, surface):
    seen = view(surface, painted_room.camera())
    jump = np.abs(np.diff(room.range, axis=1)) > 0.5
    jump &= room.valid[:, 1:] & room.valid[:, :-1]
    assert jump.any()
    assert not seen.sure[:, 1:][jump].any()
    assert not seen.sure[:, :-1][jump].any()


@pytest.mark.parametrize("zoom", [1.006, 1.01])
def test_a_camera_that_is_off_paints_no_ghost_beside_an_outline(room, surface, zoom):
    # The box is red, the wall behind it white: everything that is reddish on the wall is a ghost.
    right = painted_room.camera((0.9, 0.3, 0.1), yaw_deg=-5)
    seen_right = view(surface, right)
    box = room.valid & (np.abs(room.points[..., 1] - 3.4) < 1e-6)
    wall = room.valid & (room.points[..., 1] > 4.99)
    photo = painted_room.photo(right)
    photo[...] = 230
    xy = right.project(room.points[box])[0]
    inside = ((xy >= 0) & (xy < [right.width, right.height])).all(axis=1)
    low, high = np.floor(xy[inside].min(axis=0)).astype(int), np.ceil(xy[inside].max(axis=0)).astype(int)
    photo[low[1] : high[1], low[0] : high[0]] = (200, 20, 20)
    off = replace(right, rotation=right.rotation, center=right.center, focal_px=right.focal_px * zoom)
    observed = fused([seen_by(PhotoImage("photo", photo), off, surface)], np.ones((1, 3)), surface)
    assert seen_right.usable[wall].mean() > 0.3
    reddish = observed.rgb[..., 0].astype(int) - observed.rgb[..., 1] > 60
    assert reddish[box & observed.seen].mean() > 0.9
    assert not (reddish & wall & observed.seen).any()


def test_a_small_part_that_is_cut_off_and_mostly_doubtful_is_left_out():
    seen, sure = np.zeros((60, 80), bool), np.zeros((60, 80), bool)
    seen[:40], sure[5:40] = True, True
    doubtful, trusted, large = np.s_[45:50, 5:10], np.s_[45:50, 20:25], np.s_[45:60, 40:80]
    for part in (doubtful, trusted, large):
        seen[part] = True
    sure[45:47, 5:10], sure[45:48, 20:25] = True, True
    expected = np.zeros_like(seen)
    expected[doubtful] = True
    np.testing.assert_array_equal(islands(seen, sure), expected)
    assert not islands(np.zeros_like(seen), sure).any()


def test_what_a_camera_beside_the_scanner_sees_through_a_gap_is_left_out(room, surface):
    ahead, aside = (view(surface, painted_room.camera(place)) for place in SIDES[:2])
    gap = np.zeros(room.shape, bool)
    rows, cols = np.nonzero(ahead.usable & aside.usable & (room.points[..., 1] > 4.99))
    middle = len(rows) // 2
    gap[rows[middle] - 3 : rows[middle] + 3, cols[middle] - 3 : cols[middle] + 3] = True
    around = cv2.dilate(gap.astype(np.uint8), np.ones((9, 9))) > 0
    through = [
        replace(seen, usable=seen.usable & (gap | ~around), doubtful=seen.doubtful | gap) for seen in (ahead, aside)
    ]
    from_scanner, from_beside = (blended(surface, [seen]).seen for seen in through)
    assert (gap & through[1].usable).any() and not (gap & from_beside).any()
    assert (gap & from_scanner).any()


def test_a_darker_photo_is_brought_to_the_brightness_of_the_other(surface):
    views = [view(surface, painted_room.camera()), view(surface, painted_room.camera((0.6, 0, 0)), gain=0.7)]
    factors = gains([views])
    assert (factors[1] / factors[0] > 1.5).all()
    np.testing.assert_allclose(np.log(factors).sum(axis=0), 0, atol=1e-6)
    first, second = (
        fused([one if k == index else None for k, one in enumerate(views)], factors, surface) for index in (0, 1)
    )
    both = views[0].sure & views[1].sure
    assert np.median(np.abs(first.rgb[both].astype(int) - second.rgb[both])) <= 4


def test_photos_that_do_not_overlap_keep_their_exposure(surface):
    seen = view(surface, painted_room.camera())
    assert (gains([[seen, None]]) == 1).all()


def test_photos_that_do_not_show_the_same_where_they_overlap_keep_their_exposure(surface):
    camera = painted_room.camera()
    assert (gains([[view(surface, camera), view(surface, camera, seed=1, gain=0.6)]]) == 1).all()


def test_without_a_photo_nothing_is_observed(surface):
    assert fused([None, None], np.ones((2, 3)), surface) is None


def test_what_one_of_three_photos_shows_alone_is_left_out(room, surface):
    def person(photo):
        photo[80:300, 200:280] = (20, 160, 60)

    cameras = [painted_room.camera(center) for center in SIDES]
    views = [view(surface, camera, changed=person if k == 0 else None) for k, camera in enumerate(cameras)]
    observed = blended(surface, views)
    painted = views[0].sure & (np.abs(views[0].rgb.astype(int) - (20, 160, 60)).max(axis=-1) < 8)
    others = painted & (views[1].sure | views[2].sure)
    assert others.sum() > 1000
    # Alone, the first photo has it everywhere; with the others next to nowhere.
    assert np.median(errors(fused(views[:1], np.ones((1, 3)), surface), room, others)) > 60
    assert (errors(observed, room, others) > 60).mean() < 0.05


def test_where_two_photos_disagree_the_color_that_its_surroundings_tell_is_taken(room, surface):
    # A wall of one color in both photos; in one of them something stands before it.
    plain = replace(room, reflectance=np.where(room.valid, 0.5, 0).astype(np.float32))
    cameras = [painted_room.camera(center) for center in SIDES[:2]]
    for with_it in (0, 1):
        views = []
        for number, camera in enumerate(cameras):
            photo = np.full((camera.height, camera.width, 3), (190, 170, 140), np.uint8)
            if number == with_it:
                photo[120:260, 200:290] = (30, 40, 120)
            views.append(seen_by(PhotoImage(str(number), photo), camera, GridSurface(plain)))
        observed = fused(views, np.ones((2, 3)), GridSurface(plain))
        both = views[0].sure & views[1].sure
        blue = observed.rgb[..., 2].astype(int) - observed.rgb[..., 0] > 40
        assert (views[with_it].rgb[..., 2].astype(int) - views[with_it].rgb[..., 0] > 40)[both].sum() > 500
        assert not blue[both].any()


def test_no_seam_shows_where_one_photo_takes_over_from_another(room, surface):
    # One color everywhere, but the second photo gets darker from the left to the right.
    cameras = [painted_room.camera((-0.5, 0.0, 0.0), yaw_deg=12), painted_room.camera((0.5, 0.0, 0.0), yaw_deg=-12)]
    views = []
    for number, camera in enumerate(cameras):
        light = np.linspace(1.0, 0.85, camera.width)[:, None] if number else np.ones((camera.width, 1))
        photo = np.broadcast_to(np.rint(light * (180, 160, 140)).astype(np.uint8), (camera.height, camera.width, 3))
        views.append(seen_by(PhotoImage(str(number), np.ascontiguousarray(photo)), camera, surface))
    observed = blended(surface, views)
    assert set(np.unique(observed.photo)) == {-1, 0, 1}
    neighbors = observed.seen[:, 1:] & observed.seen[:, :-1]
    step = np.abs(np.diff(observed.rgb.astype(int), axis=1)).max(axis=-1)
    border = neighbors & (observed.photo[:, 1:] != observed.photo[:, :-1])
    # Beside the box the wall is in one photo only, in a strip that is too narrow to blend over.
    border &= cv2.dilate(surface.edge.astype(np.uint8), np.ones((17, 17), np.uint8))[:, 1:] == 0
    assert border.sum() > 50
    # Without blending most are 9 and more.
    assert np.quantile(step[border], 0.95) <= 4


def test_the_photo_that_saw_best_leads(surface):
    # The first has half a pixel for one of the scan.
    views = [view(surface, painted_room.camera(width=160, height=120)), view(surface, painted_room.camera((0.2, 0, 0)))]
    observed = blended(surface, views)
    both = views[0].sure & views[1].sure & (views[1].quality > 1.2 * views[0].quality)
    assert both.sum() > 200
    assert (observed.photo[both] == 1).mean() > 0.9


def test_what_no_photo_saw_has_no_weight_and_no_photo(surface):
    observed = blended(surface, [view(surface, painted_room.camera())])
    assert observed.rgb.dtype == np.uint8 and observed.weight.dtype == np.float32 and observed.photo.dtype == np.int16
    assert ((observed.photo >= 0) == (observed.weight > 0)).all()
    assert not observed.rgb[~observed.seen].any()
    assert not observed.weight[~surface.scan.valid].any()
    assert observed.weight.min() >= 0 and observed.weight.max() == 1


def test_what_one_scan_has_from_a_photo_serves_another_that_sees_the_same_surface(room, surface):
    observed = blended(surface, [view(surface, painted_room.camera())])
    other = painted_room.scan(rows=100, columns=140, step_deg=0.4, name="other", center=(0.8, 0.6, 0.3), yaw_deg=4)
    given, taken = shared([surface, GridSurface(other)], [observed, None])
    assert given is observed
    # Off by much only at the borders between patches.
    assert taken.seen.sum() > 0.6 * other.valid.sum()
    assert (errors(taken, other, taken.seen) < 40).mean() > 0.85
    assert (taken.photo[taken.seen] == 0).all()
    assert not taken.seen[~other.valid].any()


def test_scans_of_the_same_pose_share_nothing(surface, room):
    observed = blended(surface, [view(surface, painted_room.camera())])
    assert shared([surface, GridSurface(replace(room, name="copy"))], [observed, None]) == [observed, None]
