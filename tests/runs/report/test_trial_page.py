"""The section "Try it" as a reader sees it: moving picture, sliders with fixed positions, steady layout, size."""

import dataclasses
import io
import json
import re
import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image

from docs.live_page import live_cars
from scenarios.signals.random_road import random_road
from tests.documentation.pages import DOCS
from tests.patience import HANG
from tests.runs.report.test_trial import STRIBECK
from vehicle.commands.shaker import main
from vehicle.handover.page.page_input import LONGEST, RunRoad
from vehicle.handover.page.trial_data import PAGE, WORKER, scripts, trial_data
from vehicle.runs.car import Car, Road
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal_file import read_signal, write_signal

LARGEST = 600_000
"""Maximum number of bytes that the section adds to a report."""

FOUR_DIGITS = 5e-4
"""Maximum relative rounding of a number with four digits, as in the table of the section."""

MOVE = """
const slider = document.getElementById(`trial-${arguments[0]}`);
slider.value = arguments[1];
slider.dispatchEvent(new Event("input"));
"""

HEIGHT = """
const section = document.getElementById("trial");
return [document.getElementById("trial-words").textContent, section.getBoundingClientRect().height];
"""


def picture(browser: Any) -> np.ndarray:
    """Return the moving picture as it is seen, without the line of text on top."""
    png = browser.find_element("id", "trial-picture").screenshot_as_png
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=int)[20:]


def wait(condition: Callable[[], bool]) -> None:
    """Wait until a condition holds."""
    late = time.monotonic() + HANG
    while not condition():
        assert time.monotonic() < late, "the page did not answer"
        time.sleep(0.1)


def words(browser: Any) -> str:
    return str(browser.find_element("id", "trial-words").text)


def drawn(shown: np.ndarray) -> float:
    """Return the share of red points."""
    red, green, blue = np.moveaxis(shown, 2, 0)
    return float(np.mean((red > 150) & (green < 120) & (blue < 120)))


def test_the_car_moves_and_stops(browser):
    browser.execute_script("document.getElementById('trial-picture').scrollIntoView()")
    wait(lambda: drawn(picture(browser)) > 0.005)
    first = picture(browser)
    wait(lambda: bool(np.mean(np.abs(first - picture(browser)).max(axis=2) > 30) > 0.002))
    browser.find_element("id", "trial-play").click()
    still = picture(browser)
    time.sleep(0.3)
    assert np.array_equal(still, picture(browser))
    # Another enlargement is another picture, and is said.
    browser.execute_script(MOVE, "factor", 0)
    assert not np.array_equal(still, picture(browser))
    assert browser.find_element("id", "trial-factor-words").text == "Displacements in the picture: 1 times"
    browser.find_element("id", "trial-play").click()


def test_fixed_positions_change_one_at_a_time(browser):
    browser.execute_script(MOVE, "tyres-vertical", 2)
    wait(lambda: "tyres, vertical stiffness factor 1 → 1.2" in words(browser))
    assert "worse)" in words(browser) or "better)" in words(browser)
    browser.execute_script(MOVE, "main-springs", 0)
    wait(lambda: "main springs, stiffness factor 1 → 0.8" in words(browser))
    assert "tyres" not in words(browser)
    assert browser.find_element("id", "trial-tyres-vertical").get_attribute("value") == "1"
    browser.execute_script(MOVE, "main-springs", 1)
    wait(lambda: "Move a slider." in words(browser))


def test_nothing_shifts(browser):
    """The section has its height before the first record, and keeps it when sliders move."""
    for _ in range(5):
        browser.refresh()
        # The driver may go on before the script of the page has filled the table.
        wait(lambda: browser.execute_script("return document.querySelectorAll('#trial-table tr').length") > 0)
        before, height = browser.execute_script(HEIGHT)
        if before == "Computing ...":
            break
    assert before == "Computing ..."
    wait(lambda: browser.find_element("id", "trial-time-used").text != "")
    heights = [browser.execute_script(HEIGHT)[1]]
    for index in (0, 2, 1):
        browser.execute_script(MOVE, "damper-mounts", index)
        time.sleep(0.7)
        heights.append(browser.execute_script(HEIGHT)[1])
    assert np.allclose(heights, height, atol=1.0), (height, heights)


@pytest.mark.parametrize("vehicle", ["focus", "focus_road"])
def test_the_section_is_small(vehicle):
    """Numbers of all cars of the page and its scripts, with a record of the full length."""
    car, options = Car.load(vehicle), dict[str, Any]()
    if vehicle == "focus":
        signal = read_signal(find_input("low.csv"), wheel="fl")
    else:
        ride = Road("B", speed=80, duration=LONGEST + 1.0).under(car.vehicle, car.overrides)
        car, signal = car.with_(ride.overrides), ride.signal()
        road = RunRoad(road_class="B", speed=80.0, behind={wheel: behind for wheel, behind, _ in ride.wheels})
        options = {"skip": ride.skip, "road": road}
    text = trial_data(car, signal, wheel="fl", **options)
    # Rotations are watched up to the angle for which the page states an error.
    data, angle = json.loads(text), "2.9 deg" if vehicle == "focus" else "9.7 deg"
    assert angle in data["checked"] and angle in data["notices"][-1]
    size = len(text) + len(scripts(WORKER)) + len(scripts(PAGE))
    assert size < (0.41 if vehicle == "focus" else 1.0) * LARGEST, size


