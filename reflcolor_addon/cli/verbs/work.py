"""The verb ``work``: how a batch starts its processes; nobody types it."""

from ...batch.archive.worker import serve

NAME = "work"
HELP = None


def add_arguments(parser):
    """``work`` takes no arguments."""
    parser.set_defaults(input=None)


def run(_arguments, session):
    """Do what standard input asks for, line by line, until it ends."""
    serve(session)
