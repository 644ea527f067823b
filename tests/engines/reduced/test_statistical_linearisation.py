"""Damping constants for a Gaussian velocity: closed forms of friction laws, quadrature of a table, the fixed point."""

from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.reduced.statistical_linearisation import line_segments
from vehicle.model.parameters.force_elements import Damper

SUBJECT = "Dampers and friction"


def damper(**numbers: Any) -> Damper:
    """Return a linear damper of 1500 N s/m with other numbers."""
    usual: dict[str, Any] = {
        "viscous": 1500.0,
        "viscous_law": "linear",
        "friction_law": "coulomb",
        "coulomb_friction": 0.0,
    }
    return Damper(**{**usual, "smoothing": 1e5, "slip_velocity": 0.006, **numbers})


@pytest.mark.parametrize("speed", [0.01, 0.3])
def test_coulomb_friction_has_the_constant_of_its_mean_force(speed: float):
    """E[F |v|]/s^2 = sqrt(2/pi) F/s; the line at rest, complete at 16 um/s, takes 1e-6 of it at 0.01 m/s."""
    found = line_segments(damper(coulomb_friction=80.0)).damping(speed)
    validated(
        SUBJECT, f"damping constant of Coulomb friction for a Gaussian velocity of {speed:g} m/s", found,
        1500.0 + np.sqrt(2.0 / np.pi) * 80.0 / speed, rel=2e-6, unit="N s/m",
        source="closed form: Caughey 1963, sqrt(2/pi) F/s",
    )  # fmt: skip


def test_stribeck_friction_has_the_constant_of_the_gaussian_integral():
    """E[|v| exp(-(v/vs)^2)] = sqrt(2/pi) s/(1 + 2 s^2/vs^2)."""
    law = damper(
        friction_law="stribeck", coulomb_friction=50.0, stribeck_friction=90.0, stribeck_velocity=0.02,
        stribeck_exponent=2.0,
    )  # fmt: skip
    speed = 0.03
    limit = 50.0 + 40.0 / (1.0 + 2.0 * (speed / 0.02) ** 2)
    validated(
        SUBJECT, "damping constant of Stribeck friction for a Gaussian velocity", line_segments(law).damping(speed),
        1500.0 + np.sqrt(2.0 / np.pi) * limit / speed, rel=1e-4, unit="N s/m",
        source="closed form: Gaussian integral of |v| exp(-(v/vs)^2)",
    )  # fmt: skip


def test_a_table_stiffer_in_rebound_has_the_least_squares_constant():
    """E[(F - E F) v]/s^2 by quadrature, from which Stein's lemma makes the mean slope."""
    law = damper(
        viscous=None, viscous_law="table", velocity=(-0.5, -0.1, 0.0, 0.05, 0.4),
        force=(-500.0, -300.0, 0.0, 400.0, 900.0),
    )  # fmt: skip
    speed = 0.12
    v = np.linspace(-2.0, 2.0, 400001)
    weight = np.exp(-0.5 * (v / speed) ** 2) * (v[1] - v[0]) / (speed * np.sqrt(2.0 * np.pi))
    points = np.array(law.velocity), np.array(law.force)
    slopes = np.diff(points[1]) / np.diff(points[0])
    force = np.interp(v, *points)
    force += slopes[-1] * np.maximum(v - 0.4, 0.0) + slopes[0] * np.minimum(v + 0.5, 0.0)
    expected = float(np.sum((force - np.sum(force * weight)) * v * weight)) / speed**2
    assert line_segments(law).damping(speed) == pytest.approx(expected, rel=1e-6)


def test_a_viscous_damper_has_its_own_constant():
    """At any velocity."""
    assert line_segments(damper()).damping(1e-3) == pytest.approx(1500.0, rel=1e-9)
