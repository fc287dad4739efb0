"""The command line: one parser for ``python -m reflcolor_addon`` and ``blender -b --command reflcolor``.

Exit status: 0 done, 1 bad input, 2 wrong usage, 130 interrupted. Whatever is wrong is said in one line.
"""

import argparse
from functools import partial

from ..batch.session import Session
from ..bundled import missing_package
from ..errors import Cancelled, ReflcolorError, UsageError
from ..version import __version__
from .console import Console
from .interruption import Interruption
from .verbs import VERBS

DONE, BAD_INPUT, WRONG_USAGE = 0, 1, 2


def main(argv, *, prog="python -m reflcolor_addon", blender=None):
    """Run one command and return its exit status.

    Parameters
    ----------
    argv : list of str
        The arguments, without the program's name.
    prog : str
        How the person called the program, for messages.
    blender : BlenderTasks, optional
        What only Blender can do. Without it, asking for that is wrong usage.
    """
    console = Console()
    try:
        arguments = _parser(prog).parse_args(argv)
    except UsageError as error:
        console.error(str(error))
        return WRONG_USAGE
    except SystemExit as end:  # how argparse ends after --help and --version
        return int(end.code or 0)
    with Interruption() as interruption:
        session = Session(say=console.print, show=console.progress, cancelled=interruption.requested, blender=blender)
        try:
            arguments.run(arguments, session)
            for warning in session.warnings:
                console.warn(warning)
            return DONE
        except UsageError as error:
            console.error(str(error))
            return WRONG_USAGE
        except (Cancelled, KeyboardInterrupt):
            status, message = interruption.exit_status, "interrupted"
        except ReflcolorError as error:
            # A signal can surface as the failure of whatever it struck.
            status = interruption.exit_status if interruption.requested() else BAD_INPUT
            message = str(error)
        except ImportError as error:
            message = missing_package(error)
            if message is None:
                raise
            status = BAD_INPUT
        except MemoryError:
            files = arguments.input if isinstance(arguments.input, list) else [arguments.input]
            status, message = BAD_INPUT, f"{', '.join(map(str, files))}: not enough memory for a scan of this size"
    if session.written:
        message += f"; already written: {', '.join(map(str, session.written))}"
    console.error(message)
    return status


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, and leaves the end of the program to the caller."""

    def error(self, message):
        raise UsageError(f"{message} (see {self.prog} --help)")


def _parser(prog):
    parser = _Parser(
        prog=prog,
        description="Color for laser scans that have none, from a few seeds.",
        epilog="Exit status: 0 done, 1 bad input, 2 wrong usage, 130 interrupted.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"reflcolor {__version__}")
    verbs = parser.add_subparsers(
        dest="verb", metavar="VERB", required=True, parser_class=partial(_Parser, allow_abbrev=False)
    )
    for verb in VERBS:
        subparser = verbs.add_parser(verb.NAME, help=verb.HELP, description=verb.run.__doc__)
        verb.add_arguments(subparser)
        subparser.set_defaults(run=verb.run)
    return parser
