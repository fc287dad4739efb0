"""How an operator reports what is wrong."""

from functools import wraps

from ...reflcolor_addon.failures import line_of
from .blender_errors import refusal_of
from .texts import shown


def call(operator, act, **arguments):
    """Have another operator act for one, with an undo step of its own; what it refuses is told as the first one's.

    Parameters
    ----------
    operator : bpy.types.Operator
    act : callable
        One of ``bpy.ops``.
    """
    try:
        return act("EXEC_DEFAULT", True, **arguments)
    except RuntimeError as error:
        operator.report({"ERROR"}, refusal_of(error))
        return {"CANCELLED"}


def reported(execute):
    """Make an operator's method report bad input, or what the machine could not do, as one line and end cancelled.

    Anything else is a defect and surfaces.
    """

    @wraps(execute)
    def reporting(self, context, *more):
        try:
            return execute(self, context, *more)
        except Exception as error:
            line = line_of(error)
            if line is None:
                raise
            self.report({"ERROR"}, shown(line))
            return {"CANCELLED"}

    return reporting
