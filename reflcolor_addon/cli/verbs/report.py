"""The verb ``report``: one page and one table of all that a batch has made."""

from pathlib import Path

from ...errors import ReflcolorError
from ...messages import Message
from ...report.archive import write_page
from ...report.archive_entries import REPORTS

NAME = "report"
HELP = "make one page and one table of a batch"


def add_arguments(parser):
    """Declare what ``report`` takes."""
    parser.add_argument("input", metavar="DIR", type=Path, help="the output folder of a batch")
    parser.add_argument("--fail", action="store_true", help="end with 1 if a scan failed")
    parser.add_argument("--openjd", action="store_true", help="tell a failure as Open Job Description has it")


def run(arguments, session):
    """Merge the reports of a batch into report.html, which any browser opens from the disk, and report.csv."""
    if not arguments.input.is_dir():
        raise ReflcolorError("{folder}: there is no such folder", folder=arguments.input)
    if not (arguments.input / REPORTS).is_dir():
        raise ReflcolorError(
            "{folder}: is not the output folder of a batch: it has no folder reports", folder=arguments.input
        )
    paths, failed = write_page(arguments.input, session)
    for path in paths:
        session.say(Message("wrote {path}", path=path))
    if failed and arguments.fail:
        message = Message(
            "{folder}: {count} failed: {names}; see the folder logs",
            folder=arguments.input,
            count=len(failed),
            names=", ".join(failed),
        )
        if arguments.openjd:
            session.say(f"openjd_fail: {message}")
        raise ReflcolorError(message)
