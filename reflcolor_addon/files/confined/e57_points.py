"""The child process that reads the points of an E57: run as a program, with what to read on its standard input.

It imports nothing of the package, and needs nothing but this folder and the library: one line of JSON comes in (see
`main`), then a line for each scan that is wanted; lines of JSON go out. Points go into a file that the parent holds
open, one column of doubles after the other.
"""

import json
import sys
from pathlib import Path

_RECORDS = 1 << 16
"""Records that are read at a time."""


def main(lines, answer):
    """Do what the lines ask for.

    Parameters
    ----------
    lines : iterable of str
        First ``{"library": path, "folders": [of DLLs], "file": [number or null, path], "columns": [number or null,
        path], "memory": bytes, "written": bytes, "seconds": number}``, then for each scan
        ``{"scan": index, "vector": [names below it], "count": records, "fields": [names]}``.
    answer : callable
        Called with each answer: ``{"at": records so far}``, ``{"done": records}``, or ``{"error": text}``.
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
            done = _read(library, image, records, wanted["fields"], wanted["count"], columns, answer)
            answer({"done": done})
    except MemoryError:
        answer({"error": "ErrorMemory"})
    except Exception as error:  # native code raises errors of any type: only their text is usable
        answer({"error": str(error)[:10_000]})


def _read(library, image, records, fields, count, columns, answer):
    chunk = memoryview(bytearray(8 * _RECORDS * len(fields)))
    places = [slice(8 * _RECORDS * place, 8 * _RECORDS * (place + 1)) for place in range(len(fields))]
    buffers = library.VectorSourceDestBuffer()
    for name, place in zip(fields, places, strict=True):
        buffers.append(library.SourceDestBuffer(image, name, chunk[place].cast("d"), _RECORDS, True, True))
    reader = records.reader(buffers)
    at = 0
    try:
        while at < count and (done := reader.read()):
            done = min(done, count - at)
            for place in range(len(fields)):
                start, source = 8 * (place * count + at), places[place].start
                columns[start : start + 8 * done] = chunk[source : source + 8 * done]
            at += done
            answer({"at": at})
    finally:
        reader.close()
    return at


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    from program import send

    main(sys.stdin, send)
