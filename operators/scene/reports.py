"""How an operator tells a person what is wrong."""

from functools import wraps

from ...reflcolor_addon.bundled import missing_package
from ...reflcolor_addon.errors import ReflcolorError, UsageError
from .texts import shown


def reported(execute):
    """Make an operator's method report bad input, or a package that is gone, as one line and end cancelled.

    Anything else is a defect and surfaces.
    """

    @wraps(execute)
    def reporting(self, context):
        try:
            return execute(self, context)
        except (ReflcolorError, UsageError) as error:
            self.report({"ERROR"}, shown(error.message))
            return {"CANCELLED"}
        except ImportError as error:
            missing = missing_package(error)
            if missing is None:
                raise
            self.report({"ERROR"}, shown(missing))
            return {"CANCELLED"}

    return reporting
