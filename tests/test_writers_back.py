"""The colors back into E57 and PTX, read by plain pye57 and by NumPy."""

import json

import numpy as np
import pye57
import pytest
from command_line import COLORIZE, SHAPE
from e57_samples import write_e57 as write_sample
from sample_scans import ptx_text
from small_scans import random_scan
from test_cases import COLOR, HALL, NAMES, fields

from reflcolor_addon.errors import Cancelled, OutputError
from reflcolor_addon.files.readers import ReadOptions, read_scans
from reflcolor_addon.files.whole import fault_of
from reflcolor_addon.files.writers import write_e57
from reflcolor_addon.files.writers.e57_colors import write_e57_colors
from reflcolor_addon.files.writers.ptx_colors import write_ptx_colors
from reflcolor_addon.files.writers.scans_back import ColoredScan, write_scans_back

RGB = ("colorRed", "colorGreen", "colorBlue")


def records(path, index=0):
    """Every field of a scan's points, as plain pye57 reads them."""
    return pye57.E57(str(path)).read_scan_raw(index, ignore_unsupported_fields=True)


def given_colors(scans, seed=7):
    rng = np.random.default_rng(seed)
    return {index: rng.integers(0, 256, (*scan.shape, 3), np.uint8) for index, scan in enumerate(scans)}


@pytest.mark.parametrize(
    ("path", "options"),
    [
        ("pumpA/pumpAVisualReferenceImage.e57", {}),
        ("cases/e57_site_coordinates.e57", {"turn_deg": 90, "flip_vertical": True}),
        ("cases/e57_every_third_row_and_column.e57", {}),
        ("cases/e57_grouping_by_line_only.e57", {}),
        ("cases/e57_unordered_in_a_rectangle.e57", {"grid": "angle"}),
        ("cases/e57_color_0_to_1_without_limits.e57", {}),
    ],
)
def test_an_e57_comes_back_with_its_points_and_the_given_colors(data_dir, tmp_path, path, options):
    options, made = ReadOptions(**options), tmp_path / "made.e57"
    scans = read_scans(data_dir / path, options=options)
    colors = given_colors(scans)
    assert write_e57_colors(data_dir / path, colors, made, options=options) == []
    assert fault_of(made) is None
    before, after = records(data_dir / path), records(made)
    for name in before.keys() - set(RGB):
        np.testing.assert_array_equal(after[name], before[name])
    assert set(RGB) <= after.keys()
    for old, new, rgb in zip(scans, read_scans(made, options=options), colors.values(), strict=True):
        assert new.name == old.name or old.name == (data_dir / path).stem
        np.testing.assert_array_equal(new.color[new.valid], rgb[old.valid])
        np.testing.assert_array_equal(new.points, old.points)
        np.testing.assert_array_equal(new.pose, old.pose)


def test_what_else_an_e57_holds_is_kept(data_dir, tmp_path):
    source, made = data_dir / "pumpA" / "pumpAVisualReferenceImage.e57", tmp_path / "made.e57"
    write_e57_colors(source, given_colors(read_scans(source)), made)
    before, after = (pye57.libe57.ImageFile(str(path), "r") for path in (source, made))
    assert described(after.root()) == {
        **described(before.root()),
        **{
            f"/data3D/0/colorLimits/{name}{end}": value
            for name in RGB
            for end, value in (("Minimum", 0), ("Maximum", 255))
        },
    }
    sizes = [
        image.root()["images2D"][0]["visualReferenceRepresentation"]["jpegImage"].byteCount()
        for image in (before, after)
    ]
    assert sizes[0] == sizes[1] > 1000
    contents = []
    for image, size in zip((before, after), sizes, strict=True):
        data = bytearray(size)
        image.root()["images2D"][0]["visualReferenceRepresentation"]["jpegImage"].read(data, 0, size)
        contents.append(bytes(data))
    assert contents[0] == contents[1]


def described(node, path=""):
    """Values of all leaves of a file, by their path."""
    lib = pye57.libe57
    if isinstance(node, lib.StructureNode | lib.VectorNode):
        found = {}
        for place in range(node.childCount()):
            name = node.get(place).elementName()
            found |= described(node[name if isinstance(node, lib.StructureNode) else place], f"{path}/{name}")
        return found
    if isinstance(node, lib.CompressedVectorNode):
        return {path: node.childCount()}
    getter = {lib.BlobNode: "byteCount", lib.ScaledIntegerNode: "scaledValue"}.get(type(node), "value")
    return {path: getattr(node, getter)()}


