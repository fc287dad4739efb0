"""Limits on a child process on Windows, set from outside by a job object."""

import ctypes

_LIMITS = 9
_PROCESS_TIME, _ACTIVE_PROCESSES, _PROCESS_MEMORY, _KILL_ON_CLOSE = 0x2, 0x8, 0x100, 0x2000


class _Basic(ctypes.Structure):
    _fields_ = (
        ("process_time", ctypes.c_int64),
        ("job_time", ctypes.c_int64),
        ("flags", ctypes.c_uint32),
        ("least_working_set", ctypes.c_size_t),
        ("most_working_set", ctypes.c_size_t),
        ("active_processes", ctypes.c_uint32),
        ("affinity", ctypes.c_size_t),
        ("priority", ctypes.c_uint32),
        ("scheduling", ctypes.c_uint32),
    )


class _Limits(ctypes.Structure):
    _fields_ = (
        ("basic", _Basic),
        ("transfers", ctypes.c_uint64 * 6),
        ("process_memory", ctypes.c_size_t),
        ("job_memory", ctypes.c_size_t),
        ("peak_process_memory", ctypes.c_size_t),
        ("peak_job_memory", ctypes.c_size_t),
    )


def limited(process_handle, *, memory, seconds):
    """Put a process into a job: it ends when the job is closed, starts no other, and has so much memory and time.

    Parameters
    ----------
    process_handle : int
    memory : int
        Bytes.
    seconds : int
        Of the processor.

    Returns
    -------
    callable
        Closes the job.

    Raises
    ------
    OSError
        If Windows refuses.
    """
    kernel = ctypes.windll.kernel32
    kernel.CreateJobObjectW.restype = ctypes.c_void_p
    job = ctypes.c_void_p(kernel.CreateJobObjectW(None, None))
    limits = _Limits()
    limits.basic.flags = _PROCESS_TIME | _ACTIVE_PROCESSES | _PROCESS_MEMORY | _KILL_ON_CLOSE
    # Windows counts in tenths of a microsecond.
    limits.basic.process_time = seconds * 10_000_000
    limits.basic.active_processes = 1
    limits.process_memory = memory
    if not (
        job
        and kernel.SetInformationJobObject(job, _LIMITS, ctypes.byref(limits), ctypes.sizeof(limits))
        and kernel.AssignProcessToJobObject(job, ctypes.c_void_p(process_handle))
    ):
        raise OSError("Windows gives no job to the process that reads the file")
    return lambda: kernel.CloseHandle(job)
