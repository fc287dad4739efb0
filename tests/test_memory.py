"""Work that cannot fit into memory is refused in one line before it starts."""

import os
from pathlib import Path

import numpy as np
import pytest

from reflcolor_addon.errors import ReflcolorError, ScanError
from reflcolor_addon.files import memory


def test_what_fits_passes():
    memory.require_memory(1, "a pixel")


def test_what_does_not_fit_is_refused_with_both_numbers(monkeypatch):
    monkeypatch.setattr(memory, "available_bytes", lambda: 3 * 2**30)
    with pytest.raises(ScanError, match=r"^a\.ptx needs about 5 GB of memory, and 3 GB are free$"):
        memory.require_memory(5 * 2**30, "a.ptx", error=ScanError)


def test_terabytes_are_refused_on_every_machine():
    if memory.available_bytes() is not None:
        with pytest.raises(ReflcolorError):
            memory.require_memory(2**60, "a.ptx")


def test_nothing_is_refused_where_the_platform_does_not_tell(monkeypatch):
    monkeypatch.setattr(memory, "available_bytes", lambda: None)
    memory.require_memory(2**60, "a.ptx")


def test_a_container_with_less_than_its_machine_decides(monkeypatch):
    monkeypatch.setattr(memory, "_free_of_the_machine", lambda: 1000)
    monkeypatch.setattr(memory, "_free_of_the_container", lambda: 10)
    monkeypatch.setattr(memory.sys, "platform", "linux")
    assert memory.available_bytes() == 10


@pytest.mark.skipif(memory._trim() is None, reason="the C library has no function for it")
def test_freed_memory_goes_back_to_the_system():
    blocks = [np.ones(100_000, np.uint8) for _ in range(1000)]
    # What stays at the end keeps the C library from shrinking the heap by itself.
    last = np.ones(100_000, np.uint8)
    del blocks
    before = held()
    memory.give_back()
    assert before - held() > 50e6 and last.all()


def held():
    """Bytes that the process holds."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
