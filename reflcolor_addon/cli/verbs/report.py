"""The verb ``report``: one page and one table of all that a batch has made."""

from pathlib import Path

from ...errors import UsageError
from ...messages import Message
from ...report.archive import write_page

NAME = "report"
HELP = "make one page and one table of a batch"


def add_arguments(parser):
    """Declare what ``report`` takes."""
    parser.add_argument("input", metavar="DIR", type=Path, help="the output folder of a batch")


def run(arguments, session):
    """Merge the reports of a batch into report.html, which any browser opens from the disk, and report.csv."""
    if not (arguments.input / "reports").is_dir():
        raise UsageError(
            "{folder}: is not the output folder of a batch: it has no folder reports", folder=arguments.input
        )
    for path in write_page(arguments.input, session):
        session.say(Message("wrote {path}", path=path))
