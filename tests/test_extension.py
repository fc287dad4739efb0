"""The zip as Blender takes it: what is in it, that it validates and installs, and that disabling leaves nothing."""

import hashlib
import importlib
import inspect
import sys
import tomllib
import zipfile
from pathlib import Path, PurePosixPath

import pytest
from blender_cli import blender_ext
from blender_session import EXTENSION
from build_extension import PLATFORMS, host_platform, read_pins
from footprint import footprint

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def contents(extension_zip):
    """Name -> bytes of every file in the zip."""
    with zipfile.ZipFile(extension_zip) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.fixture(scope="module")
def manifest(contents):
    return tomllib.loads(contents["blender_manifest.toml"].decode())


def test_blender_validates_the_zip(extension_zip):
    blender_ext("validate", extension_zip)


def test_blender_validates_the_source_tree():
    blender_ext("validate", ROOT)


def test_manifest_says_what_the_extension_is(manifest):
    assert manifest["id"] == "reflcolor"
    assert manifest["type"] == "add-on"
    assert manifest["blender_version_min"] == "4.5.0"
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]
    assert "blender" not in manifest["name"].lower()
    assert list(manifest["permissions"]) == ["files"]
    assert manifest["platforms"] == [host_platform()]


def test_zip_holds_the_sources_and_nothing_else(contents):
    top = {PurePosixPath(name).parts[0] for name in contents}
    assert top <= {
        "blender_manifest.toml",
        "__init__.py",
        "CHANGELOG.md",
        "LICENSE",
        "README.md",
        "operators",
        "panels",
        "reflcolor_addon",
        "wheels",
    }
    packaged = {name for name in contents if name.endswith(".py")}
    sources = {
        path.relative_to(ROOT).as_posix()
        for folder in ("operators", "panels", "reflcolor_addon")
        for path in (ROOT / folder).rglob("*.py")
    }
    assert packaged == sources | {"__init__.py"}
    assert not [name for name in contents if "__pycache__" in name or PurePosixPath(name).name.startswith(".")]


def test_zip_holds_the_license(contents):
    assert contents["LICENSE"] == (ROOT / "LICENSE").read_bytes()
    assert b"GNU GENERAL PUBLIC LICENSE" in contents["LICENSE"]


def test_manifest_lists_the_wheels_of_the_zip(contents, manifest):
    assert manifest["wheels"] == sorted(f"./{name}" for name in contents if name.startswith("wheels/"))


def test_every_bundled_wheel_is_pinned_by_its_hash(contents):
    pins = read_pins()
    bundled = {}
    for name, data in contents.items():
        if name.startswith("wheels/") and not name.startswith("wheels/reflcolor_kernel-"):
            package = PurePosixPath(name).name.split("-")[0].lower().replace("_", "-")
            assert f"sha256:{hashlib.sha256(data).hexdigest()}" in pins[package], name
            bundled[package] = name
    assert set(bundled) == set(pins) - set(PLATFORMS[host_platform()].without)


def test_numpy_is_left_to_blender(contents):
    assert not [name for name in contents if name.startswith("wheels/numpy")]


def test_zip_bears_no_dates(extension_zip):
    with zipfile.ZipFile(extension_zip) as archive:
        entries = archive.infolist()
    assert {entry.date_time for entry in entries} == {(1980, 1, 1, 0, 0, 0)}
    assert [entry.filename for entry in entries] == sorted(entry.filename for entry in entries)


def test_bundled_packages_come_from_the_zip(installed_blender):
    installed = Path(installed_blender.utils.user_resource("EXTENSIONS"))
    for name in ("cv2", "lazy_loader", "pye57", "pyquaternion", "scipy", "skimage"):
        assert Path(importlib.import_module(name).__file__).is_relative_to(installed), name


def test_the_package_inside_the_extension_is_the_installed_one(installed_blender):
    module = importlib.import_module(f"{EXTENSION}.reflcolor_addon")
    assert Path(module.__file__).is_relative_to(installed_blender.utils.user_resource("EXTENSIONS"))


def test_enabling_registers_the_operators(blender):
    registered = [name for name in dir(blender.types) if name.startswith("REFLCOLOR_OT_")]
    assert {"REFLCOLOR_OT_import_scan", "REFLCOLOR_OT_colorize"} <= set(registered)


def test_disabling_leaves_nothing_behind(blender, bare_footprint):
    enabled = footprint(blender)
    try:
        for _ in range(2):
            blender.ops.preferences.addon_disable(module=EXTENSION)
            assert footprint(blender) == bare_footprint
            assert not _running_timers(blender)
            blender.ops.preferences.addon_enable(module=EXTENSION)
            assert footprint(blender) == enabled
    finally:
        if EXTENSION not in blender.context.preferences.addons:
            blender.ops.preferences.addon_enable(module=EXTENSION)


def test_disabling_takes_the_command_line_verb_off(blender, monkeypatch):
    added, removed = [], []
    register, unregister = blender.utils.register_cli_command, blender.utils.unregister_cli_command

    def recording_register(name, function):
        added.append(register(name, function))
        return added[-1]

    def recording_unregister(handle):
        removed.append(handle)
        unregister(handle)

    blender.ops.preferences.addon_disable(module=EXTENSION)
    monkeypatch.setattr(blender.utils, "register_cli_command", recording_register)
    monkeypatch.setattr(blender.utils, "unregister_cli_command", recording_unregister)
    blender.ops.preferences.addon_enable(module=EXTENSION)
    assert len(added) == 1
    blender.ops.preferences.addon_disable(module=EXTENSION)
    assert removed == added
    blender.ops.preferences.addon_enable(module=EXTENSION)


def test_blender_reports_no_policy_violation(installed_blender):
    import addon_utils

    if installed_blender.app.version < (5, 0, 0):
        pytest.skip("Blender 4.5 checks less")
    addon_utils._is_first_reset()
    assert addon_utils._extensions_warnings_get() == {}


def test_core_loads_no_blender():
    """The package that does the thinking runs where there is no Blender."""
    sources = (ROOT / "reflcolor_addon").rglob("*.py")
    assert not [path.name for path in sources if "import bpy" in path.read_text() or "from bpy" in path.read_text()]


def _running_timers(bpy) -> list[str]:
    modules = [module for name, module in sys.modules.items() if name.startswith(EXTENSION)]
    functions = [function for module in modules for _, function in inspect.getmembers(module, inspect.isfunction)]
    return [function.__qualname__ for function in functions if bpy.app.timers.is_registered(function)]
