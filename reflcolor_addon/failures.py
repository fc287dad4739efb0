"""Turns failures into one line for the user, at the outermost boundary of the command line and of Blender's operators.

Bad input, a missing package, too little memory, and errors of the operating system become one line. Anything else is a
defect of the package and surfaces with its traceback.
"""

import sys
from pathlib import Path

from .bundled import missing_package
from .errors import ReflcolorError, UsageError
from .messages import Message

NO_MEMORY = "not enough memory; close other programs, or read the scan with a larger step"
_CV2_NO_MEMORY = -4


def line_of(error):
    """Return the line that explains an exception to the user; None where it is a defect.

    Parameters
    ----------
    error : BaseException

    Returns
    -------
    Message or None
    """
    if isinstance(error, ReflcolorError | UsageError):
        return error.message
    if isinstance(error, MemoryError) or _is_opencv_out_of_memory(error) or _is_library_out_of_memory(error):
        return Message(NO_MEMORY)
    if isinstance(error, ImportError):
        return missing_package(error)
    if isinstance(error, OSError):
        reason = error.strerror or str(error) or type(error).__name__
        if error.filename is None and _current_folder_is_gone():
            return Message("the current folder was deleted; change to another, or name files by their whole path")
        if error.filename is None:
            return Message("the operating system reports: {reason}", reason=reason)
        return Message("{file}: {reason}", file=_text(error.filename), reason=reason)
    return None


def _is_opencv_out_of_memory(error):
    # Looked up, not imported: an error of OpenCV can only occur if OpenCV was imported.
    opencv = sys.modules.get("cv2")
    return opencv is not None and isinstance(error, opencv.error) and error.code == _CV2_NO_MEMORY


def _is_library_out_of_memory(error):
    """Whether a native library could not be loaded for want of memory, in the words of the loader of Linux."""
    return isinstance(error, ImportError) and str(error).endswith("failed to map segment from shared object")


def _current_folder_is_gone():
    try:
        Path.cwd()
    except OSError:
        return True
    return False


def _text(filename):
    return filename.decode(errors="backslashreplace") if isinstance(filename, bytes) else str(filename)
