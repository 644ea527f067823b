"""The implicit damper forces of a step."""

import numpy as np
import pytest
from scipy.optimize import brentq

from vehicle.laws.stribeck import Stribeck
from vehicle.reduced.march import damper_force, friction_limit, solve_damper

LAWS = [
    (8e6, 125.0, 0.0, 0.0),
    (8e6, 125.0, 12750.0, 255.0),
    (500.0, 100.0, 12750.0, 2.0),  # the degressive corner comes first
    (0.0, 0.0, 12750.0, 255.0),
    (0.0, 0.0, 0.0, 0.0),
]


@pytest.mark.parametrize(("c", "limit", "d", "limit2"), LAWS)
@pytest.mark.parametrize("g", [1e-7, 7.7e-5, 1e-2])
def test_velocity_answers_its_own_force(c, limit, d, limit2, g):
    inverses = (1.0 / (1.0 + g * (c + d)), 1.0 / (1.0 + g * c), 1.0 / (1.0 + g * d))
    for w in [*np.geomspace(1e-9, 3.0, 60), -0.02, -1.5]:
        found = solve_damper(w, g, c, limit, d, limit2, *inverses)
        size = abs(w)
        expected = brentq(
            lambda v, size=size: v - g * damper_force(v, c, limit, d, limit2) - size, 0.0, size, xtol=1e-18
        )
        assert found == pytest.approx(np.sign(w) * expected, rel=1e-9, abs=1e-17)


def test_limit_is_the_stribeck_law():
    law = Stribeck(
        friction_limit=65.0, static_limit=125.0, stribeck_velocity=0.03, stribeck_exponent=3.5, smoothing=1e9
    )
    for velocity in (1e-6, 0.01, 0.03, 0.08, 1.0):
        expected = float(law.force(np.array(velocity)))
        # The steep arctangent is at its limit but for (2/pi) / (steepness velocity) < 1e-3.
        assert friction_limit(-velocity, 65.0, 125.0, 0.03, 3.5) == pytest.approx(expected, rel=1e-3)
    assert friction_limit(0.5, 125.0, 125.0, 0.03, 3.5) == 125.0
