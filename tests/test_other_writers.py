"""What still other programs write of the kinds of test_cases.py: read as well, or refused where there is no grid."""

import errno

import numpy as np
import pye57
import pytest
from e57_samples import Records, write_e57
from hall import COLOR, HALL, NAMES, e57, fields, ptx
from sample_scans import ptx_text

from reflcolor_addon.errors import ScanError
from reflcolor_addon.files.readers import ReadOptions, read_scans
from reflcolor_addon.files.refusals import unreadable, unwritable
from reflcolor_addon.files.writers.scans_back import ColoredScan, write_scans_back

ANGLE = ReadOptions(grid="angle", position=(0.0, 0.0, 0.0))


def body(text, change):
    """A PTX with its lines of points changed."""
    lines = text.splitlines()
    return "\n".join([*lines[:10], *map(change, lines[10:])]) + "\n"


def without_intensity(line):
    words = line.split()
    return " ".join(words[:3] + words[4:])


def require_hall(scan, atol=1e-9):
    np.testing.assert_allclose(scan.points, HALL, atol=atol)
    np.testing.assert_allclose(scan.reflectance, NAMES, atol=1e-6)


def test_a_ptx_without_intensity_is_a_scan_without_reflectance(tmp_path):
    (scan,) = ptx(tmp_path, body(ptx_text(HALL, NAMES), without_intensity))
    np.testing.assert_array_equal(scan.points, HALL)
    assert not scan.has_reflectance and "has no intensity" in scan.warnings[0]


def test_a_ptx_of_colors_alone_is_colorized_by_their_luminance(tmp_path):
    (scan,) = ptx(tmp_path, body(ptx_text(HALL, NAMES, COLOR), without_intensity))
    np.testing.assert_array_equal(scan.color, COLOR)
    assert scan.has_reflectance and "luminance" in scan.warnings[0]


@pytest.mark.parametrize("color", [None, COLOR])
def test_colors_go_back_into_a_ptx_without_intensity(tmp_path, color):
    (scan,) = ptx(tmp_path, body(ptx_text(HALL, NAMES, color), without_intensity))
    rgb = np.stack([np.full(NAMES.shape, level, np.uint8) for level in (10, 20, 30)], axis=-1)
    write_scans_back([ColoredScan(scan=scan, rgb=rgb, source=scan.source, index=1)], tmp_path / "out.ptx")
    assert all(line.endswith(" 0.500000 10 20 30") for line in (tmp_path / "out.ptx").read_text().splitlines()[10:])
    (again,) = read_scans(tmp_path / "out.ptx")
    np.testing.assert_array_equal(again.points, HALL)


@pytest.mark.parametrize("nothing", ["0 0 0", "0.000 0.000 -0.000"])
def test_three_zeros_alone_are_no_return(tmp_path, nothing):
    lines = ptx_text(HALL, NAMES).splitlines()
    lines[10], lines[500] = nothing, nothing
    (scan,) = ptx(tmp_path, "\n".join(lines))
    assert scan.valid.sum() == NAMES.size - 2 and scan.has_reflectance and not scan.warnings


@pytest.mark.parametrize(
    "change",
    [
        lambda line: line.replace(" ", ","),
        lambda line: line.replace(" ", ", "),
        lambda line: line.replace(" ", ";"),
        lambda line: line.replace(".", ",").replace(" ", ";"),
        lambda line: line.replace(".", ","),
    ],
)
def test_numbers_of_a_ptx_are_parted_by_commas_or_have_them(tmp_path, change):
    text = "\n".join(map(change, ptx_text(HALL, NAMES).splitlines()))
    (scan,) = ptx(tmp_path, text)
    require_hall(scan)
    assert not scan.warnings


def test_a_comma_in_a_line_of_its_own_is_told_with_the_line(tmp_path):
    lines = ptx_text(HALL, NAMES).splitlines()
    lines[30] = lines[30].replace(".", ",", 1)
    with pytest.raises(ScanError, match="line 31: expected a number, found"):
        ptx(tmp_path, "\n".join(lines))


def test_a_list_of_returns_cut_into_lines_of_any_length_has_no_grid(tmp_path):
    header, lines = ptx_text(HALL, NAMES).splitlines()[:10], ptx_text(HALL, NAMES).splitlines()[10:]
    # A program left out what it takes for no return, and states sizes that have the right product.
    lines = [line for number, line in enumerate(lines) if number % 9 != 4]
    header[:2] = ["200", "16"]
    assert len(lines) == 3200
    with pytest.raises(ScanError, match=r"has no grid: .*--grid angle"):
        ptx(tmp_path, "\n".join([*header, *lines]))


def test_returns_sorted_by_their_distance_have_no_grid(tmp_path):
    order = np.argsort(np.linalg.norm(HALL, axis=-1).ravel(), kind="stable")
    points, names = HALL.reshape(-1, 3)[order].reshape(HALL.shape), NAMES.ravel()[order].reshape(NAMES.shape)
    with pytest.raises(ScanError, match="has no grid"):
        e57(tmp_path, fields(points, intensity=names))


