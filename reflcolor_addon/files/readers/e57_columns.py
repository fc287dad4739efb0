"""The points of an E57 file, read by a child process into memory that is shared with it."""

import re
import sys
from pathlib import Path

import numpy as np

from ...errors import ScanError
from ..confined.reading import ConfinedReading, native_library
from ..gate import size_of

SCRIPT = Path(__file__).resolve().parent.parent / "confined" / "e57_points.py"
_WORD = 8
_ROOM = 1 << 19
"""Records that are read at a time."""

# What the child may take: the library, its nodes for every byte of the XML section, and its buffers.
_BASE_BYTES, _BYTES_PER_XML_BYTE = 1 << 29, 40
# Seconds of the processor: far more than the slowest machine needs.
_BASE_SECONDS, _BYTES_PER_SECOND = 15, 2_000_000

_REASONS = {
    "ErrorBadChecksum": "a checksum does not match: the file is damaged; copy or export it again",
    "ErrorBadXMLFormat": "its XML section is damaged; copy or export it again",
    "ErrorXMLParser": "its XML section is damaged; copy or export it again",
    "ErrorBadCVHeader": "its point section is damaged; copy or export it again",
    "ErrorBadCVPacket": "its point section is damaged; copy or export it again",
    "ErrorBadFileLength": "its length is not what its header says; copy or export it again",
    "ErrorReadFailed": "it ends too early; copy or export it again",
    "ErrorMemory": "does not fit into memory",
}


class E57Columns:
    """Reads points, scan after scan; a context manager.

    Parameters
    ----------
    file : binary file
        The E57, open.
    path : Path
        Its place, for messages and for systems that cannot hand on what is open.
    fields, count : int
        The most fields, and the most records, that any of the scans has.
    xml_size : int
        Bytes of the XML section.
    cancelled : callable, optional

    Raises
    ------
    ScanError
        In one line, here and from every method.
    Cancelled
        If ``cancelled()`` returned True.
    """

    def __init__(self, file, path, *, fields, count, xml_size, cancelled=None):
        self._path = path
        library, folders = library_of(path)
        self._room = min(_ROOM, max(1, count))
        size = max(1, fields) * self._room * _WORD
        self._reading = ConfinedReading(
            SCRIPT,
            "E57",
            file,
            path,
            size=size,
            limits={
                "memory": _BASE_BYTES + size + _BYTES_PER_XML_BYTE * xml_size,
                "seconds": _BASE_SECONDS + size_of(file) // _BYTES_PER_SECOND,
            },
            request={"library": str(library), "folders": folders},
            reason_of=reason_of,
            cancelled=cancelled,
        )

    def __enter__(self):
        self._reading.__enter__()
        return self

    def __exit__(self, *error):
        self._reading.__exit__(*error)

    def read(self, index, count, fields, report, vector=("points",)):
        """Read the points of a scan, piece by piece.

        Parameters
        ----------
        index : int
            Its place in the file, from 0.
        count : int
            Records that it announces.
        fields : sequence of str
        report : callable
            Called with a fraction.
        vector : sequence of str
            Where the records are below the scan's node: its points, or its groups of them.

        Yields
        ------
        dict of str to (n,) float64
            The next records. Views of the shared memory: what comes after overwrites them.
        """
        report(0.0)
        wanted = {"scan": index, "vector": list(vector), "count": count, "room": self._room, "fields": list(fields)}
        self._reading.ask(wanted)
        at = 0
        while True:
            kind, number = self._reading.answer(read=min(self._room, count - at), done=count)
            if kind == "done":
                break
            yield {
                name: np.frombuffer(self._reading.memory, np.float64, number, _WORD * self._room * place)
                for place, name in enumerate(fields)
            }
            at += number
            report(at / count)
            self._reading.ask({})
        if not at == number == count:
            raise ScanError(
                "{file}: holds {found:,} points where {count:,} were announced; it is damaged",
                file=self._path.name,
                found=number,
                count=count,
            )


def library_of(path):
    """Where libE57 lies in the wheel, and the folders of the libraries that it needs on Windows."""
    found = native_library("pye57", "libe57.*")
    if found is None:
        raise ScanError("{file}: E57 needs pye57, which this platform has not; export the scan as PTX", file=path.name)
    beside = (found.parent, found.parent.with_name("pye57.libs"))
    return found, [str(folder) for folder in beside if sys.platform == "win32" and folder.is_dir()]


def reason_of(text, unknown="cannot be read as E57"):
    """Why the library refused something, as the end of a line; what it says itself where nothing better is known."""
    # libE57 tells its code in the first line, and where in its own source in the others.
    first = text.strip().partition("\n")[0]
    code = re.search(r"Error\w+", first)
    return _REASONS.get(code[0] if code else None) or f"{unknown} ({first})"
