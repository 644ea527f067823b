"""Rubber friction: Jenkins elements against Berg's curve, Masing's rule and a spring in series."""

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError
from vehicle.model.laws.amplitude import ELEMENTS, behind_spring, friction_elements
from vehicle.model.parameters.force_elements import Bushing, Hydromount
from vehicle.model.parameters.force_table import ForceTable
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.vehicle import load_vehicle

FORCE, STROKE = 240.0, 3e-4
AMPLITUDES = STROKE * np.geomspace(0.02, 20.0, 40)


def curve(x):
    """First loading of Berg's model."""
    return FORCE * x / (STROKE + x)


def steady(law, amplitude, count=40000):
    """Displacement and force of a cycle after first loading and one further cycle."""
    cycle = amplitude * np.cos(np.linspace(0.0, 2.0 * np.pi, count + 1))
    path = np.concatenate([np.linspace(0.0, amplitude, 500), cycle[1:], cycle[1:]])
    return path[-count - 1 :], law.path(path)[-count - 1 :]


def test_tangent_at_rest_and_largest_force():
    law = friction_elements(FORCE, STROKE)
    validated(
        "Bushings, springs and stops", "tangent at rest of rubber friction", law.stiffness.sum(), FORCE / STROKE,
        rel=1e-12, unit="N/m", source="closed form: derivative of Fmax x / (x2 + x) at 0",
    )  # fmt: skip
    assert law.limit.sum() == pytest.approx(FORCE, rel=1e-12)
    assert len(law.limit) == ELEMENTS and np.all(law.stiffness > 0.0) and np.all(law.limit > 0.0)


def test_force_amplitude_over_displacement_amplitude():
    law = friction_elements(FORCE, STROKE)
    reached = [np.max(steady(law, amplitude, 400)[1]) for amplitude in AMPLITUDES]
    validated(
        "Bushings, springs and stops", "force amplitude of rubber friction at 0.02 to 20 times its stroke",
        np.array(reached), curve(AMPLITUDES), rel=(np.pi / 2.0 / ELEMENTS) ** 2, unit="N",
        source="closed form: Fmax x / (x2 + x) (Berg 1998)",
    )  # fmt: skip


def test_loss_angle_over_displacement_amplitude():
    law = friction_elements(FORCE, STROKE)
    loss = []
    for amplitude in AMPLITUDES:
        x, force = steady(law, amplitude, 4000)
        loss.append(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(x)) / (np.pi * amplitude * np.max(force)))
    area = AMPLITUDES - STROKE * np.log1p(AMPLITUDES / STROKE) - AMPLITUDES**2 / (2.0 * (STROKE + AMPLITUDES))
    validated(
        "Bushings, springs and stops", "work of rubber friction in a cycle over pi A F(A), its loss angle",
        np.array(loss), 8.0 * FORCE * area / (np.pi * AMPLITUDES * curve(AMPLITUDES)), abs=0.05,
        source="closed form: Masing's rule on Fmax x / (x2 + x)",
    )  # fmt: skip


def test_in_series_with_a_spring():
    stiffness, local = 7e5, 3e6
    law = friction_elements(FORCE, STROKE)
    moved = behind_spring(law, stiffness, local)
    turns = STROKE * np.array([0.0, 1.9, -1.4, 0.6, -1.4, 3.0])
    path = np.concatenate([np.linspace(a, b, 60)[1:] for a, b in itertools.pairwise(turns)])
    # Element after element, with the displacement of the rubber as the unknown of each point.
    forces, at, total = np.zeros(ELEMENTS), 0.0, []

    def pulled(x):
        return np.clip(forces + law.stiffness * (x - at), -law.limit, law.limit)

    for whole in path:
        x = brentq(
            lambda x, whole=whole: stiffness * x + pulled(x).sum() - local * (whole - x), -0.01, 0.01, xtol=1e-17
        )
        forces, at = pulled(x), x
        total.append(stiffness * x + forces.sum())
    elastic = stiffness * local / (stiffness + local)
    validated(
        "Bushings, springs and stops", "rubber with friction in series with the spring of its attachment, along loops",
        elastic * path + moved.path(path), np.array(total), abs=1e-9, unit="N",
        source=foreign("scipy", "brentq at each point"),
    )  # fmt: skip
    assert moved.stiffness.sum() + elastic == pytest.approx(
        1.0 / (1.0 / local + 1.0 / (stiffness + FORCE / STROKE)), rel=1e-12
    )


NUMBERS: dict[str, Any] = {"stiffness": (1e5, 1e5, 1e5), "damping": (0.0, 0.0, 0.0), "rotational_stiffness": 0.0}
RUBBER: dict[str, Any] = {"friction_force": (0.0, 0.0, 100.0), "friction_stroke": (0.0, 0.0, 1e-3)}
BAD: dict[str, tuple[type, dict[str, Any], str]] = {
    "no stroke": (
        Bushing,
        {"friction_force": (0.0, 0.0, 100.0)},
        "Bushing.friction_stroke.z: found 0.0 m, must be at least 1e-06 m",
    ),
    "no stroke of a hydromount": (
        Hydromount,
        {"friction_force": (50.0, 0.0, 0.0), "maxwell_stiffness": 1e5, "maxwell_damping": 1e3},
        "Hydromount.friction_stroke.x: found 0.0 m, must be at least 1e-06 m",
    ),
    "a negative force": (
        Bushing,
        {"friction_force": (0.0, -1.0, 0.0)},
        "Bushing.friction_force: found -1.0 N, must be at least 0.0",
    ),
    "a table on the same axis": (
        Bushing,
        {**RUBBER, "table_z": ForceTable(displacement=(-1.0, 1.0), force=(-1e5, 1e5))},
        "Bushing.friction_force.z: found 100.0 N together with table_z",
    ),
    "a one-sided contact": (Bushing, {**RUBBER, "one_sided": True}, "Bushing.friction_force.z: found 100.0 N"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_numbers(case):
    element, changes, message = BAD[case]
    with pytest.raises(ConfigurationError) as caught:
        element(**NUMBERS, **changes)
    assert str(caught.value).startswith(message)


def test_a_table_on_another_axis():
    table = ForceTable(displacement=(-1.0, 1.0), force=(-1e5, 1e5))
    assert Bushing(**NUMBERS, **RUBBER, table_x=table).friction_force[2] == 100.0


def test_overrides_without_effect():
    changes = ["rear.bushings.damper_mount.friction_stroke=[0,0,2e-4]"]
    path = changes[0].partition(".friction_stroke")[0]
    assert idle_parameters(load_vehicle(Path("focus_road"), changes), changes) == (
        f"{changes[0]}: has no effect; it acts only with {path}.friction_force above zero",
    )
    changes += [f"{path}.friction_force=[0,0,40]"]
    assert idle_parameters(load_vehicle(Path("focus_road"), changes), changes) == ()
