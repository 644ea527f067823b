"""Shares of the modes in an acceleration: their sum is the response, and a sine at a resonance belongs to its mode."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear import mode_shares as module
from vehicle.engines.linear.forced_response import force_amplitudes, unit_response
from vehicle.engines.linear.mode_shares import forced_mode_shares, mode_shares
from vehicle.runs.car import Car

CHANNEL = "seat_rail_acc_z"


@pytest.mark.parametrize(("name", "stuck"), [("focus", True), ("sedan", False)])
def test_the_parts_add_up_to_the_response(name, stuck):
    car, lines = Car.load(name), np.array([1.3, 4.0, 11.0, 27.0])
    wheels = car.vehicle.wheels
    rng = np.random.default_rng(4)
    plates = rng.standard_normal((len(wheels), 4)) + 1j * rng.standard_normal((len(wheels), 4))
    result = mode_shares(car.matrices.system, CHANNEL, lines, plates, stuck=stuck)
    expected = sum(
        car.matrix_frf([CHANNEL], lines, wheel=wheel, damper="stuck" if stuck else "sliding")[0] * plate
        for wheel, plate in zip(wheels, plates, strict=True)
    )
    validated(
        "Linear system", f"sum of the parts of the modes of {name}", result.acceleration, expected, rel=1e-7,
        unit="m/s2", source="second derivation: frequency response by partial fractions to each plate",
    )  # fmt: skip


def test_blocks_of_lines_give_the_shares_of_the_whole(monkeypatch):
    car, lines = Car.load("sedan"), np.linspace(1.0, 30.0, 50)
    plates = np.exp(1j * np.arange(4 * lines.size).reshape(4, -1) ** 2)
    whole = mode_shares(car.matrices.system, CHANNEL, lines, plates, stuck=False)
    monkeypatch.setattr(module, "LINES_AT_ONCE", 7)
    blocks = mode_shares(car.matrices.system, CHANNEL, lines, plates, stuck=False)
    np.testing.assert_allclose(blocks.acceleration, whole.acceleration, rtol=1e-9)
    np.testing.assert_allclose(blocks.shares, whole.shares, atol=1e-9 * np.max(np.abs(whole.shares)))


def test_a_sine_at_a_resonance_belongs_to_its_mode():
    car = Car.load("sedan")
    heave = next(mode for mode in car.modes("sliding") if mode.description.startswith("body heave"))
    plates = np.ones((4, 1), dtype=complex)
    result = mode_shares(car.matrices.system, CHANNEL, [heave.frequency], plates, stuck=False)
    strongest = int(np.argmax(result.shares))
    assert abs(result.poles[strongest]) / (2 * np.pi) == pytest.approx(heave.frequency, rel=1e-9)
    assert 0.5 < result.shares[strongest] < 1.5 and abs(result.shares.sum() - 1.0) < 0.2


@pytest.mark.parametrize("stuck", [True, False])
def test_the_parts_of_forces_add_up_to_their_response(stuck):
    """An imbalance, a run-out of a tyre and the orders of the engine, each at its own frequency."""
    texts = {
        "front.imbalance.mass": 0.02, "front.imbalance.radius": 0.2, "front.nonuniformity.runout": [[1, 1e-4, 0]],
        "force.a.on": "engine", "force.a.moment": [0, 1, 0], "force.a.angle": "crank",
        "force.a.harmonics": [[2, 10, 0]], "crank.rpm": 800.0, "driving.speed": 30.0,
    }  # fmt: skip
    matrices = Car.load("sedan", texts).matrices
    forced, amplitudes = np.array(matrices.lines.frequencies), force_amplitudes(matrices)
    every = np.arange(len(amplitudes))
    unit = unit_response(matrices, [CHANNEL], forced.tolist(), every, stuck=stuck)[:, 0]
    assert len(forced) > 1
    for line, frequency in enumerate(forced / (2.0 * np.pi)):
        found = forced_mode_shares(matrices, CHANNEL, frequency, amplitudes[:, line], stuck=stuck)
        expected = np.sum(unit[:, line] * amplitudes[:, line])
        assert found.acceleration == pytest.approx(np.array([expected]), rel=1e-7)
        # What is left of the whole belongs to real poles.
        assert abs(found.shares.sum() - 1.0) < 0.2
