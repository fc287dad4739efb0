"""Fixtures of the scenarios' runner, and what it prints at the end."""

import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue

import pytest
from build_extension import build, host_platform
from window_blender import find_blender
from window_scenarios import OUT, run_file, scenario_files

# How many Blenders run at a time: one, where stalls are measured.
WINDOWS = int(os.environ.get("REFLCOLOR_WINDOWS", "1"))


@pytest.fixture(scope="session")
def outcome_of(request):
    """A function that gives a scenario's outcome: each file runs in a Blender, REFLCOLOR_WINDOWS of them at a time."""
    blender = find_blender()
    named = os.environ.get("REFLCOLOR_ZIP")
    zip_file = Path(named).resolve(strict=True) if named else build(host_platform(), (blender.python,))
    for left in OUT.glob("user*"):
        shutil.rmtree(left, ignore_errors=True)
    OUT.mkdir(parents=True, exist_ok=True)
    files = scenario_files()
    names = {}
    for item in request.session.items:
        stem, name = item.callspec.params["scenario"]
        names.setdefault(stem, []).append(name)
    # Each Blender that runs has a user folder of its own.
    users = Queue()
    for number in range(WINDOWS):
        users.put(OUT / f"user-{number + 1}")

    def outcomes(stem):
        user = users.get()
        try:
            return run_file(files[stem], names[stem], blender, zip_file, user)
        finally:
            users.put(user)

    with ThreadPoolExecutor(WINDOWS) as pool:
        running = {stem: pool.submit(outcomes, stem) for stem in names}
        yield lambda stem, name: running[stem].result()[name]
        for each in running.values():
            each.cancel()


def pytest_terminal_summary(terminalreporter):
    """Print what each scenario took and checked, and the stalls that were measured."""
    told = [
        value
        for kind in ("passed", "failed")
        for report in terminalreporter.getreports(kind)
        for name, value in getattr(report, "user_properties", ())
        if name == "told" and value
    ]
    if not told:
        return
    terminalreporter.section("scenarios")
    for one in told:
        pictures = f"{len(one['pictures'])} pictures in {OUT.name}/" if one["pictures"] else ""
        terminalreporter.write_line(f"{one['seconds']:6.1f} s {one['checks']:5} checks  {one['name']}  {pictures}")
    notes = [note for one in told for note in one["notes"]]
    stalls = [note for note in notes if "stall" in note]
    for note in notes:
        if "measure" in note:
            figures = (f"{name} {value:.2f}" for name, value in note.items() if name != "measure")
            terminalreporter.write_line(f"{note['measure']}: {'; '.join(figures)}")
    if not stalls:
        return
    terminalreporter.section("longest gaps (ms): event loop, computing in it, between redraws")
    for note in stalls:
        figures = f"{note['loop_ms']:7.0f} {note['loop_cpu_ms']:7.0f} {note['redraw_ms']:7.0f}"
        terminalreporter.write_line(f"{figures}  {note['stall']} ({note['seconds']:.1f} s, {note['redraws']} redraws)")
