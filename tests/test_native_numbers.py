"""Lines of numbers read by the kernel: the same bits as Python's float, or left to the caller."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon.native.numbers import read_numbers

plain = st.from_regex(r"[-+]?([0-9]{1,12}(\.[0-9]{0,8})?|\.[0-9]{1,8})([eE][-+]?[0-9]{1,2})?", fullmatch=True)
written = st.floats(-1e9, 1e9).map(repr) | st.floats(-1e6, 1e6).map("{:.6f}".format) | plain


@given(st.lists(st.lists(written, min_size=4, max_size=4), max_size=20), st.sampled_from([" ", "\t", "  "]))
def test_numbers_have_the_bits_of_float(rows, blank):
    text = "".join(blank.join(row) + "\n" for row in rows).encode()
    at, found = 0, []
    while at < len(text):
        values, lines, end = read_numbers(text, at, 100, 4)
        found += values.tolist()
        if not lines:
            # Too many digits: left to the caller.
            line, end = text[at : text.index(b"\n", at)], text.index(b"\n", at) + 1
            found.append([float(word) for word in line.split()])
        at = end
    expected = np.array([[float(word) for word in row] for row in rows]).reshape(-1, 4)
    assert np.array(found).reshape(-1, 4).tobytes() == expected.tobytes()


def test_scanners_numbers_are_read_to_the_last():
    rng = np.random.default_rng(0)
    rows = np.round(rng.uniform(-500_000, 500_000, (1000, 4)), 6)
    text = "\n".join(" ".join(f"{value:.6f}" for value in row) for row in rows).encode()
    values, lines, end = read_numbers(text, 0, 1000, 4)
    assert (lines, end) == (1000, len(text))
    assert values.tobytes() == rows.tobytes()


@pytest.mark.parametrize(
    "line",
    [
        "1 2",
        "1 2 3 4",
        "1 2 x",
        "1 2 nan",
        "1 2 inf",
        "1 2 0x3",
        "1 2 3,",
        "1 2 1_0",
        "1 2 3e",
        "1 2 .",
        "1 2 -",
        "1 2 3d0",
    ]
    + ["1 2 12345678901234567890", "1 2 1e300", "1\x0b2 3", "1\xa02 3"],
)
def test_a_line_of_another_make_is_left_to_the_caller(line):
    text = f"\n  \n0 1 2\n{line}\n3 4 5\n".encode("latin-1")
    values, lines, end = read_numbers(text, 0, 100, 3)
    assert (values.tolist(), lines, end) == ([[0, 1, 2]], 3, len("\n  \n0 1 2\n"))


def test_no_more_lines_are_read_than_asked_for():
    text = b"x\n1 2\n3 4\n5 6"
    values, lines, end = read_numbers(text, 2, 2, 2)
    assert (values.tolist(), lines, text[end:]) == ([[1, 2], [3, 4]], 2, b"5 6")
    values, lines, end = read_numbers(text, end, 2, 2)
    assert (values.tolist(), lines, end) == ([[5, 6]], 1, len(text))
    assert read_numbers(text, len(text), 2, 2)[1:] == (0, len(text))


def test_zeros_keep_their_sign():
    values, *_ = read_numbers(b"0 -0 -0.0 +0e5", 0, 1, 4)
    assert np.signbit(values).tolist() == [[False, True, True, False]]
