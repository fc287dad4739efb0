"""The verbs of the command line, one module each.

A verb's module has ``NAME`` and ``HELP``, ``add_arguments(parser)`` and ``run(arguments, session)``.
"""

from . import colorize, evaluate, info, provenance, seeds, simulate, verify

VERBS = (info, seeds, colorize, evaluate, provenance, verify, simulate)
