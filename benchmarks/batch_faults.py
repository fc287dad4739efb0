"""Faults injected into whole batches: python -m benchmarks.batch_faults [--moments N] [--folder DIR] [FAULT ...]

    kill      kill -9 on the parent and on a child, in turn, at random moments; the batch is run again with --resume
    scenes    the same of a batch that writes .blend and renders, in the bpy of the environment, after make build
    often     the same at so many moments of one batch of 60 scans and 12 photos, made as by benchmarks.archive
    full      an output folder on a disk (a small tmpfs) that fills up under the batch, and is emptied afterwards
    gone      an output folder that vanishes under the batch, and comes back
    together  two batches on the same folder at once

After each of them the outputs must equal those of a batch that nothing happened to, byte for byte (of a report all but
its times, of a .blend every array), and nothing that was finished may be done again. A fault that was not survived is
printed and makes the command end with 1. With --folder it goes on at the moment where it was interrupted. Linux only;
`full` needs the right to mount.
"""

import argparse
import json
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

from benchmarks.archive import make
from benchmarks.faults import mounted
from benchmarks.geodesic_tables import ROOT
from benchmarks.rooms import Room
from reflcolor_addon import Seeds
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_ptx

_WITH_SEEDS, _WITH_PHOTOS, _PHOTOS = 6, 3, 3
_SCENES, _FOR_BLENDER = 3, 'write = ["blend"]'
_COLORED, _STATE = "colored", "batch-state"
_DISK_KB = 1200


def main():
    """Inject the faults that are asked for and print what came of each."""
    faults = {"kill": _kill, "scenes": _scenes, "often": _often, "full": _full, "gone": _gone, "together": _together}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("faults", metavar="FAULT", nargs="*", help=", ".join(faults))
    parser.add_argument("--moments", type=int, default=20, help="how often it is killed (default %(default)s)")
    parser.add_argument("--folder", type=Path, help="where the archive is put, and kept")
    arguments = parser.parse_args()
    folder = arguments.folder or Path(tempfile.mkdtemp(prefix="batch-faults-"))
    wrong = 0
    whole, known = _undisturbed(folder)
    for name in arguments.faults or faults:
        if name not in faults:
            parser.error(f"{name}: no such fault; there are {', '.join(faults)}")
        for line, bad in faults[name](folder, whole, known, arguments.moments):
            print(f"{name:<9} {line}", flush=True)
            for each in bad:
                print(f"          NOT SURVIVED: {each}", flush=True)
            wrong += len(bad)
    if arguments.folder is None:
        shutil.rmtree(folder)
    return int(wrong > 0)


def _make(folder):
    """Some scans with seeds, and some that photos are looked at for; all small."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ['format = "reflcolor-batch"', "version = 1", f'output = "{_COLORED}"', 'write = ["png", "ply"]']
    lines += ['photos = "photo_*.png"', "settings = { slic_segments = 60 }"]
    rng = np.random.default_rng(3)
    for number in range(_WITH_SEEDS):
        lines += _with_seeds(folder, number, rng)
    for number in range(_WITH_SEEDS, _WITH_SEEDS + _WITH_PHOTOS):
        write_ptx(Room(number).scan(40, 65, 1.2), folder / f"scan_{number}.ptx")
        lines += ["[[scan]]", f'file = "scan_{number}.ptx"']
    for number in range(_PHOTOS):
        write_png(folder / f"photo_{number}.png", Room(_WITH_SEEDS + number).photo(number, 120, 90))
    (folder / "batch.toml").write_text("\n".join(lines) + "\n")


def _make_scenes(folder):
    """Three scans with seeds, of which Blender makes scenes and pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ['format = "reflcolor-batch"', "version = 1", f'output = "{_COLORED}"', _FOR_BLENDER, "render = true"]
    rng = np.random.default_rng(3)
    for number in range(_SCENES):
        lines += _with_seeds(folder, number, rng)
    (folder / "batch.toml").write_text("\n".join(lines) + "\n")


