"""Faults injected into real runs, with their counts: python -m benchmarks.faults [--moments N] [FAULT ...]

    kill      kill -9 at random moments of each kind of writing: the old or the new file is there, whole
    signals   SIGINT, SIGTERM and SIGHUP at random moments of whole runs: one line, the status, no litter
    full      a full disk (a small tmpfs) for each kind of output: one line, the old file is there
    folders   a folder that is read-only, and one that vanishes while it is written to
    together  two processes that write one output for some seconds

Without FAULT all of them. A fault that was not survived is printed and makes the command end with 1. Linux only; `full`
and the read-only folder need the right to mount, and say so where there is none.
"""

import argparse
import contextlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

from benchmarks.geodesic_tables import ROOT
from reflcolor_addon import Seeds
from reflcolor_addon.errors import OutputError
from reflcolor_addon.files import work_folder
from reflcolor_addon.files.images import write_jpeg, write_png
from reflcolor_addon.files.whole import fault_of
from reflcolor_addon.files.writers import write_e57, write_glb, write_ply, write_ptx
from reflcolor_addon.files.writers.scans_back import ColoredScan, write_scans_back
from reflcolor_addon.scan.scan import Scan
from reflcolor_addon.scan.surface import ScanSurface

_SHAPE = (90, 120)
_SECONDS_TOGETHER = 5.0
_FULL_KB = 200
_BEGUN = """
import os, runpy
from reflcolor_addon.cli import interruption
listen = interruption.leave_at_once
interruption.leave_at_once = lambda: (listen(), os.close({writer}))
runpy.run_module('reflcolor_addon', run_name='__main__')
"""
_STATUS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}


def main():
    """Inject the faults that are asked for and print what came of each."""
    faults = {"kill": _kill, "signals": _signals, "full": _full, "folders": _folders, "together": _together}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("faults", metavar="FAULT", nargs="*", help=", ".join(faults))
    parser.add_argument("--moments", type=int, default=60, help="random moments of each kind (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    random.seed(arguments.seed)
    wrong = 0
    for name in arguments.faults or faults:
        if name not in faults:
            parser.error(f"{name}: no such fault; there are {', '.join(faults)}")
        with tempfile.TemporaryDirectory() as folder:
            for line, bad in faults[name](Path(folder), arguments.moments):
                print(f"{name:<9} {line}", flush=True)
                for each in bad:
                    print(f"          NOT SURVIVED: {each}", flush=True)
                wrong += len(bad)
    return int(wrong > 0)


def _scan(number):
    """One of two scans of a room; their files differ in length."""
    height, width = (side + 10 * number for side in _SHAPE)
    chance = np.random.default_rng(number)
    azimuth, elevation = np.linspace(2.5, -2.5, width)[None], np.linspace(0.7, -0.7, height)[:, None]
    distance = 4 + np.sin(3 * azimuth) * np.cos(2 * elevation)
    level = distance * np.cos(elevation)
    points = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)
    strength = chance.random((height, width)).astype(np.float32)
    return Scan(name="room", points=points, reflectance=strength, valid=np.ones((height, width), bool))


def _writers(folder):
    """{end of the name: a function of a path and 0 or 1 that writes one of two files}."""
    scans = [_scan(number) for number in (0, 1)]
    chance = np.random.default_rng(7)
    colors = [chance.integers(0, 256, (*scan.shape, 3), np.uint8) for scan in scans]
    surfaces = [ScanSurface(scan, rgb) for scan, rgb in zip(scans, colors, strict=True)]
    seeds = [Seeds(np.arange(n) % 80, np.arange(n) % 100, chance.integers(0, 256, (n, 3))) for n in (3000, 4000)]
    sources = folder / "sources"
    sources.mkdir()
    write_e57(scans[0], sources / "room.e57")
    write_ptx(scans[0], sources / "room.ptx")

    def back(path, number):
        rgb = np.full((*_SHAPE, 3), 100 * number, np.uint8)
        source = sources / f"room{path.suffix}"
        write_scans_back([ColoredScan(scan=scans[0], rgb=rgb, source=source, index=1)], path)

    return {
        ".png": lambda path, number: write_png(path, colors[number]),
        ".ply": lambda path, number: write_ply([surfaces[number]], path),
        ".glb": lambda path, number: write_glb([surfaces[number]], path),
        ".e57": lambda path, number: write_e57(scans[number], path),
        ".ptx": lambda path, number: write_ptx(scans[number], path),
        ".json": lambda path, number: seeds[number].save(path),
        ".jpg": lambda path, number: write_jpeg(path, colors[number]),
        "_colors.e57": back,
        "_colors.ptx": back,
    }


def _forked(act):
    """Run ``act`` in a copy of this process, which knows of no folder that it has cleaned; return its number."""
    number = os.fork()
    if number == 0:
        try:
            work_folder._cleaned.clear()
            act()
            os._exit(0)
        except BaseException as error:
            sys.stderr.write(f"{type(error).__name__}: {error}\n")
            os._exit(1)
    return number


