"""The command line interrupted."""

import os
import re
import signal
import subprocess
import threading

import numpy as np
import pytest
from command_line import COLORIZE, ROOT, blender_tasks, process_line, run_process
from small_scans import random_scan

from reflcolor_addon import Cancelled, Seeds, colorize
from reflcolor_addon.cli.interruption import Interruption
from reflcolor_addon.files.writers import write_ptx


@pytest.fixture(autouse=True)
def _with_a_terminal():
    """Tests may run under nohup, where SIGHUP is ignored, here and in what is started from here."""
    previous = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, previous)


@pytest.fixture
def interrupting(monkeypatch):
    """A function that makes ``colorize`` get a signal at its first progress."""

    def arrange(number=signal.SIGINT, times=1):
        def interrupted(scan, seeds, settings, observed, *, progress, cancelled):
            def told(fraction, text):
                for _ in range(times):
                    signal.raise_signal(number)
                if not cancelled():
                    progress(fraction, text)

            return colorize(scan, seeds, settings, observed, progress=told, cancelled=cancelled)

        monkeypatch.setattr("reflcolor_addon.batch.pipeline.colorize", interrupted)

    return arrange


@pytest.mark.parametrize(
    ("number", "times", "status"),
    [(signal.SIGINT, 1, 130), (signal.SIGINT, 2, 130), (signal.SIGTERM, 1, 143), (signal.SIGHUP, 1, 129)],
)
def test_an_interruption_ends_it_with_nothing_written(run_cli, cli_folder, interrupting, number, times, status):
    interrupting(number, times)
    before = sorted(cli_folder.iterdir())
    assert run_cli(*COLORIZE, "-o", "out.png", "--report", "r.json") == (status, "", "error: interrupted\n")
    assert sorted(cli_folder.iterdir()) == before


@pytest.mark.parametrize("handler", [signal.SIG_IGN, signal.SIG_DFL, signal.default_int_handler])
def test_the_handlers_of_signals_are_put_back(run_cli, cli_folder, interrupting, handler):
    interrupting()
    previous = signal.signal(signal.SIGINT, handler)
    try:
        assert run_cli(*COLORIZE, "-o", "out.png")[0] == 130
        assert signal.getsignal(signal.SIGINT) == handler
    finally:
        signal.signal(signal.SIGINT, previous)


def test_an_interruption_while_blender_writes_ends_it_and_names_what_is_there(run_cli):
    def write_scene(_results, paths, _render, _picture, progress):
        paths[0].write_bytes(b"scene")
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(Cancelled):
            progress(0.5, "Writing b.usd")
        raise Cancelled

    status, out, err = run_cli(
        *COLORIZE, "-o", "a.blend", "-o", "b.usd", blender=blender_tasks(write_scene=write_scene)
    )
    assert (status, out, err) == (130, "", "error: interrupted; already written: a.blend\n")


def test_it_runs_outside_the_main_thread(run_cli, cli_folder):
    outcomes = []
    thread = threading.Thread(target=lambda: outcomes.append(run_cli(*COLORIZE, "-o", "out.png")))
    thread.start()
    thread.join()
    assert outcomes == [(0, "wrote out.png\n", "")]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT for a single process")
def test_ctrl_c_ends_a_process(cli_folder):
    scan = random_scan(shape=(400, 500))
    write_ptx(scan, cli_folder / "garage.ptx")
    rng = np.random.default_rng(0)
    Seeds(rng.integers(0, 400, 5000), rng.integers(0, 500, 5000), rng.integers(0, 256, (5000, 3))).save("seeds.json")
    master, slave = os.openpty()
    line, options = process_line(*COLORIZE, "--nearest", "all", "-o", "out.png")
    process = subprocess.Popen(line, **options, stdout=subprocess.PIPE, stderr=slave)
    os.close(slave)
    try:
        said = b""
        while not re.search(rb"Seed \d+ of 5000", said):
            said += os.read(master, 1000)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=30) == 130
        said += os.read(master, 1000)
    finally:
        process.kill()
        process.communicate()
        os.close(master)
    assert said.rstrip().endswith(b"error: interrupted")
    assert sorted(path.name for path in cli_folder.iterdir()) == ["garage.ptx", "seeds.json"]


def test_a_handler_that_is_not_pythons_gives_way_to_the_default(monkeypatch):
    # As in Blender, whose own handlers Python reports as None and cannot put back.
    previous = signal.getsignal(signal.SIGINT)
    install, calls = signal.signal, []

    def foreign(number, handler):
        calls.append((number, handler))
        install(number, handler)

    try:
        with monkeypatch.context() as patched:
            patched.setattr(signal, "signal", foreign)
            with Interruption() as interruption:
                signal.raise_signal(signal.SIGINT)
                assert interruption.requested()
        put_back = calls[len(calls) // 2 :]
        assert [number for number, _ in put_back] == [number for number, _ in calls[: len(put_back)]]
        assert (signal.SIGINT, signal.SIG_DFL) in put_back
    finally:
        signal.signal(signal.SIGINT, previous)


def test_a_run_under_nohup_goes_on_when_its_terminal_is_closed(run_cli, cli_folder, interrupting):
    interrupting(signal.SIGHUP)
    previous = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert run_cli(*COLORIZE, "-o", "out.png") == (0, "wrote out.png\n", "")
    finally:
        signal.signal(signal.SIGHUP, previous)


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_while_it_starts_is_one_line(cli_folder, name):
    # NumPy's place is taken by a module that gets the signal while it is imported.
    (cli_folder / "numpy.py").write_text(
        f"import signal\nsignal.raise_signal(signal.{name})\nimport time; time.sleep(60)"
    )
    done = run_process("info", "garage.ptx", environment={"PYTHONPATH": f"{cli_folder}{os.pathsep}{ROOT}"})
    assert (done.returncode, done.stdout, done.stderr) == (128 + getattr(signal, name), "", "error: interrupted\n")
