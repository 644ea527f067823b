"""Jenkins elements and the presliding curve of a damper against closed forms."""

import dataclasses
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_law
from vehicle.model.laws.jenkins import Jenkins
from vehicle.model.laws.presliding import presliding_elements
from vehicle.model.parameters.force_elements import Damper
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.vehicle import load_vehicle

STIFFNESS, LIMIT = 5e5, 125.0


def damper(**changes) -> Damper:
    numbers = {"friction_law": "presliding", "coulomb_friction": LIMIT, "presliding_stiffness": STIFFNESS, **changes}
    return dataclasses.replace(load_vehicle().damper, **numbers)


def elements(law: Damper) -> Jenkins:
    stiffness, share = presliding_elements(law).T
    return Jenkins(stiffness=stiffness, limit=share * law.coulomb_friction)


def polygon(x):
    """The default curve of first loading, from its definition: slopes 1, 3/4, 1/2, 1/4 up to each quarter of Fd."""
    force = LIMIT * np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    corners = np.cumsum([0.0, 0.25, 0.25 / 0.75, 0.25 / 0.5, 0.25 / 0.25]) * LIMIT / STIFFNESS
    return np.sign(x) * np.interp(np.abs(x), corners, force)


def masing(turns, x, branch):
    """Masing's rule: after a reversal at (x0, F0) the force changes by twice the curve of half the way."""
    if branch == 0:
        return polygon(x)
    start = turns[branch - 1]
    return masing(turns, start, branch - 1) + 2.0 * polygon((x - start) / 2.0)


def test_a_loop_follows_masings_rule():
    law, size = elements(damper()), 1.7 * LIMIT / STIFFNESS
    # A loop between both turns after first loading, and one that closes inside it.
    turns = [size, -size, 0.4 * size, -size]
    starts = [0.0, *turns]
    path = [np.linspace(a, b, 301)[1:] for a, b in zip(starts, turns, strict=False)]
    expected = np.concatenate([masing(turns, x, branch) for branch, x in enumerate(path)])
    validated(
        "Dampers and friction", "presliding friction of a damper along loops of the stroke",
        law.path(np.concatenate(path)), expected, abs=1e-9, unit="N",
        source="closed form: Masing's rule on the curve of first loading",
    )  # fmt: skip
    assert 0.5 * LIMIT < np.max(expected) < LIMIT


def test_the_curve_is_scaled_by_limit_and_stiffness():
    default, single = presliding_elements(damper()), damper(presliding_force=(1.0,), presliding_slope=(1.0,))
    assert default.sum(axis=0) == pytest.approx([STIFFNESS, 1.0], rel=1e-14)
    assert presliding_elements(single).tolist() == [[STIFFNESS, 1.0]]
    assert presliding_elements(load_vehicle().damper).shape == (0, 2)
    law = Jenkins.through([1e-4, 3e-4], [40.0, 60.0])
    assert law.backbone(np.array([-1e-4, 1e-4, 2e-4, 3e-4, 1.0])) == pytest.approx(
        [-40.0, 40.0, 50.0, 60.0, 60.0], rel=1e-14
    )
    # Lumped models have the smooth form with the same limit.
    assert damper_law(damper(gas_force=0.0, viscous=0.0)).force(1e3) == pytest.approx(LIMIT, rel=1e-6)


BAD: dict[str, tuple[dict[str, Any], str]] = {
    "no stiffness": ({"presliding_stiffness": None}, "Damper.presliding_stiffness: missing"),
    "one slope too many": (
        {"presliding_force": (0.5, 1.0), "presliding_slope": (1.0, 0.5, 0.2)},
        "Damper.presliding_slope: found 3 values, but presliding_force has 2",
    ),
    "an end below the limit": (
        {"presliding_force": (0.5, 0.9), "presliding_slope": (1.0, 0.5)},
        "Damper.presliding_force: found [0.5, 0.9], must rise to 1",
    ),
    "a slope that rises": (
        {"presliding_force": (0.5, 1.0), "presliding_slope": (1.0, 1.0)},
        "Damper.presliding_slope: found [1.0, 1.0], must fall from 1",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_curves(case):
    changes, message = BAD[case]
    with pytest.raises(ConfigurationError) as caught:
        damper(**changes)
    assert str(caught.value).startswith(message)


def test_overrides_without_effect():
    changes = ["damper.presliding_stiffness=5e5"]
    assert idle_parameters(load_vehicle(None, changes), changes) == (
        "damper.presliding_stiffness=5e5: has no effect; it acts only with front.damper.friction_law = presliding",
    )
    changes += ["damper.friction_law=presliding", "damper.smoothing=1e4"]
    assert idle_parameters(load_vehicle(None, changes), changes) == (
        "damper.smoothing=1e4: has no effect; it acts only with front.damper.friction_law = coulomb or stribeck",
    )
