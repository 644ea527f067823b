"""Modal A of the modes of the car against the residue of a response, and against the dynamic stiffness itself."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.modal_scale import modal_a


def stiffness(system, s):
    """Return D(s) of the theory, written out."""
    branch = system.branch_stiffness * s * system.branch_time / (1.0 + s * system.branch_time)
    rows = system.branch_rows
    return s**2 * system.mass + s * system.damping + system.stiffness + rows.T @ (branch[:, None] * rows)


def test_modal_a_is_the_slope_of_the_dynamic_stiffness(car):
    system = car.matrices.system
    for mode in car.modes("sliding")[:12:3]:
        size = 2.0 * np.pi * mode.frequency
        pole = complex(mode.growth, np.sqrt(size**2 - mode.growth**2))
        step = 1e-5 * size
        up, down = (mode.shape @ stiffness(system, pole + side * step) @ mode.shape for side in (1.0, -1.0))
        validated(
            "Linear system", f"modal A of the mode at {mode.frequency:.2f} Hz", modal_a(system, pole, mode.shape),
            (up - down) / (2.0 * step), rel=1e-6, source="second derivation: slope of the dynamic stiffness",
        )  # fmt: skip
        assert mode.modal_a == pytest.approx(modal_a(system, pole, mode.shape), rel=1e-9)
        # A mode is a motion that the dynamic stiffness balances: it is the pole of D that was taken.
        balance = abs(mode.shape @ stiffness(system, pole) @ mode.shape)
        assert balance < 1e-6 * abs(mode.shape @ (pole**2 * system.mass) @ mode.shape)
