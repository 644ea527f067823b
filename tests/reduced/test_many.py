"""Many cars at once against each of them alone: the same bits in any company, the same motion, exact friction."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from vehicle.excitation.random_road import random_road
from vehicle.reduced.many import COARSE_STEP, simulate_many
from vehicle.reduced.run import LONGEST_STEP, simulate_reduced

pytest.importorskip("numba", reason="the reduced engine needs it")

ROAD = random_road(rms=1e-3, seed=5, duration=2.0)
CHANNELS = [
    *(f"seat_rail_acc_{axis}" for axis in "xyz"),
    *(f"damper_{wheel}_{kind}" for wheel in ("fr", "fl") for kind in ("velocity", "force")),
    *("knuckle_fr_acc_z", "tyre_fr_force_z", "tyre_fl_force_z", "plate_fr_displacement", "plate_fl_displacement"),
]
LAWS: dict[str, dict[str, Any]] = {
    "coulomb": {},
    "stribeck": {"coulomb_friction": 60.0, "friction_law": "stribeck"},
    "degressive": {"coulomb_friction": 60.0, "viscous_law": "degressive"},
    "table": {"viscous_law": "table", "velocity": (-0.5, 0.0, 0.05, 0.5), "force": (-1400.0, 0.0, 350.0, 1362.5)},
    "no friction": {"coulomb_friction": 0.0},
}
"""Laws with one least slope, 2250 N s/m, which the poles hold."""


def dampers(car, name):
    return [dataclasses.replace(one.law, **LAWS[name]) for one in car.vehicle.composition.dampers]


def with_idle_poles(model, pairs, reals):
    """The same car with poles that nothing moves, as another car may have more of them."""
    at = [model.pairs] * pairs + [len(model.poles)] * reals
    return dataclasses.replace(
        model,
        poles=np.insert(model.poles, at, [-5.0 + 3.0j] * pairs + [-7.0] * reals),
        pairs=model.pairs + pairs,
        **{name: np.insert(getattr(model, name), at, 0.0, axis=0) for name in ("height", "velocity", "force")},
        **{name: np.insert(getattr(model, name), at, 0.0, axis=1) for name in ("slip", "modal", "branch")},
    )


def run_many(models, laws, signal, tyre_load, channels=CHANNELS, **more):
    return simulate_many(
        models, signal, dampers=laws, record_rate=1000.0, tyre_load=tyre_load, channels=channels, **more
    )


@pytest.fixture(scope="module")
def company(car):
    """Ten cars of all laws and of several numbers of poles, their laws and tyre loads."""
    models = [with_idle_poles(car.poles, k % 3, (2 * k) % 5) for k in range(10)]
    laws = [dampers(car, name) for name in (*LAWS, *LAWS)]
    return models, laws, [car.model.static.tyre_load] * 10


@pytest.fixture(scope="module")
def together(company):
    models, laws, loads = company
    return run_many(models, laws, ROAD, loads)


@pytest.mark.parametrize("order", [[9], [3, 1], [9, 8, 7, 6, 5, 4, 3, 2, 1, 0]])
def test_a_car_does_not_know_its_neighbours(company, together, order):
    chosen = [[part[k] for k in order] for part in company]
    other = run_many(chosen[0], chosen[1], ROAD, chosen[2], channels=CHANNELS[::-1])
    for place, k in enumerate(order):
        for name in CHANNELS:
            np.testing.assert_array_equal(other.channels[name][place], together.channels[name][k], err_msg=name)
        assert other.statistics[place].warnings == together.statistics[k].warnings


@pytest.mark.parametrize("name", LAWS)
def test_a_car_moves_as_it_does_alone(company, together, name, monkeypatch):
    models, laws, loads = company
    k = list(LAWS).index(name)
    # One car alone is of first order in the step where its law is not one of constants: an eighth of its step.
    monkeypatch.setattr("vehicle.reduced.run.LONGEST_STEP", LONGEST_STEP / 8.0)
    alone = simulate_reduced(
        models[k], ROAD, dampers=laws[k], record_rate=1000.0, tyre_load=loads[k], channels=CHANNELS
    )
    for step, of_rail, bound in ((COARSE_STEP, 5e-3, 0.015), (LONGEST_STEP, 1e-3, 2.5e-3)):
        found = run_many(models[k : k + 1], laws[k : k + 1], ROAD, loads, step=step)
        for channel in CHANNELS:
            difference = np.std(found.channels[channel][0] - alone[channel])
            largest = of_rail if channel.startswith("seat_rail") else bound
            # A force jumps, and the others only where it does.
            assert difference <= largest * np.std(alone[channel]), (channel, step)
        assert found.recording(0).statistics.warnings == alone.statistics.warnings
