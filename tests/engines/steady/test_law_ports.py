"""Ports: every force and motion of a resolvent belong to the law of the car, and to p + lambda w = u."""

import dataclasses
from typing import Any

import numpy as np
import pytest

from tests.engines.reduced.test_displacement_laws import stop, tyre
from vehicle.engines.steady.car_ports import MOVED, _elastic, damper_port
from vehicle.engines.steady.law_ports import Play
from vehicle.model.laws.damper import damper_curve
from vehicle.model.laws.friction import Clamped
from vehicle.model.laws.jenkins import Jenkins
from vehicle.model.laws.stribeck import Stribeck
from vehicle.model.parameters.vehicle import load_vehicle

SUMS = np.random.default_rng(1).uniform(-900.0, 900.0, (3, 128)) * np.array([[0.02], [0.3], [1.0]])
SCALING = np.array([[800.0], [2500.0], [9000.0]])

DAMPERS: dict[str, dict[str, Any]] = {
    "Coulomb": {"coulomb_friction": 60.0},
    "no friction": {"coulomb_friction": 0.0, "viscous_law": "degressive"},
    "degressive": {"coulomb_friction": 60.0, "viscous_law": "degressive"},
    "table": {"viscous_law": "table", "velocity": (-0.5, 0.0, 0.05, 0.5), "force": (-1400.0, 0.0, 350.0, 1362.5)},
    "Stribeck": {
        "friction_law": "stribeck", "coulomb_friction": 40.0, "stribeck_friction": 75.0, "stribeck_velocity": 0.03,
        "stribeck_exponent": 1.5,
    },
    "steep Stribeck": {
        "friction_law": "stribeck", "coulomb_friction": 40.0, "stribeck_friction": 75.0, "stribeck_velocity": 0.06,
        "stribeck_exponent": 2.0, "viscous_law": "degressive",
    },
}  # fmt: skip


def damper(changes):
    return dataclasses.replace(load_vehicle().damper, **{"degressive_viscous": 4000.0, **changes})


@pytest.mark.parametrize("name", DAMPERS)
def test_a_damper(name):
    law = damper(DAMPERS[name])
    port, curve = damper_port(0, law), damper_curve(law)
    scaling = np.maximum(SCALING, 1.5 * port.fall)
    force = port.force(SUMS, scaling, 1.0)
    v = (SUMS - force) / scaling
    limit = law.coulomb_friction
    friction = np.clip(np.abs(v) * 2.0 * law.smoothing / np.pi, 0.0, 1.0) * np.sign(v) * limit
    if law.friction_law == "stribeck":
        friction = Clamped(
            law=Stribeck(
                friction_limit=limit, smoothing=law.smoothing, static_limit=law.stribeck_friction,
                stribeck_velocity=law.stribeck_velocity, stribeck_exponent=law.stribeck_exponent,
            )
        ).force(v)  # fmt: skip
    expected = curve.force(v) - curve.force(0.0) - curve.least_slope * v + friction
    # On the friction line, 1e6 N s/m, the round-off of v is multiplied.
    np.testing.assert_allclose(force, expected, atol=1e-4)
    assert port.odd == (name != "table")
    assert (port.fall > 0.0) == (law.friction_law == "stribeck")


def test_the_fall_of_stribeck_friction_is_that_of_its_slope():
    """delta = 1 beyond a short friction line: the steepest place is the beginning, -(Fs - Fd)/vs."""
    law = damper({**DAMPERS["Stribeck"], "stribeck_exponent": 1.0, "smoothing": 1e7})
    assert damper_port(0, law).fall == pytest.approx(35.0 / 0.03, rel=1e-4)


@pytest.mark.parametrize("law", [stop(0), tyre(0)])
def test_a_law_over_displacement(law):
    moved = MOVED * -law.slopes[0] if law.one_sided else 0.0
    port = _elastic(4, law, moved)
    scaling = port.scaling(np.array([2e-6, 3e-5, 3e-4]))[:, None]
    sums = SUMS * 40.0
    force = port.force(sums, scaling, 1.0)
    x = (sums - force) / scaling
    assert x.min() < law.low or x.max() > law.high
    np.testing.assert_allclose(force, law.force(x) + moved * x, atol=1e-6)
    # A tyre that has lifted off keeps the share of its stiffness that has not moved.
    assert port.fall == pytest.approx((1.0 - MOVED) * 2.5e5 if law.one_sided else 0.0, abs=1e-6)


@pytest.mark.parametrize("kept", [0.0, 6e4])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_jenkins_elements(sign, kept):
    """The inverse of their play operator, against their own path over further periods."""
    elements = Jenkins.through([1e-4, 3e-4, 1e-3], [60.0, 100.0, 125.0])
    port = Play(
        base=4, of_velocity=False, share=0.5, stiffness=elements.stiffness, stroke=elements.limit / elements.stiffness,
        kept=kept,
    )  # fmt: skip
    phase = np.linspace(0.0, 2.0 * np.pi, 256, endpoint=False)[: 256 if sign > 0.0 else 128]
    harmonics = np.cos(phase) + 0.4 * np.cos(3.0 * phase + 1.0) + (0.3 * np.sin(2.0 * phase) if sign > 0.0 else 0.0)
    sums = np.array([[30.0], [150.0], [600.0]]) * harmonics
    scaling = np.array([[1e5], [3e5], [2e6]])
    force = port.force(sums, scaling, sign)
    x = (sums - force) / scaling
    for row, expected in zip(x, force, strict=True):
        whole = np.concatenate([row, sign * row])
        path = elements.path(np.tile(whole, 3))[-whole.size :][: row.size]
        np.testing.assert_allclose(expected, path - kept * row, atol=1e-6)


def test_the_loop_of_an_element_has_the_energy_of_the_closed_form():
    """4 k x_y (A - x_y) for a displacement of the amplitude A (Masing)."""
    port = Play(base=0, of_velocity=False, share=0.5, stiffness=np.array([2e5]), stroke=np.array([5e-4]))
    scaling, amplitude = 3e5, 2e-3
    x = amplitude * np.cos(np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False))
    path = Jenkins(stiffness=port.stiffness, limit=port.stiffness * port.stroke).path(np.tile(x, 2))[x.size :]
    force = port.force((path + scaling * x)[None], np.array([[scaling]]), 1.0)[0]
    loss = np.sum(0.5 * (force + np.roll(force, -1)) * (np.roll(x, -1) - x))
    # The corners of the loop lie between two samples.
    assert loss == pytest.approx(4.0 * 2e5 * 5e-4 * (amplitude - 5e-4), rel=1e-5)
