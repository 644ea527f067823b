"""The implicit damper forces of a step."""

import numpy as np
import pytest
from scipy.optimize import brentq

from vehicle.laws.damper import RECORD
from vehicle.reduced.march import damper_force, solve_damper, solve_dampers

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


@pytest.mark.parametrize("count", [1, 2, 4])
def test_dampers_with_laws_of_their_own_answer_each_other(count):
    # Static limit, sliding limit, smoothing, slope and limit of the degressive law of each damper, by hand.
    numbers = [(65.0, 125.0, 1.0), (90.0, 90.0, 0.0), (0.0, 0.0, 0.0), (30.0, 40.0, 1.0)][:count]
    laws = np.zeros(count, dtype=RECORD)
    laws["friction_limit"], laws["static_limit"], laws["friction_law"] = np.transpose(numbers)
    laws["smoothing"], laws["stribeck_velocity"], laws["stribeck_exponent"] = 1e3, 0.03, 2.0
    laws["degressive_slope"], laws["degressive_limit"] = 12750.0, 255.0
    generator = np.random.default_rng(7)
    own = 7.7e-5 * (1.0 + 0.2 * np.arange(count))
    gain = np.diag(own) + 3e-6 * (np.ones((count, count)) - np.eye(count))
    for size in (1e-6, 1e-3, 0.05, 1.0):
        arriving, start = size * generator.standard_normal((2, count))
        velocity, force = start.copy(), np.zeros(count)
        solve_dampers(count, arriving, gain, laws, velocity, force, np.full((6, count), np.nan))
        # v = a + G f, and f follows from v by each law, with the limit of the velocity that the step began with.
        np.testing.assert_allclose(velocity, arriving + gain @ force, rtol=1e-9, atol=1e-12)
        for v, before, f, (sliding, static, stribeck) in zip(velocity, start, force, numbers, strict=True):
            limit = sliding + stribeck * (static - sliding) * np.exp(-((before / 0.03) ** 2))
            friction = np.clip(2.0 / np.pi * limit * 1e3 * v, -limit, limit)
            assert f == pytest.approx(-friction - np.clip(12750.0 * v, -255.0, 255.0), rel=1e-12, abs=1e-14)
