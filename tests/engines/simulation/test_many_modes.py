"""A body of more modes than its attachments can tell apart: against the model in which MuJoCo holds them all."""

from dataclasses import replace

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.simulation import stepping
from vehicle.engines.simulation.car_model import build_model
from vehicle.engines.simulation.run_model import prepared, run_model
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

MODES = 84
NODES, TURNING = 15, 9
"""Nodes at which something acts on the body of the shipped car, and those under a rotational stiffness."""


@pytest.fixture(scope="module")
def car():
    """The shipped car with random modes above its own nine."""
    shipped = Car.load()
    body, rng, more = shipped.trimmed_body, np.random.default_rng(3), MODES - 9
    wide = replace(
        body,
        frequencies=np.concatenate([body.frequencies, np.linspace(45.0, 200.0, more)]),
        damping_ratio=np.full(MODES, 0.03),
        shapes=np.concatenate([body.shapes, 0.02 * rng.standard_normal((more, len(body.nodes), 3))]),
        rotations={node: 0.02 * rng.standard_normal((MODES, 3)) for node in body.nodes},
        mode_names=tuple(f"mode {number}" for number in range(MODES)),
        derived=True,  # random shapes are no modes of its masses
    )
    return build_model(shipped.vehicle, wide)


def test_modes_beside_the_solver_are_modes_in_it(car, monkeypatch):
    time = np.arange(0.0, 0.4, 1e-3)
    signal = Signal(time=time, displacement={"fr": 4e-3 * np.sin(2.0 * np.pi * (3.0 + 40.0 * time) * time)})
    loads = tuple(car.vehicle.load_channels)
    found = stepping.simulate(car, signal, requested=loads)
    model, space = run_model(car)
    assert space is not None and model.nv == car.model.nv - MODES + 3 * (NODES + TURNING)
    monkeypatch.setattr(stepping, "run_model", lambda car: (prepared(car.spec, car.model.qpos_spring), None))
    expected = stepping.simulate(car, signal, requested=loads)
    size = np.abs(expected.poses).max(axis=0)
    assert np.max(np.abs(expected.poses[:, 7 : 7 + MODES])) > 1e-3
    # The solver stops where its tolerance of 1e-12 lets it.
    validated(
        "Integration in MuJoCo", "poses of a car on 84 body modes, modes integrated beside the solver", found.poses,
        expected.poses, abs=1e-9 * size.max(), source="second derivation: MuJoCo with all modes as joints",
    )  # fmt: skip
    for name, channel in expected.channels.items():
        error = np.max(np.abs(found.channels[name] - channel))
        # An acceleration is a difference of positions over 1 ms2, and along some axes next to nothing.
        assert error < 1e-7 * max(np.abs(channel).max(), 1.0), name
    one, other = found.statistics.energies, expected.statistics.energies
    assert one is not None and other is not None
    np.testing.assert_allclose([one.dissipated, one.stored], [other.dissipated, other.stored], rtol=1e-8)


def test_few_modes_stay_in_the_solver():
    model, space = run_model(Car.load().model)
    assert space is None and model.nv == 63
