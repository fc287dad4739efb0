"""Messages of operations, listed in Blender through the installed zip."""

import importlib
import json

import numpy as np
import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import write_small_ptx


@pytest.fixture
def notices(installed_blender):
    return importlib.import_module(f"{EXTENSION}.operators.scene.notices")


@pytest.fixture
def wall(blender, tmp_path):
    """bpy with a scan of 6 x 10 pixels, one of them without return, with seeds there and elsewhere."""
    valid = np.ones((6, 10), bool)
    valid[2, 3] = False
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3, valid=valid))))
    for row, col in ((0, 0), (2, 3), (5, 9)):
        blender.ops.reflcolor.add_seed(row=row, col=col, color=(1, 0, 0))
    return blender


def said(bpy):
    return [(notice.warning, notice.text) for notice in bpy.context.active_object.reflcolor.notices]


def test_an_import_is_told(wall):
    assert said(wall) == [(False, "Imported wall")]


def test_the_last_operation_is_told_with_its_warnings(wall):
    wall.ops.reflcolor.colorize()
    wall.ops.reflcolor.colorize()
    assert said(wall) == [
        (False, "Colorized wall from 3 seeds"),
        (True, "seed 2: no return at row 2, column 3; moved to row 1, column 3"),
    ]


def test_a_message_about_a_seed_selects_it(wall):
    wall.ops.reflcolor.colorize()
    state = wall.context.active_object.reflcolor
    state.active_seed = 0
    assert wall.ops.reflcolor.show_notice(index=1) == {"FINISHED"}
    assert state.active_seed == 1 and [seed.select for seed in state.seeds] == [False, True, False]


def test_the_seed_is_found_after_others_were_removed_or_lack_a_color(wall):
    state = wall.context.active_object.reflcolor
    state.seeds[0].has_color = False
    wall.ops.reflcolor.colorize()
    assert said(wall)[1][1].startswith("seed 1: no return at row 2")
    wall.ops.reflcolor.show_notice(index=1)
    assert state.active_seed == 1
    wall.ops.reflcolor.remove_seed(index=0)
    wall.ops.reflcolor.show_notice(index=1)
    assert state.active_seed == 0


def test_a_seed_that_is_gone_is_told_and_nothing_changes(wall, capfd):
    wall.ops.reflcolor.colorize()
    wall.ops.reflcolor.remove_seed(index=1)
    assert wall.ops.reflcolor.show_notice(index=1) == {"CANCELLED"}
    assert "That seed was moved or removed" in capfd.readouterr().out


def test_a_message_can_be_read_in_full(wall, capfd):
    wall.ops.reflcolor.colorize()
    capfd.readouterr()
    wall.ops.reflcolor.read_notice("EXEC_DEFAULT", index=1)
    assert "moved to row 1, column 3" in capfd.readouterr().out
    assert wall.ops.reflcolor.copy_notice(index=1) == {"FINISHED"}


def test_messages_are_saved_undone_and_copied_with_the_object(wall, tmp_path):
    wall.ops.ed.undo_push(message="start")
    wall.ops.reflcolor.colorize()
    wall.ops.ed.undo_push(message="colorized")
    before = said(wall)
    wall.ops.ed.undo()
    assert said(wall) == [(False, "Imported wall")]
    wall.ops.ed.redo()
    assert said(wall) == before
    copy = wall.context.active_object.copy()
    assert [notice.text for notice in copy.reflcolor.notices] == [text for _, text in before]
    wall.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    wall.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    assert said(wall) == before


def test_thousands_of_warnings_are_cut_and_counted(wall, notices):
    class Silent:
        def report(self, _kind, _text):
            """Nobody reads it."""

    obj = wall.context.active_object
    notices.show_result(Silent(), obj, "Done", [f"line {number}" for number in range(1000)])
    assert len(obj.reflcolor.notices) == notices.MAX_NOTICES + 2
    assert obj.reflcolor.notices[-1].text == "800 more warnings"


def test_seeds_from_a_file_have_their_warnings_listed(wall, tmp_path):
    seeds = [{"row": 0, "col": 1, "rgb": [9, 9, 9]}, {"row": 2, "col": 3, "rgb": [9, 9, 9]}]
    path = tmp_path / "wall.json"
    path.write_text(json.dumps({"format": "reflcolor-seeds", "version": 1, "seeds": seeds}))
    wall.ops.reflcolor.load_seeds(filepath=str(path))
    assert said(wall)[0] == (False, "Loaded 2 seeds") and said(wall)[1][1].startswith("seed 2: no return")
    wall.ops.reflcolor.show_notice(index=1)
    assert wall.context.active_object.reflcolor.active_seed == 1


def test_without_a_scan_or_messages_it_says_so(blender, wall):
    wall.context.active_object.reflcolor.notices.clear()
    with pytest.raises(RuntimeError, match="There are no messages"):
        wall.ops.reflcolor.show_notice(index=0)
