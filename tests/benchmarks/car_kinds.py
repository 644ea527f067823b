"""Coverage of the stated error of comfort for five kinds of cars, classes A to D, 30 to 120 km/h."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from vehicle.engines.reduced.batch_simulation import COARSE_STEP
from vehicle.runs.car import Car, Road
from vehicle.signals.analysis.ride_comfort import ERROR, UNWEIGHTED, WEIGHTED
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.sweeps.case_evaluation import measured_batch
from vehicle.studies.sweeps.measure import ComfortMeasure

SPAN_S = 10.0

KINDS: dict[str, Sequence[str]] = {
    "friction": ("front.damper.coulomb_friction=300", "rear.damper.coulomb_friction=200"),
    "presliding": ("*.damper.friction_law=presliding", "*.damper.presliding_stiffness=1e6"),
    "degressive": ("*.damper.viscous_law=degressive", "front.damper.viscous=1000", "rear.damper.viscous=800"),
    "one-sided tyres": ("*.bushings.tyre.one_sided=true",),
    "little friction": ("*.damper.coulomb_friction=20",),
}
"""Changes of `focus_road`: dampers that stick for half of the time (class B), and four other kinds."""


def kinds(repetitions: int) -> list[dict[str, Any]]:
    """Stated 95 % intervals of 10 s against the scatter of the values over the seeds; the slip share beside them."""
    rows: list[dict[str, Any]] = []
    for road in "ABCD":
        for speed in (30.0, 50.0, 80.0, 120.0):
            driving = f"driving.speed={speed / 3.6!r}"
            cars = [Car.load("focus_road", [driving, *changes]) for changes in KINDS.values()]
            found = []
            for seed in range(1, repetitions + 1):
                drive = Road(road, speed, seed=seed).under(cars[0].vehicle)
                assert isinstance(drive, RoadDrive)
                signal = replace(drive, duration=drive.skip + SPAN_S).signal()
                measure = ComfortMeasure(skip=drive.skip, timestep=COARSE_STEP)
                results = measured_batch(cars, signal, measure, accept_invalid=True)
                found.append([each.values for each in results if each is not None])
            table = {name: np.array([[row[name] for row in run] for run in found]) for name in found[0][0]}
            slip = np.mean([table[name] for name in table if name.startswith("slip_share")], axis=(0, 1))
            for value in (WEIGHTED, UNWEIGHTED):
                comfort = table[value] / table[value].mean(axis=0)
                half = 1.96 * table[f"{value}{ERROR}"] * comfort
                covers = np.mean(np.abs(comfort - 1.0) < half, axis=0)
                for car, kind in enumerate(KINDS):
                    rows.append(
                        {
                            "car": f"{kind}, {road} {speed:g} km/h",
                            "value": value,
                            "slip_share": float(slip[car]),
                            "scatter_percent": 100.0 * comfort[:, car].std(ddof=1),
                            "half_width_percent": 100.0 * np.sqrt(np.mean(half[:, car] ** 2)),
                            "covers_95": float(covers[car]),
                        }
                    )
    return rows
