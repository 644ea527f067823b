"""The report in a real browser: no error, no request, a mode that moves, another that is picked, print."""

from __future__ import annotations

import base64
import io
import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

selenium = pytest.importorskip("selenium", reason="selenium is missing: pip install 'vehicle-on-shaker[browser]'")

CHROMIUM, DRIVER = Path("/usr/bin/chromium"), Path("/usr/bin/chromedriver")
FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--window-size=1300,900", "--disable-dev-shm-usage"),
)


@pytest.fixture(scope="module")
def browser(reported, tmp_path_factory) -> Iterator[Any]:
    """The report, opened."""
    if not (CHROMIUM.is_file() and DRIVER.is_file()):
        pytest.skip("chromium and chromium-driver are not installed: tools/system-libraries.sh browser installs them")
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = str(CHROMIUM)
    for flag in (*FLAGS, f"--user-data-dir={tmp_path_factory.mktemp('browser')}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service(str(DRIVER)), options=options)
    try:
        driver.get(reported.page.as_uri())
        yield driver
    finally:
        driver.quit()


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
    assert browser.title == "Car on the shaker: run"
    assert any("Content Security Policy" in entry["message"] for entry in browser.get_log("browser"))


def test_a_mode_moves_and_stops(browser):
    first = picture(browser)
    time.sleep(0.4)
    second = picture(browser)
    assert np.mean(np.abs(first - second).max(axis=2) > 30) > 0.002
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
    buttons = browser.find_elements(By.CSS_SELECTOR, "#mode-gallery button")
    pick = Select(browser.find_element("id", "mode-pick"))
    assert len(buttons) == len(pick.options) > 20
    buttons[5].click()
    assert pick.all_selected_options == [pick.options[5]]
    chosen = browser.find_element("id", "mode-words").text
    assert chosen != words and "6.43 Hz" in chosen and "body roll" in chosen
    after = picture(browser)
    assert not np.array_equal(before, after)
    canvas = browser.find_element("id", "mode-canvas")
    ActionChains(browser).drag_and_drop_by_offset(canvas, 80, 30).perform()
    turned = picture(browser)
    assert not np.array_equal(after, turned)
    ActionChains(browser).scroll_from_origin(_origin(canvas), 0, -400).perform()
    assert not np.array_equal(turned, picture(browser))
    Select(browser.find_element("id", "mode-state")).select_by_value("sliding")
    assert browser.find_element("id", "mode-words").text != chosen


def _origin(canvas):
    from selenium.webdriver.common.actions.wheel_input import ScrollOrigin

    return ScrollOrigin.from_element(canvas)


def test_the_page_prints(browser):
    pdf = base64.b64decode(browser.print_page())
    assert pdf.startswith(b"%PDF") and len(pdf) > 50_000
    assert 6 <= pdf.count(b"/Type /Page\n") + pdf.count(b"/Type /Page ") <= 30