def test_points_that_are_no_part_of_the_scan_have_no_color_and_are_counted(tmp_path):
    state = np.zeros(NAMES.shape, int)
    state[3, 4:9] = 2
    source, made = tmp_path / "hall.e57", tmp_path / "made.e57"
    write_sample(source, fields(cartesianInvalidState=state), fields() | {"name": "other"})
    scans = read_scans(source)
    colors = given_colors(scans)
    warnings = write_e57_colors(source, {0: colors[0]}, made)
    assert warnings == ["made.e57: scan 'hall 1': 5 of 3,600 points have no color: they are not part of its grid"]
    # The other scan, which was given none, has none.
    assert not set(RGB) & records(made, 1).keys()
    assert "isColorInvalid" in pye57.E57(str(made)).get_header(0).point_fields
    back = read_scans(made)
    np.testing.assert_array_equal(back[0].color[back[0].valid], colors[0][scans[0].valid])
    assert back[1].name == "other" and back[1].color is None


def test_every_point_of_a_thinned_grid_gets_the_color_of_its_pixel(tmp_path):
    keep = np.random.default_rng(0).random(NAMES.shape) < 0.3
    source, made = tmp_path / "hall.e57", tmp_path / "made.e57"
    write_sample(source, fields(keep=keep))
    (scan,) = read_scans(source)
    assert write_e57_colors(source, {0: np.full((*scan.shape, 3), (9, 8, 7), np.uint8)}, made) == []
    found = np.stack([records(made)[name] for name in RGB], axis=1)
    assert (found == (9, 8, 7)).all() and len(found) == keep.sum()


def test_a_file_that_has_changed_is_told_and_nothing_is_left(tmp_path):
    source, made = tmp_path / "hall.e57", tmp_path / "made.e57"
    write_sample(source, fields())
    with pytest.raises(OutputError, match=r"hall\.e57 has changed since its scans were read"):
        write_e57_colors(source, {0: np.zeros((3, 4, 3), np.uint8)}, made)
    with pytest.raises(Cancelled):
        write_e57_colors(source, {0: np.zeros((*NAMES.shape, 3), np.uint8)}, made, cancelled=lambda: True)
    assert [path.name for path in tmp_path.iterdir()] == ["hall.e57"]


@pytest.mark.parametrize("by_rows", [False, True])
def test_a_ptx_comes_back_word_by_word_with_the_given_colors(tmp_path, by_rows):
    source, made = tmp_path / "hall.ptx", tmp_path / "made.ptx"
    lines = ptx_text(HALL, NAMES, COLOR).splitlines(keepends=True)
    body = np.array(lines[10:]).reshape(90, 40)
    text = "".join(lines[:10]) + "".join((body.T if by_rows else body).ravel())
    source.write_text(text + ptx_text(HALL[:5], NAMES[:5]) + "\x1a")
    scans = read_scans(source)
    colors = given_colors(scans)
    assert write_ptx_colors(source, {0: colors[0]}, made) == []
    assert fault_of(made) is None
    back = read_scans(made)
    np.testing.assert_array_equal(back[0].color, colors[0])
    np.testing.assert_array_equal(back[1].reflectance, NAMES[:5])
    assert back[1].color is None
    old, new = (path.read_text().split() for path in (source, made))
    assert old[:25] == new[:25]
    table = [np.loadtxt(path, skiprows=10, max_rows=3600) for path in (source, made)]
    np.testing.assert_array_equal(table[0][:, :4], table[1][:, :4])


def test_of_a_ptx_that_is_cut_short_the_whole_columns_come_back(tmp_path):
    source, made = tmp_path / "hall.ptx", tmp_path / "made.ptx"
    lines = ptx_text(HALL, NAMES).splitlines(keepends=True)
    source.write_text("".join(lines[:-50]))
    scans = read_scans(source)
    write_ptx_colors(source, given_colors(scans), made)
    (back,) = read_scans(made)
    assert fault_of(made) is None and back.shape == scans[0].shape == (40, 88)
    np.testing.assert_array_equal(back.points, scans[0].points)
    np.testing.assert_array_equal(back.color, given_colors(scans)[0])


