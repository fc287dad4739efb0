"""Which failures are temporary, so that a second try makes sense."""

import errno

_PASSING = {
    getattr(errno, name)
    for name in ("ENOSPC", "EDQUOT", "EIO", "EAGAIN", "EBUSY", "ESTALE", "ETIMEDOUT", "ENOMEM")
    if hasattr(errno, name)
}


def may_pass(error):
    """Return whether an error comes from a disk that is full, or a share that is gone for a while."""
    cause = error
    while cause is not None:
        if isinstance(cause, OSError) and cause.errno in _PASSING:
            return True
        cause = cause.__cause__
    return False