def _with_seeds(folder, number, rng):
    """Write a small scan and its seeds; return their lines of the manifest."""
    scan = Room(number).scan(40, 65, 1.2)
    write_ptx(scan, folder / f"scan_{number}.ptx")
    rows, columns = (rng.integers(size, size=30) for size in scan.shape)
    Seeds(rows, columns, scan.color[rows, columns]).save(folder / f"scan_{number}.seeds.json")
    return ["[[scan]]", f'file = "scan_{number}.ptx"', f'seeds = "scan_{number}.seeds.json"']


def _undisturbed(folder, made=_make, name="undisturbed"):
    """What the batch takes by the clock, and the outputs of one that nothing happens to; both kept."""
    plain = folder / name
    if not (plain / "seconds").is_file():
        shutil.rmtree(plain, ignore_errors=True)
        plain.mkdir(parents=True)
        made(plain)
        start = time.monotonic()
        with _started(plain) as process:
            said = process.communicate()[0]
        if process.returncode:
            sys.exit(said)
        (plain / "seconds").write_text(str(time.monotonic() - start))
    return float((plain / "seconds").read_text()), _outputs(plain / _COLORED)


def _fresh(folder, name="undisturbed"):
    """The archive without any output."""
    own = folder / f"own {name}"
    if not own.exists():
        shutil.copytree(folder / name, own, ignore=shutil.ignore_patterns(_COLORED, "seconds"))
    _emptied(own / _COLORED)
    return own


def _emptied(colored):
    """Remove what is in an output folder; the folder itself may be a disk of its own."""
    for path in colored.iterdir() if colored.is_dir() else ():
        shutil.rmtree(path) if path.is_dir() else path.unlink()


