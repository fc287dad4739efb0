"""How an operator tells a person what is wrong."""

from functools import wraps

from ...reflcolor_addon.errors import ReflcolorError, UsageError
from .texts import shown


def reported(execute):
    """Make an operator's method report bad input as its one line and end cancelled; anything else is a defect."""

    @wraps(execute)
    def reporting(self, context):
        try:
            return execute(self, context)
        except (ReflcolorError, UsageError) as error:
            self.report({"ERROR"}, shown(error.message))
            return {"CANCELLED"}

    return reporting
