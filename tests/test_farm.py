"""The templates for render farms: Open Job Description is run for real, Flamenco's job type beside a stub."""

import json
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from archives import make_archive

ROOT = Path(__file__).resolve().parent.parent
TEMPLATE = ROOT / "farm" / "openjd" / "reflcolor.yaml"
OPENJD = Path(sys.executable).with_name("openjd")
# What Blender's command line is followed by; the rest are the verb and its arguments.
START = ["-b", "--command", "reflcolor"]


def openjd(*arguments, **options):
    line = [str(OPENJD), *map(str, arguments), "--extensions", "TASK_CHUNKING"]
    return subprocess.run(line, capture_output=True, text=True, timeout=300, **options)


@pytest.fixture(scope="module")
def parameters(tmp_path_factory):
    """The parameters of a job: five scans, of which the second cannot be read; and a stand-in for Blender."""
    folder = tmp_path_factory.mktemp("farm")
    manifest = make_archive(folder, count=5)
    (folder / "hall_1.ptx").write_text("no scan\n")
    blender = folder / "blender"
    blender.write_text(
        f"#!{sys.executable}\nimport sys\nassert sys.argv[1:4] == {START}\nsys.path.insert(0, {str(ROOT)!r})\n"
        "from reflcolor_addon.cli.main import main\nsys.exit(main(sys.argv[4:]))\n"
    )
    blender.chmod(blender.stat().st_mode | stat.S_IXUSR)
    return {
        "Manifest": manifest,
        "Output": folder / "colored",
        "Scans": 5,
        "ScansPerTask": 3,
        "Blender": blender,
    }


def given(parameters):
    return [part for name, value in parameters.items() for part in ("-p", f"{name}={value}")]


def test_the_template_is_valid_and_has_all_steps(parameters):
    assert openjd("check", TEMPLATE).returncode == 0
    told = json.loads(openjd("summary", TEMPLATE, *given(parameters), "--output", "json").stdout)
    assert [step["name"] for step in told["steps"]] == ["Look", "Match", "Color", "Render", "Report"]


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="the stand-in for Blender is a script of POSIX systems")
def test_the_template_runs_all_steps_and_names_the_scan_that_failed(parameters):
    done = openjd("run", TEMPLATE, *given(parameters))
    assert done.returncode != 0
    assert "1 failed: hall_1" in done.stdout
    written = sorted(path.name for path in parameters["Output"].glob("*.png"))
    assert written == ["hall_0.png", "hall_2.png", "hall_3.png", "hall_4.png"]
    assert (parameters["Output"] / "report.html").is_file()
    assert "Action failed" not in done.stdout.split("Report", 1)[0]


def compiled(settings):
    """The tasks that Flamenco's job type makes of its settings, compiled by Node beside a stub of Flamenco."""
    stub = """
const fs = require("fs");
const tasks = [];
const author = {
    Task: (name, type) => ({
        name, type, commands: [], before: [],
        addCommand(command) { this.commands.push(command); },
        addDependency(task) { this.before.push(task.name); },
    }),
    Command: (name, parameters) => ({ name, parameters }),
};
const source = fs.readFileSync(process.argv[1], "utf8");
const { JOB_TYPE, compileJob } = new Function("author", source + "\\nreturn { JOB_TYPE, compileJob };")(author);
compileJob({ settings: JSON.parse(process.argv[2]), addTask: (task) => tasks.push(task) });
console.log(JSON.stringify({ type: JOB_TYPE, tasks }));
"""
    line = ["node", "-e", stub, str(ROOT / "farm" / "flamenco" / "reflcolor.js"), json.dumps(settings)]
    done = subprocess.run(line, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.skipif(shutil.which("node") is None, reason="Node is not installed")
def test_the_flamenco_job_type_makes_the_tasks_in_order():
    told = compiled({"manifest": "/disk/batch.toml", "output": "/disk/colored", "scans": 5, "scans_per_task": 3})
    assert {setting["key"] for setting in told["type"]["settings"]} == {
        "manifest",
        "output",
        "scans",
        "scans_per_task",
    }
    tasks = {task["name"]: task for task in told["tasks"]}
    stages = ("look", "match", "color", "render")
    assert list(tasks) == [*(f"{stage} {index}" for stage in stages for index in ("1-3", "4-5")), "report"]
    assert tasks["look 1-3"]["before"] == []
    assert tasks["color 4-5"]["before"] == ["match 1-3", "match 4-5"]
    assert tasks["report"]["before"] == ["render 1-3", "render 4-5"]
    for name, task in tasks.items():
        (command,) = task["commands"]
        assert (task["type"], command["name"]) == ("blender", "exec")
        assert command["parameters"]["exe"] == "{blender}"
        assert command["parameters"]["args"][:3] == START
        verb, first = command["parameters"]["args"][3:5]
        assert (verb, first) == (("report", "/disk/colored") if name == "report" else ("batch", "/disk/batch.toml"))
    color = tasks["color 4-5"]["commands"][0]["parameters"]["args"]
    assert color[color.index("--index") + 1] == "4-5" and color[color.index("--stage") + 1] == "color"


@pytest.mark.skipif(shutil.which("node") is None, reason="Node is not installed")
@pytest.mark.parametrize("settings", [{"scans": 0, "scans_per_task": 1}, {"scans": 3, "scans_per_task": 0}])
def test_the_flamenco_job_type_refuses_what_makes_no_tasks(settings):
    with pytest.raises(AssertionError, match="expected whole numbers from 1"):
        compiled({"manifest": "a.toml", "output": "b"} | settings)
