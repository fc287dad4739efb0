"""Several pieces of long work as one."""

import pytest

from reflcolor_addon import Cancelled
from reflcolor_addon.progress import in_turn


def piece(result):
    def work(progress, cancelled):
        if cancelled is not None and cancelled():
            raise Cancelled
        if progress is not None:
            progress(0.0, "Begun")
            progress(1.0, "Done")
        return result

    return work


def test_pieces_are_done_in_their_order_with_common_progress():
    said = []
    results = in_turn({"wall": piece(1), "floor": piece(2)})(lambda *step: said.append(step), None)
    assert results == [1, 2]
    assert said == [(0.0, "wall: Begun"), (0.5, "wall: Done"), (0.5, "floor: Begun"), (1.0, "floor: Done")]


def test_one_piece_says_what_it_says_alone():
    said = []
    assert in_turn({"wall": piece(1)})(lambda *step: said.append(step), None) == [1]
    assert said == [(0.0, "Begun"), (1.0, "Done")]


def test_nobody_has_to_watch():
    assert in_turn({"wall": piece(1), "floor": piece(2)})(None, None) == [1, 2]


def test_cancelling_ends_the_work_between_pieces():
    asked = iter([False, True])
    with pytest.raises(Cancelled):
        in_turn({"wall": piece(1), "floor": piece(2)})(None, lambda: next(asked))
