"""The child process that reads the points of an E57: run as a program, with what to read on its standard input.

It imports nothing of the package, and needs nothing but this folder and the library: one line of JSON comes in (see
`main`), then a line for each scan that is wanted; lines of JSON go out. Points go into a file that the parent holds
open, one column of doubles after the other, as many as it has room for at a time.
"""

import json
import sys
from pathlib import Path


def main(lines, answer):
    """Do what the lines ask for.

    Parameters
    ----------
    lines : iterable of str
        First ``{"library": path, "folders": [of DLLs], "file": [number or null, path], "columns": [number or null,
        path], "memory": bytes, "written": bytes, "seconds": number}``, then for each scan
        ``{"scan": index, "vector": [names below it], "count": records, "room": records, "fields": [names]}``, and any
        line after each answer ``{"read": records}``, when what was read has been taken.
    answer : callable
        Called with each answer: ``{"read": records}``, ``{"done": records in all}``, or ``{"error": text}``.
    """
    from confinement import confine, reopened
    from program import library_at, shared_memory

    lines = iter(lines)
    request = json.loads(next(lines))
    columns = shared_memory(*request["columns"])
    library = library_at("libe57", request["library"], request["folders"])
    confine(**{key: request[key] for key in ("memory", "written", "seconds")})
    answer({"ready": True})
    try:
        image = library.ImageFile(reopened(*request["file"]), "r")
        scans = image.root()["data3D"]
        for line in lines:
            wanted = json.loads(line)
            records = scans[wanted["scan"]]
            for name in wanted["vector"]:
                records = records[name]
            reader = records.reader(_buffers(library, image, wanted["fields"], wanted["room"], columns))
            try:
                at = 0
                while at < wanted["count"] and (done := reader.read()):
                    done = min(done, wanted["count"] - at)
                    at += done
                    answer({"read": done})
                    next(lines)
            finally:
                reader.close()
            answer({"done": at})
    except MemoryError:
        answer({"error": "ErrorMemory"})
    except Exception as error:  # native code raises errors of any type: only their text is usable
        answer({"error": str(error)[:10_000]})


def _buffers(library, image, fields, room, columns):
    """Where the library puts the records: each field into its own column."""
    buffers = library.VectorSourceDestBuffer()
    for place, name in enumerate(fields):
        column = columns[8 * room * place : 8 * room * (place + 1)].cast("d")
        buffers.append(library.SourceDestBuffer(image, name, column, room, True, True))
    return buffers


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    from program import send

    main(sys.stdin, send)