@pytest.fixture
def longer(browser, tmp_path) -> Iterator[Any]:
    """A run of 32 s of a car with Stribeck friction, opened in a narrow window; afterwards the other report again."""
    signal = tmp_path / "longer.csv"
    write_signal(signal, random_road(rms=5.25e-4, seed=3, wheel="fl", duration=32.0), plain=True)
    words = [
        "--input",
        str(signal),
        "--output",
        str(tmp_path / "run"),
        "--engine",
        "reduced",
        "--no-figures",
        "--quiet",
    ]
    assert main([*words, "--report", *(word for one in STRIBECK for word in ("--set", one))]) == 0
    report, size = browser.current_url, browser.get_window_size()
    browser.set_window_size(800, 900)
    browser.get((tmp_path / "run/report.html").as_uri())
    yield browser
    browser.set_window_size(size["width"], size["height"])
    browser.get(report)
    wait(lambda: browser.find_element("id", "trial-time-used").text != "")


def test_a_longer_run_with_stribeck_friction_in_a_narrow_window(longer):
    # Nothing to keep before the first record.
    longer.execute_script("[...document.querySelectorAll('#trial-controls button')].at(-1).click()")
    wait(lambda: "(first 30 s)" in words(longer) and "Move a slider." in words(longer))
    longer.execute_script(MOVE, "front-coulomb_friction", 200)
    wait(lambda: "Coulomb friction 60 N → 200 N" in words(longer))
    # The page runs no static friction below the Coulomb friction, and says so.
    assert "front static friction (Stribeck) 95 N → 200 N" in words(longer)
    label = longer.find_element("css selector", "label[for=trial-front-static_friction]")
    assert label.text == "front static friction (Stribeck): 200 N"
    # The titles of the plots have room.
    widths = longer.execute_script(
        "return [...document.querySelectorAll('.plots canvas')].map((one) => one.clientWidth)"
    )
    # No map of levels with Stribeck friction.
    assert len(widths) == 6 and min(widths[:5]) > 400 and widths[5] == 0
    assert [entry for entry in longer.get_log("browser") if str(longer.current_url) in entry["message"]] == []


@pytest.fixture
def first_page(browser, tmp_path) -> Iterator[Any]:
    """The frame of docs/index.md with the pages that the build of the site writes; afterwards the report again."""
    app = SimpleNamespace(outdir=tmp_path, builder=SimpleNamespace(format="html"))
    live_cars(app, None)
    (frame,) = re.findall(r"^```\{raw\} html\n(.*?)^```", (DOCS / "index.md").read_text("utf-8"), re.MULTILINE | re.S)
    (tmp_path / "index.html").write_text(f"<!DOCTYPE html><link rel='icon' href='data:,'>{frame}", encoding="utf-8")
    report = browser.current_url
    browser.get_log("browser"), browser.get_log("performance")
    browser.get((tmp_path / "index.html").as_uri())
    browser.switch_to.frame("live-car")
    yield browser
    browser.switch_to.default_content()
    browser.get(report)
    wait(lambda: browser.find_element("id", "trial-time-used").text != "")


def computed(browser: Any) -> float:
    """Return the weighted acceleration of the car with the settings of the sliders, from the table."""
    wait(lambda: browser.find_element("id", "trial-time-used").text != "")
    return float(browser.find_element("css selector", "#trial-table td:nth-child(3)").text)


def test_the_first_page_of_the_docs_computes_what_the_command_does(first_page):
    """Shaker with two values of the friction and road, to the digits of the page; no error, nothing loaded."""
    signal = read_signal(find_input("low.csv"), wheel="fl")
    count = round(LONGEST / signal.timestep) + 1
    plates = {wheel: z[:count] - z[0] for wheel, z in signal.displacement.items()}
    signal = dataclasses.replace(signal, time=signal.time[:count], displacement=plates)
    car = Car.load("focus")
    sticking = car.run(signal, engine="reduced").comfort().weighted.overall
    free = car.with_({"damper.coulomb_friction": 0.0}).run(signal, engine="reduced").comfort().weighted.overall
    driven = Car.load("sedan").run(Road("B", 80, duration=30.0), engine="reduced").comfort().weighted.overall
    assert computed(first_page) == pytest.approx(driven, rel=FOUR_DIGITS)
    assert first_page.find_element("id", "trial-notices").text == ""
    first_page.switch_to.default_content()
    first_page.find_element("link text", "On the shaker").click()
    first_page.switch_to.frame("live-car")
    loaded = "return document.readyState === 'complete' && document.title.includes('shaker')"
    wait(lambda: bool(first_page.execute_script(loaded)))
    assert computed(first_page) == pytest.approx(sticking, rel=FOUR_DIGITS)
    first_page.execute_script(MOVE, "front-coulomb_friction", 0)
    wait(lambda: "front Coulomb friction 125 N → 0 N" in words(first_page))
    assert computed(first_page) == pytest.approx(free, rel=FOUR_DIGITS)
    # What index.md says of it.
    assert free < 0.5 * sticking
    assert first_page.get_log("browser") == []
    events = [json.loads(entry["message"])["message"] for entry in first_page.get_log("performance")]
    asked = [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert sum(url.endswith("live/shaker.html") for url in asked) == 1
