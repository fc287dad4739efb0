"""Writing by steps, between which the window can be drawn: generators, which yield nothing.

Where something is undone between two steps, the rest is dropped (`jobs`).
"""

from inspect import isgenerator


def complete(steps):
    """Do all that is left of the steps; of what is no generator, nothing is left."""
    if isgenerator(steps):
        for _ in steps:
            pass
