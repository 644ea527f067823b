"""One short run with all its files and its report, made once."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from markupsafe import Markup

from scenarios.signals.random_road import random_road
from tests.patience import HANG
from vehicle.commands.shaker import main
from vehicle.signals.excitation.signal_file import write_signal


@pytest.fixture
def no_figures(monkeypatch):
    """Leave out the figures of reports, all but their labels."""
    for module in ("sections", "answer", "car_section", "comparison_section", "spectra_section"):
        monkeypatch.setattr(
            f"vehicle.runs.report.{module}.drawing", lambda plot, label: Markup(f"<figure>{label}</figure>")
        )


@pytest.fixture
def one_car(monkeypatch):
    """Leave out the sliders with a car for each position, which take most of the time of a page."""
    monkeypatch.setattr("vehicle.handover.page.trial_data.stepped_sliders", lambda car, drive: ([], [car]))


@dataclass(frozen=True)
class Reported:
    """A folder of a run, and its report."""

    folder: Path
    page: Path

    @property
    def text(self) -> str:
        return self.page.read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def reported(tmp_path_factory: pytest.TempPathFactory) -> Reported:
    """A run of 20 s with another friction, whose input has a name that is markup."""
    place = tmp_path_factory.mktemp("report")
    write_signal(place / "a<b>&c.csv", random_road(rms=5.25e-4, seed=3, wheel="fl", duration=20.0), plain=True)
    folder = place / "run"
    words = ["--input", str(place / "a<b>&c.csv"), "--output", str(folder), "--engine", "reduced", "--quiet"]
    words += ["--report", "--author", "A. Engineer", "--project", "Ride"]
    assert main([*words, "--set", "damper.coulomb_friction=100"]) == 0
    return Reported(folder=folder, page=folder / "report.html")


CHROMIUM, DRIVER = Path("/usr/bin/chromium"), Path("/usr/bin/chromedriver")
FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--window-size=1300,900", "--disable-dev-shm-usage"),
)


@pytest.fixture(scope="module")
def browser(reported, tmp_path_factory) -> Iterator[Any]:
    """The report, opened, with its trial run once."""
    pytest.importorskip("selenium", reason="selenium is missing: pip install 'vehicle-on-shaker[browser]'")
    if not (CHROMIUM.is_file() and DRIVER.is_file()):
        pytest.skip("chromium and chromium-driver are not installed: tools/system-libraries.sh tests installs them")
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.support.ui import WebDriverWait

    options = webdriver.ChromeOptions()
    options.binary_location = str(CHROMIUM)
    for flag in (*FLAGS, f"--user-data-dir={tmp_path_factory.mktemp('browser')}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service(str(DRIVER)), options=options)
    try:
        driver.get(reported.page.as_uri())
        WebDriverWait(driver, HANG).until(lambda driver: driver.find_element("id", "trial-time-used").text)
        yield driver
    finally:
        driver.quit()
