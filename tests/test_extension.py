"""The zip as Blender takes it: what is in it, that it validates and installs, and that disabling leaves nothing."""

import importlib
import inspect
import sys
import tomllib
import zipfile
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

import pytest
from blender_cli import blender_ext
from blender_session import EXTENSION
from build_extension import host_platform, pinned_wheels, running_python
from footprint import footprint
from trim_wheels import faults, trimmed_name

from reflcolor_addon.version import __version__

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
    assert manifest["version"] == __version__


def test_zip_holds_the_sources_and_nothing_else(contents):
    top = {PurePosixPath(name).parts[0] for name in contents}
    assert top <= {
        "blender_manifest.toml",
        "__init__.py",
        "CHANGELOG.md",
        "LICENSE",
        "README.md",
        "examples",
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


def test_every_bundled_wheel_is_a_pinned_one_trimmed(contents, tmp_path):
    pinned = {trimmed_name(wheel.name): wheel for wheel in pinned_wheels(host_platform(), running_python())}
    bundled = {Path(name).name: data for name, data in contents.items() if name.startswith("wheels/")}
    (kernel,) = [name for name in bundled if name.startswith("reflcolor_kernel-")]
    assert set(bundled) == {kernel, *pinned}
    for name, wheel in pinned.items():
        (tmp_path / name).write_bytes(bundled[name])
        assert faults(wheel, tmp_path / name) == [], name


def test_numpy_is_left_to_blender(contents):
    assert not [name for name in contents if name.startswith("wheels/numpy")]


def test_zip_bears_no_dates(extension_zip):
    with zipfile.ZipFile(extension_zip) as archive:
        entries = archive.infolist()
    assert {entry.date_time for entry in entries} == {(1980, 1, 1, 0, 0, 0)}
    assert [entry.filename for entry in entries] == sorted(entry.filename for entry in entries)


def test_bundled_packages_come_from_the_zip(installed_blender, request):
    if not request.config.getoption("--blender"):
        pytest.skip("needs --blender: other tests of this process have them from elsewhere already")
    installed = Path(installed_blender.utils.user_resource("EXTENSIONS"))
    for name in ("cv2", "laspy", "lazrs", "lazy_loader", "pye57", "pyquaternion", "scipy", "skimage"):
        assert Path(importlib.import_module(name).__file__).is_relative_to(installed), name


def test_the_package_inside_the_extension_is_the_installed_one(installed_blender):
    module = importlib.import_module(f"{EXTENSION}.reflcolor_addon")
    assert Path(module.__file__).is_relative_to(installed_blender.utils.user_resource("EXTENSIONS"))


def test_enabling_registers_the_operators(blender):
    registered = [name for name in dir(blender.types) if name.startswith("REFLCOLOR_OT_")]
    assert {"REFLCOLOR_OT_import_scan", "REFLCOLOR_OT_colorize"} <= set(registered)


@dataclass
class Life:
    """What was registered, in order, while the extension was disabled and enabled twice."""

    enabled: list = field(default_factory=list)
    disabled: list = field(default_factory=list)
    timers: list = field(default_factory=list)
    verbs_added: list = field(default_factory=list)
    verbs_removed: list = field(default_factory=list)


@pytest.fixture(scope="module")
def life(installed_blender):
    bpy, life = installed_blender, Life()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    register, unregister = bpy.utils.register_cli_command, bpy.utils.unregister_cli_command

    def recording_register(name, function):
        handle = register(name, function)
        life.verbs_added.append(handle)
        return handle

    def recording_unregister(handle):
        life.verbs_removed.append(handle)
        unregister(handle)

    life.enabled.append(footprint(bpy))
    bpy.ops.preferences.addon_disable(module=EXTENSION)
    life.disabled.append(footprint(bpy))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bpy.utils, "register_cli_command", recording_register)
        patch.setattr(bpy.utils, "unregister_cli_command", recording_unregister)
        bpy.ops.preferences.addon_enable(module=EXTENSION)
        life.enabled.append(footprint(bpy))
        bpy.ops.preferences.addon_disable(module=EXTENSION)
    life.disabled.append(footprint(bpy))
    life.timers = _running_timers(bpy)
    bpy.ops.preferences.addon_enable(module=EXTENSION)
    life.enabled.append(footprint(bpy))
    return life


def test_disabling_leaves_nothing_behind(life, bare_footprint):
    for disabled in life.disabled:
        assert disabled == bare_footprint
    assert not life.timers


def test_enabling_again_registers_the_same(life, bare_footprint):
    assert life.enabled[0] != bare_footprint
    assert life.enabled[1:] == life.enabled[:1] * 2


def test_disabling_takes_the_command_line_verb_off(life):
    assert len(life.verbs_added) == 1
    assert life.verbs_removed == life.verbs_added


def test_blender_reports_no_policy_violation(installed_blender):
    import addon_utils

    addon_utils._is_first_reset()
    assert addon_utils._extensions_warnings_get() == {}


def test_core_loads_no_blender():
    """The core runs where there is no Blender."""
    sources = (ROOT / "reflcolor_addon").rglob("*.py")
    assert not [path.name for path in sources if "import bpy" in path.read_text() or "from bpy" in path.read_text()]


def _running_timers(bpy) -> list[str]:
    modules = [module for name, module in sys.modules.items() if name.startswith(EXTENSION)]
    functions = [function for module in modules for _, function in inspect.getmembers(module, inspect.isfunction)]
    return [function.__qualname__ for function in functions if bpy.app.timers.is_registered(function)]


def test_every_class_is_registered(blender):
    defined = {
        cls
        for module_name, module in list(sys.modules.items())
        if module_name.startswith((f"{EXTENSION}.operators.", f"{EXTENSION}.panels."))
        for name, cls in vars(module).items()
        if isinstance(cls, type) and (name.startswith("REFLCOLOR_") or issubclass(cls, blender.types.PropertyGroup))
    } - {blender.types.PropertyGroup}
    assert len(defined) > 20
    # Gizmos do not tell whether they are.
    assert [cls.__name__ for cls in defined if not getattr(cls, "is_registered", True)] == []
