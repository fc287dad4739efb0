"""How often a photo is verified, one that shows the scan and one that does not: python -m benchmarks.trust

Every scan of benchmarks.trust_cases, as it is and with holes in pixels, lines and blobs of 3 to 20 percent, is matched
with photos that show it and with photos of many kinds that do not. Each try is kept in a file, benchmarks/trust.jsonl,
which belongs to the project, so that tries made at different times add up; started again, the command goes on where it
was, so that it may be stopped at any time. The tries are in an order as if drawn at random, every scan once before any
comes again: what was tried so far stands for the whole. Several processes may share the work: --part 1/2 and --part 2/2
with a file of their own each, which are put together afterward.

The rates are printed for each kind, with the limits that they lie within (exact ones of the binomial, 95 percent), and
the evidence of the surest wrong photos and of the least sure right ones, as a share of what is needed; then, for
several bars, how many wrong and how many right photos reach them.

The file has one JSON object a line for each try: key (scan|holes|kind|photo, by which a try is known again), scan,
holes, kind, photo, verified, evidence (1 is needed), found_by, off (how far the camera is off as a share of the photo's
width, where the true one is known), seconds (of the processor), code (the state of the modules that decide a verdict,
without comments: tries of a state that decides otherwise are not counted and are made anew), numbers (the fields of
Evidence) and wide (what registration/repetition.py looks at, whatever the verdict: how many tiles are in place, how
many of these in windows three times as wide, and the mean score of all there), so that another measure or bar can be
judged afterward.
"""

import argparse
import ast
import contextlib
import hashlib
import json
import time
import zlib
from collections import defaultdict
from functools import cache
from itertools import islice, product
from pathlib import Path

import numpy as np

from benchmarks import trust_cases
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.fitting import FINE
from reflcolor_addon.matching.registration.registration import ScanViews, register
from reflcolor_addon.matching.registration.tiles import surfaces
from reflcolor_addon.matching.registration.verification import RADIUS, in_place

RESULTS = Path(__file__).with_suffix(".jsonl")
# Of each kind, for one scan with one kind of holes, so that about half are photographs; others of these for each scan.
_OF_KIND = {"noise": 4, "foreign": 9, "scrambled": 2, "elsewhere": 2, "mirrored": 2, "upside-down": 2, "reflectance": 2}
# The photos of one scan with one kind of holes are tried in so many parts, each of photos of all kinds.
_PARTS = 3
# The bars that the table of right and wrong photos is printed for.
_BARS = (0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0)
# The modules of reflcolor_addon/matching that decide a verdict.
_DECIDING = (
    *("edges", "grid_angles", "models", "photo_image", "scan_image"),
    *(f"registration/{name}" for name in ("features", "fitting", "refinement", "registration", "search", "sphere_map")),
    *("registration/tiles", "registration/verification", "registration/repetition"),
)
# States of these that decide alike: since a9c31609, the maps that archives are looked at with can be coarser.
_ALIKE = {"a9c31609", "81338670"}


