"""What the kernel refuses, how it stops, and that it never touches memory that is not its own."""

import ctypes
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from reflcolor_addon.errors import Cancelled
from reflcolor_addon.geodesic import kernel
from reflcolor_addon.geodesic.engines import NativeEngine
from reflcolor_addon.geodesic.exact import HeldFields, add_fields
from reflcolor_addon.geodesic.graph import PixelGraph
from reflcolor_addon.native import library as native

KERNEL = Path(__file__).resolve().parent.parent / "kernel"
FUZZ = KERNEL.parent / "tools" / "fuzz_kernel.sh"
# Cells grow in bands of single rows, so that small images have many.
NARROW_BANDS = ("-DRC_BAND_PIXELS=1", "-DRC_BAND_CELLS=0")


def test_rows_of_an_image_of_one_column_may_be_stored_backward():
    image = np.ones((1, 3), np.float32)[:, ::-1].T
    for shown in (image, image[::-1], image[:1][::-1]):
        graph = kernel.Graph(shown, shown, shown > 0)
        assert graph.shape == shown.shape


@pytest.fixture
def library():
    return native.library()


@pytest.mark.parametrize(
    ("height", "width"),
    [(0, 5), (5, 0), (-1, 5), (5, -1), (2**16, 2**16), (2**31, 1), (1, 2**31), (2**62, 2**62), (-(2**63), 7)],
)
def test_a_size_that_is_no_size_or_too_large_is_refused_by_a_code(library, height, width):
    assert library.rc_plane_size(height, width) == -2


def test_null_pointers_are_refused_by_a_code(library):
    graph = native.CGraph(2, 2, 8, 0, 1.0, 0.0, None, None)
    assert library.rc_field(None, 1, None, None, None, None) == -1
    assert library.rc_field(graph, 1, None, None, None, None) == -1
    assert library.rc_nearest_bounds(graph, 1, None, 1, 0, None, None, None) == -1
    assert library.rc_nearest_part(graph, None, 1, None, None, 1, None, None, None) == -1
    assert library.rc_nearest_merge(graph, 0, 1, None, 1, 1, None, None, None) == -1
    assert library.rc_graph_fill(2, 2, 0, None, 2, None, 2, None, 2, None, None, None) == -1
    assert library.rc_blend_add(2, 2, None, 2, 6.0, 0, 2, *[None] * 5, 4, None) == -1
    assert library.rc_blend_finish(4, None, 2, None, 4) == -1
    assert library.rc_blend_nearest(None, 0, 2, 1, None, 1, 2, None, 6.0, *[None] * 5) == -1
    assert library.rc_blend_nearest(graph, 0, 2, 1, None, 1, 2, None, 6.0, *[None] * 5) == -1
    assert library.rc_kriging(1, None, 1, None, 2, None, None, None) == -1


def test_a_number_of_channels_that_is_none_or_too_large_is_refused_by_a_code(library):
    numbers = np.zeros(8, np.float32).ctypes.data
    for pixels, count, channels in ((0, 1, 2), (1, 0, 2), (1, 1, 0), (1, 1, 5), (-1, 1, 2), (1, -(2**62), 2)):
        assert library.rc_kriging(pixels, numbers, count, numbers, channels, numbers, numbers, None) == -2
    for channels in (0, 5):
        blended = 1, 1, numbers, 1, 6.0, 0, channels, *[numbers] * 5, 1, None
        assert library.rc_blend_add(*blended) == -2
        assert library.rc_blend_finish(1, numbers, channels, numbers, 1) == -2


def test_a_seed_count_that_is_no_count_is_refused_by_a_code(library):
    flat = np.zeros((2, 2), np.float32)
    graph, plane, pixel = kernel.Graph(flat, flat, flat == 0), np.zeros(64, np.float32), np.zeros(1, np.int64)
    for count in (0, -1, 2**31, 2**62):
        assert library.rc_field(graph._c, count, pixel.ctypes.data, None, plane.ctypes.data, None) == -2
        bounds = count, pixel.ctypes.data, 1, 0, None, plane.ctypes.data
        assert library.rc_nearest_bounds(graph._c, *bounds, None) == -2


@pytest.fixture(scope="module")
def large_images():
    random = np.random.default_rng(0)
    return *(random.random((2, 2000, 2000)) * 255).astype(np.float32), np.ones((2000, 2000), bool)


@pytest.fixture(scope="module")
def large_graph(large_images):
    return kernel.Graph(*large_images)


