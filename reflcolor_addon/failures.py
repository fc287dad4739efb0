"""The outermost boundary, for the command line and Blender's operators alike: what a failure is to the person.

Bad input, a missing package, too little memory, and whatever the operating system refuses are one line. Anything else
is a defect of the package and surfaces with its traceback.
"""

import sys
from pathlib import Path

from .bundled import missing_package
from .errors import ReflcolorError, UsageError
from .messages import Message

NO_MEMORY = "not enough memory; close other programs, or read the scan with a larger step"
_CV2_NO_MEMORY = -4


def line_of(error):
    """Return the one line that tells a person of an exception; None where it is a defect.

    Parameters
    ----------
    error : BaseException

    Returns
    -------
    Message or None
    """
    if isinstance(error, ReflcolorError | UsageError):
        return error.message
    if isinstance(error, MemoryError) or _is_opencv_out_of_memory(error):
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
    # Looked up, not imported: an error of OpenCV is there only where OpenCV is.
    opencv = sys.modules.get("cv2")
    return opencv is not None and isinstance(error, opencv.error) and error.code == _CV2_NO_MEMORY


def _current_folder_is_gone():
    try:
        Path.cwd()
    except OSError:
        return True
    return False


def _text(filename):
    return filename.decode(errors="backslashreplace") if isinstance(filename, bytes) else str(filename)
