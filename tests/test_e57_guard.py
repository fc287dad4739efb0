"""The XML section of an E57 is checked before native code sees the file. The inputs are harmless ones of each kind."""

import struct
import time

import numpy as np
import pytest
from e57_samples import with_valid_checksums, write_e57
from sample_scans import intensity_of, room_points

from reflcolor_addon.errors import Cancelled, ScanError
from reflcolor_addon.files.confined import reading
from reflcolor_addon.files.e57_pages import HEADER, PAGE, PAYLOAD, contents
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.readers.e57_xml import parse_xml

POINTS = room_points()
NAMES = ("cartesianX", "cartesianY", "cartesianZ", "intensity", "rowIndex", "columnIndex")
DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>'


def whole(path):
    row, column = np.mgrid[: POINTS.shape[0], : POINTS.shape[1]]
    grids = (*np.moveaxis(POINTS, -1, 0), intensity_of(POINTS), row, column)
    write_e57(path, {"fields": {name: grid.ravel() for name, grid in zip(NAMES, grids, strict=True)}, "name": "yard"})


def with_xml(path, change):
    """Give an E57 the XML section that ``change`` makes of its own, at its end, with everything else put right."""
    with path.open("rb") as file:
        head = HEADER.unpack(file.read(HEADER.size))
        text = change(contents(file, head[4], head[5]).decode()).encode()
    pages = path.read_bytes()[: head[4] // PAGE * PAGE]
    before = path.read_bytes()[len(pages) : head[4]]
    body = before + text
    body += bytes(-len(body) % PAYLOAD)
    pages += b"".join(body[at : at + PAYLOAD] + bytes(4) for at in range(0, len(body), PAYLOAD))
    header = HEADER.pack(*head[:3], len(pages), head[4], len(text), PAGE)
    path.write_bytes(with_valid_checksums(header + pages[HEADER.size :]))


@pytest.fixture
def native(monkeypatch):
    """No child process may be started: a list of those that were."""
    started = []

    def start(*arguments, **options):
        started.append(arguments)
        raise AssertionError("native code was to see this file")

    monkeypatch.setattr(reading, "Child", start)
    return started


def insert(after, text):
    return lambda xml: xml.replace(after, after + text, 1)


def swap(old, new, count=1):
    def change(xml):
        assert old in xml
        return xml.replace(old, new, count)

    return change


ROOT = '<e57Root type="Structure"\n         xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0">'
LIST = '<data3D type="Vector" allowHeterogeneousChildren="1">'


def without(first, last):
    return lambda xml: xml[: xml.index(first)] + xml[xml.index(last) + len(last) :]


KINDS = {
    "document type": (insert(DECLARATION, "<!DOCTYPE e57Root>"), "a document type, which no E57 has"),
    "internal entity": (
        insert(DECLARATION, '<!DOCTYPE e57Root [<!ENTITY name "yard">]>'),
        "a document type, which no E57 has",
    ),
    "external document type": (
        insert(DECLARATION, '<!DOCTYPE e57Root SYSTEM "nothing.dtd">'),
        "a document type, which no E57 has",
    ),
    "undefined entity": (swap("<![CDATA[yard]]>", "&name;"), "its XML section is damaged"),
    "processing instruction": (insert(DECLARATION, '<?style href="a"?>'), "a processing instruction"),
    "location of a schema": (
        swap(
            'type="Structure"\n',
            'type="Structure" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="a b"\n',
        ),
        "refers to something outside of it (xsi:schemaLocation)",
    ),
    "location of a schema without namespace": (
        swap(
            'type="Structure"\n',
            'type="Structure" xmlns:x="http://www.w3.org/2001/XMLSchema-instance" x:noNamespaceSchemaLocation="a"\n',
        ),
        "refers to something outside of it (x:noNamespaceSchemaLocation)",
    ),
    "inclusion": (
        insert(ROOT, '<i:include xmlns:i="http://www.w3.org/2001/XInclude" type="String"/>'),
        "refers to something outside of it (i:include)",
    ),
    "base": (swap('type="Structure"\n', 'type="Structure" xml:base="a"\n'), "refers to something outside of it"),
    "other encoding": (swap('"UTF-8"', '"ISO-8859-1"'), "not XML 1.0 in UTF-8"),
    "other version": (swap('version="1.0"', 'version="1.1"'), "its XML section"),
    "not closed": (swap("</e57Root>", ""), "its XML section is damaged"),
    "something behind": (swap("</e57Root>", "</e57Root><more/>"), "its XML section is damaged"),
    "other root": (lambda xml: xml.replace("e57Root", "root"), "begins with root, expected e57Root"),
    "no type": (swap('<guid type="String">', "<guid>"), "guid has the type None, which E57 does not define"),
    "unknown type": (swap('<guid type="String">', '<guid type="Text">'), "guid has the type Text"),
    "text among nodes": (insert(ROOT, "words"), "e57Root holds text, expected nodes"),
    "a node inside of a value": (
        swap("<![CDATA[yard]]>", '<a type="String">b</a>'),
        "a lies inside of name, which holds a value",
    ),
    "the same node twice": (insert(ROOT, '<guid type="String">x</guid>'), "e57Root holds guid twice"),
    "no number": (
        swap('<versionMajor type="Integer">1<', '<versionMajor type="Integer">one<'),
        "versionMajor holds one",
    ),
    "no prototype": (without("<prototype", "</prototype>"), "points has no prototype"),
    "an empty prototype": (
        lambda xml: without("<prototype", "</prototype>")(xml).replace(
            "<codecs", '<prototype type="Structure"></prototype><codecs'
        ),
        "points has no prototype",
    ),
    "a prototype of structures": (
        swap('<prototype type="Structure">', '<prototype type="Structure"><a type="Structure"></a>'),
        "its prototype holds something other than numbers",
    ),
    "codecs that are no list": (swap('<codecs type="Vector"', '<codecs type="Structure"'), "its codecs are not a list"),
    "points in a list of one kind": (
        swap(LIST, LIST.replace('"1"', '"0"')),
        "points lies inside of a list that allows only children of one kind",
    ),
    "points in a list of no said kind": (
        swap(LIST, '<data3D type="Vector">'),
        "points lies inside of a list that allows only children of one kind",
    ),
    "no count of records": (lambda xml: xml.replace("recordCount=", "records="), "points has no recordCount"),
    "a count that is no number": (lambda xml: xml.replace('recordCount="', 'recordCount="-'), "recordCount is -126"),
    "points outside of the file": (
        lambda xml: xml.replace('fileOffset="', 'fileOffset="99999999'),
        "points lies outside of the file",
    ),
    "a bound that is no number": (swap('maximum="', 'maximum="x'), "maximum is x"),
    "more points than the file can hold": (
        swap('recordCount="126"', 'recordCount="900000000000"'),
        "announces 900,000,000,000 points, more than the file can hold",
    ),
    "more points than its rows and columns tell apart": (
        lambda xml: (
            xml.replace('recordCount="126"', 'recordCount="99999"')
            .replace('maximum="8"', 'maximum="0"')
            .replace('maximum="13"', 'maximum="0"')
            .replace('type="Float" precision="double"', 'type="Integer" minimum="0" maximum="0"')
            .replace('<intensity type="Float"', '<intensity type="Integer" minimum="0" maximum="0"')
            .replace('Z type="Float"', 'Z type="Integer" minimum="0" maximum="0"')
            .replace('Y type="Float"', 'Y type="Integer" minimum="0" maximum="0"')
            .replace('X type="Float"', 'X type="Integer" minimum="0" maximum="0"')
        ),
        "announces 99,999 points, more than the file can hold",
    ),
    "too many nodes inside each other": (
        insert(
            ROOT,
            "".join(f'<a{n} type="Structure">' for n in range(40)) + "".join(f"</a{n}>" for n in range(39, -1, -1)),
        ),
        "or more than 32 inside each other",
    ),
    "a list instead of points": (
        lambda xml: without("<points", "</points>")(xml).replace(
            "</vectorChild>", '<points type="Vector"/></vectorChild>'
        ),
        "has points of the type Vector",
    ),
    "scans that are no structures": (
        lambda xml: without("<vectorChild", "</vectorChild>")(xml).replace(LIST, LIST + '<vectorChild type="Float"/>'),
        "data3D is not a list of scans",
    ),
    "a structure instead of scans": (
        lambda xml: without("<vectorChild", "</vectorChild>")(xml).replace(
            LIST, '<data3D type="Structure"><a type="Structure"/>'
        ),
        "data3D is not a list of scans",
    ),
}


@pytest.mark.parametrize(("change", "said"), KINDS.values(), ids=KINDS)
def test_what_native_code_would_trip_over_or_fetch_is_refused_before(tmp_path, native, change, said):
    path = tmp_path / "a.e57"
    whole(path)
    with_xml(path, change)
    with pytest.raises(ScanError) as caught:
        read_scans(path)
    assert str(caught.value).startswith("a.e57: ")
    assert said in str(caught.value)
    assert str(caught.value).isprintable() and len(str(caught.value)) < 400
    assert native == []


@pytest.mark.parametrize(
    "change",
    [
        lambda xml: xml,
        without("<codecs", "</codecs>"),
        swap("<![CDATA[yard]]>", "yard"),
        lambda xml: xml.replace("\n", "\r\n"),
        lambda xml: xml.replace(DECLARATION, ""),
        insert(ROOT, '<more type="Structure"><a type="Float"/></more>'),
    ],
    ids=["as it is", "no codecs", "no CDATA", "other line ends", "no declaration", "nodes that nobody knows"],
)
def test_what_the_standard_allows_is_read(tmp_path, change):
    path = tmp_path / "a.e57"
    whole(path)
    with_xml(path, change)
    (scan,) = read_scans(path)
    assert np.array_equal(scan.points, POINTS)
    assert scan.name == "yard"


@pytest.mark.parametrize("count", [b"-26", b"999", b"  0", b"abc", b"nan", b"9" * 20])
def test_a_count_of_records_may_be_anything(tmp_path, count):
    path = tmp_path / "a.e57"
    whole(path)
    with_xml(path, swap('recordCount="126"', f'recordCount="{count.decode()}"'))
    with pytest.raises(ScanError) as caught:
        read_scans(path)
    assert str(caught.value).isprintable()


def test_a_large_section_is_read_in_little_time_and_can_be_cancelled():
    nodes = "".join(f'<a{number} type="Float">1</a{number}>' for number in range(60_000))
    text = f"{ROOT}{nodes}</e57Root>".encode()
    start = time.process_time()
    assert len(parse_xml(text, "a.e57", 1 << 40).children) == 60_000
    assert time.process_time() - start < 5
    answers = iter([False, False, True])
    with pytest.raises(Cancelled):
        parse_xml(text, "a.e57", 1 << 40, cancelled=lambda: next(answers))
    with pytest.raises(ScanError, match=r"holds more than 65,536 characters"):
        parse_xml(f'{ROOT}<a type="String">{"x" * 100_000}</a></e57Root>'.encode(), "a.e57", 1 << 40)


def test_what_the_header_says_of_the_xml_is_checked(tmp_path, native):
    path = tmp_path / "a.e57"
    whole(path)
    data = bytearray(path.read_bytes())
    for at, length in ((0, 100), (1 << 60, 100), (1022, 100), (len(data) - 4, 100), (48, 1 << 60), (48, len(data))):
        struct.pack_into("<QQ", data, 24, at, length)
        path.write_bytes(with_valid_checksums(bytes(data)))
        with pytest.raises(ScanError) as caught:
            read_scans(path)
        assert "XML section" in str(caught.value)
    assert native == []


def test_a_wrong_checksum_of_the_xml_is_told_before_it_is_parsed(tmp_path, native):
    path = tmp_path / "a.e57"
    whole(path)
    data = path.read_bytes()
    path.write_bytes(data.replace(b"<e57Root", b"<e57root"))
    with pytest.raises(ScanError, match="a checksum does not match"):
        read_scans(path)
    assert native == []
