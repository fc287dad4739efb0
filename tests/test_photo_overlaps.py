"""Photos that overlap are of one place: where one of them was found, the others are tried, too."""

import csv
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from test_photo_claims import CELLAR, HALL, HALL_AGAIN, claim

from benchmarks.rooms import Room
from reflcolor_addon.batch.archive import candidates, look_stage, match_stage, overlap_blocks, overlap_stage, tries
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.overlap_blocks import overlaps_at
from reflcolor_addon.batch.archive.registrations import Registrations
from reflcolor_addon.batch.archive.tries import Tries
from reflcolor_addon.batch.archive.verdicts import Verdicts
from reflcolor_addon.cli.main import main
from reflcolor_addon.errors import Cancelled
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.matching.models import GridHomography
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.overlaps import LEAST_AGREEMENT, Described, agreement
from reflcolor_addon.matching.registration.registration import Registration
from reflcolor_addon.matching.registration.verification import Evidence

ASIDE = (0.4, -0.3)


def overlap(one, other):
    return agreement(one, other) >= LEAST_AGREEMENT


def described(rgb):
    return Described.of(PhotoImage("photo", rgb))


@pytest.fixture(scope="module")
def of_rooms():
    return {(room, number): described(Room(room).photo(number)) for room in (1, 2, 3) for number in (1, 2)}


def test_photos_of_one_room_overlap_and_those_of_others_do_not(of_rooms):
    for one, own in of_rooms.items():
        for other, its in of_rooms.items():
            assert overlap(own, its) == (one[0] == other[0])
    assert agreement(of_rooms[1, 1], of_rooms[1, 2]) > 0.95


def test_darker_and_smaller_photos_overlap_as_well():
    bright = Room(1).photo(1, 480, 360)
    dark = np.uint8(0.3 * Room(1).photo(2, 240, 180) + 20)
    assert overlap(described(bright), described(dark)) and overlap(described(dark), described(bright))


def test_the_same_pattern_in_other_brightness_is_not_the_same_thing():
    rng = np.random.default_rng(0)
    outlines = np.kron(rng.integers(0, 2, (12, 16)), np.ones((20, 20)))

    def tiles(seed):
        # Wherever the pattern has an edge, both photos have one, but each shade is drawn anew.
        shade = np.random.default_rng(seed).uniform(40, 215, (12, 16))
        image = np.kron(shade, np.ones((20, 20)))
        return np.uint8(np.where(outlines > 0, image, 255 - image))[..., None].repeat(3, axis=2)

    assert agreement(described(tiles(1)), described(tiles(1))) == pytest.approx(1)
    assert not overlap(described(tiles(1)), described(tiles(2)))
    assert not overlap(described(tiles(1)), described(255 - tiles(1)))


def test_a_photo_of_nothing_overlaps_nothing(of_rooms):
    gray = described(np.full((180, 240, 3), 90, np.uint8))
    noise = described(np.random.default_rng(0).integers(0, 255, (180, 240, 3), np.uint8))
    for own in (gray, noise):
        assert not any(overlap(own, other) or overlap(other, own) for other in of_rooms.values())
    assert agreement(gray, gray) == 0


def request(folder, photos, others=None, hashes=None):
    others = photos if others is None else others
    hashes = hashes or {path: f"hash of {path[-7:-4]}" for path in photos + others}
    return {"folder": str(folder), "photos": photos, "others": others, "hashes": hashes}


@pytest.fixture
def photos(tmp_path):
    (folder := BatchFolder(tmp_path / "out")).make()
    paths = [str(tmp_path / f"p{room}{number}.png") for room in (1, 2) for number in (1, 2)]
    for path in paths:
        write_png(path, Room(int(path[-6])).photo(int(path[-5])))
    return folder.root, paths


def test_a_worker_names_the_pairs_that_overlap_and_does_not_compare_them_again(photos, monkeypatch):
    root, paths = photos
    work = {"progress": lambda *_: None, "cancelled": lambda: False}
    found = overlaps_at(request(root, paths), **work)
    assert [pair[:2] for pair in found["overlaps"]] == [paths[:2], paths[2:]] and found["worked"] == 1
    assert all(0.9 < agreed <= 1 for *_, agreed in found["overlaps"])
    across = overlaps_at(request(root, paths[:1], paths[1:]), **work)
    assert across == {"overlaps": found["overlaps"][:1], "worked": 1.0}
    monkeypatch.setattr(overlap_blocks, "agreement", None)
    assert overlaps_at(request(root, paths), **work) == found | {"worked": 0.0}
    with pytest.raises(Cancelled):
        overlaps_at(request(root, paths[1:]), progress=lambda *_: None, cancelled=lambda: True)


