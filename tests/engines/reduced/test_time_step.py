"""The implicit damper forces of a step."""

import ctypes
import dataclasses
from typing import Any

import numpy as np
import pytest

from tests.core.idle_march import idle_march
from vehicle.core.library import core
from vehicle.engines.reduced.car_table import CarTable
from vehicle.engines.reduced.pole_model import Outputs
from vehicle.engines.reduced.step_factors import ACCURACY, CarFactors
from vehicle.engines.reduced.table_layout import DOUBLE, SINGLE
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.vehicle import load_vehicle

LAWS: list[dict[str, Any]] = [
    {"coulomb_friction": 90.0},
    {"coulomb_friction": 65.0, "viscous_law": "degressive"},
    {"coulomb_friction": 0.0, "viscous_law": "degressive"},
    # Bump and rebound, with a corner within the stick of the friction.
    {
        "coulomb_friction": 30.0,
        "viscous_law": "table",
        "velocity": (-0.4, 0.0, 1e-4, 0.1, 1.0),
        "force": (-240.0, 0.0, 5.0, 155.0, 900.0),
    },
]


def solve(table, count):
    """Solve the forces of a step of cars in double precision."""
    march = idle_march(rows=table.rows, table=table.table, dampers=count, pieces=table.pieces)
    core().core_solve_forces_d(ctypes.c_void_p(march.address))


def table_of(gain, laws, element):
    """Return the table of a car with one idle pole and the gains of its dampers."""
    d = len(laws)
    factors = CarFactors(
        columns=[0], lines=0, integrated=np.arange(1), pairs=0, plate_inputs=0,
        step=np.zeros((1, 3 + 2 * d), dtype=complex), direct=np.zeros((1, 2 * d + 2), dtype=complex),
        slip=np.zeros((d, 1), dtype=complex), gains=(np.zeros((d, 1)), gain, np.zeros((d, d))),
    )  # fmt: skip
    no_sensors = Outputs(poles=np.zeros((0, 1), dtype=complex), height=np.zeros((0, 1)), velocity=np.zeros((0, 1)))
    return CarTable([factors], [laws], np.zeros((2, 1)), element, [no_sensors])


@pytest.mark.parametrize("coupling", [0.0, 0.04, 0.3])
@pytest.mark.parametrize("count", [1, 2, 4])
@pytest.mark.parametrize("own_gain", [1e-7, 7.7e-5, 1e-2])
def test_velocities_and_forces_of_coupled_dampers_are_consistent(count, own_gain, coupling):
    laws = [dataclasses.replace(load_vehicle().damper, **law) for law in LAWS[-count:]]
    gain = own_gain * (np.diag(1.0 + 0.2 * np.arange(count)) + coupling * (1.0 - np.eye(count)))
    generator = np.random.default_rng(7)
    for size in (1e-6, 1e-3, 0.05, 1.0):
        table = table_of(gain, laws, DOUBLE)
        t, r = table.table, table.rows
        arriving, hold = size * generator.standard_normal(count), 20.0 * generator.standard_normal(count)
        t[r["work"] :][:count], t[r["hold"] :][:count] = arriving[:, None], hold[:, None]
        t[r["stick"] :][:count] = 0.0  # The forces are constant over the step.
        solve(table, count)
        velocity, force = t[r["velocity"] :][:count, 0], t[r["inputs"] :][:count, 0]
        # v = a + G f, and f follows from v: the curve acts with the mean of both ends.
        # The iteration leaves a share `ACCURACY` of the change of a force in the step, here from 0.
        left = ACCURACY * np.max(gain) * np.max(np.abs(force))
        np.testing.assert_allclose(velocity, arriving + gain @ force, rtol=1e-7, atol=1e-7 * size + left)
        for v, f, half, law in zip(velocity, force, hold, laws, strict=True):
            curve = damper_curve(law)
            excess = 0.5 * float(curve.force(v) - curve.least_slope * v)
            friction = np.clip(
                2.0 / np.pi * law.coulomb_friction * law.smoothing * v, *law.coulomb_friction * np.array([-1, 1])
            )
            assert f == pytest.approx(-(half + excess + friction), rel=1e-7, abs=1e-7)


def test_lanes_of_both_precisions():
    laws = [dataclasses.replace(load_vehicle().damper, **law) for law in LAWS[:2]]
    gain = np.array([[8e-5, 1e-7], [1e-7, 9e-5]])
    assert table_of(gain, laws, DOUBLE).table.shape[1] == 4
    assert table_of(gain, laws, SINGLE).table.shape[1] == 8
