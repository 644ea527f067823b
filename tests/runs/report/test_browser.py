"""The report in a real browser: no error, no request, a mode that moves, another that is picked, print."""

import base64
import io
import json
import shutil
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.patience import HANG


def picture(browser) -> np.ndarray:
    """The canvas of the modes as it is seen."""
    png = browser.find_element("id", "mode-canvas").screenshot_as_png
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=int)


def press(browser, name: str) -> None:
    browser.find_element("id", f"mode-{name}").click()


def test_no_error_and_no_request_to_anyone(browser, reported):
    browser.find_element("id", "mode-canvas")
    assert browser.get_log("browser") == []
    events = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    own = reported.page.as_uri()
    asked = [
        event["params"]["request"]["url"]
        for event in events
        if event["method"] == "Network.requestWillBeSent" and event["params"].get("documentURL") == own
    ]
    assert own in asked
    assert [url for url in asked if url != own and not url.startswith("data:")] == []


def test_the_policy_of_the_page_lets_nothing_in(browser):
    """A picture from elsewhere and a script that is not the page's are refused; they would have changed the title."""
    browser.execute_script(
        "const one = document.createElement('script'); one.textContent = 'document.title = \"other\"';"
        "document.body.append(one);"
    )
    assert browser.title == "Focus on the shaker: run"
    assert any("Content Security Policy" in entry["message"] for entry in browser.get_log("browser"))


def test_a_mode_moves_and_stops(browser):
    first, late = picture(browser), time.monotonic() + HANG
    while not np.mean(np.abs(first - picture(browser)).max(axis=2) > 30) > 0.002:
        assert time.monotonic() < late, "the mode stands still"
        time.sleep(0.1)
    press(browser, "play")
    still = picture(browser)
    assert np.array_equal(still, picture(browser))
    # Something is drawn, in more than one colour.
    assert np.mean(np.ptp(still, axis=2) > 40) > 0.005


def test_another_mode_another_state_and_another_view_are_shown(browser):
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.support.ui import Select

    words, before = browser.find_element("id", "mode-words").text, picture(browser)
    browser.find_element(By.CSS_SELECTOR, "details:has(#mode-gallery) summary").click()
    buttons = browser.find_elements(By.CSS_SELECTOR, "#mode-gallery button")
    pick = Select(browser.find_element("id", "mode-pick"))
    assert len(buttons) == len(pick.options) > 20
    buttons[5].click()
    assert pick.all_selected_options == [pick.options[5]]
    chosen = browser.find_element("id", "mode-words").text
    assert chosen != words and "5.87 Hz" in chosen and "body roll" in chosen
    after = picture(browser)
    assert not np.array_equal(before, after)
    canvas = browser.find_element("id", "mode-canvas")
    ActionChains(browser).drag_and_drop_by_offset(canvas, 80, 30).perform()
    turned = picture(browser)
    assert not np.array_equal(after, turned)
    ActionChains(browser).scroll_from_origin(_origin(canvas), 0, -400).perform()
    assert not np.array_equal(turned, picture(browser))
    Select(browser.find_element("id", "mode-state")).select_by_value("stuck")
    assert browser.find_element("id", "mode-words").text != chosen
    browser.find_element(By.CSS_SELECTOR, "details:has(#mode-gallery) summary").click()


def _origin(canvas):
    from selenium.webdriver.common.actions.wheel_input import ScrollOrigin

    return ScrollOrigin.from_element(canvas)


@pytest.fixture
def printed(browser) -> Iterator[Any]:
    """The page with the style of paper, as wide as the text of A4."""
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    browser.execute_script("window.dispatchEvent(new Event('beforeprint'));")
    yield browser
    browser.execute_script("window.dispatchEvent(new Event('afterprint'));")
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def test_paper_has_no_form_controls_and_nothing_folded(printed):
    """Neither controls nor headings without content; the gallery of modes remains as pictures."""
    shown = printed.execute_script(
        "const names = 'select, input, nav, video, summary, #mode-canvas, #mode-gallery canvas';"
        "return [...document.querySelectorAll(names)]"
        ".filter((one) => one.checkVisibility()).map((one) => one.tagName + one.parentElement.tagName);"
    )
    assert set(shown) == {"CANVASBUTTON"} and len(shown) > 20
    headings = [one.text for one in printed.find_elements("css selector", "h2") if one.is_displayed()]
    assert {"Spectra", "The car", "Modes"} <= {*headings} and "All values" not in headings
    printed.execute_script("document.querySelector('#tables details').open = true;")
    assert printed.find_element("css selector", "#tables table").is_displayed(), "what is unfolded is printed"
    printed.execute_script("document.querySelector('#tables details').open = false;")


def test_print_has_six_to_eight_pages_and_none_is_half_empty(browser, tmp_path):
    from selenium.webdriver.common.print_page_options import PrintOptions

    options = PrintOptions()
    options.set_page_size(PrintOptions.A4)
    pdf = base64.b64decode(browser.print_page(options))
    (tmp_path / "report.pdf").write_bytes(pdf)
    filled = fill_of_pages(tmp_path / "report.pdf")
    assert 6 <= len(filled) <= 8
    assert min(filled[:-1]) > 0.5, filled
    assert filled[-1] > 0.25, filled


def fill_of_pages(pdf: Path) -> list[float]:
    """Height down to the last ink of each page over the height of the page."""
    if shutil.which("pdftoppm") is None:
        pytest.skip("pdftoppm is not installed: tools/system-libraries.sh tests installs it")
    subprocess.run(["pdftoppm", "-r", "20", "-gray", str(pdf), str(pdf.with_suffix(""))], check=True, timeout=HANG)
    pages = [np.asarray(Image.open(path)) for path in sorted(pdf.parent.glob(f"{pdf.stem}-*.pgm"))]
    return [float(np.flatnonzero((page < 200).any(axis=1)).max() / len(page)) for page in pages]


def test_after_printing_the_page_is_folded_as_before(browser):
    opened = "return document.querySelectorAll('details[open]').length;"
    folded = browser.execute_script("return document.querySelectorAll('details.printed').length;")
    before = browser.execute_script(opened)
    browser.execute_script("window.dispatchEvent(new Event('beforeprint'));")
    assert browser.execute_script(opened) == before + folded > 3
    browser.execute_script("window.dispatchEvent(new Event('afterprint'));")
    assert browser.execute_script(opened) == before


def test_the_page_is_short(browser):
    """5978 px for a run with film, 6718 for this changed car: a second statement and picture, more notices."""
    assert browser.execute_script("return document.documentElement.scrollHeight;") < 6900