@pytest.mark.parametrize("numbered", [True, False])
def test_lines_of_points_have_bounds_of_their_own(tmp_path, numbered):
    points = HALL.swapaxes(0, 1)
    columns = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), points.reshape(-1, 3).T, strict=True))
    columns |= {"intensity": NAMES.T.ravel()}
    if numbered:
        columns |= {"rowIndex": np.tile(np.arange(40), 90), "columnIndex": np.repeat(np.arange(90), 40)}
    bounds = {
        f"{axis}{end}": getattr(points[..., place], find)(axis=1)
        for place, axis in enumerate("xyz")
        for end, find in (("Minimum", "min"), ("Maximum", "max"))
    }
    groups = {
        "idElementName": "columnIndex",
        "groups": Records(
            idElementValue=np.arange(90),
            startPointIndex=40 * np.arange(90),
            pointCount=np.full(90, 40),
            cartesianBounds=bounds,
        ),
    }
    path, out = tmp_path / "hall.e57", tmp_path / "out.e57"
    write_e57(path, {"fields": columns, "pointGroupingSchemes": {"groupingByLine": groups}})
    (scan,) = read_scans(path)
    require_hall(scan)
    write_scans_back([ColoredScan(scan=scan, rgb=COLOR.astype(np.uint8), source=path, index=1)], out)
    (again,) = read_scans(out)
    np.testing.assert_array_equal(again.color, COLOR)
    file, found = pye57.E57(str(out)), np.zeros(90)
    kept = file.root["data3D"][0]["pointGroupingSchemes"]["groupingByLine"]["groups"]
    buffers = pye57.libe57.VectorSourceDestBuffer()
    name = "cartesianBounds/zMaximum"
    buffers.append(pye57.libe57.SourceDestBuffer(file.image_file, name, found, 90, True, True))
    assert kept.reader(buffers).read() == 90
    np.testing.assert_array_equal(found, bounds["zMaximum"])


def test_spherical_coordinates_are_taken_where_the_cartesian_are_no_numbers(tmp_path):
    distance = np.linalg.norm(HALL, axis=-1)
    spherical = {
        "sphericalRange": distance,
        "sphericalAzimuth": np.arctan2(HALL[..., 1], HALL[..., 0]),
        "sphericalElevation": np.arcsin(HALL[..., 2] / distance),
    }
    (scan,) = e57(tmp_path, fields(HALL * np.nan, **spherical))
    require_hall(scan)


TEXTS = {
    "names in another order": ("R G B Intensity X Y Z", "{3} {4} {5} {6:.9f} {0:.9f} {1:.9f} {2:.9f}"),
    "CloudCompare": ("//X Y Z R G B Intensity", "{0:.9f} {1:.9f} {2:.9f} {3} {4} {5} {6:.9f}"),
    "CloudCompare, colors from 0 to 1": ("//X Y Z Rf Gf Bf Intensity", "{0:.9f} {1:.9f} {2:.9f} {7} {8} {9} {6:.9f}"),
    "CloudCompare, no names": ("", "{0:.9f} {1:.9f} {2:.9f} {3} {4} {5} {6:.9f}"),
    "units and a column of its own": (
        '"x[m]";"y[m]";"z[m]";"time";"Reflectance(dB)"',
        "{0:.9f};{1:.9f};{2:.9f};77;{6:.9f}",
    ),
    "decimal commas": ("", "{0:.9f} {1:.9f} {2:.9f} {6:.9f}"),
    "decimal commas between semicolons": ("x;y;z;i", "{0:.9f};{1:.9f};{2:.9f};{6:.9f}"),
}


@pytest.mark.parametrize("kind", TEXTS)
def test_columns_of_a_text_are_those_that_it_names_or_shows(tmp_path, kind):
    names, line = TEXTS[kind]
    hall, names_of_pixels, colors_of_pixels = HALL[::2, ::3], NAMES[::2, ::3], COLOR[::2, ::3]
    values = np.concatenate([hall.reshape(-1, 3), names_of_pixels.reshape(-1, 1)], axis=1)
    colors = colors_of_pixels.reshape(-1, 3).astype(int)
    rows = [line.format(*point[:3], *rgb, point[3], *rgb / 255) for point, rgb in zip(values, colors, strict=True)]
    text = "\n".join(row.replace(".", ",") if "commas" in kind else row for row in rows)
    (tmp_path / "hall.csv").write_text(f"{names}\n{text}\n" if names else text)
    (scan,) = read_scans(tmp_path / "hall.csv", options=ANGLE)
    np.testing.assert_allclose(scan.points, hall, atol=1e-8)
    np.testing.assert_allclose(scan.reflectance, names_of_pixels, atol=1e-6)
    if "{3}" in line or "{7}" in line:
        np.testing.assert_array_equal(scan.color, colors_of_pixels)


def test_a_limit_on_the_size_of_files_is_told_with_what_to_do():
    failure = OSError(errno.EFBIG, "File too large")
    for refusal in (unreadable("hall.e57", failure), unwritable("out.ply", failure)):
        assert "ulimit -f" in str(refusal)


def test_noise_beside_the_scanner_does_not_undo_a_grid(tmp_path):
    points, rng = HALL.copy(), np.random.default_rng(5)
    noisy = rng.random(NAMES.shape) < 0.2
    points[noisy] = rng.normal(0, 0.01, (noisy.sum(), 3))
    (scan,) = e57(tmp_path, fields(points))
    np.testing.assert_array_equal(scan.points, points)
