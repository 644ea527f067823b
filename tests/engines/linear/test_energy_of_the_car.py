"""Modes of the car with gravity and preloads, compared with an independent derivation from energies."""

import numpy as np
import pytest

from tests.engines.linear.energy_car import EnergyCar
from tests.validation import validated
from vehicle.engines.linear.first_order import first_order

HIGHEST = 100.0
"""Highest frequency [Hz] of the comparison."""


def poles_of(car, *, stuck):
    poles = np.linalg.eigvals(first_order(car.matrices.system, stuck=stuck).state)
    poles = poles[poles.imag > 1e-6]
    return poles[np.argsort(np.abs(poles))]


@pytest.fixture(scope="module")
def second(car):
    return EnergyCar(car)


@pytest.mark.parametrize("stuck", [True, False], ids=["stuck", "sliding"])
def test_modes_with_gravity_are_those_of_the_energies(car, second, stuck):
    expected, unbalanced = second.poles(stuck=stuck)
    # 15 kN of weight, solved for once and differenced by complex steps: round-off of an ill-conditioned solution.
    assert unbalanced < 1e-5
    car_poles = poles_of(car, stuck=stuck)
    below = np.abs(expected) < 2.0 * np.pi * HIGHEST
    assert below.sum() > 25
    car_poles, expected = car_poles[: below.sum()], expected[below]
    # Without the modal displacement in the lines of the springs and in the levers: 363 ppm and 0.26 %.
    energies = "second derivation: Lagrange equations from energies, no row shared"
    state = "stuck" if stuck else "sliding"
    validated(
        "Linear system", f"natural frequencies of the car below 100 Hz, dampers {state}",
        np.abs(car_poles) / (2.0 * np.pi),
        np.abs(expected) / (2.0 * np.pi), rel=5e-6, unit="Hz", source=energies,
    )  # fmt: skip
    ratio = (car_poles.real / np.abs(car_poles)) / (expected.real / np.abs(expected)) - 1.0
    validated(
        "Linear system", f"damping ratios of the car below 100 Hz over those of the energies, dampers {state}",
        1.0 + ratio, 1.0, abs=5e-5, source=energies,
    )  # fmt: skip
