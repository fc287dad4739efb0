"""The child process that decompresses the points of a LAZ: run as a program, with what to read on its standard input.

It imports nothing of the package, and needs nothing but this folder and the library. One line of JSON comes in (see
`main`); lines of JSON go out. The records go into a file that the parent holds open, as an uncompressed LAS has them.
"""

import json
import sys
from pathlib import Path

_RECORDS = 1 << 18
"""That are read at a time."""


def main(lines, answer):
    """Do what the line asks for.

    Parameters
    ----------
    lines : iterable of str
        One: ``{"library": path, "file": [number or null, path], "columns": [number or null, path], "at": first byte of
        the points, "laszip": [bytes of the record that describes the compression], "count": records, "record": bytes
        of one, "memory": bytes, "written": bytes, "seconds": number}``.
    answer : callable
        Called with each answer: ``{"at": records so far}``, ``{"done": records}``, or ``{"error": text}``.
    """
    from confinement import confine, reopened
    from program import library_at, shared_memory

    request = json.loads(next(iter(lines)))
    records = shared_memory(*request["columns"])
    library = library_at("lazrs", request["library"])
    confine(**{key: request[key] for key in ("memory", "written", "seconds")})
    answer({"ready": True})
    try:
        with Path(reopened(*request["file"])).open("rb") as file:
            file.seek(request["at"])
            unpacked = library.LasZipDecompressor(file, bytes(request["laszip"]))
            size, count = request["record"], request["count"]
            for first in range(0, count, _RECORDS):
                last = min(count, first + _RECORDS)
                unpacked.decompress_many(records[first * size : last * size])
                answer({"at": last})
        answer({"done": count})
    except MemoryError:
        answer({"error": "memory"})
    except (
        BaseException
    ) as error:  # whatever native code raises, panics of Rust included: its text is all that there is
        answer({"error": str(error)[:10_000]})


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    from program import send

    main(sys.stdin, send)
