"""The verbs of the command line, one module each.

A verb's module has ``NAME`` and ``HELP``, ``add_arguments(parser)`` and ``run(arguments, session)``.
"""

from . import batch, colorize, evaluate, info, manifest, provenance, report, seeds, simulate, verify, work

VERBS = (info, seeds, colorize, evaluate, provenance, verify, simulate, manifest, batch, report, work)
