"""A batch inside Blender: what only Blender writes is written by workers that run in Blender."""

import csv
import json

import pytest
from archives import HEAD, make_archive

from reflcolor_addon.files.images import read_image

pytestmark = pytest.mark.blender


def test_a_scene_and_a_rendered_picture(blender_command, tmp_path):
    path = make_archive(tmp_path, count=1)
    seeds = path.read_text(encoding="utf-8").split("\n", 4)[4]
    path.write_text(HEAD + 'write = ["blend"]\nrender = true\n' + seeds, encoding="utf-8")
    done = blender_command("batch", path, "--jobs", "1", cwd=tmp_path, timeout=300)
    assert done.returncode == 0, done.stderr + done.stdout
    colored = tmp_path / "colored"
    assert (colored / "hall_0.blend").stat().st_size > 10_000
    assert read_image(colored / "hall_0 render.png").std() > 1
    report = json.loads((colored / "reports" / "hall_0.json").read_text(encoding="utf-8"))
    assert "--render" in [output["option"] for output in report["outputs"]]
    assert report["versions"]["blender"]
    with (colored / "report.csv").open(encoding="utf-8", newline="") as file:
        assert [row["state"] for row in csv.DictReader(file)] == ["done"]
    made = [colored / f"hall_0{end}" for end in (".blend", ".png", " render.png")]
    made += [colored / "reports" / f"hall_0{end}" for end in (".jpg", ".json")]
    times = [file.stat().st_mtime_ns for file in made]
    again = blender_command("batch", path, "--jobs", "1", "--resume", cwd=tmp_path)
    assert again.returncode == 0 and "1 done before" in again.stdout
    assert [file.stat().st_mtime_ns for file in made] == times
