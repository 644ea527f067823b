"""The implicit damper forces of a step."""

import numpy as np
import pytest
from scipy.optimize import brentq

from vehicle.engines.reduced.pole_stepping import damper_force, solve_damper, solve_dampers
from vehicle.model.laws.damper import RECORD

SMOOTHING = 1e3
CURVES = {
    "linear": ([], [0.0], [0.0]),
    "degressive": ([-0.02, 0.02], [0.0, 12750.0, 0.0], [-255.0, 0.0, 255.0]),
    # Bump and rebound, through (0, 0), with a corner within the stick of the friction.
    "table": ([-0.4, 0.0, 1e-4, 0.1], [0.0, 300.0, 5e4, 1500.0, 800.0], [-120.0, 0.0, 0.0, 4.85, 74.85]),
}


def pieces_of(name, gain, width=5):
    """Return the segments of a curve for the time stepping."""
    knots, slopes, offsets = CURVES[name]
    segments = np.zeros((4, width))
    segments[0], segments[3] = np.inf, 1.0
    segments[0, : len(knots)], segments[1, : len(slopes)], segments[2, : len(slopes)] = knots, slopes, offsets
    segments[3] = 1.0 / (1.0 + gain * segments[1])
    return segments


def curve_force(name, velocity):
    """Return the force of a curve from its breakpoints."""
    knots, slopes, offsets = map(np.array, CURVES[name])
    piece = int(np.sum(velocity > knots))
    return slopes[piece] * velocity + offsets[piece]


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("limit", [0.0, 100.0])
@pytest.mark.parametrize("g", [1e-7, 7.7e-5, 1e-2])
def test_velocity_and_force_of_a_damper_are_consistent(name, limit, g):
    def law(v):
        return np.clip(2.0 / np.pi * limit * SMOOTHING * v, -limit, limit) + curve_force(name, v)

    for start in (0, len(CURVES[name][1]) - 1):
        for a in [*np.geomspace(1e-9, 3.0, 40), *-np.geomspace(1e-9, 3.0, 40)]:
            curve = pieces_of(name, g)
            velocity, piece = solve_damper(a, g, limit, 0.5 * np.pi / SMOOTHING, curve, start)
            expected = brentq(lambda v, a=a: v + g * law(v) - a, -4.0, 4.0, xtol=1e-18, rtol=1e-14)
            assert velocity == pytest.approx(expected, rel=1e-9, abs=1e-16)
            assert damper_force(velocity, limit, SMOOTHING, curve, piece) == pytest.approx(-law(expected), rel=1e-8)


@pytest.mark.parametrize("count", [1, 2, 4])
def test_coupled_dampers_with_different_laws(count):
    # Static limit, sliding limit, smoothing, slope and limit of the degressive law of each damper, by hand.
    numbers = [(65.0, 125.0, 1.0), (90.0, 90.0, 0.0), (0.0, 0.0, 0.0), (30.0, 40.0, 1.0)][:count]
    laws = np.zeros(count, dtype=RECORD)
    laws["friction_limit"], laws["static_limit"], laws["friction_law"] = np.transpose(numbers)
    laws["smoothing"], laws["stribeck_velocity"], laws["stribeck_exponent"] = 1e3, 0.03, 2.0
    generator = np.random.default_rng(7)
    own_gain = 7.7e-5 * (1.0 + 0.2 * np.arange(count))
    gain = np.diag(own_gain) + 3e-6 * (np.ones((count, count)) - np.eye(count))
    curves = np.array([pieces_of("degressive", value) for value in own_gain])
    for size in (1e-6, 1e-3, 0.05, 1.0):
        arriving, start = size * generator.standard_normal((2, count))
        velocity, force = start.copy(), np.zeros(count)
        room, pieces = np.full((3, count), 0.5e-3 * np.pi), np.zeros(count, dtype=int)
        solve_dampers(count, arriving, gain, laws, curves, velocity, force, room, pieces)
        # v = a + G f, and f follows from v by each law, with the limit of the velocity that the step began with.
        np.testing.assert_allclose(velocity, arriving + gain @ force, rtol=1e-9, atol=1e-12)
        for v, before, f, (sliding, static, stribeck) in zip(velocity, start, force, numbers, strict=True):
            limit = sliding + stribeck * (static - sliding) * np.exp(-((before / 0.03) ** 2))
            friction = np.clip(2.0 / np.pi * limit * 1e3 * v, -limit, limit)
            assert f == pytest.approx(-friction - np.clip(12750.0 * v, -255.0, 255.0), rel=1e-12, abs=1e-14)
