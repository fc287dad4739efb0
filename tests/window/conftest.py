"""Fixtures of the scenarios' runner, and what it prints at the end."""

import os
import shutil
from pathlib import Path

import pytest
from build_extension import build, host_platform
from window_blender import find_blender
from window_scenarios import OUT, run_file, scenario_files


@pytest.fixture(scope="session")
def outcome_of(request):
    """A function that gives a scenario's outcome; the first question about a file starts a Blender for it."""
    blender = find_blender()
    named = os.environ.get("REFLCOLOR_ZIP")
    zip_file = Path(named).resolve(strict=True) if named else build(host_platform(), (blender.python,))
    shutil.rmtree(OUT / "user", ignore_errors=True)
    OUT.mkdir(parents=True, exist_ok=True)
    asked = [item.callspec.params["scenario"] for item in request.session.items if hasattr(item, "callspec")]
    files, outcomes = scenario_files(), {}

    def outcome(stem, name):
        if stem not in outcomes:
            names = [other for file, other in asked if file == stem]
            outcomes[stem] = run_file(files[stem], names, blender, zip_file)
        return outcomes[stem][name]

    return outcome


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