def _started(own, *options):
    command = [sys.executable, "-m", "reflcolor_addon"]
    if _FOR_BLENDER in (own / "batch.toml").read_text():
        blender = ROOT / "tools" / "blender_command.py"
        command = [sys.executable, blender, "--resources", own.parent / "blender", "--"]
    return subprocess.Popen(
        [*command, "batch", "batch.toml", "--jobs", "2", "--keep-going", *options],
        cwd=own,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def _run(own, *options):
    with _started(own, *options) as process:
        said = process.communicate()[0]
    return process.returncode, said


def _outputs(colored):
    """The bytes of everything that a batch made for its user, by path; a report without its times."""
    found = {}
    for path in sorted(colored.rglob("*")):
        parts = path.relative_to(colored).parts
        if path.is_dir() or parts[0] in (_STATE, "logs") or path.name in ("report.html", "report.csv"):
            continue
        data = path.read_bytes()
        if path.suffix == ".json":
            data = {key: own for key, own in json.loads(data).items() if key not in ("times_s", "created")}
            # The bytes of a .blend differ from run to run.
            data["outputs"] = [own for own in data.get("outputs", ()) if not own["path"].endswith(".blend")]
        found["/".join(parts)] = data
    scenes = sorted(colored.rglob("*.blend"))
    for path, held in _held(scenes).items() if scenes else ():
        found[path.relative_to(colored).as_posix()] = held
    return found


def _held(scenes):
    """What .blend files hold, see benchmarks.blend_contents."""
    line = [sys.executable, "-m", "benchmarks.blend_contents", *scenes]
    done = subprocess.run(line, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return {Path(path): held for path, held in json.loads(done.stdout.splitlines()[-1]).items()}


def _finished(colored):
    """When each thing that is remembered was done: of scans, and of photos matched with scans."""
    kinds = (colored / _STATE / kind for kind in ("done", "matched"))
    # What a scan was colored to is noted again when its picture is there, but was not done again then.
    return {
        path: json.loads(path.read_bytes()).get("ended", path.stat().st_mtime_ns)
        for kind in kinds
        for path in kind.glob("*.json")
    }


def _faults(own, known, before, what):
    """What is wrong after a batch was run to its end."""
    bad, found = [], _outputs(own / _COLORED)
    if found != known:
        differing = [name for name in {*found, *known} if found.get(name) != known.get(name)]
        bad.append(f"{what}: other outputs: {', '.join(sorted(differing))}")
    after = _finished(own / _COLORED)
    bad += [f"{what}: {path.name} was done again" for path, time_ns in before.items() if after.get(path) != time_ns]
    bad += [f"{what}: {path} is left" for path in (own / _COLORED).rglob(".reflcolor-*")]
    return bad


def _children(pid):
    """The processes that a process has started."""
    try:
        return [int(own) for each in Path(f"/proc/{pid}/task").glob("*/children") for own in each.read_text().split()]
    except OSError:
        return []


def _kill(folder, whole, known, moments):
    yield from _killed(folder, whole, known, moments, "undisturbed", _WITH_SEEDS + _WITH_PHOTOS * (1 + _PHOTOS))


def _scenes(folder, _whole, _known, moments):
    whole, known = _undisturbed(folder, _make_scenes, "scenes")
    # Each is colorized and rendered.
    yield from _killed(folder, whole, known, moments, "scenes", 2 * _SCENES)


def _killed(folder, whole, known, moments, name, things):
    """Kill a batch in which so many things are done, at random moments."""
    kept = folder / f"kills of {name}.json"
    told = json.loads(kept.read_text()) if kept.is_file() else []
    for moment in range(len(told), moments):
        chance, own = random.Random(moment), _fresh(folder, name)
        what = "child" if moment % 2 else "parent"
        process = _started(own)
        # A busy machine is slow: the moment is told by what is finished, and a little more.
        count = chance.randrange(things)
        while process.poll() is None and len(_finished(own / _COLORED)) < count:
            time.sleep(0.01)
        time.sleep(chance.uniform(0, 0.5))
        victims = _children(process.pid) if what == "child" else [process.pid]
        if victims and process.poll() is None:
            os.kill(chance.choice(victims), signal.SIGKILL)
        before = _finished(own / _COLORED)
        said = process.communicate()[0]
        bad, again = [], "; trying again" in said
        if what == "child" and process.returncode:
            bad.append(f"moment {moment}: after a child was killed the batch ended with {process.returncode}: {said}")
        status, said = _run(own, "--resume")
        if status:
            bad.append(f"moment {moment}: resumed, it ended with {status}: {said[-300:]}")
        bad += _faults(own, known, before, f"moment {moment}, {what}")
        told.append({"what": what, "done": len(before), "again": again, "bad": bad})
        kept.write_text(json.dumps(told))
    count = Counter(each["what"] for each in told)
    finished = [each["done"] for each in told]
    yield (
        f"{len(told)} moments of a batch of {whole:.1f} s ({count['parent']} of its parent, {count['child']} of a "
        f"child, of which {sum(each['again'] for each in told)} had work that was begun again); {min(finished)} to "
        f"{max(finished)} things were finished by then, and none of them was done again",
        [line for each in told for line in each["bad"]],
    )


def _often(folder, _whole, _known, moments):
    plain, own = folder / "many", folder / "many, killed"
    whole, known = _undisturbed(folder, lambda folder: make(folder, 60, 12), plain.name)
    shutil.rmtree(own, ignore_errors=True)
    shutil.copytree(plain, own, ignore=shutil.ignore_patterns(_COLORED, "seconds"))
    everything, chance = len(_finished(plain / _COLORED)), random.Random(1)
    process, first, killed, bad = _started(own), {}, Counter(), []
    # In order, so that each lies in what the batch has not done yet; some are before anything is finished.
    for moment, count in enumerate(sorted(chance.choices(range(everything - 5), k=moments))):
        while process.poll() is None and len(_finished(own / _COLORED)) < count:
            time.sleep(0.02)
        time.sleep(chance.uniform(0, 3))
        what, victims = ("child", []) if moment % 2 else ("parent", [process.pid])
        while process.poll() is None and not victims:
            time.sleep(0.02)
            victims = _children(process.pid)
        if process.poll() is not None:
            bad.append(f"moment {moment}: the batch had ended with {process.returncode}")
            break
        os.kill(chance.choice(victims), signal.SIGKILL)
        killed[what] += 1
        if what == "parent":
            process.communicate()
            process = _started(own, "--resume")
        first = _finished(own / _COLORED) | first
    said = process.communicate()[0]
    if process.returncode:
        bad.append(f"it ended with {process.returncode}: {said[-300:]}")
    bad += _faults(own, known, first, "in the end")
    verified = sum(bool(data["photos"]) for name, data in known.items() if name.endswith(".json"))
    yield (
        f"one batch of 60 scans and 12 photos, {whole:.0f} s undisturbed; killed at {sum(killed.values())} moments "
        f"({killed['parent']} of its parent, {killed['child']} of a child), {everything} things finished in the end, "
        f"{verified} reports name photos",
        bad,
    )


def _full(folder, _whole, known, _moments):
    own = _fresh(folder)
    disk = own / _COLORED
    with mounted(disk, "-o", f"size={_DISK_KB}k") as allowed:
        if not allowed:
            yield "skipped: this user may not mount a small disk", []
            return
        status, said = _run(own)
        before = _finished(disk)
        bad = _plain(said, status, 1)
        if not (last := said.splitlines()[-1]).startswith("error: batch.toml: ") or "failed: scan_" not in last:
            bad.append(f"its last line does not name what failed: {last}")
        subprocess.run(["mount", "-o", "remount,size=64m", disk], check=True)
        status, again = _run(own, "--resume")
        bad += _plain(again, status, 0) + _faults(own, known, before, "after room was made")
        yield f"{len(before)} things were finished when the disk was full; then with room and --resume all", bad
        yield f"it said: {[line for line in said.splitlines() if line.startswith('error:')]}", []


def _gone(folder, whole, known, _moments):
    own = _fresh(folder)
    process = _started(own)
    while not _finished(own / _COLORED):
        time.sleep(0.02)
    away = (own / _COLORED).rename(own / "away")
    said = process.communicate()[0]
    bad = _plain(said, process.returncode, 1)
    if (own / _COLORED).exists():
        bad.append("the batch made the folder anew")
        shutil.rmtree(own / _COLORED)
    away.rename(own / _COLORED)
    before = _finished(own / _COLORED)
    status, again = _run(own, "--resume")
    bad += _plain(again, status, 0) + _faults(own, known, before, "after it came back")
    yield f"{len(before)} things were finished by then; with the folder back and --resume all", bad
    yield f"it said: {[line for line in said.splitlines() if line.startswith('error:')]}", []


def _together(folder, _whole, known, _moments):
    own = _fresh(folder)
    both = [_started(own, "--resume"), _started(own, "--resume")]
    said = [process.communicate()[0] for process in both]
    bad = [line for text, process in zip(said, both, strict=True) for line in _plain(text, process.returncode, 0)]
    before = _finished(own / _COLORED)
    done = [sum(": done in" in line for line in text.splitlines()) for text in said]
    if sum(done) > _WITH_SEEDS + _WITH_PHOTOS:
        bad.append(f"{sum(done)} scans were colorized, more than there are")
    status, again = _run(own, "--resume")
    bad += _plain(again, status, 0) + _faults(own, known, before, "after both")
    yield f"one colorized {done[0]} scans, the other {done[1]}; a third, with --resume, found all done", bad


def _plain(said, status, expected):
    """What is wrong with what a batch said at its end."""
    bad = [] if status == expected else [f"status {status}: {said[-500:]}"]
    return bad + ["a traceback: " + said[-800:]] * ("Traceback" in said)


if __name__ == "__main__":
    sys.exit(main())
