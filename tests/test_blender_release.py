"""What a release hands out: the zips' hashes, and a folder from which Blender installs the extension."""

import hashlib
import json
import os
import subprocess
import sys

import pytest
import release

INSTALL = """
import os, sys
import bpy
# Blender asks for it even where the repository is a folder of the machine.
bpy.context.preferences.system.use_online_access = True
bpy.context.preferences.extensions.repos.new(name="Release", module="release", remote_url=sys.argv[-1])
(index,) = [i for i, repo in enumerate(bpy.context.preferences.extensions.repos) if repo.module == "release"]
bpy.ops.extensions.repo_sync(repo_index=index)
bpy.ops.extensions.package_install(repo_index=index, pkg_id="reflcolor", enable_on_install=True)
enabled = "bl_ext.release.reflcolor" in bpy.context.preferences.addons
print("enabled:", enabled, hasattr(bpy.types, "REFLCOLOR_OT_colorize"))
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture(scope="module")
def folder(extension_zip, tmp_path_factory):
    folder = tmp_path_factory.mktemp("release") / "folder"
    release.lay_out([extension_zip], folder)
    return folder


def test_the_hashes_and_the_index_are_those_of_the_zip(folder, extension_zip):
    digest = hashlib.sha256(extension_zip.read_bytes()).hexdigest()
    assert (folder / "SHA256SUMS").read_text() == f"{digest}  {extension_zip.name}\n"
    (entry,) = json.loads((folder / "index.json").read_text())["data"]
    assert (entry["id"], entry["archive_hash"]) == ("reflcolor", f"sha256:{digest}")
    assert entry["archive_url"] == f"./{extension_zip.name}"


def test_blender_installs_from_the_folder(folder, tmp_path):
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(tmp_path)}
    line = [sys.executable, "-c", INSTALL, (folder / "index.json").as_uri()]
    done = subprocess.run(line, env=environment, capture_output=True, text=True, check=False, timeout=120)
    assert "enabled: True True" in done.stdout, done.stdout + done.stderr
    assert list(tmp_path.glob("extensions/.local/lib/python*/site-packages/scipy/__init__.py"))


def test_a_release_needs_a_section_in_the_changelog():
    assert release.has_section("# Changelog\n\n## 0.2.0 (2026-12-01)\n\n- Colors.\n", "0.2.0")
    assert not release.has_section("# Changelog\n\n## 0.2.0\n\n## 0.1.0\n\n- Colors.\n", "0.2.0")
    assert not release.has_section("# Changelog\n\n## 0.1.0\n\n- Colors.\n", "0.2.0")
