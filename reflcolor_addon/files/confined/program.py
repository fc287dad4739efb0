"""What the programs of child processes have in common; it imports nothing of the package."""

import importlib.util
import json
import mmap
import os
import sys


def shared_memory(number, path):
    """Return the memory that is shared with the parent, as a memoryview: an open file, or one that is opened."""
    if number is None:
        number = os.open(path, os.O_RDWR | getattr(os, "O_BINARY", 0))
    return memoryview(mmap.mmap(number, 0))


def library_at(name, path, folders=()):
    """Return a native module as it lies in its wheel, without the Python around it.

    Parameters
    ----------
    name : str
        Of the module.
    path : str
    folders : sequence of str
        Of the libraries that it needs on Windows.
    """
    for folder in folders:
        os.add_dll_directory(folder)
    spec = importlib.util.spec_from_file_location(name, path)
    library = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(library)
    return library


def send(answer):
    """Send an answer to the parent: a line of JSON."""
    sys.stdout.write(json.dumps(answer) + "\n")
    sys.stdout.flush()