def test_of_a_ptx_whose_second_scan_is_cut_short_what_is_left_out_is_counted(tmp_path):
    source, made = tmp_path / "hall.ptx", tmp_path / "made.ptx"
    whole = ptx_text(HALL, NAMES)
    source.write_text(whole + "\x1a\n" + "".join(whole.splitlines(keepends=True)[:30]))
    scans = read_scans(source)
    (warning,) = write_ptx_colors(source, given_colors(scans), made)
    assert "30 lines at the end of hall.ptx" in warning
    (back,) = read_scans(made)
    np.testing.assert_array_equal(back.color, given_colors(scans)[0])


def test_a_line_that_only_ends_a_file_may_stand_between_scans(tmp_path):
    source, made = tmp_path / "hall.ptx", tmp_path / "made.ptx"
    source.write_text(ptx_text(HALL, NAMES) + "\x1a\n" + ptx_text(HALL[:5], NAMES[:5]))
    scans = read_scans(source)
    assert write_ptx_colors(source, given_colors(scans), made) == []
    assert [back.shape for back in read_scans(made)] == [scan.shape for scan in scans]


def test_two_copies_of_one_scan_have_no_room_in_its_file(tmp_path):
    source = tmp_path / "hall.ptx"
    source.write_text(ptx_text(HALL, NAMES))
    (scan,) = read_scans(source)
    rgb = given_colors([scan])[0]
    twice = [ColoredScan(scan=scan, rgb=colors, source=source, index=1) for colors in (rgb, 255 - rgb)]
    with pytest.raises(OutputError, match=r"made.ptx: two of the scans are the same scan of hall.ptx"):
        write_scans_back(twice, tmp_path / "made.ptx")
    assert not (tmp_path / "made.ptx").exists()


@pytest.mark.parametrize("suffix", [".e57", ".ptx"])
def test_scans_of_other_formats_are_made_anew_and_what_is_lost_is_told(tmp_path, suffix):
    scans = [random_scan(number, SHAPE) for number in (1, 2)]
    colors = given_colors(scans)
    colored = [ColoredScan(scan=scan, rgb=colors[index]) for index, scan in enumerate(scans)]
    (warning,) = write_scans_back(colored, tmp_path / f"site{suffix}")
    assert "written anew" in warning
    for scan, rgb, back in zip(scans, colors.values(), read_scans(tmp_path / f"site{suffix}"), strict=True):
        np.testing.assert_allclose(back.points, scan.points, rtol=0, atol=1e-9)
        np.testing.assert_array_equal(back.color, rgb)


@pytest.mark.parametrize(("source", "made"), [("ptx", "ptx"), ("e57", "e57"), ("ptx", "e57"), ("e57", "ptx")])
def test_the_command_writes_colors_back(run_cli, cli_folder, source, made):
    if source == "e57":
        write_e57(read_scans(cli_folder / "garage.ptx"), cli_folder / "garage.e57")
    line = [f"garage.{source}" if word == "garage.ptx" else word for word in COLORIZE]
    status, _, err = run_cli(*line, "-o", "a.ply", "-o", f"made.{made}", "--report", "r.json")
    assert status == 0 and ("written anew" in err) == (source != made)
    (before,), (after,) = read_scans(cli_folder / f"garage.{source}"), read_scans(cli_folder / f"made.{made}")
    (colored,) = read_scans(cli_folder / "a.ply")
    np.testing.assert_allclose(after.points, before.points, rtol=0, atol=1e-9)
    np.testing.assert_array_equal(after.color[after.valid], colored.color[colored.valid])
    outputs = json.loads((cli_folder / "r.json").read_text(encoding="utf-8"))["outputs"]
    assert {entry["path"] for entry in outputs if "sha256" in entry} == {"a.ply", f"made.{made}"}


@pytest.mark.parametrize("suffix", [".ptx", ".e57"])
def test_a_scan_that_the_file_does_not_have_is_told(tmp_path, suffix):
    source = tmp_path / f"hall{suffix}"
    if suffix == ".ptx":
        source.write_text(ptx_text(HALL, NAMES / NAMES.max()))
        write = write_ptx_colors
    else:
        write_e57([random_scan(shape=HALL.shape[:2])], source)
        write = write_e57_colors
    for number in (-1, 1):
        with pytest.raises(OutputError, match=r"made.* has changed since its scans were read"):
            write(source, {number: COLOR}, tmp_path / f"made{suffix}")
        assert not (tmp_path / f"made{suffix}").exists()
