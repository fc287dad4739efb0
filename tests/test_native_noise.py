"""What native code prints about a file does not appear among the messages."""

import os

import pytest

from reflcolor_addon.files.native_noise import native_output_aside


def test_what_is_printed_is_held_back(capfd):
    with native_output_aside() as lines:
        os.write(2, b"libthing: a remark\nand more")
    os.write(2, b"after")
    assert lines == ["libthing: a remark", "and more"]
    assert capfd.readouterr().err == "after"


def test_a_failure_passes_through_and_what_it_printed_does_not(capfd):
    with pytest.raises(ValueError, match="broken"), native_output_aside():
        os.write(2, b"libthing: something is wrong")
        raise ValueError("broken")
    assert capfd.readouterr().err == ""


def test_blocks_may_lie_in_each_other(capfd):
    with native_output_aside() as outer:
        with native_output_aside() as inner:
            os.write(2, b"inner")
        os.write(2, b"outer")
    assert (inner, outer) == (["inner"], ["outer"])
    assert capfd.readouterr().err == ""


def test_a_program_without_stderr_is_no_trouble(monkeypatch):
    def no_stderr(_number):
        raise OSError(9, "Bad file descriptor")

    monkeypatch.setattr(os, "dup", no_stderr)
    with native_output_aside() as lines:
        pass
    assert lines == []
    with pytest.raises(ValueError, match="broken"), native_output_aside():
        raise ValueError("broken")
