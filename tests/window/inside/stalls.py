"""Measures stalls of the window: the longest time that Blender's loop, or a view's drawing, stood still."""

import time
from contextlib import contextmanager
from itertools import pairwise

import bpy

_BEAT_S = 0.005


class Stalls:
    """Adds to ``notes``, a list of dicts, what was measured."""

    def __init__(self):
        self.notes = []

    @contextmanager
    def stalls(self, act):
        """Measure the stalls of an act: the longest gap between two turns of the event loop, and between redraws.

        A redraw is part of a turn, so with software OpenGL a gap holds the time of drawing the whole window. "cpu" is
        the most time that this thread itself computed within one gap, not always the longest: the rest it waited, for
        the OpenGL driver's threads or for a processor.
        """
        beats, draws = [_now()], [time.perf_counter()]

        def beat():
            beats.append(_now())
            return _BEAT_S

        def drawn():
            draws.append(time.perf_counter())

        spaces = (bpy.types.SpaceView3D, bpy.types.SpaceImageEditor)
        handles = [(space, space.draw_handler_add(drawn, (), "WINDOW", "POST_PIXEL")) for space in spaces]
        bpy.app.timers.register(beat, first_interval=0, persistent=True)
        try:
            yield
        finally:
            bpy.app.timers.unregister(beat)
            for space, handle in handles:
                space.draw_handler_remove(handle, "WINDOW")
            beats.append(_now())
            wall, cpu = (max(later[i] - earlier[i] for earlier, later in pairwise(beats)) for i in (0, 1))
            redraw = max((b - a for a, b in pairwise(draws)), default=float("nan"))
            self.notes.append(
                {
                    "stall": act,
                    "seconds": beats[-1][0] - beats[0][0],
                    "loop_ms": 1000 * wall,
                    "loop_cpu_ms": 1000 * cpu,
                    "redraw_ms": 1000 * redraw,
                    "turns": len(beats),
                    "redraws": len(draws) - 1,
                }
            )


def _now():
    return time.perf_counter(), time.thread_time()
