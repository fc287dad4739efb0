"""Runs files of window scenarios, each in a Blender of its own, and reads what came of every scenario."""

import ast
import json
import os
import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path

from window_blender import ROOT, Blender, Ended, run

HERE = ROOT / "tests" / "window"
OUT = ROOT / "build" / "window"
DATA = Path(os.environ.get("REFLCOLOR_DATA") or ROOT.parent / "shared" / "data")
# How many random acts there are; CI asks for fewer (.ci/run).
ACTS = os.environ.get("REFLCOLOR_ACTS", "2000")
# Which ones: the same number gives the same acts.
RANDOM = os.environ.get("REFLCOLOR_RANDOM", "20130506")
SESSION = ROOT / "tools" / "window_session.sh"
# Width and height of the screen; larger for pictures.
SIZE = os.environ.get("REFLCOLOR_WINDOW", "1280x900").split("x")
LIMIT_S = 400
LOG_LINES = 40

# What Blender, Python and the operators' reports write where something went wrong. At its end Blender counts what it
# has not freed of its own, which is no fault of the scenario.
_ERROR = re.compile(
    r"Traceback \(most recent call last\)|^\s*[\w.]*(Error|Exception|\wWarning): (?!Not freed memory)|\| ERROR "
)
_MARK = re.compile(r"^window-test: (begin|end) (\w+)$")


@dataclass(frozen=True)
class ScenarioFile:
    """A file of scenarios.

    Attributes
    ----------
    path : Path
    names : tuple of str
        Its functions ``scenario_...``, in order.
    fresh : bool
        Whether Blender starts with a new user folder, the extension not installed.
    limit_s : float
        Time for all of it.
    """

    path: Path
    names: tuple[str, ...]
    fresh: bool
    limit_s: float


@dataclass
class Outcome:
    """What a scenario told of itself, and Blender's log meanwhile.

    Attributes
    ----------
    begun : bool
    told : dict
        Empty where it did not come to its end.
    log : list of str
    ended : Ended
        How the Blender that it ran in ended.
    log_path : Path
    last : bool
        Whether no other scenario ran after it in that Blender.
    """

    begun: bool = False
    told: dict = field(default_factory=dict)
    log: list[str] = field(default_factory=list)
    ended: Ended | None = None
    log_path: Path | None = None
    last: bool = False

    def fault(self) -> str:
        """Return what is wrong, with the end of the log; "" if nothing is."""
        told, ended = self.told, self.ended
        how = "was ended at its time limit" if ended.timed_out else f"ended with status {ended.status}"
        if not told:
            what = f"Blender {how} {'during' if self.begun else 'before'} this scenario"
        elif told["problem"]:
            what = told["problem"]
        elif wrong := self._errors():
            what = f"errors in the log: {wrong[0]}"
        elif not told["checks"]:
            what = "the scenario checked nothing"
        elif self.last and ended.status:
            what = f"Blender did not quit by itself: it {how}"
        else:
            return ""
        pictures = ", ".join(told.get("pictures", ())) or "none"
        log = "\n".join(self.log[-LOG_LINES:])
        return f"{what}\npictures: {pictures}\n{self.log_path.relative_to(ROOT)}:\n{log}"

    def _errors(self) -> list[str]:
        allowed = [re.compile(pattern) for pattern in self.told["expected_errors"]]
        return [line for line in self.log if _ERROR.search(line) and not any(p.search(line) for p in allowed)]


def scenario_files() -> dict[str, ScenarioFile]:
    """Return the files of scenarios, by their names; they are read without being run, for they need Blender."""
    files = {}
    for path in sorted(HERE.glob("scenario_*.py")):
        body = ast.parse(path.read_text(encoding="utf-8")).body
        names = [item.name for item in body if isinstance(item, ast.FunctionDef) and item.name.startswith("scenario_")]
        constants = {
            item.targets[0].id: item.value.value
            for item in body
            if isinstance(item, ast.Assign) and isinstance(item.value, ast.Constant)
        }
        limit_s = constants.get("LIMIT_S", LIMIT_S)
        files[path.stem] = ScenarioFile(path, tuple(names), constants.get("FRESH", False), limit_s)
    return files


def run_file(file: ScenarioFile, names: list[str], blender: Blender, zip_file: Path, user: Path) -> dict[str, Outcome]:
    """Start a Blender with a user folder for scenarios of a file; return the outcome of each."""
    stem = file.path.stem
    out, results, log = OUT / stem, OUT / f"{stem}.jsonl", OUT / f"{stem}.log"
    user = OUT / f"user-{stem}" if file.fresh else user
    for folder in (out, user) if file.fresh else (out,):
        shutil.rmtree(folder, ignore_errors=True)
    for folder in (out, user):
        folder.mkdir(parents=True, exist_ok=True)
    results.write_text("")
    folders = {ROOT / name: f"/project/{name}" for name in ("tests", "tools", "examples")}
    folders |= {OUT: "/out", zip_file.parent: "/zip"} | ({DATA: "/data"} if DATA.is_dir() else {})

    def seen(path):
        return blender.seen(path, folders)

    line = [
        "bash",
        seen(SESSION),
        *SIZE,
        blender.program,
        "--enable-event-simulate",
        "--python-exit-code",
        "9",
    ]
    line += ["--python", seen(HERE / "inside" / "start.py"), "--", "--scenarios", seen(file.path), "--names", *names]
    line += ["--zip", seen(zip_file), "--out", seen(out), "--results", seen(results), "--limit", str(file.limit_s - 5)]
    line += ["--examples", seen(ROOT / "examples"), *(["--data", seen(DATA)] if DATA.is_dir() else [])]
    environment = {"BLENDER_USER_RESOURCES": seen(user), "REFLCOLOR_ACTS": ACTS, "REFLCOLOR_RANDOM": RANDOM}
    ended = run(blender.command(line, folders, environment), file.limit_s, log)

    outcomes = read_outcomes(names, results, log)
    for outcome in outcomes.values():
        outcome.ended, outcome.log_path = ended, log
    outcomes[names[-1]].last = True
    return outcomes


def read_outcomes(names: list[str], results: Path, log: Path) -> dict[str, Outcome]:
    """Return each scenario's outcome from what it wrote and what Blender logged meanwhile."""
    outcomes = {name: Outcome() for name in names}
    for line in results.read_text(encoding="utf-8").splitlines():
        told = json.loads(line)
        if told["event"] == "begin":
            outcomes[told["name"]].begun = True
        elif told["event"] == "end":
            outcomes[told["name"]].told = told
    before, current = [], None
    for line in log.read_text(encoding="utf-8", errors="replace").splitlines():
        if mark := _MARK.match(line):
            current = mark[2]
        else:
            (outcomes[current].log if current else before).append(line)
    for outcome in outcomes.values():
        # What went wrong before the first one is everyone's.
        outcome.log[:0] = before
    return outcomes
