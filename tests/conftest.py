"""Fixtures: the shared scans, the built zip, a Blender that has it installed, the command in a process of its own."""

import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import blender_session
import pytest
from build_extension import host_platform, running_python, zip_path
from footprint import footprint
from hypothesis import settings

ROOT = Path(__file__).resolve().parent.parent
IN_CI = os.environ.get("CI") == "true"
RESOURCES = pytest.StashKey[Path]()
OPENED = pytest.StashKey[tuple]()
EXIT_STATUS = pytest.StashKey[int]()

# More fixtures: the command line in this process.
pytest_plugins = ["archives", "command_line", "gltf_files"]

settings.register_profile("reflcolor", deadline=None, derandomize=IN_CI)
settings.load_profile("reflcolor")


@pytest.fixture(scope="session")
def data_dir():
    """The folder of real scans, REFLCOLOR_DATA or ../shared/data; without it the test is skipped, in CI it fails."""
    folder = Path(os.environ.get("REFLCOLOR_DATA") or ROOT.parent / "shared" / "data")
    if not folder.is_dir():
        reason = f"needs the shared scans: {folder} is no folder (set REFLCOLOR_DATA)"
        if IN_CI:
            pytest.fail(reason)
        pytest.skip(reason)
    return folder


@pytest.fixture(scope="session", autouse=True)
def _no_waiting_for_the_disk():
    """Nothing in the tests has to survive a power failure; waiting for the disk would take most of their time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _number: None)
        yield


@pytest.fixture(scope="session")
def extension_zip():
    """The built zip: REFLCOLOR_ZIP, or what `make build` left for this platform and Python, of the present sources."""
    return find_zip()


@pytest.fixture(scope="session")
def _bare_blender(request):
    return request.config.stash.get(OPENED, None) or open_blender(request.config)


@pytest.fixture(scope="session")
def bare_footprint(_bare_blender):
    """What was registered in Blender before the extension came."""
    return _bare_blender[1]


@pytest.fixture(scope="session")
def installed_blender(_bare_blender, extension_zip):
    """bpy with the zip installed and enabled, once for all tests of the process."""
    bpy = _bare_blender[0]
    blender_session.enable(bpy, extension_zip)
    return bpy


@pytest.fixture
def blender(installed_blender):
    """bpy with the extension enabled and an empty scene, made anew for every test."""
    installed_blender.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return installed_blender


@pytest.fixture(scope="session")
def blender_command(extension_zip, tmp_path_factory):
    """A function that runs `blender -b --command reflcolor ARGUMENT...` in a process of its own, from the zip.

    It returns the finished process, with `returncode`, `stdout` and `stderr` as text.
    """
    resources = tmp_path_factory.mktemp("command")

    def run(*arguments, cwd=None, timeout=120):
        line = [sys.executable, ROOT / "tools" / "blender_command.py", "--zip", extension_zip, "--resources", resources]
        line += ["--", *arguments]
        return subprocess.run(
            [str(part) for part in line], cwd=cwd, timeout=timeout, capture_output=True, text=True, check=False
        )

    yield run
    shutil.rmtree(resources, ignore_errors=True)


def find_zip() -> Path:
    """The zip to test; fails where it is missing or was built from other sources."""
    if named := os.environ.get("REFLCOLOR_ZIP"):
        return Path(named).resolve(strict=True)
    path = zip_path(host_platform(), (running_python(),))
    if not path.is_file():
        pytest.fail(f"{path} is not there: run make build")
    with zipfile.ZipFile(path) as archive:
        for name in archive.namelist():
            source = ROOT / name
            if name.endswith(".py") and not (source.is_file() and source.read_bytes() == archive.read(name)):
                pytest.fail(f"{path.name} holds another {name} than the source tree: run make build")
    return path


def open_blender(config):
    """bpy with a new user folder, and what is registered in it before the extension comes."""
    config.stash[RESOURCES] = Path(tempfile.mkdtemp(prefix="reflcolor-blender-"))
    bpy = blender_session.open_blender(config.stash[RESOURCES])
    config.stash[OPENED] = bpy, footprint(bpy)
    return config.stash[OPENED]


class _RootIsNoPackage:
    """Keeps pytest from importing the extension's __init__.py, and with it bpy, as the package that tests/ lies in."""

    @staticmethod
    def pytest_collect_directory(path, parent):
        return pytest.Dir.from_parent(parent, path=path) if path == ROOT else None


def pytest_addoption(parser):
    parser.addoption(
        "--blender",
        action="store_true",
        help="only the tests that need bpy, with every package that the zip bundles taken from the zip",
    )


def pytest_configure(config):
    """With --blender: install the zip before any test module imports the bundled packages."""
    # A conftest's own hooks see only what lies below it; a plugin's see the root, too.
    config.pluginmanager.register(_RootIsNoPackage())
    if config.getoption("--blender"):
        blender_session.enable(open_blender(config)[0], find_zip())


def pytest_collection_modifyitems(config, items):
    """Mark the tests that need bpy, in the process or in one of their own, so that they can run apart."""
    for item in items:
        if {"_bare_blender", "extension_zip"} & set(getattr(item, "fixturenames", ())):
            item.add_marker("blender")
    if config.getoption("--blender"):
        others = [item for item in items if not item.get_closest_marker("blender")]
        items[:] = [item for item in items if item.get_closest_marker("blender")]
        config.hook.pytest_deselected(items=others)


def pytest_sessionfinish(session, exitstatus):
    """Keep the status for the way out."""
    session.config.stash[EXIT_STATUS] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    """Leave at once where bpy is loaded, after pytest's closing line: bpy 4.5 can hang at the interpreter's end."""
    if "bpy" in sys.modules:
        if resources := config.stash.get(RESOURCES, None):
            shutil.rmtree(resources, ignore_errors=True)
        config.get_terminal_writer().flush()
        blender_session.end(config.stash.get(EXIT_STATUS, 1))


@pytest.fixture(params=["kernel", "scipy"])
def engine(request, monkeypatch):
    """The native kernel, and scipy in its place."""
    from reflcolor_addon.geodesic import kernel

    if request.param == "scipy":
        monkeypatch.setattr(kernel, "available", lambda: False)
    else:
        assert kernel.available(), f"{kernel.reason()}: run make kernel"
    return request.param
