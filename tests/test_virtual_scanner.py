"""The virtual scanner against walls and spheres whose ranges are known in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reflcolor_addon.errors import Cancelled, SettingsError
from reflcolor_addon.scan.directions import directions
from reflcolor_addon.simulation.virtual_scanner import Hits, ScannerModel, simulate_scan
from reflcolor_addon.srgb import linear_to_srgb8


def wall(distance, *, albedo=0.5, color=(10, 20, 30)):
    """Cast onto the plane y = distance."""

    def cast(azimuths_deg, elevations_deg):
        rays = directions(azimuths_deg, elevations_deg)
        ahead = rays[..., 1]
        ranges = np.where(ahead > 1e-9, distance / np.maximum(ahead, 1e-9), np.inf)
        return Hits(
            range=ranges,
            cos_incidence=-ahead,
            albedo=np.full(ranges.shape, albedo),
            color=np.broadcast_to(np.array(color, np.uint8), (*ranges.shape, 3)),
        )

    return cast


def step_at_azimuth_zero(near, far):
    """Cast onto a sphere of radius ``near`` left of azimuth 0 and of radius ``far`` right of it."""

    def cast(azimuths_deg, elevations_deg):
        shape = (len(elevations_deg), len(azimuths_deg))
        ranges = np.broadcast_to(np.where(np.asarray(azimuths_deg) < 0, near, far), shape)
        return Hits(
            range=ranges, cos_incidence=np.ones(shape), albedo=np.ones(shape), color=np.zeros((*shape, 3), np.uint8)
        )

    return cast


SMALL = ScannerModel(rows=12, columns=20, azimuth_deg=(-20, 20), elevation_deg=(-12, 12)).ideal()


def test_an_ideal_scan_of_a_wall_has_every_point_on_the_wall():
    scan, _ = simulate_scan(wall(5.0), SMALL)
    assert scan.valid.all()
    assert scan.points[..., 1] == pytest.approx(5.0)


def test_points_run_left_to_right_and_top_to_bottom():
    scan, _ = simulate_scan(wall(5.0), SMALL)
    assert (np.diff(scan.points[..., 0], axis=1) > 0).all()
    assert (np.diff(scan.points[..., 2], axis=0) < 0).all()


def test_pixel_centers_lie_half_a_step_inside_the_edges():
    model = ScannerModel(rows=4, columns=8, azimuth_deg=(-180, 180), elevation_deg=(-40, 40))
    assert model.azimuths_deg()[[0, -1]] == pytest.approx([-157.5, 157.5])
    assert model.elevations_deg()[[0, -1]] == pytest.approx([30, -30])
    assert model.step_deg == pytest.approx((20, 45))


def test_steps_need_not_be_square():
    model = replace(SMALL, rows=48, columns=10)
    scan, _ = simulate_scan(wall(5.0), model)
    assert scan.step_deg == pytest.approx((0.5, 4.0), rel=1e-6)


def test_a_full_turn_is_recognized_as_one():
    model = replace(SMALL, columns=72, azimuth_deg=(-180, 180))
    scan, _ = simulate_scan(step_at_azimuth_zero(3.0, 4.0), model)
    assert scan.full_turn


def test_signal_follows_albedo_incidence_and_range():
    model = replace(SMALL, range_falloff=2.0, incidence_falloff=1.0, reference_range_m=3.0, reflectance_gain=0.9)
    scan, _ = simulate_scan(wall(5.0, albedo=0.4), model)
    cosine = 5.0 / scan.range
    expected = 0.9 * 0.4 * cosine * (3.0 / scan.range) ** 2
    assert scan.reflectance == pytest.approx(expected, abs=1 / 65535)


def test_a_retroreflector_saturates_at_one():
    scan, _ = simulate_scan(wall(1.0, albedo=5.0), SMALL)
    assert scan.reflectance.max() == 1.0


def test_readings_have_the_bits_of_the_sensor():
    scan, _ = simulate_scan(wall(5.0), replace(SMALL, reflectance_bits=4))
    assert scan.reflectance * 15 == pytest.approx(np.round(scan.reflectance * 15), abs=1e-5)


def test_ranges_are_multiples_of_the_range_step():
    scan, _ = simulate_scan(wall(5.0), replace(SMALL, range_step_m=0.01))
    assert scan.range / 0.01 == pytest.approx(np.round(scan.range / 0.01), abs=1e-6)


def test_nothing_returns_from_beyond_the_range_limits():
    scan, _ = simulate_scan(wall(5.0), replace(SMALL, range_limits_m=(0.5, 5.1)))
    assert np.array_equal(scan.valid, 5.0 / directions(SMALL.azimuths_deg(), SMALL.elevations_deg())[..., 1] <= 5.1)
    assert 0 < scan.valid.sum() < scan.valid.size


def test_a_black_surface_gives_no_return():
    scan, truth = simulate_scan(wall(5.0, albedo=0.001), replace(SMALL, detection_limit=0.01))
    assert not scan.valid.any()
    assert not truth.any()


def test_nothing_to_hit_gives_no_return():
    scan, _ = simulate_scan(wall(5.0), replace(SMALL, azimuth_deg=(120, 160)))
    assert not scan.valid.any()


def test_truth_is_the_color_of_the_surface():
    _, truth = simulate_scan(wall(5.0, color=(7, 8, 9)), SMALL)
    assert (truth == (7, 8, 9)).all()


def test_truth_of_a_mixed_pixel_is_the_light_of_its_surfaces_together():
    def cast(azimuths_deg, elevations_deg):
        hits = step_at_azimuth_zero(3.0, 3.1)(azimuths_deg, elevations_deg)
        return replace(hits, color=np.where(hits.range[..., None] < 3.05, 255, 0).astype(np.uint8).repeat(3, axis=-1))

    model = replace(SMALL, columns=21, azimuth_deg=(-21, 21), beam_deg=1.0)
    _, truth = simulate_scan(cast, model)
    # Two of the five rays, with 0.3 of the energy, go left of the edge.
    assert (truth[:, 10] == linear_to_srgb8([0.3] * 3)).all()
    assert (truth[:, :10] == 255).all()
    assert (truth[:, 11:] == 0).all()


def test_range_noise_has_the_given_spread():
    model = ScannerModel(rows=200, columns=200, range_noise_m=0.004, range_step_m=0, dropout_rate=0, beam_deg=0)
    scan, _ = simulate_scan(step_at_azimuth_zero(3.0, 3.0), model)
    assert np.std(scan.range) == pytest.approx(0.004, rel=0.03)


def test_range_noise_grows_as_the_signal_weakens():
    model = ScannerModel(rows=200, columns=200, range_noise_m=0.001, range_step_m=0, beam_deg=0, dropout_rate=0)
    model = replace(model, detection_limit=0)
    spread = [np.std(simulate_scan(wall_facing(a), model)[0].range[100:]) for a in (1.0, 0.25, 0.01)]
    assert spread[1] / spread[0] == pytest.approx(2, rel=0.05)
    assert spread[2] / spread[0] == pytest.approx(4, rel=0.05)


def wall_facing(albedo):
    """Cast onto a sphere of 3 m around the scanner."""

    def cast(azimuths_deg, elevations_deg):
        hits = step_at_azimuth_zero(3.0, 3.0)(azimuths_deg, elevations_deg)
        return replace(hits, albedo=np.full(hits.range.shape, albedo))

    return cast


def test_speckle_has_the_given_relative_spread():
    model = ScannerModel(rows=200, columns=200, reflectance_noise=0.05, beam_deg=0)
    scan, _ = simulate_scan(wall_facing(0.5), model)
    inside = scan.reflectance[scan.valid]
    assert np.std(inside) / np.mean(inside) == pytest.approx(0.05, rel=0.05)


def test_the_given_share_of_pixels_drops_out():
    scan, _ = simulate_scan(wall_facing(0.5), ScannerModel(rows=200, columns=200, dropout_rate=0.1))
    assert 1 - scan.valid.mean() == pytest.approx(0.1, abs=0.01)


def test_a_jump_within_the_echo_length_gives_mixed_pixels_between_the_surfaces():
    model = replace(SMALL, columns=21, azimuth_deg=(-21, 21), beam_deg=1.0, echo_length_m=0.5)
    scan, _ = simulate_scan(step_at_azimuth_zero(3.0, 3.4), model)
    middle = scan.range[:, 10]
    assert ((middle > 3.05) & (middle < 3.35)).all()
    assert scan.range[:, 9] == pytest.approx(3.0)
    assert scan.range[:, 11] == pytest.approx(3.4)


def test_a_jump_beyond_the_echo_length_gives_the_stronger_surface():
    model = replace(SMALL, columns=21, azimuth_deg=(-21, 21), beam_deg=1.0, echo_length_m=0.5)
    scan, _ = simulate_scan(step_at_azimuth_zero(3.0, 9.0), model)
    assert np.isin(np.round(scan.range[:, 10], 9), (3.0, 9.0)).all()


def test_the_same_seed_gives_the_same_scan_and_another_seed_another():
    scans = [simulate_scan(wall(5.0), ScannerModel(rows=30, columns=40, seed=seed))[0] for seed in (3, 3, 4)]
    assert scans[0].points.tobytes() == scans[1].points.tobytes()
    assert scans[0].reflectance.tobytes() == scans[1].reflectance.tobytes()
    assert scans[0].points.tobytes() != scans[2].points.tobytes()


def test_cancelling_ends_the_scan():
    with pytest.raises(Cancelled):
        simulate_scan(wall(5.0), SMALL, cancelled=lambda: True)


def test_progress_ends_at_one():
    told = []
    simulate_scan(wall(5.0), replace(SMALL, beam_deg=0.1), progress=lambda fraction, text: told.append(fraction))
    assert told == sorted(told)
    assert told[-1] == 1.0


@settings(max_examples=50, deadline=None)
@given(
    rows=st.integers(1, 9),
    columns=st.integers(1, 9),
    distance=st.floats(0.2, 50),
    seed=st.integers(0, 2**32 - 1),
    beam_deg=st.floats(0, 2),
)
def test_every_return_lies_on_the_ray_of_its_pixel(rows, columns, distance, seed, beam_deg):
    model = ScannerModel(rows=rows, columns=columns, seed=seed, beam_deg=beam_deg, dropout_rate=0.2)
    scan, _ = simulate_scan(wall(distance), model)
    rays = directions(model.azimuths_deg(), model.elevations_deg())
    assert scan.points == pytest.approx(rays * scan.range[..., None], abs=1e-9)
    assert (scan.reflectance[scan.valid] <= 1).all()


@pytest.mark.parametrize(
    "wrong",
    [
        {"rows": 0},
        {"rows": 1.5},
        {"rows": 10**6, "columns": 10**6},
        {"azimuth_deg": (10, 10)},
        {"azimuth_deg": (-200, 200)},
        {"elevation_deg": (-91, 10)},
        {"elevation_deg": (20, 10)},
        {"range_limits_m": (5, 2)},
        {"range_noise_m": -0.1},
        {"beam_deg": float("nan")},
        {"reflectance_bits": 17},
        {"dropout_rate": 1.5},
        {"seed": -1},
    ],
)
def test_a_setting_out_of_range_is_named(wrong):
    with pytest.raises(SettingsError, match=next(iter(wrong)).split("_")[0]):
        ScannerModel(**wrong)
