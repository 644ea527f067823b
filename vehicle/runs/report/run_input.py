"""Inputs of the runs of a report: their words, the runs that are compared, and the error of a change on one road."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from vehicle.names import AXES
from vehicle.runs.figures.chosen_figure import ChosenFigure
from vehicle.runs.figures.value import values_of
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.main_band import POINT
from vehicle.signals.analysis.comfort_error import STUDENT_95, difference_error
from vehicle.signals.analysis.ride_comfort import WEIGHTED


def input_text(run: FinishedRun) -> str:
    """Return the input in words: the road with its speed, or the file with its level."""
    road, excitation = run.summary.input.road or {}, run.summary.input
    if road.get("level"):
        return f"a level road at {road['speed_kmh']:g} km/h"
    if road.get("class"):
        return f"a road of class {road['class']} at {road['speed_kmh']:g} km/h"
    if road.get("speed_kmh"):
        named = road.get("obstacle") or road.get("profile") or Path(excitation.file).name
        return f"{named} at {road['speed_kmh']:g} km/h"
    return f"{Path(excitation.file).name} (RMS {1e3 * excitation.rms_m:.3g} mm)"


def car_title(name: str, road: Mapping[str, Any], run: str = "") -> str:
    """Return car and road as a title, "Sedan on road B at 80 km/h"; off a road, the car and the name of its run.

    Args:
        name: name of the car.
        road: the road in the summary of the run; empty on a rig.
        run: name of the run.
    """
    car, speed = name[:1].upper() + name[1:].replace("_", " "), road.get("speed_kmh")
    if speed is None:
        return f"{car} on the shaker: {run}"
    under = f"road {road['class']}" if road.get("class") else "a level road" if road.get("level") else ""
    under = under or str(road.get("obstacle") or road.get("profile") or "a road").replace("_", " ")
    return f"{car} on {under} at {speed:g} km/h"


def references(runs: Sequence[FinishedRun]) -> list[int | None]:
    """Return the number of the run with which each run is compared: the first one on its input.

    Returns:
        None for the first run on an input. If no two runs have the same input and all are on a rig, its signals are
        compared: the first run is the reference of all others. Roads and speeds are nobody's choice.
    """
    inputs = [input_text(run) for run in runs]
    if len(set(inputs)) == len(inputs) and not any(run.summary.input.road for run in runs):
        return [None, *[0] * (len(runs) - 1)]
    return [None if inputs.index(text) == number else inputs.index(text) for number, text in enumerate(inputs)]


def change_half_width(first: FinishedRun, run: FinishedRun) -> float | None:
    """Return half of the 95 % interval of the change of the weighted acceleration at the seat rail [%].

    The error is that of two cars on the same random road, `vehicle.signals.analysis.comfort_error.difference_error`,
    times t_0.975 with 2 `WAVES` degrees of freedom, over the value of the first run. On a road that repeats, the waves
    are those that the linear twin of each car does not explain.

    Args:
        first, run: runs.

    Returns:
        The half width; None unless both drive on the same random road, with the same seed and the same evaluated span.
    """
    names = [f"{POINT}_acc_{axis}" for axis in AXES]
    recorded = all(name in each.recording.channels for each in (first, run) for name in names)
    if not first.runs.random or _same_for_both(first) != _same_for_both(run) or not recorded:
        return None
    runs = [first.runs, run.runs]
    if any(each.twin is None for each in runs):  # what a twin leaves compares with no whole waves
        runs = [replace(each, period=None) for each in runs]
    before, after = (values_of(ChosenFigure(quantity=WEIGHTED), each) for each in runs)
    assert before.waves is not None and after.waves is not None  # a comfort value on a random road
    return 100.0 * float(STUDENT_95 * difference_error(before.waves, after.waves)[0] / before.value[0])


def _same_for_both(run: FinishedRun) -> tuple[object, ...]:
    """Return what two runs on one road have in common: road, level, and evaluated span."""
    road = run.summary.input.road or {}
    parts = (road.get(key) for key in ("class", "profile", "speed_kmh", "seed", "coherence", "repeats_after_s"))
    return *parts, run.summary.input.rms_m, run.summary.input.duration_s, run.skip
