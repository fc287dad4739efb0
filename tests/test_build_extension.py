"""The tool that makes the zip: what it stages, that its output is reproducible, and its error messages."""

import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from build_extension import (
    BUDGETS,
    MANIFEST,
    PLATFORMS,
    BuildError,
    build,
    matching_wheels,
    read_pins,
    require_budget,
    sha256,
    stage_sources,
    staged_manifest,
    write_reproducibly,
    zip_path,
)


def make_zip(path, names, date):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in names:
            archive.writestr(zipfile.ZipInfo(name, date), f"content of {name}")
    return path


def test_same_content_gives_the_same_bytes(tmp_path):
    first = make_zip(tmp_path / "first.zip", ["a.py", "b/c.py", "d"], (2020, 1, 2, 3, 4, 6))
    second = make_zip(tmp_path / "second.zip", ["d", "b/c.py", "a.py"], (2024, 5, 6, 7, 8, 10))
    write_reproducibly(first, tmp_path / "x.zip")
    write_reproducibly(second, tmp_path / "y.zip")
    assert (tmp_path / "x.zip").read_bytes() == (tmp_path / "y.zip").read_bytes()
    with zipfile.ZipFile(tmp_path / "x.zip") as archive:
        assert {name: archive.read(name).decode() for name in archive.namelist()} == {
            name: f"content of {name}" for name in ("a.py", "b/c.py", "d")
        }


def test_staged_manifest_adds_platform_and_wheels_and_keeps_the_rest():
    wheels = ["./wheels/a-1-py3-none-any.whl", "./wheels/b-2-py3-none-any.whl"]
    staged = tomllib.loads(staged_manifest("linux-x64", wheels))
    assert staged.pop("platforms") == ["linux-x64"]
    assert staged.pop("wheels") == wheels
    assert staged == tomllib.loads(MANIFEST.read_text(encoding="utf-8"))


def test_stage_holds_what_the_manifest_lets_in(tmp_path):
    stage_sources(tmp_path)
    staged = {path.name for path in tmp_path.iterdir()}
    assert {"__init__.py", "LICENSE", "operators", "panels", "reflcolor_addon"} <= staged
    assert not staged & {"tests", "tools", "kernel", "benchmarks", "requirements", ".git"}
    example = {path.name: path.stat().st_size for path in (tmp_path / "examples").rglob("*") if path.is_file()}
    assert set(example) == {"cones.range.png", "cones.reflectance.png", "cones.scan.json", "photo.jpg"}
    assert sum(example.values()) < 700_000
    assert not list(tmp_path.rglob("__pycache__"))


def test_a_zip_above_its_budget_is_refused_and_taken_away(tmp_path, monkeypatch):
    heavy = tmp_path / "heavy.zip"
    heavy.write_bytes(bytes(1_000_001))
    monkeypatch.setitem(BUDGETS, 1, 1.5)
    require_budget(heavy, 1)
    monkeypatch.setitem(BUDGETS, 1, 1)
    with pytest.raises(BuildError, match=r"heavy\.zip would be 1\.0 MB, above its budget of 1 MB"):
        require_budget(heavy, 1)
    assert not heavy.exists()


def test_numpy_is_not_pinned_for_the_zip():
    assert {"opencv-python-headless", "scikit-image", "scipy", "pye57"} <= set(read_pins())
    assert "numpy" not in read_pins()


def test_zip_names_tell_platform_and_python():
    assert zip_path("macos-arm64", ("3.11", "3.13", "3.14")).name.endswith("-macos_arm64.zip")
    assert zip_path("linux-x64", ("3.13",)).name.endswith("-linux_x64-cp313.zip")


def test_a_wheel_that_is_not_the_pinned_one_is_refused(tmp_path):
    wheel = tmp_path / "example_package-1.0-py3-none-any.whl"
    wheel.write_bytes(b"the pinned one")
    pins = {"example-package": f"example-package==1.0 --hash=sha256:{sha256(wheel)}\n"}
    assert matching_wheels(tmp_path, ["example-package"], pins) == [wheel]
    wheel.write_bytes(b"another")
    assert matching_wheels(tmp_path, ["example-package"], pins) is None


@pytest.mark.parametrize(
    ("platform", "reason"), [("windows-arm64", "OpenCV has no wheel for it"), ("amiga", "no such platform")]
)
def test_a_platform_without_wheels_is_refused_with_the_reason(platform, reason):
    with pytest.raises(BuildError, match=reason):
        build(platform, ("3.13",))


def test_every_platform_without_a_package_names_a_pinned_one():
    for platform in PLATFORMS.values():
        assert set(platform.without) <= set(read_pins())


@pytest.mark.parametrize("tool", ["build_extension.py", "release.py"])
def test_a_tool_starts_as_a_command_in_any_folder(tool, tmp_path):
    script = Path(__file__).resolve().parent.parent / "tools" / tool
    run = subprocess.run([sys.executable, script, "--help"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
