"""Runs scenarios, which are generators: each yield hands back to Blender's event loop."""

import importlib.util
import json
import sys
import time
import traceback

import bpy

from inside.window import Missing, Window, install


class Driver:
    """Runs the chosen scenarios of a file from a timer and quits Blender.

    Parameters
    ----------
    args : argparse.Namespace
        From start.py.
    """

    def __init__(self, args):
        self._args = args
        self._results = args.results.open("a", encoding="utf-8")
        self._all = self._run_all()

    def start(self):
        """Begin as soon as Blender's event loop runs."""
        bpy.app.timers.register(self._step, first_interval=0.1, persistent=True)

    def _step(self):
        try:
            return next(self._all) or 0.0
        except StopIteration:
            return None

    def _run_all(self):
        spec = importlib.util.spec_from_file_location("scenarios", self._args.scenarios)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        if not getattr(module, "FRESH", False):
            began = time.perf_counter()
            install(self._args.zip)
            print(f"window-test: extension enabled in {time.perf_counter() - began:.1f} s", flush=True)
        for name in self._args.names:
            yield from self._run_one(name, getattr(module, name))
        self._tell({"event": "quit"})
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.wm.quit_blender()

    def _run_one(self, name, scenario):
        window = Window(self._args, name)
        yield from window.start_anew()
        self._tell({"event": "begin", "name": name})
        print(f"window-test: begin {name}", flush=True)
        began, problem, missing = time.perf_counter(), "", ""
        try:
            yield from scenario(window)
        except Missing as error:
            missing = str(error)
        except Exception:
            problem = traceback.format_exc()
        # What goes wrong just after the last act belongs to this scenario, too.
        for _ in range(5):
            yield 0.0
        if problem:
            # A picture of how it was left, for whoever looks for the reason.
            window.picture_now("failed")
        print(f"window-test: end {name}", flush=True)
        sys.stderr.flush()
        self._tell(
            {
                "event": "end",
                "name": name,
                "problem": problem,
                "missing": missing,
                "checks": window.checks,
                "seconds": time.perf_counter() - began,
                "expected_errors": window.expected_errors,
                "pictures": window.pictures,
                "notes": window.notes,
            }
        )

    def _tell(self, what):
        self._results.write(json.dumps(what) + "\n")
        self._results.flush()
