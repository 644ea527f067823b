"""Findings of the rides: tables, and rows that test the finding of Bommer 2006 on four wheels."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np

from scenarios.claims import COMPARED, OWN_CHECK, Claim, markdown
from scenarios.comfort_sensitivity.figures import number
from scenarios.road.runs import Found, Ride, RideRuns
from vehicle.signals.analysis.road_level import CLASSES

LOAD = "load_{}"

SCALED = 5e-3
"""Difference of two relative comfort values that are one by the scaling [-]."""

LARGE = 1.10
"""Growth of a comfort value [-] that a passenger may notice: differences of about 10 % and more are felt (Mansfield and
Griffin, Journal of Sound and Vibration 236 (2000), just noticeable differences of vertical vibration in a car)."""


def class_table(runs: RideRuns, rides: Sequence[Ride]) -> str:
    """Return every ride of the grid of classes and speeds as a Markdown table."""
    axles = [axle for axle, _ in runs.measure.by_axle]
    head = (
        "car",
        "class",
        "speed [km/h]",
        "rail, 2 to 50 Hz [m/s²]",
        "rail, ISO 2631-1 [m/s²]",
        "seat, ISO 2631-1 [m/s²]",
    )
    loads = tuple(f"dynamic over static load, {axle} [%]" for axle in axles)
    heads = ("SEAT value [-]", *loads, "lowest load over static [%] (time below 0)", "slip of the dampers [%]")
    rows = []
    for ride in rides:
        average = runs(ride)
        mean = average.mean
        rows.append(
            (
                *(
                    ride.car,
                    ride.road,
                    f"{ride.speed:g}",
                    *(_pair(average, name) for name in ("rail", "rail_weighted")),
                ),
                *(_pair(average, "seat_weighted"), _pair(average, "seat_value")),
                *(f"{100.0 * mean[f'load_{axle}']:.1f}" for axle in axles),
                f"{100.0 * mean['lowest_load']:.0f} ({100.0 * mean['pulling']:.2g} %)",
                f"{100.0 * mean['slip']:.0f}",
            )
        )
    return markdown((*head, *heads), rows)


def friction_table(runs: RideRuns, rides: Sequence[Ride]) -> str:
    """Return a table of every friction limit, relative to the car without friction on the same records."""
    axles = [axle for axle, _ in runs.measure.by_axle]
    names = ("rail", "rail_weighted", "seat_weighted", *(f"load_{axle}" for axle in axles))
    head = (
        "car",
        "class",
        "friction of every damper [N]",
        "rail, 2 to 50 Hz [m/s²]",
        *(f"{name} [%]" for name in names),
    )
    rows = []
    for ride in rides:
        ratios = [ratio(runs, ride, name) for name in names]
        cells = [
            f"{100.0 * mean:.1f} ± {number(100.0 * error, 1)}" if np.isfinite(mean) else "" for mean, error in ratios
        ]
        rows.append(
            (
                ride.car,
                ride.road,
                f"{ride.friction:g}",
                _pair(runs(ride), "rail"),
                *cells,
                f"{100.0 * runs(ride).mean['slip']:.0f}",
            )
        )
    return markdown((*head, "slip of the dampers [%]"), rows)


def check_table(runs: RideRuns, pairs: Mapping[str, tuple[Ride, Ride]]) -> str:
    """Return a Markdown table that compares a ride by two models."""
    names = list(runs.measure.units)
    rows = []
    for label, (passage, other) in pairs.items():
        first, second = (runs(ride).mean for ride in (passage, other))
        cells = [
            f"{100.0 * (second[name] / first[name] - 1.0):+.2f}"
            for name in names
            if name not in ("lowest_load", "pulling")
        ]
        rows.append((label, f"{first['rail']:.4f}, {second['rail']:.4f}", *cells, f"{100.0 * second['pulling']:.2g}"))
    shown = [f"{name} [%]" for name in names if name not in ("lowest_load", "pulling")]
    return markdown(("ride", "rail, both [m/s²]", *shown, "time a tyre would pull [%]"), rows)


def ratio(runs: RideRuns, ride: Ride, name: str) -> tuple[float, float]:
    """Return the ratio of a value to that of the car without friction: mean over the records, and standard error."""
    base = Ride(car=ride.car, road=ride.road, speed=ride.speed, friction=0.0)
    values = np.array(
        [
            values_of_record[name] / other[name]
            for values_of_record, other in zip(runs(ride).each, runs(base).each, strict=True)
        ]
    )
    error = float(np.std(values, ddof=1) / np.sqrt(values.size)) if values.size > 1 else float("nan")
    return float(np.mean(values)), error


def friction_claims(
    runs: RideRuns, car: str, roads: Sequence[str], speed: float, frictions: Sequence[float]
) -> list[Claim]:
    """Return the rows on friction: less comfort on a smooth road, less effect on a rough road, on four wheels.

    Roads from smooth to rough, speed [km/h], frictions from 0 up [N].
    """

    def grown(road: str, name: str) -> list[float]:
        return [
            ratio(runs, Ride(car=car, road=road, speed=speed, friction=friction), name)[0] for friction in frictions
        ]

    smooth, rough = grown(roads[0], "rail"), grown(roads[-1], "rail")
    changes = ", ".join(f"{100.0 * value:.0f} %" for value in smooth)
    rows = [
        COMPARED.statement(
            f"{car}: comfort of the rail on the smoothest road (class {roads[0]}) against friction",
            "friction makes a smooth road uncomfortable (chapter 4, one corner on the shaker)",
            f"{changes} of the value without friction at {_list(frictions)} N",
            smooth[-1] > LARGE and all(b > a for a, b in itertools.pairwise(smooth[1:])),
            f"it must rise from step to step beyond the first, and by more than {100.0 * (LARGE - 1.0):.0f} % in all",
        ),
        COMPARED.statement(
            f"{car}: the same on the roughest road (class {roads[-1]})",
            "on a rough road friction matters less",
            f"{', '.join(f'{100.0 * value:.0f} %' for value in rough)} at {_list(frictions)} N",
            rough[-1] - 1.0 < 0.5 * (smooth[-1] - 1.0),
            "its growth must be less than half of that on the smoothest road",
        ),
    ]
    if runs.vehicles[car].seated:
        seat = grown(roads[0], "seat_weighted")
        rows.append(
            OWN_CHECK.statement(
                f"{car}: weighted vibration of the seat on class {roads[0]} against friction",
                "what the rail shows reaches the person",
                f"{', '.join(f'{100.0 * value:.0f} %' for value in seat)} at {_list(frictions)} N",
                seat[-1] > LARGE,
                f"it must rise by more than {100.0 * (LARGE - 1.0):.0f} % in all",
            )
        )
    return rows


def scaling_claim(
    runs: RideRuns, car: str, roads: Sequence[str], speed: float, frictions: Sequence[float]
) -> list[Claim]:
    """Return the row on equal relative comfort for twice the road amplitude and twice the friction.

    A car that is linear but for Coulomb friction has u = a U(F / a) on a road of the amplitude a; each class has twice
    the amplitude of the one before.
    """
    rough, smooth, factor = roads[-1], roads[0], CLASSES[roads[-1]] / CLASSES[roads[0]]
    pairs = [
        (limit, other)
        for limit in frictions
        for other in frictions
        if limit > 0.0 and np.isclose(other, limit * factor**0.5)
    ]
    if not pairs:
        return []
    ratios = [
        (ratio(runs, Ride(car=car, road=smooth, speed=speed, friction=limit), "rail")[0],
         ratio(runs, Ride(car=car, road=rough, speed=speed, friction=other), "rail")[0])
        for limit, other in pairs
    ]  # fmt: skip
    pairs_text = "; ".join(
        f"{100.0 * a:.2f} % (class {smooth}, {limit:g} N), {100.0 * b:.2f} % (class {rough}, {other:g} N)"
        for (a, b), (limit, other) in zip(ratios, pairs, strict=True)
    )
    return [
        OWN_CHECK.statement(
            f"{car}: what counts is friction over the amplitude of the road",
            "a car that is linear but for Coulomb friction has the same relative comfort at twice both",
            pairs_text,
            all(abs(a / b - 1.0) < SCALED for a, b in ratios),
            f"within {100.0 * SCALED:g} %: exact in the reduced engine, in MuJoCo parts turn by finite angles",
        )
    ]


def words(runs: RideRuns, car: str, roads: Sequence[str], speed: float, frictions: Sequence[float]) -> str:
    """Return a sentence for each class on the effect of friction on a car."""
    said = []
    for road in roads:
        rides = [Ride(car=car, road=road, speed=speed, friction=friction) for friction in frictions]
        best = min(rides, key=lambda ride: runs(ride).mean[LOAD.format(runs.measure.by_axle[0][0])])
        rail = ratio(runs, rides[-1], "rail")[0]
        part = f"class {road}: {frictions[-1]:g} N in every damper change the vibration of the rail by {_percent(rail)}"
        if runs.vehicles[car].seated:
            part += f", the weighted vibration of the seat by {_percent(ratio(runs, rides[-1], 'seat_weighted')[0])}"
        said.append(f"{part}; the front tyre load varies least at {best.friction:g} N")
    return (
        f"In words, {car}, {speed:g} km/h. " + ". ".join(friction[0].upper() + friction[1:] for friction in said) + "."
    )


def _percent(value: float) -> str:
    return f"{100.0 * (value - 1.0):+.0f} %"


def _list(values: Sequence[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)


def _pair(average: Found, name: str) -> str:
    mean, error = average.mean[name], average.error[name]
    return f"{mean:.3f} ± {number(error, 3)}" if np.isfinite(mean) else ""
