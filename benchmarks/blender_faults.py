"""Faults injected while Blender itself writes: python -m benchmarks.blender_faults [--moments N] [FAULT ...]

    kill      kill -9 at random moments of writing a .blend, a .usd and a rendered .png: the old or the new file is
              there, whole, and the next run cleans up
    signals   SIGINT, SIGTERM and SIGHUP at random moments of whole runs with all three: one line, the status, no litter

Without FAULT both. Needs `make build`; Linux only. --state FILE keeps the counts, and with --minutes a run stops after
so long and goes on there the next time. A fault that was not survived is printed and makes the command end with 1.
"""

import argparse
import importlib
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from benchmarks.faults import colorize_words, litter, prepare, wrong_end
from benchmarks.geodesic_tables import ROOT
from reflcolor_addon.files.whole import fault_of

_SUFFIXES = (".blend", ".usd", ".png")
_SIGNALS_FAULT = "signals"
_SIZE = (96, 64)
_LONGEST_S = 180


def main():
    """Inject the faults that are asked for and print what came of each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("faults", metavar="FAULT", nargs="*", help="kill, signals")
    parser.add_argument("--moments", type=int, default=60, help="random moments of each kind (default %(default)s)")
    parser.add_argument("--minutes", type=float)
    parser.add_argument("--state", type=Path)
    parser.add_argument("--child", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        _child(*arguments.child)
    for name in arguments.faults:
        if name not in ("kill", "signals"):
            parser.error(f"{name}: no such fault; there are kill, signals")
    faults = arguments.faults or ["kill", "signals"]
    tried = [*(_SUFFIXES if "kill" in faults else ()), *([_SIGNALS_FAULT] if "signals" in faults else ())]
    end = time.monotonic() + 60 * arguments.minutes if arguments.minutes else None
    state = {name: {"moments": 0, "counts": {}, "bad": []} for name in tried}
    if arguments.state and arguments.state.exists():
        state |= json.loads(arguments.state.read_text())
    for name in tried:
        entry = state[name]
        if entry["moments"] < arguments.moments and (end is None or time.monotonic() < end):
            with tempfile.TemporaryDirectory() as folder:
                step = (_Signals if name == _SIGNALS_FAULT else _Kills)(Path(folder), name)
                while entry["moments"] < arguments.moments and (end is None or time.monotonic() < end):
                    counted, bad = step.moment()
                    entry["moments"] += 1
                    entry["counts"] = dict(Counter(entry["counts"]) + Counter(counted))
                    entry["bad"] += bad
                    if arguments.state:
                        arguments.state.write_text(json.dumps(state))
                step.end()
        told = ", ".join(f"{what}: {count}" for what, count in sorted(entry["counts"].items()))
        print(f"{name:<8} {entry['moments']} moments; {told}", flush=True)
        for each in entry["bad"]:
            print(f"         NOT SURVIVED: {each}", flush=True)
    return int(any(state[name]["bad"] for name in tried))


class _Kills:
    """kill -9 while one kind of file is written on and on, by copies of one Blender that has all it needs in memory."""

    def __init__(self, folder, suffix):
        self._place = folder / "place"
        self._place.mkdir()
        self._path = self._place / f"out{suffix}"
        prepare(folder)
        option = ("-o", "colors.ply", "--render") if suffix == ".png" else ("-o",)
        words = ["kill", folder / "resources", *colorize_words(), *option, self._path]
        self._blender = _started(folder, *words)
        self._longest = 2.2 * self._answer("time")

    def moment(self):
        """Kill one copy, then have another write once; return what is counted, and what went wrong."""
        bad = []
        self._answer(f"kill {random.uniform(0, self._longest)}")
        if (fault := fault_of(self._path)) is not None:
            bad.append(f"neither the old nor the new file: {fault}")
        left = "left a folder, which the next run removed" if litter(self._place) else "left nothing"
        self._answer("time")
        bad += [f"the next run did not clean up: {name}" for name in litter(self._place)]
        return {"whole": int(not bad), left: 1}, bad

    def end(self):
        """End Blender."""
        self._blender.kill()
        self._blender.communicate()

    def _answer(self, request):
        self._blender.stdin.write(f"{request}\n")
        self._blender.stdin.flush()
        line = next((said for said in self._blender.stdout if said.startswith("answer ")), None)
        if line is None:
            raise RuntimeError(f"Blender did not write: {self._blender.stderr.read()[-300:]!r}")
        return float(line.split()[1])


class _Signals:
    """A signal at a random moment of a whole run, counted from the first line of the command."""

    _NAMES = ("o.blend", "o.usd", "o.png", "o.json")

    def __init__(self, folder, _name):
        self._folder, self._whole = folder, None
        prepare(folder)

    def moment(self):
        """Send one; return what is counted, and what went wrong."""
        if self._whole is None:
            # The first run installs the extension.
            self._run(None)
            self._whole, status, said = self._run(None)
            if status:
                return {}, [f"without a signal: status {status}, said {said[-300:]!r}"]
        for name in self._NAMES:
            (self._folder / name).unlink(missing_ok=True)
        number = random.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
        _, status, said = self._run(number)
        bad = [f"{number.name}: {fault}"] if (fault := wrong_end(number, status, said)) else []
        halves = [name for name in self._NAMES if (self._folder / name).exists() and fault_of(self._folder / name)]
        scratch = [path.name for path in (self._folder / "scratch").iterdir()]
        if left := halves + litter(self._folder) + scratch:
            bad.append(f"{number.name}: left {left}")
        return {f"status {status}": 1}, bad

    def end(self):
        """Nothing is left to end."""

    def _run(self, number):
        words = [*colorize_words(), "-o", "o.blend", "-o", "o.usd", "--render", "o.png", "--report", "o.json"]
        with _started(self._folder, _SIGNALS_FAULT, self._folder / "resources", *words) as process:
            process.stdout.readline()
            begun = time.monotonic()
            if number is not None:
                time.sleep(random.uniform(0, self._whole))
                process.send_signal(number)
            try:
                said = process.communicate(timeout=_LONGEST_S)[1]
            except subprocess.TimeoutExpired:
                process.kill()
                said = f"did not end; {process.communicate()[1]}"
        return time.monotonic() - begun, process.returncode, said


def _started(folder, *arguments):
    scratch = folder / "scratch"
    scratch.mkdir(exist_ok=True)
    env = os.environ | {"PYTHONPATH": os.pathsep.join((str(ROOT), str(ROOT / "tools"))), "TMPDIR": str(scratch)}
    line = [sys.executable, "-m", "benchmarks.blender_faults", "--child", *map(str, arguments)]
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    return subprocess.Popen(line, cwd=folder, env=env, text=True, **pipes)


def _child(fault, resources, *words):
    """In a process of its own: Blender with the extension, which runs a command; it never returns.

    With the fault "kill" what the command has written last is then written on and on.
    """
    import blender_session
    from build_extension import host_platform, running_python, zip_path

    bpy = blender_session.start(zip_path(host_platform(), (running_python(),)), Path(resources))
    command, writing, render, folders = (
        importlib.import_module(f"{blender_session.EXTENSION}.{name}")
        for name in (
            "operators.command",
            "operators.scene.write_results",
            "operators.scene.render",
            "reflcolor_addon.files.work_folder",
        )
    )
    render.picture_size = lambda _aspect: _SIZE
    if fault == _SIGNALS_FAULT:
        print("begun", flush=True)
    try:
        status = command.run(list(words))
    except SystemExit as error:
        status = error.code
    if fault == _SIGNALS_FAULT or status:
        blender_session.end(status)
    write = _writer(bpy, writing, Path(words[-1]))
    for request in sys.stdin:
        kind, *seconds = request.split()
        start = time.monotonic()
        number = os.fork()
        if number == 0:
            # A copy of this process, but one that knows of no folder that it has cleaned.
            folders._cleaned.clear()
            write()
            while kind == "kill":
                write()
            os._exit(0)
        if kind == "kill":
            time.sleep(float(seconds[0]))
            os.kill(number, signal.SIGKILL)
        if os.waitpid(number, 0)[1] not in (0, signal.SIGKILL):
            sys.exit(f"a copy of Blender failed to write {words[-1]}")
        # What a killed copy was printing has no end.
        print(f"\nanswer {time.monotonic() - start:.3f}", flush=True)


def _writer(bpy, writing, path):
    if path.suffix == ".png":
        return lambda: writing._write(path, lambda temporary: writing.render(bpy.context, temporary))
    return lambda: writing._write(path, writing._WRITERS[path.suffix])


if __name__ == "__main__":
    sys.exit(main())