def _written(write, path, number):
    """Write in a copy of this process; whether that went well."""
    return os.waitpid(_forked(lambda: write(path, number)), 0)[1] == 0


def _contents(folder, suffix, write):
    """The bytes of the two files."""
    found = []
    for number in (0, 1):
        path = folder / f"known{number}{suffix}"
        write(path, number)
        found.append(path.read_bytes())
        path.unlink()
    return found


def litter(folder):
    """Return the names of what killed runs have left in a folder."""
    return [path.name for path in folder.iterdir() if path.name.startswith(".reflcolor-")]


def _kill(folder, moments):
    for suffix, write in _writers(folder).items():
        known = _contents(folder, suffix, write)
        path = folder / f"out{suffix}"
        write(path, 0)
        start = time.monotonic()
        _written(write, path, 0)
        longest = 2.2 * (time.monotonic() - start)
        left, bad = 0, []

        def on_and_on(write=write, path=path):
            for turn in range(10**6):
                write(path, (turn + 1) % 2)

        for moment in range(moments):
            child = _forked(on_and_on)
            time.sleep(random.uniform(0, longest))
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            left += bool(litter(folder))
            if path.read_bytes() not in known or fault_of(path) is not None:
                bad.append(f"{suffix}, moment {moment}: neither the old nor the new file")
            if not _written(write, path, 0) or litter(folder):
                bad.append(f"{suffix}, moment {moment}: the next run did not clean up: {len(litter(folder))} folders")
        told = f"{suffix:<11} {moments} kills, {left} left a folder"
        yield told if bad else f"{told}, which the next run removed; the file was always one of the two, whole", bad


def colorize_words(scan="room.e57"):
    """Return the words of a command that colorizes what `prepare` has written."""
    # The preset's brightness is the scan's noise, which no picture packs well.
    return ["colorize", scan, "--seeds", "seeds.json", "--preset", "Paper"]


def _command(folder, *outputs, scan="room.e57", environment=None):
    line = [sys.executable, "-m", "reflcolor_addon", *colorize_words(scan)]
    scratch = folder / "scratch"
    scratch.mkdir(exist_ok=True)
    env = os.environ | {"PYTHONPATH": str(ROOT), "TMPDIR": str(scratch)} | (environment or {})
    return line + list(outputs), {"cwd": folder, "env": env}


def prepare(folder):
    """Write a scan and its seeds into a folder."""
    write_e57(_scan(0), folder / "room.e57")
    Seeds(np.arange(0, 80, 8), np.arange(0, 100, 10), np.full((10, 3), 120)).save(folder / "seeds.json")