def test_a_photo_that_cannot_be_read_overlaps_nothing(photos):
    root, paths = photos
    Path(paths[1]).write_bytes(b"not a picture")
    found = overlaps_at(request(root, paths), progress=lambda *_: None, cancelled=lambda: False)
    assert [pair[:2] for pair in found["overlaps"]] == [paths[2:]]


def asked(count, scans, left_out=(), agreed=()):
    """What the workers are asked, and what follows if they answer that photos, by their numbers, agree so well."""
    tasks = []

    def work(stage, own, done, *_):
        tasks.extend(own)
        for task in own:
            of_task = [one for one in agreed if one[0] in task.request["photos"] and one[1] in task.request["others"]]
            done(task, {"found": {"overlaps": of_task}})

    context = SimpleNamespace(
        work_again=work,
        problems=dict.fromkeys(left_out, "damaged"),
        folder=SimpleNamespace(root="out", log=lambda name: name),
        costs=SimpleNamespace(memory=lambda scans: 0),
    )
    names = {str(number): str(number) for number in range(count)}
    return tasks, overlap_stage.overlapping(context, SimpleNamespace(photos=names, hashes=names), scans)


def compared(count, scans, left_out=()):
    """The pairs of photos, by their numbers, that the workers are asked to compare."""
    pairs = []
    for task in asked(count, scans, left_out)[0]:
        own, others = task.request["photos"], task.request["others"]
        assert max(len(own), len(others)) <= 100
        pairs += [
            tuple(sorted((int(one), int(other)))) for one in own for other in others if own != others or one < other
        ]
    return pairs


@pytest.mark.parametrize("count", [0, 1, 2, 7, 40, 250])
def test_every_pair_of_photos_is_compared_once(count):
    pairs = compared(count, scans=30)
    assert len(pairs) == len(set(pairs)) == count * (count - 1) // 2


def test_of_very_many_photos_those_are_compared_that_are_next_to_each_other():
    pairs = set(compared(1000, scans=10))
    assert {(number, number + away) for away in (1, 50, 100) for number in range(1000 - away)} <= pairs
    assert max(other - one for one, other in pairs) < 300


def test_photos_that_cannot_be_read_are_not_compared():
    assert not any("3" in map(str, pair) for pair in compared(10, 30, left_out=["3"]))


def test_of_a_photo_that_overlaps_very_many_the_best_are_kept():
    found = asked(40, 30, agreed=[("0", str(other), 0.7 + 0.005 * other) for other in range(1, 20)])[1]
    assert found["0"] == [str(other) for other in range(19, 7, -1)]
    assert all(found[str(other)] == ["0"] for other in range(1, 20)) and len(found) == 20


def test_what_a_photo_shows_is_tried_for_those_that_overlap_it_beyond_the_share_of_all_pairs():
    names = [f"scan {number}" for number in range(30)]
    ranks = {f"{photo}": [(name, 1.0 / (k + 1)) for k, name in enumerate(names)] for photo in range(40)}
    both = [claim(name, 80.0, seen, evidence=2.0) for name, seen in (("scan 20", HALL), ("scan 21", HALL_AGAIN))]
    overlaps = {"0": ["1"], "1": ["0", "2"], "2": ["1"]}
    chosen = Tries(ranks, {}, overlaps=overlaps)
    assert len(chosen.next(Verdicts({}), {})["scan 0"]) == 40
    second = chosen.next(Verdicts({"0": both}), {})
    assert {("1", "scan 20"), ("1", "scan 21")} <= {(photo, name) for name, own in second.items() for photo in own}
    # It is passed on once it was found there, and not before.
    assert "2" not in second.get("scan 20", ())
    third = chosen.next(Verdicts({"0": both, "1": both[:1]}), {})
    assert "2" in third["scan 20"] and "2" in third["scan 21"]
    pairs = sum(len(own) for own in second.values()) + sum(len(own) for own in third.values())
    while more := chosen.next(Verdicts({}), {}):
        pairs += sum(len(own) for own in more.values())
    # Both scans for each of the three photos do not count.
    assert pairs == int(0.105 * 1200) - 40 + 6


