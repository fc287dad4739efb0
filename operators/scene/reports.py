"""How an operator reports what is wrong."""

from functools import wraps

from ...reflcolor_addon.failures import line_of
from .texts import shown


def reported(execute):
    """Make an operator's method report bad input, or what the machine could not do, as one line and end cancelled.

    Anything else is a defect and surfaces.
    """

    @wraps(execute)
    def reporting(self, context):
        try:
            return execute(self, context)
        except Exception as error:
            line = line_of(error)
            if line is None:
                raise
            self.report({"ERROR"}, shown(line))
            return {"CANCELLED"}

    return reporting
