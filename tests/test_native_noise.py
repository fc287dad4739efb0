"""What native code prints about a broken file does not appear beside the one line that the error is."""

import os

import pytest

from reflcolor_addon.files.native_noise import quiet_on_failure


def test_what_is_printed_before_a_failure_is_dropped(capfd):
    with pytest.raises(ValueError, match="broken"), quiet_on_failure():
        os.write(2, b"libthing: something is wrong")
        raise ValueError("broken")
    assert capfd.readouterr().err == ""


def test_what_is_printed_in_success_passes_through(capfd):
    with quiet_on_failure():
        os.write(2, b"libthing: a remark")
    os.write(2, b"; and more")
    assert capfd.readouterr().err == "libthing: a remark; and more"


def test_blocks_may_lie_in_each_other(capfd):
    with quiet_on_failure():
        with pytest.raises(ValueError, match="broken"), quiet_on_failure():
            os.write(2, b"dropped")
            raise ValueError("broken")
        os.write(2, b"kept")
    assert capfd.readouterr().err == "kept"


def test_a_program_without_stderr_is_no_trouble(monkeypatch):
    def no_stderr(_number):
        raise OSError(9, "Bad file descriptor")

    monkeypatch.setattr(os, "dup", no_stderr)
    with quiet_on_failure():
        pass
    with pytest.raises(ValueError, match="broken"), quiet_on_failure():
        raise ValueError("broken")
