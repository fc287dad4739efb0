"""How often a photo is verified, one that shows the scan and one that does not: python -m benchmarks.trust

Every scan of benchmarks.trust_cases, as it is and with holes in pixels, lines and blobs of 3 to 20 percent, is matched
with photos that show it and with photos of many kinds that do not. Each try is kept in a file; started again, the
command goes on where it was, so that it may be stopped at any time. The tries are in an order as if drawn at random:
what was tried so far stands for the whole.

The rates are printed for each kind, with the limits that they lie within (exact ones of the binomial, 95 percent), and
the evidence of the surest wrong photos and of the least sure right ones, as a share of what is needed.
"""

import argparse
import contextlib
import hashlib
import json
import time
import zlib
from collections import defaultdict
from pathlib import Path

import numpy as np

from benchmarks import trust_cases
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews, register

RESULTS = Path("build/trust.jsonl")
# Of each kind, for one scan with one kind of holes, so that about half are photographs; others of these for each scan.
_OF_KIND = {"noise": 4, "foreign": 9, "scrambled": 2, "elsewhere": 2, "mirrored": 2, "upside-down": 2, "reflectance": 2}


def main():
    """Try what is not in the file, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=RESULTS, help="the file of tries")
    parser.add_argument("--minutes", type=float, default=np.inf, help="stop after so long; 0 only prints the table")
    parser.add_argument("--scan", action="append", choices=trust_cases.SCANS, help="only these scans")
    parser.add_argument("--holes", action="append", choices=trust_cases.HOLES, help="only these holes")
    parser.add_argument("--kind", action="append", choices=trust_cases.WRONG + trust_cases.RIGHT, help="only these")
    parser.add_argument("--every-foreign", action="store_true", help="all photographs for each scan, not some of them")
    arguments = parser.parse_args()
    ends = time.monotonic() + 60 * arguments.minutes
    known = {try_["key"]: try_ for try_ in _read(arguments.results)}
    photographs = {}
    arguments.results.parent.mkdir(parents=True, exist_ok=True)
    with arguments.results.open("a", encoding="utf-8") as file:
        for group in _groups(arguments):
            if time.monotonic() >= ends:
                break
            for try_ in _tried(group, arguments, known, photographs, ends):
                known[try_["key"]] = try_
                file.write(json.dumps(try_) + "\n")
                file.flush()
    table([try_ for try_ in known.values() if _asked(try_, arguments)])


def _groups(arguments):
    """Pairs of a scan's name and holes, in an order as if at random."""
    pairs = [
        (scan, holes) for scan in arguments.scan or trust_cases.SCANS for holes in arguments.holes or trust_cases.HOLES
    ]
    return sorted(pairs, key=lambda pair: zlib.crc32("|".join(pair).encode()))


def _asked(try_, arguments):
    return all(
        chosen is None or try_[key] in chosen
        for key, chosen in (("scan", arguments.scan), ("holes", arguments.holes), ("kind", arguments.kind))
    )


def _photos(scan, holes, arguments):
    """Yield kind, name and image of what one scan with one kind of holes is matched with."""
    for kind in trust_cases.WRONG:
        if arguments.kind is None or kind in arguments.kind:
            photos = sorted(
                trust_cases.wrong(scan, kind), key=lambda photo: zlib.crc32(f"{scan}|{holes}|{photo[0]}".encode())
            )
            count = len(photos) if kind == "foreign" and arguments.every_foreign else _OF_KIND[kind]
            yield from ((kind, *photo) for photo in photos[:count])
    for kind, name, rgb in trust_cases.right(scan):
        if arguments.kind is None or kind in arguments.kind:
            yield kind, name, rgb


def _tried(group, arguments, known, photographs, ends):
    """Yield a dict of what became of each photo of a group that is not known yet; photographs are kept as images."""
    scan_name, holes = group
    views = None
    for kind, name, rgb in _photos(*group, arguments):
        key = f"{scan_name}|{holes}|{kind}|{name}"
        if key in known or time.monotonic() >= ends:
            continue
        if views is None:
            views = ScanViews(trust_cases.with_holes(trust_cases.scan(scan_name), holes))
        started = time.process_time()
        if kind in ("foreign", "elsewhere"):
            photo = photographs.setdefault(name, PhotoImage(name, rgb))
        else:
            photo = PhotoImage(name, rgb)
        found = register(views, photo)
        proof = found.evidence
        off = None
        if kind in ("pair", "all around") and found.model is not None:
            off = trust_cases.off(scan_name, found.model)
        yield {
            "key": key,
            "scan": scan_name,
            "holes": holes,
            "kind": kind,
            "photo": name,
            "verified": bool(found.accepted),
            "evidence": round(proof.share, 3),
            "found_by": found.found_by,
            "off": off,
            "seconds": round(time.process_time() - started, 2),
            "code": _code(),
            "numbers": {name: float(value) for name, value in vars(proof).items()},
        }


def table(tries):
    """Print the rates of each kind."""
    kinds = defaultdict(list)
    for try_ in tries:
        kinds[try_["kind"]].append(try_)
    wrong = [kind for kind in trust_cases.WRONG if kind in kinds]
    print(
        f"{'kind':12} {'tries':>6} {'scans':>6} {'verified':>9} {'rate':>7}  limits         evidence           seconds"
    )
    for kind in (*wrong, *(kind for kind in trust_cases.RIGHT if kind in kinds)):
        _row(kind, kinds[kind], kind in wrong)
    if wrong:
        _row("all wrong", [try_ for kind in wrong for try_ in kinds[kind]], True)
    others = sum(try_["code"] != _code() for try_ in tries)
    if others:
        print(f"{others} of these tries were made with another state of the code; delete the file to make them anew")
    for try_ in tries:
        if try_["verified"] and try_["kind"] in trust_cases.WRONG:
            print(f"VERIFIED though wrong: {try_['key']}, evidence {try_['evidence']}")
    for try_ in tries:
        if try_["off"] is not None:
            verdict = "verified" if try_["verified"] else "refused"
            print(f"{try_['key']}: {verdict}, off {100 * try_['off']:.2f} % of the width")


def _row(kind, tries, is_wrong):
    from scipy.stats import beta

    count, verified = len(tries), sum(try_["verified"] for try_ in tries)
    low = beta.ppf(0.025, verified, count - verified + 1) if verified else 0.0
    high = beta.ppf(0.975, verified + 1, count - verified) if verified < count else 1.0
    evidence = np.array([try_["evidence"] for try_ in tries])
    surest = f"most {evidence.max():.2f}" if is_wrong else f"least {evidence.min():.2f}"
    middle = f"median {np.median(evidence):.2f}, {surest}"
    scans = len({try_["scan"] for try_ in tries})
    seconds = np.mean([try_["seconds"] for try_ in tries])
    rate = f"{verified:9d} {verified / count:7.4f}  {low:.4f}..{high:.4f}"
    print(f"{kind:12} {count:6d} {scans:6d} {rate}  {middle:26} {seconds:6.1f}")


def _code():
    """A short name of the state of the code that tries photos."""
    folder = Path(trust_cases.__file__).parent.parent / "reflcolor_addon" / "matching"
    digest = hashlib.sha256()
    for path in sorted([*folder.glob("*.py"), *(folder / "registration").glob("*.py")]):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:8]


def _read(path):
    with contextlib.suppress(FileNotFoundError), path.open(encoding="utf-8") as file:
        # A line that was cut when the command was stopped is tried again.
        for line in file:
            with contextlib.suppress(json.JSONDecodeError):
                yield json.loads(line)


if __name__ == "__main__":
    main()
