"""Results and warnings of the last operation on a scan: kept with its object, for the panel to list."""

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty

from ...reflcolor_addon.messages import about_scan, value_of
from .texts import report_text, shown

# More than anyone reads; the first ones show what is wrong.
MAX_NOTICES = 200


class ReflcolorNotice(bpy.types.PropertyGroup):
    """A result or a warning of the last operation on the scan"""

    text: StringProperty(name="Text", description="What was said")
    warning: BoolProperty(name="Warning", description="Whether it is a warning, not a result")
    row: IntProperty(name="Row", description="Row of the seed that is meant; -1 for none", default=-1)
    col: IntProperty(name="Column", description="Column of the seed that is meant; -1 for none", default=-1)


def show_result(operator, obj, result, warnings, seeds=None, details=(), *, one_of_several=False):
    """Report what came of an operation, and keep it with the object in place of what was kept before.

    Parameters
    ----------
    operator : bpy.types.Operator
    obj : bpy.types.Object
    result : str
    warnings : sequence of Message
        One line each.
    seeds : Seeds, optional
        Those that a warning's value ``seed`` counts, from 1.
    details : sequence of str
        More of the result, to be read in the list only.
    one_of_several : bool
        Whether a warning that is reported has to name the object.
    """
    notices = obj.reflcolor.notices
    notices.clear()
    for warning in warnings:
        operator.report({"WARNING"}, shown(about_scan(warning, obj.name) if one_of_several else warning))
    operator.report({"INFO"}, result)
    for text in (result, *details):
        notices.add().text = text
    for warning in warnings[:MAX_NOTICES]:
        notice = notices.add()
        notice.text, notice.warning = shown(warning), True
        number = value_of(warning, "seed")
        if number is not None and seeds is not None and 1 <= number <= len(seeds):
            notice.row, notice.col = (int(places[number - 1]) for places in (seeds.rows, seeds.cols))
    if len(warnings) > MAX_NOTICES:
        notice = notices.add()
        notice.text = report_text("{count} more warnings", count=len(warnings) - MAX_NOTICES)
        notice.warning = True


def show_results(operator, objects, result, skipped):
    """Report what came of an operation on several scans, after those of each; at the end, the scans that were skipped.

    Parameters
    ----------
    operator : bpy.types.Operator
    objects : sequence of bpy.types.Object
        Those that were worked on; the skipped ones are noted with them.
    result : str
        Reported where they are several.
    skipped : sequence of str
        One line for each scan that was selected but not worked on.
    """
    if len(objects) > 1:
        operator.report({"INFO"}, result)
    for line in skipped:
        operator.report({"WARNING"}, line)
        for obj in objects:
            notice = obj.reflcolor.notices.add()
            notice.text, notice.warning = line, True


def seed_of(obj, notice):
    """Return the index of the seed that a notice is about; None if it is about none, or the seed is gone or moved."""
    if notice.row < 0:
        return None
    places = ((seed.row, seed.col) for seed in obj.reflcolor.seeds)
    return next((index for index, place in enumerate(places) if place == (notice.row, notice.col)), None)
