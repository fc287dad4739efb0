"""The command line: one parser for ``python -m reflcolor_addon`` and ``blender -b --command reflcolor``.

Exit status: 0 done, 1 bad input, 2 wrong usage, 130, 143 or 129 interrupted. Whatever is wrong is said in one line.
"""

import argparse
from collections import Counter
from functools import partial

from ..batch.session import Session
from ..errors import Cancelled, UsageError
from ..failures import line_of
from ..messages import Message, value_of
from ..version import __version__
from .console import Console, open_standard_streams
from .interruption import Interruption
from .verbs import VERBS

DONE, BAD_INPUT, WRONG_USAGE = 0, 1, 2
_INTERRUPTED = "interrupted"
_MOST_OF_A_KIND = 20


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
    with Interruption() as interruption:
        open_standard_streams()
        console = Console()
        session = Session(
            say=console.print,
            complain=console.error,
            show=console.progress,
            cancelled=interruption.requested,
            blender=blender,
        )
        try:
            status, line = _outcome(argv, prog, session, console, interruption)
        except KeyboardInterrupt:  # a second signal: the user does not want to wait
            status, line = interruption.exit_status, _INTERRUPTED
        if line is not None:
            written = f"; already written: {', '.join(map(str, session.written))}" if session.written else ""
            console.error(line + written)
        console.finish()
        return status


def _outcome(argv, prog, session, console, interruption):
    """Run a command; return the exit status and, where it failed, the line that says why."""
    files = ""
    try:
        arguments = _parser(prog).parse_args(argv)
        files = ", ".join(map(str, _inputs(arguments)))
        arguments.run(arguments, session)
        _warn(session, console)
        return DONE, None
    except SystemExit as end:  # how argparse ends after --help and --version
        return int(end.code or 0), None
    except Cancelled as end:
        return interruption.exit_status, str(end) or _INTERRUPTED
    except Exception as error:
        line = line_of(error)
        if line is None:
            raise
        # A signal can show up as an error of the code that it interrupted.
        if interruption.requested():
            return interruption.exit_status, _INTERRUPTED
        # What was noticed before may be the reason.
        _warn(session, console)
        if isinstance(error, MemoryError) and files:
            line = f"{files}: {line}"
        return WRONG_USAGE if isinstance(error, UsageError) else BAD_INPUT, line


def _warn(session, console):
    """Print what was noticed; of what is noticed again and again, about each scan of a file, only some."""
    kinds = Counter()
    for warning in session.warnings:
        kind = value_of(warning, "note") or warning
        kinds[template := getattr(kind, "template", kind)] += 1
        if kinds[template] <= _MOST_OF_A_KIND:
            console.warn(warning)
    if more := sum(max(0, count - _MOST_OF_A_KIND) for count in kinds.values()):
        console.warn(Message("{count:,} more of the same kinds", count=more))


def _inputs(arguments):
    """The files that a command works on."""
    given = arguments.input
    return given if isinstance(given, list) else [given] * (given is not None)


class _Parser(argparse.ArgumentParser):
    """Reports errors in one line, and leaves it to the caller to end the program."""

    def error(self, message):
        raise UsageError("{message} (see {prog} --help)", message=message, prog=self.prog)


def _parser(prog):
    parser = _Parser(
        prog=prog,
        description="Color for laser scans that have none, from a few seeds.",
        epilog="Exit status: 0 done, 1 bad input, 2 wrong usage, 130, 143 or 129 interrupted.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"reflcolor {__version__}")
    verbs = parser.add_subparsers(
        dest="verb", metavar="VERB", required=True, parser_class=partial(_Parser, allow_abbrev=False)
    )
    for verb in VERBS:
        # A verb without a help is not listed.
        shown = {} if verb.HELP is None else {"help": verb.HELP}
        subparser = verbs.add_parser(verb.NAME, description=verb.run.__doc__, **shown)
        verb.add_arguments(subparser)
        subparser.set_defaults(run=verb.run)
    return parser
