"""Random acts, the same ones every time: no Python error, no crash, and the seeds stay inside the grid."""

import os
import time

import bpy
from inside.random_acts import RandomActs

LIMIT_S = 2400
ACTS = int(os.environ["REFLCOLOR_ACTS"])
SEED = int(os.environ["REFLCOLOR_RANDOM"])


def has_view(window):
    return any(area.type == "VIEW_3D" for area in window.bpy_window.screen.areas)


def scenario_random_acts(window):
    # Refusals in one line; a traceback's last line begins otherwise.
    window.expect_error(r"^Error: (?!Python)")
    acts, seconds = RandomActs(window, SEED), {}
    yield from window.show_sidebar()
    # An act that is refused tests little.
    acts.import_scan()
    for number in range(ACTS):
        # A workspace is laid out in several turns of the event loop.
        yield from window.until(lambda: has_view(window), 20, "a 3D View is there")
        begun = time.perf_counter()
        name = yield from acts.act()
        # The last line of the log of a crash tells which act it was.
        print(f"window-test: act {number} {name}", flush=True)
        yield 0.0
        seconds.setdefault(name, []).append(time.perf_counter() - begun)
        for obj in bpy.data.objects:
            state = obj.reflcolor
            inside = all(seed.row < state.rows and seed.col < state.cols for seed in state.seeds)
            window.check(inside, f"seeds of {obj.name} are inside its grid after act {number}, {name}")
        if has_view(window) and not window.area("VIEW_3D").spaces.active.show_region_ui:
            yield from window.show_sidebar()
    print(f"window-test: {acts.done} done, {acts.refused} refused", flush=True)
    window.check(acts.done > ACTS / 2, f"most acts are done: {acts.done} done, {acts.refused} refused")
    slowest = sorted(seconds.items(), key=lambda item: -sum(item[1]))
    for name, each in slowest:
        print(f"window-test: {sum(each):7.2f} s for {len(each):4} x {name}", flush=True)
    yield from window.screenshot("after")