def test_where_a_photo_was_refused_because_of_another_that_one_is_tried_and_may_connect_both_scans():
    ranks = {f"{photo}": [(f"scan {k}", 1.0 / (k + 1)) for k in range(30)] for photo in range(40)}
    overlaps = {"0": ["1"], "1": ["0"]}
    tries = Tries(ranks, {}, overlaps=overlaps)
    tries.next(Verdicts({}), {})
    claims = {
        "0": [claim("scan 20", 60.0, HALL, evidence=1.9), claim("scan 21", 0.0, verified=False)],
        "1": [claim("scan 21", 180.0, HALL_AGAIN, evidence=2.0, photo="1.jpg")],
    }
    found = Verdicts(claims, overlaps=overlaps)
    assert found.by_photo()["0"].refused == ("scan 20",)
    assert "1" in tries.next(found, {})["scan 20"]
    for seen, shown in ((HALL, ("scan 20",)), (CELLAR, ())):
        both = [*claims["1"], claim("scan 20", 40.0, seen, evidence=2.0, photo="1.jpg")]
        assert Verdicts(claims | {"1": both}, overlaps=overlaps).by_photo()["0"].shown == shown


def helped(tries, claims):
    """What the next round of tries is helped with: (photo, item), and by which photos."""
    pairs = tries.next(Verdicts(claims), {})
    return {(photo, name): by for name, own in pairs.items() for photo, by in own.items() if by}


def test_photos_help_to_place_others_where_they_were_found():
    ranks = {photo: [(f"scan {number}", 1.0) for number in range(30)] for photo in "abcde"}
    tries = Tries(ranks, {}, overlaps={"a": ["e", "c", "b"], "b": ["a"], "c": ["a"], "e": ["a"]})
    assert helped(tries, {}) == {}
    sure, as_sure, unsure = (claim("scan 9", 80.0, evidence=evidence) for evidence in (2.0, 2.0, 1.05))
    claims = {"b": [sure], "c": [as_sure], "d": [claim("scan 8", 80.0, evidence=2.0)], "e": [unsure]}
    # What is sure needs no help, what is unsure gives none, and what does not overlap helps nothing.
    assert helped(tries, claims) == {("a", "scan 9"): ("c", "b")}
    # Placed with their help, it does not help to place better what helped it. It is not tried again with the same.
    assert helped(tries, claims | {"a": [claim("scan 9", 60.0, helpers=("c", "b"))]}) == {}
    assert helped(tries, claims) == {}


def test_what_was_tried_by_itself_is_tried_with_help_once():
    ranks = {photo: [(f"scan {number}", 1.0) for number in range(30)] for photo in "ab"} | {
        f"other {number}": [(f"scan {scan}", 1.0) for scan in range(30)] for number in range(40)
    }
    tries, tried = Tries(ranks, {}, overlaps={"a": ["b"], "b": ["a"]}), []
    claims = {"b": [claim("scan 1", 80.0, evidence=2.0)]}
    while pairs := tries.next(Verdicts(claims if ("scan 1", ()) in tried else {}), {}):
        tried += [(name, own["a"]) for name, own in pairs.items() if "a" in own]
    assert [helpers for name, helpers in tried if name == "scan 1"] == [(), ("b",)]


def test_a_photo_whose_place_is_unsure_is_placed_anew_by_others_that_were_found_without_help():
    ranks = {photo: [(f"scan {number}", 1.0) for number in range(30)] for photo in "ab"}
    tries = Tries(ranks, {}, overlaps={"a": ["b"], "b": ["a"]})
    tries.next(Verdicts({}), {})
    claims = {"a": [claim("scan 9", 20.0, evidence=1.05)], "b": [claim("scan 9", 80.0, evidence=2.0)]}
    assert helped(tries, claims) == {("a", "scan 9"): ("b",)}


def test_what_was_placed_by_photos_that_are_refused_is_refused_too():
    helped = claim("hall", 90.0, photo="b.jpg", helpers=("a",))
    right = {"a": [claim("hall", 60.0, HALL, photo="a.jpg")], "b": [helped]}
    assert Verdicts(right).by_photo()["b"].shown == ("hall",)
    wrong = right | {"a": [*right["a"], claim("cellar", 55.0, CELLAR, photo="a.jpg")]}
    found = Verdicts(wrong).by_photo()
    assert found["a"].shown == () and found["b"].refused == ("hall",)
    assert "a.jpg, which turned out not to show it" in str(found["b"].warning("b.jpg"))
    assert "by which it was placed" in found["b"].doubt("hall") and "a.jpg" in found["b"].doubt("hall")
    # What it helped in turn falls, too, unless a person says that it is right.
    chain = wrong | {"c": [claim("hall", 70.0, photo="c.jpg", helpers=("b",))]}
    assert Verdicts(chain).by_photo()["c"].refused == ("hall",)
    chain["c"] = [claim("hall", 70.0, photo="c.jpg", helpers=("b",), by_hand=True)]
    assert Verdicts(chain).by_photo()["c"].shown == ("hall",)