def _signals(folder, moments):
    prepare(folder)
    names = ("o.png", "o.ply", "o.glb", "o.e57", "o.json")
    options = ["-o", "o.png", "-o", "o.ply", "-o", "o.glb", "-o", "o.e57", "--report", "o.json"]
    line, settings = _command(folder, *options)
    start = time.monotonic()
    subprocess.run(line, **settings, check=True, capture_output=True)
    whole = time.monotonic() - start
    statuses, bad = Counter(), []
    for moment in range(moments):
        for name in names:
            (folder / name).unlink(missing_ok=True)
        number = random.choice(list(_STATUS))
        reader, writer = os.pipe()
        # The program says that it has begun by closing a pipe when its first line is done.
        begun = _BEGUN.format(writer=writer)
        process = subprocess.Popen(
            [sys.executable, "-c", begun, *line[3:]],
            **settings,
            pass_fds=[writer],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        os.close(writer)
        os.read(reader, 1)
        os.close(reader)
        time.sleep(random.uniform(0, whole))
        process.send_signal(number)
        try:
            _, said = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            said = f"did not end; {process.communicate()[1]}"
        statuses[process.returncode] += 1
        if fault := wrong_end(number, process.returncode, said):
            bad.append(f"moment {moment}, {number.name}: {fault}")
        halves = [name for name in names if (folder / name).exists() and fault_of(folder / name) is not None]
        if halves or litter(folder) or list((folder / "scratch").iterdir()):
            bad.append(f"moment {moment}, {number.name}: left {halves + litter(folder)}")
    told = ", ".join(f"status {status}: {count}" for status, count in sorted(statuses.items()))
    yield f"{moments} moments of a run of {whole:.1f} s, its imports and the E57 child included; {told}", bad


def wrong_end(number, status, said):
    """Return what is wrong with how a run ended that got a signal, None where nothing is: it was done, or says so."""
    lines = said.splitlines()
    ended = status == _STATUS[number] and len(lines) == 1 and lines[0].startswith("error: interrupted")
    return None if ended or (status == 0 and not lines) else f"status {status}, said {said[-300:]!r}"


@contextlib.contextmanager
def mounted(folder, *options):
    """A disk of its own at a folder; gives False where this user may not mount."""
    folder.mkdir(exist_ok=True)
    done = subprocess.run(["mount", "-t", "tmpfs", *options, "none", folder], capture_output=True, check=False)
    try:
        yield done.returncode == 0
    finally:
        if done.returncode == 0:
            subprocess.run(["umount", folder], check=True)


def _full(folder, _moments):
    prepare(folder)
    disk = folder / "disk"
    with mounted(disk, "-o", f"size={_FULL_KB}k") as allowed:
        if not allowed:
            yield "skipped: this user may not mount a small disk", []
            return
        for suffix in (".png", ".ply", ".glb", ".e57", ".ptx"):
            scan = "room.ptx" if suffix == ".ptx" else "room.e57"
            if suffix == ".ptx":
                write_ptx(_scan(0), folder / scan)
            yield _on_full_disk(folder, disk, suffix, ["-o", f"disk/out{suffix}"], scan)
        yield _on_full_disk(folder, disk, ".json", ["-o", "o.png", "--report", "disk/out.json"], "room.e57")


def _on_full_disk(folder, disk, suffix, options, scan):
    for path in disk.iterdir():
        path.unlink()
    path = disk / f"out{suffix}"
    path.write_bytes(b"old and good")
    # All but a little is taken.
    with (disk / "filler").open("wb") as filler, contextlib.suppress(OSError):
        while True:
            filler.write(bytes(4096))
            filler.flush()
    os.truncate(disk / "filler", (disk / "filler").stat().st_size - 4096 * (suffix != ".json"))
    line, settings = _command(folder, *options, scan=scan)
    done = subprocess.run(line, **settings, check=False, capture_output=True, text=True)
    lines = done.stderr.splitlines()
    bad = []
    if done.returncode != 1 or len(lines) != 1 or path.name not in lines[0]:
        bad.append(f"{suffix}: status {done.returncode}, said {done.stderr[-300:]!r}")
    if path.read_bytes() != b"old and good" or litter(disk):
        bad.append(f"{suffix}: the old file is gone, or {litter(disk)} is left")
    return f"{suffix:<11} {lines[-1] if lines else done.returncode}", bad


def _folders(folder, moments):
    prepare(folder)
    disk = folder / "disk"
    with mounted(disk, "-o", "ro") as allowed:
        if allowed:
            line, settings = _command(folder, "-o", "disk/out.png")
            done = subprocess.run(line, **settings, check=False, capture_output=True, text=True)
            one = done.returncode == 1 and done.stderr.count("\n") == 1
            yield f"read-only: {done.stderr.strip()}", [] if one else [done.stderr[-300:]]
        else:
            yield "read-only: skipped: this user may not mount", []
    for suffix, write in _writers(folder).items():
        bad, told = [], Counter()
        for moment in range(moments):
            place = folder / "vanishing"
            place.mkdir()
            reader, writer = os.pipe()

            def on_and_on(write=write, place=place, suffix=suffix, writer=writer):
                try:
                    for turn in range(10**6):
                        write(place / f"out{suffix}", turn % 2)
                except OutputError as error:
                    os.write(writer, str(error).encode())

            child = _forked(on_and_on)
            os.close(writer)
            time.sleep(random.uniform(0, 0.1))
            moved = place.rename(folder / "moved")
            shutil.rmtree(moved, ignore_errors=True)
            said = b"".join(iter(lambda reader=reader: os.read(reader, 4096), b"")).decode()
            status = os.waitpid(child, 0)[1]
            os.close(reader)
            shutil.rmtree(folder / "moved", ignore_errors=True)
            told["told in one line"] += 1
            if status or not said or "\n" in said or place.exists():
                bad.append(f"{suffix}, moment {moment}: status {status}, said {said!r}")
                shutil.rmtree(place, ignore_errors=True)
        yield f"{suffix:<11} vanishes at {moments} moments: {told['told in one line'] - len(bad)} told in one line", bad


def _together(folder, _moments):
    for suffix, write in _writers(folder).items():
        known = _contents(folder, suffix, write)
        path = folder / f"out{suffix}"
        write(path, 0)
        end = time.monotonic() + _SECONDS_TOGETHER

        def on_and_on(first, write=write, path=path, end=end):
            turn = first
            while time.monotonic() < end:
                write(path, turn % 2)
                turn += 1

        children = [_forked(lambda first=first: on_and_on(first)) for first in (0, 1)]
        looked, bad = 0, []
        while time.monotonic() < end:
            looked += 1
            if path.read_bytes() not in known:
                bad.append(f"{suffix}: look {looked}: neither of the two files")
        if any([os.waitpid(child, 0)[1] for child in children]):
            bad.append(f"{suffix}: a writer failed")
        if litter(folder):
            bad.append(f"{suffix}: left {litter(folder)}")
        yield (
            f"{suffix:<11} two writers for {_SECONDS_TOGETHER:.0f} s: looked at {looked} times, always one of the two",
            bad,
        )


if __name__ == "__main__":
    sys.exit(main())