@pytest.mark.parametrize("call", ["graph", "field", "nearest", "blend", "exact"])
def test_a_running_call_stops_within_50_ms(large_images, large_graph, call):
    control = kernel.Control()
    pixels = np.arange(0, 4_000_000, 40_000)
    luminance, range_image, valid = large_images
    engine = NativeEngine(PixelGraph(luminance=luminance, range_image=range_image, valid=valid))
    sums, flat = kernel.Blend(valid.shape, 6.0), np.zeros(valid.shape, np.float32)
    seeds = [(int(pixel), (0.0, 0.0)) for pixel in pixels]
    once = {"threads": 2, "held": HeldFields(0), "added": lambda index, field: None}
    calls = {
        "graph": lambda: [kernel.Graph(*large_images, control=control) for _ in range(500)],
        "field": lambda: [kernel.field(large_graph, 0, control=control) for _ in range(50)],
        "nearest": lambda: kernel.nearest(large_graph, pixels, 8, control=control),
        "blend": lambda: [sums.add(flat, (0, 0), control) for _ in range(500)],
        "exact": lambda: add_fields(engine, sums, seeds, cancelled=lambda: control.cancelled, **once),
    }
    before = threading.active_count()
    moment = []

    def cancel():
        # CPU time of the whole process: other programs on the machine do not count.
        moment.append(time.process_time())
        control.cancel()

    timer = threading.Timer(0.3, cancel)
    timer.start()
    with pytest.raises(Cancelled):
        calls[call]()
    taken = time.process_time() - moment[0]
    timer.join()
    assert taken < 0.05
    assert threading.active_count() == before


def test_progress_counts_pixels_of_a_field_and_seeds_of_a_search(large_graph):
    control = kernel.Control()
    kernel.field(large_graph, 0, control=control)
    assert control.done >= 0.99 * 4_000_000
    control = kernel.Control()
    kernel.nearest(large_graph, [0, 5, 7], 1, control=control)
    assert control.done == 3


def test_cancelled_runs_leave_no_memory_behind(large_graph):
    statm = Path("/proc/self/statm")
    if not statm.exists():
        pytest.skip("reads the process's memory from /proc")
    control = kernel.Control()
    control.cancel()

    def run():
        for _ in range(20):
            with pytest.raises(Cancelled):
                kernel.nearest(large_graph, [0, 1000], 2, control=control)
        return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    first = run()
    assert run() - first < 4 * 4_000_000


def run_fuzz(compiler, tmp_path, *options, rounds):
    """Compile the kernel with its fuzz driver, run it, return what it prints."""
    program = tmp_path / "fuzz"
    sources = [KERNEL / "fuzz" / "fuzz.c", *sorted((KERNEL / "src").glob("*.c"))]
    common = ["-std=c11", "-ffp-contract=off", "-o", program, *sources, "-lm"]
    subprocess.run([*compiler, *options, *common], check=True, capture_output=True)
    done = subprocess.run([program, "1", str(rounds)], capture_output=True, text=True, timeout=100, check=False)
    assert not done.returncode, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
def test_random_sizes_and_strides_pass_the_sanitizers():
    if sys.platform == "win32":
        pytest.skip("needs a shell")
    done = subprocess.run([FUZZ, "600", "1"], capture_output=True, text=True, timeout=300, check=False)
    if done.returncode == 77:
        pytest.skip(done.stderr.strip())
    assert not done.returncode, done.stdout + done.stderr


@pytest.mark.slow
def test_every_optimization_and_instruction_set_gives_the_same_bits(tmp_path):
    zig = [sys.executable, "-m", "ziglang", "cc"]
    if subprocess.run([*zig, "--version"], capture_output=True, check=False).returncode:
        pytest.skip("needs the package ziglang, which make setup installs")
    variants = [("-O2",), ("-O0",), ("-O3", "-DRC_SCALAR"), ("-O2", *NARROW_BANDS)]
    hashes = {run_fuzz(zig, tmp_path, "-fno-sanitize=all", *options, rounds=1000) for options in variants}
    assert len(hashes) == 1


def test_a_kernel_of_another_interface_is_not_used(monkeypatch):
    native._load.cache_clear()
    monkeypatch.setattr(native, "ABI_VERSION", 999)
    try:
        assert not kernel.available()
        assert "999" in kernel.reason()
    finally:
        native._load.cache_clear()


@pytest.mark.parametrize("content", [b"", b"not a library"])
def test_a_library_that_does_not_load_is_a_reason_and_no_crash(monkeypatch, tmp_path, content):
    import reflcolor_kernel

    library = tmp_path / "library"
    library.write_bytes(content)
    monkeypatch.setattr(reflcolor_kernel, "library_path", lambda: library)
    native._load.cache_clear()
    try:
        assert "does not load" in kernel.reason()
    finally:
        native._load.cache_clear()


def test_the_interface_is_plain_c(library):
    assert library.rc_abi_version() == kernel.ABI_VERSION
    assert ctypes.sizeof(native.CGraph) == 48