def registration(strength, **more):
    evidence = Evidence(strength, 50, 60, 1.0, 1.0, strength, needed=9.0)
    model = GridHomography(np.eye(3), (10, 10), 20, 20)
    return Registration(model, evidence, "search", **more)


def test_a_registration_by_others_is_kept_beside_that_without_help(tmp_path):
    (folder := BatchFolder(tmp_path)).make()
    hashes, job = {"a.ptx": "1", "b.jpg": "2"}, SimpleNamespace(path=Path("a.ptx"), index=1, label="a")
    alone, by_others = Registrations(folder, hashes), Registrations(folder, hashes, helpers={"b.jpg": ["3", "4"]})
    weak, good = registration(10.0), registration(30.0, beside="c.jpg")
    assert alone(job, "b.jpg", lambda: weak) is weak
    by_others.place(job, "b.jpg", lambda: good)
    by_others.place(job, "b.jpg", pytest.fail)
    assert by_others(job, "b.jpg", pytest.fail).beside == "c.jpg" and by_others.recalled == 0
    again = Registrations(folder, hashes, helpers={"b.jpg": ["3", "4"]})
    assert again(job, "b.jpg", pytest.fail).beside == "c.jpg" and again.recalled == 1
    assert alone(job, "b.jpg", pytest.fail).beside is None
    # Others may not place it, or not as well; and without a hash nothing is kept.
    other = Registrations(folder, hashes, helpers={"b.jpg": ["5"]})
    other.place(job, "b.jpg", lambda: None)
    assert other(job, "b.jpg", pytest.fail).beside is None
    Registrations(folder, hashes, helpers={"b.jpg": [""]}).place(job, "b.jpg", pytest.fail)


def test_a_photo_that_looks_like_another_scan_is_found_by_one_that_overlaps_it(tmp_path, monkeypatch):
    for name, number in (("b", 1), ("c", 2), ("d", 3)):
        write_ptx(Room(number).scan(place=ASIDE, name=name), tmp_path / f"{name}.ptx")
    for number in (1, 2):
        write_png(tmp_path / f"photo{number}.png", Room(1).photo(number))
    lines = ('format = "reflcolor-batch"', "version = 1", 'output = "colored"', 'scans = "*.ptx"')
    lines += ('photos = "*.png"', 'write = "png"', "settings = { slic_segments = 60 }")
    (tmp_path / "batch.toml").write_text("\n".join(lines), encoding="utf-8")
    # As in a large archive, where both looks take the second photo for one of scan c: one try each.
    right = look_stage.ranks

    def misled(*arguments, **options):
        return {
            path: sorted(own, key=lambda pair: pair[0] != "c") if path.endswith("2.png") else own
            for path, own in right(*arguments, **options).items()
        }

    monkeypatch.setattr(look_stage, "ranks", misled)
    monkeypatch.setattr(look_stage, "merged", lambda first, second: second)
    monkeypatch.setattr(match_stage, "looks_of_scans", lambda *_: {})
    monkeypatch.setattr(candidates, "ALL_PAIRS", 0)
    for name, value in (("_AT_ONCE", 1), ("MOST_SCANS", 1), ("MOST_PAIRS", 0.0)):
        monkeypatch.setattr(tries, name, value)
    assert main(["batch", str(tmp_path / "batch.toml"), "--jobs", "1", "--keep-going"]) == 0
    with (tmp_path / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    shows, notes = ({(row["scan"], row["photo"]): row[which] for row in rows} for which in ("shows", "note"))
    assert "verified with the help of photo1.png, which shows part of the same" in notes["b", "photo2.png"]
    assert shows["b", "photo1.png"] == shows["b", "photo2.png"] == "yes"
    assert shows["c", "photo2.png"] == "no"
    assert [name for name, own in shows.items() if own == "not tried"] == [
        ("c", "photo1.png"),
        ("d", "photo1.png"),
        ("d", "photo2.png"),
    ]
