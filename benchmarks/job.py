"""The whole job of a user, part by part, beside an older build: python -m benchmarks.job BASE [CASE ...]

BASE is a checkout of the older build, both with a zip in dist/ (`make bench-job` sees to that). Every run is a process
of its own, as a user starts it, in the same Blender; the two builds take turns. A part is what a run with it takes more
than a run without it. Seconds are of the processor, of all processes of a run together; memory is the most that they
held at once. Figures are medians.

Runs are kept in build/bench-job/, so that a call that was interrupted goes on where it was; they are made anew for
another commit. Linux only.
"""

import argparse
import json
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

import cv2

from benchmarks import geodesic_cases, matching_cost, run_apart
from benchmarks.geodesic_tables import ROOT, head, row
from reflcolor_addon.files.writers import write_e57, write_ptx

FOLDER = ROOT / "build" / "bench-job"
CONES = ROOT / "examples" / "cones"
# Name: rows, columns and suffix of the scan `doria`, enlarged (None: the example); whether a picture is rendered.
CASES = {
    "cones": (None, True),
    "doria": ((760, 1135, "ptx"), True),
    "doria_4": ((2000, 2000, "e57"), False),
}
# A part, the run that has it, and the run that has all but it.
PARTS = (
    ("Blender itself", "start", None),
    ("read", "info", "start"),
    ("match", "seeds", "info"),
    ("propagate, .png", "png", "info"),
    ("mesh, .blend", "blend", "png"),
    (".glb", "glb", "blend"),
    ("render", "render", "glb"),
)


class Inputs:
    """The files of one case."""

    def __init__(self, name, size):
        if size is None:
            self.scan, self.photo = CONES / "cones.scan.json", CONES / "photo.jpg"
        else:
            rows, columns, suffix = size
            self.scan, self.photo = FOLDER / "inputs" / f"{name}.{suffix}", FOLDER / "inputs" / "doria_photo.jpg"
            self._make(rows, columns)
        self.seeds = FOLDER / "inputs" / f"{name}.seeds.json"

    def _make(self, rows, columns):
        self.scan.parent.mkdir(parents=True, exist_ok=True)
        if not self.photo.is_file():
            photo = matching_cost.enlarged_photo("doria", "warped")
            cv2.imwrite(str(self.photo), photo[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 95])
        if not self.scan.is_file():
            write = write_ptx if self.scan.suffix == ".ptx" else write_e57
            write(geodesic_cases.whole_scan("doria", 1, (rows, columns)), self.scan)


def command(run, inputs, rendered, out):
    """The arguments of one run."""
    if run == "start":
        return ["colorize", "--help"]
    if run == "info":
        return ["info", inputs.scan]
    if run == "seeds":
        return ["seeds", inputs.scan, "--photo", inputs.photo, "-o", out / "seeds.json"]
    most = {"png": 1, "blend": 2, "glb": 3}.get(run, 4)
    outputs = [part for suffix in ("png", "blend", "glb")[:most] for part in ("-o", out / f"out.{suffix}")]
    if rendered and most == 4:
        outputs += ["--render", out / "render.png"]
    given = [] if run == "whole" else ["--seeds", inputs.seeds]
    return ["colorize", inputs.scan, *given, "--photo", inputs.photo, *outputs, "--report", out / "report.json"]


class Build:
    """A checkout that was built, and how to run Blender's command with it."""

    def __init__(self, name, root):
        self.name, self._root = name, root
        commit = ["git", "-C", root, "rev-parse", "--short", "HEAD"]
        self.commit = subprocess.run(commit, capture_output=True, text=True, check=True).stdout.strip()
        # Where Blender installs the extension, once.
        self._resources = FOLDER / f"blender-{name}"

    def install(self):
        """Install the zip as it is now."""
        shutil.rmtree(self._resources, ignore_errors=True)
        self.run(["colorize", "--help"])

    def run(self, arguments):
        """Run one command and return what `run_apart.measured` tells of it."""
        line = [sys.executable, self._root / "tools" / "blender_command.py", "--resources", self._resources, "--"]
        return run_apart.measured([*map(str, line), *map(str, arguments)])


class Record:
    """The runs that are known, kept in a file."""

    def __init__(self, path):
        self._path, self._known = path, {}
        if path.is_file():
            for line in path.read_text().splitlines():
                entry = json.loads(line)
                self._known[tuple(entry["key"])] = entry

    def run(self, key, build, arguments):
        if key not in self._known:
            entry = self._known[key] = {"key": key} | build.run(arguments)
            with self._path.open("a") as file:
                file.write(json.dumps(entry) + "\n")
        return self._known[key]


def measured(name, case, builds, rounds, record):
    """Medians by build and run: of seconds, and of bytes at the peak."""
    size, rendered = case
    inputs, out = Inputs(name, size), FOLDER / "out"
    out.mkdir(parents=True, exist_ok=True)
    if not inputs.seeds.is_file():
        # All builds color from the same seeds.
        builds[0].run(["seeds", inputs.scan, "--photo", inputs.photo, "-o", inputs.seeds])
    runs = [run for _, run, _ in PARTS if rendered or run != "render"] + ["whole"]
    for number in range(rounds):
        for run in runs:
            for build in builds:
                print(f"{name}, round {number + 1}: {run}, {build.name}", file=sys.stderr, flush=True)
                key = (build.name, build.commit, name, run, number)
                record.run(key, build, command(run, inputs, rendered, out))
    found = {}
    for build in builds:
        for run in runs:
            entries = [record.run((build.name, build.commit, name, run, n), build, ()) for n in range(rounds)]
            found[build.name, run] = {key: statistics.median(e[key] for e in entries) for key in ("processor", "bytes")}
    return found


def compare(builds, names, rounds, record):
    """One table for each case: every part, today and before."""
    for name in names:
        found = measured(name, CASES[name], builds, rounds, record)
        head(f"{name}: seconds of the processor", "part", *(build.name for build in builds), "ratio", "peak memory, MB")
        for part, run, without in PARTS:
            if (builds[0].name, run) in found:
                seconds = [_less(found, build.name, run, without) for build in builds]
                _print(part, seconds, [found[build.name, run]["bytes"] for build in builds])
        whole = [found[build.name, "whole"] for build in builds]
        _print("**whole job**", [each["processor"] for each in whole], [each["bytes"] for each in whole])


def _less(found, name, run, without):
    return found[name, run]["processor"] - (found[name, without]["processor"] if without else 0)


def _print(part, seconds, peaks):
    before, now = seconds
    ratio = f"{now / before:.2f}" if before > 0 else ""
    row(part, *(f"{each:.1f}" for each in seconds), ratio, " -> ".join(f"{peak / 1e6:.0f}" for peak in peaks))


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.job", description=__doc__.partition("\n")[0])
    parser.add_argument("base", metavar="BASE", type=Path, help="a checkout of the older build, built")
    parser.add_argument("cases", metavar="CASE", nargs="*", help=f"by default all: {', '.join(CASES)}")
    parser.add_argument("--rounds", type=int, default=3, help="runs per figure (3)")
    options = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    own = Build("now", ROOT)
    own.install()
    record = Record(FOLDER / f"runs-{own.commit}.jsonl")
    base = Build("before", options.base)
    base.install()
    compare([base, own], options.cases or CASES, options.rounds, record)


if __name__ == "__main__":
    main()
