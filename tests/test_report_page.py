"""The page of a batch in a real browser: by mouse, by keyboard, on a phone, without a network."""

import os

import numpy as np
import pytest
from archives import make_archive
from browser import BROWSER, Browser

from reflcolor_addon.cli.main import main
from reflcolor_addon.files.images import read_image

pytestmark = [
    pytest.mark.skipif(BROWSER is None, reason="no Chromium is installed"),
    pytest.mark.skipif(os.name == "nt", reason="pipes of POSIX systems"),
]
NAMES = ["hall_0", "hall_1", "hall_2", "hall_3"]
SHOWN = (
    "[...document.querySelectorAll('tbody tr')].filter(row => row.offsetHeight).map(row => row.cells[1].dataset.value)"
)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page of a batch of four scans; hall_2 cannot be read."""
    folder = tmp_path_factory.mktemp("archive")
    path = make_archive(folder, count=4)
    (folder / "hall_2.ptx").write_text("no scan\n")
    main(["batch", str(path), "--jobs", "1", "--keep-going"])
    return folder / "colored" / "report.html"


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("browser")) as browser:
        yield browser


def focused(browser):
    return browser.value("document.activeElement.id || document.activeElement.innerText")


def test_nothing_is_fetched_and_nothing_complains(browser, page):
    browser.open(page)
    asked = [event["params"]["request"]["url"] for event in browser.events if "request" in event.get("params", {})]
    assert {url.partition(":")[0] for url in asked} <= {"file", "data"}
    assert [url for url in asked if url.startswith("file:")] == [page.absolute().as_uri()]
    complaints = ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded")
    assert not [event for event in browser.events if event.get("method") in complaints]


def test_a_click_on_a_heading_sorts(browser, page):
    browser.open(page)
    assert browser.value(SHOWN) == NAMES
    browser.click("thead th:nth-child(2) button")
    assert browser.value(SHOWN) == NAMES[::-1]
    assert browser.value("document.querySelector('th[aria-sort]').getAttribute('aria-sort')") == "descending"
    browser.click("thead th:nth-child(4) button")
    assert browser.value(SHOWN)[0] == "hall_2"
    assert browser.value("document.querySelectorAll('th[aria-sort]').length") == 1


def test_the_keyboard_alone_searches_sorts_and_unfolds(browser, page):
    browser.open(page)
    browser.press("Tab")
    assert focused(browser) == "search"
    browser.write("HALL_1")
    assert browser.value(SHOWN) == ["hall_1"]
    assert browser.value("document.getElementById('count').innerText") == "1 of 4 scans"
    browser.press("Tab")
    assert focused(browser) == "show"
    browser.press("Tab")
    assert focused(browser).startswith("Scan")
    browser.press("Enter")
    assert browser.value("document.querySelector('thead th:nth-child(2)').getAttribute('aria-sort')") == "descending"
    for _ in range(8):
        browser.press("Tab")
    assert focused(browser) == "Details"
    browser.press(" ")
    assert "SHA-256" in browser.value("document.querySelector('details[open]').innerText")


def test_a_failure_is_found_by_its_state(browser, page):
    browser.open(page)
    browser.value("document.getElementById('show').value = 'failed'")
    browser.value("document.getElementById('show').dispatchEvent(new Event('change'))")
    assert browser.value(SHOWN) == ["hall_2"]
    assert "hall_2.ptx: line 1" in browser.value("document.querySelector('tbody tr:not([hidden])').innerText")


def test_a_desktop_shows_all_columns(browser, page):
    browser.open(page, 1280, 900)
    assert browser.value("document.documentElement.scrollWidth") <= 1280


def test_a_phone_shows_all_of_it_without_scrolling_aside(browser, page):
    browser.open(page, 390, 844, phone=True)
    assert browser.value("document.documentElement.scrollWidth") <= 390
    assert browser.value("document.getElementById('sort').offsetHeight") > 0
    widest = "Math.max(...[...document.querySelectorAll('tbody *')].map(own => own.getBoundingClientRect().right))"
    assert browser.value(widest) <= 390


@pytest.mark.parametrize("width", [1280, 390])
def test_the_four_pictures_of_a_scan_differ(browser, page, tmp_path, width):
    browser.open(page, width, 900)
    tiles = "[...document.querySelectorAll('tbody tr:first-child .tiles div')]"
    boxes = browser.value(
        f"{tiles}.map(own => own.getBoundingClientRect()).map(box => [box.x, box.y, box.width, box.height])"
    )
    browser.picture(tmp_path / "page.png")
    shot = read_image(tmp_path / "page.png")
    means = [shot[int(y) : int(y + h), int(x) : int(x + w)].reshape(-1, 3).mean(axis=0) for x, y, w, h in boxes]
    assert len(means) == 4
    assert all(np.abs(a - b).max() > 2 for number, a in enumerate(means) for b in means[:number])


@pytest.mark.parametrize("width", [1600, 1280, 390])
def test_the_pictures_of_a_very_flat_scan_stay_in_their_cell(browser, page, width):
    browser.open(page, width, 900)
    browser.value("document.querySelector('tbody .tiles').style.setProperty('--aspect', '10.6')")
    right = "document.querySelector('tbody {}').getBoundingClientRect().right"
    assert browser.value(right.format(".tiles div:last-child")) <= browser.value(right.format("tr td")) + 0.5
