"""Several pieces of work with the progress of one."""

from reflcolor_addon.progress import part


def told(number, count):
    """The progress of a piece that reports its begin and its end."""
    said = []
    progress = part(lambda *step: said.append(step), number, count, "wall")
    progress(0.0, "Begun")
    progress(1.0, "Done")
    return said


def test_a_piece_has_its_share_of_the_progress_and_names_itself():
    assert told(1, 4) == [(0.25, "wall: Begun"), (0.5, "wall: Done")]


def test_one_piece_tells_what_it_tells_alone():
    assert told(0, 1) == [(0.0, "Begun"), (1.0, "Done")]


def test_nobody_has_to_watch():
    assert part(None, 1, 2, "wall") is None