def main():
    """Try what is not in the file, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=RESULTS, help="the file of tries")
    parser.add_argument("--minutes", type=float, default=np.inf, help="stop after so long; 0 only prints the table")
    parser.add_argument("--scan", action="append", choices=trust_cases.SCANS, help="only these scans")
    parser.add_argument("--holes", action="append", choices=trust_cases.HOLES, help="only these holes")
    parser.add_argument("--kind", action="append", choices=trust_cases.WRONG + trust_cases.RIGHT, help="only these")
    parser.add_argument(
        "--part", type=_part, default=(0, 1), metavar="K/N", help="only the K-th of N parts of the tries"
    )
    parser.add_argument("--every-foreign", action="store_true", help="all photographs for each scan, not some of them")
    arguments = parser.parse_args()
    ends = time.monotonic() + 60 * arguments.minutes
    known = {try_["key"]: try_ for try_ in counted(arguments.results)}
    photographs = {}
    arguments.results.parent.mkdir(parents=True, exist_ok=True)
    with arguments.results.open("a", encoding="utf-8") as file:
        for group in islice(_groups(arguments), arguments.part[0], None, arguments.part[1]):
            if time.monotonic() >= ends:
                break
            for try_ in _tried(group, arguments, known, photographs, ends):
                known[try_["key"]] = try_
                file.write(json.dumps(try_) + "\n")
                file.flush()
    table([try_ for try_ in known.values() if _asked(try_, arguments)])


def _part(text):
    """The number from 0 and the count that K/N stands for."""
    number, count = map(int, text.split("/"))
    if not 1 <= number <= count:
        raise ValueError(text)
    return number - 1, count


def _groups(arguments):
    """A scan's name, holes, and a part of their photos, as if at random, but every scan once before any comes again."""

    def random(*names):
        return zlib.crc32("|".join(map(str, names)).encode())

    groups = []
    for scan in arguments.scan or trust_cases.SCANS:
        own = sorted(product(arguments.holes or trust_cases.HOLES, range(_PARTS)), key=lambda part: random(scan, *part))
        groups += [(turn, random(scan, *part), scan, *part) for turn, part in enumerate(own)]
    return [group[2:] for group in sorted(groups)]


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
    scan_name, holes, part = group
    views = None
    for kind, name, rgb in islice(_photos(scan_name, holes, arguments), part, None, _PARTS):
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
            "numbers": {name: float(f"{value:.4g}") for name, value in vars(proof).items()},
            "wide": _in_wide_windows(views, photo, found.model),
        }


def _in_wide_windows(views, photo, model):
    """The tiles in place, those that still are in windows three times as wide, and their mean score; None where too few
    are seen."""
    found = model and surfaces(views.image(FINE[0]), views.tiles(*FINE), photo, model, 3 * RADIUS)
    if found is None:
        return None
    near, still = in_place(found.scores[:, 2 * RADIUS : -2 * RADIUS, 2 * RADIUS : -2 * RADIUS]), in_place(found.scores)
    middle = found.scores[:, found.radius, found.radius].mean()
    return {"in_place": int(near.sum()), "held": int((near & still).sum()), "mean": round(float(middle), 3)}


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
    _curves(tries)
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


def _curves(tries):
    """Print which share of the wrong and of the right photos would be verified with other bars."""
    evidence = {
        name: np.array([try_["evidence"] for try_ in tries if try_["kind"] in kinds])
        for name, kinds in (("wrong", trust_cases.WRONG), ("right", trust_cases.RIGHT))
    }
    if not all(map(len, evidence.values())):
        return
    print("\nevidence of at least  " + "".join(f"{bar:7.2f}" for bar in _BARS))
    for name, values in evidence.items():
        print(f"{name:5} of {len(values):5d}        " + "".join(f"{np.sum(values >= bar):7d}" for bar in _BARS))


@cache
def _code():
    """A short name of the state of the code that decides verdicts; comments and docstrings do not count."""
    folder = Path(trust_cases.__file__).parent.parent / "reflcolor_addon" / "matching"
    digest = hashlib.sha256()
    for name in _DECIDING:
        tree = ast.parse((folder / f"{name}.py").read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node) is not None:
                del node.body[0]
        digest.update(ast.unparse(tree).encode())
    return digest.hexdigest()[:8]


def counted(path=RESULTS):
    """Yield the tries in a file that were made by code which decides as today's does."""
    alike = _ALIKE if _code() in _ALIKE else {_code()}
    yield from (try_ for try_ in _read(path) if try_["code"] in alike)


def _read(path):
    with contextlib.suppress(FileNotFoundError), path.open(encoding="utf-8") as file:
        # A line that was cut when the command was stopped is tried again.
        for line in file:
            with contextlib.suppress(json.JSONDecodeError):
                yield json.loads(line)


if __name__ == "__main__":
    main()
