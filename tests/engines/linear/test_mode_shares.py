"""Shares of the modes in an acceleration: their sum is the response, and a sine at a resonance belongs to its mode."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.mode_shares import mode_shares
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


def test_a_sine_at_a_resonance_belongs_to_its_mode():
    car = Car.load("sedan")
    heave = next(mode for mode in car.modes("sliding") if mode.description.startswith("body heave"))
    plates = np.ones((4, 1), dtype=complex)
    result = mode_shares(car.matrices.system, CHANNEL, [heave.frequency], plates, stuck=False)
    strongest = int(np.argmax(result.shares))
    assert abs(result.poles[strongest]) / (2 * np.pi) == pytest.approx(heave.frequency, rel=1e-9)
    assert 0.5 < result.shares[strongest] < 1.5 and abs(result.shares.sum() - 1.0) < 0.2
