"""Pages in which the browser computes a car: sliders, plots and moving picture, as the section "Try it" of a report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from vehicle import Car, Road, road
from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.handover.page.page_input import LONGEST, RunRoad
from vehicle.handover.page.trial_data import trial_data
from vehicle.handover.page.trial_section import trial_of
from vehicle.runs.report.modes_section import as_json, mode_set
from vehicle.runs.report.page import document
from vehicle.runs.report.run_input import car_title
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal_file import read_signal


def live_cars(app: Any, error: Exception | None) -> None:
    """Write the pages that index.md shows, at the end of the build of the site."""
    folder = Path(app.outdir) / "live"
    if error is None and app.builder.format == "html":
        folder.mkdir(exist_ok=True)
        road_b = road("B", 80, duration=30)
        cars: dict[str, tuple[str, str | Road]] = {"shaker": ("focus", "low.csv"), "road": ("sedan", road_b)}
        for name, (car, source) in cars.items():
            (folder / f"{name}.html").write_text(live_page(Car.load(car), source), encoding="utf-8")


def live_page(car: Car, source: str | Road) -> str:
    """Return a page in which a car runs on a signal or a road, with sliders.

    The page is one HTML document that loads nothing. Its numbers are those of `Car.run` with the reduced engine.

    Args:
        car: the car.
        source: file of plate displacements or the name of a shipped one, or a road with a class.

    Raises:
        ConfigurationError: the page cannot run the car or the input (see `trial_data`).
        DataError: the file cannot be read or holds bad data.
    """
    wheel = car.vehicle.shaker_wheel
    if isinstance(source, Road):
        drive = source.under(car.vehicle, car.overrides)
        summary: dict[str, Any] = {**drive.summary(signal := drive.signal())}
        car, title, skip = car.with_(drive.overrides), car_title(car.vehicle.name, summary), drive.skip
        driven = RunRoad(road_class=summary["class"], speed=summary["speed_kmh"], behind=summary["behind_m"])
        numbers = trial_data(car, signal, wheel=wheel, skip=skip, road=driven)
    else:
        signal, title = read_signal(find_input(source), wheel=wheel), car_title(car.vehicle.name, {}, source)
        numbers = trial_data(car, signal, wheel=wheel)
    trial = trial_of(numbers, min(signal.duration, LONGEST))
    picture = as_json([mode_set(car.vehicle.name, car_wireframe(car.model), {})])
    return document(title, (), [("Try it", "trial", trial.content)], modes=picture, trial=trial)
