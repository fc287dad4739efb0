"""Adds an output that was made later to a report."""

from .provenance import read_report
from .report import REPORT_OPTION, output_entry, write_report


def add_output(report_path, option, path):
    """Add an output to the report of its scan, in place of what the report says of that file so far.

    Parameters
    ----------
    report_path : Path
    option : str
        What asked for it.
    path : Path

    Raises
    ------
    ReflcolorError
        If the report, or the output, cannot be read, or the report cannot be written.
    """
    report = read_report(report_path)
    entry = output_entry(option, path, report_path)
    outputs = [other for other in report["outputs"] if other["path"] != entry["path"]]
    # What a report says of itself stays at the end.
    place = next((k for k, other in enumerate(outputs) if other["option"] == REPORT_OPTION), len(outputs))
    outputs.insert(place, entry)
    write_report(report_path, report | {"outputs": outputs})
