"""Eigenvectors of the first-order form: their displacements and velocities belong together."""

import numpy as np
import pytest

from vehicle.engines.linear.first_order import first_order
from vehicle.runs.car import Car


@pytest.mark.parametrize("name", ["focus", "focus_road"])
def test_a_pole_times_the_displacements_of_its_vector_are_its_velocities(name):
    """Also those of the free angles of rolling wheels, whose positions are no states."""
    system = Car.load(name, {"driving.speed": 20.0} if name == "focus_road" else {}).matrices.system
    form = first_order(system)
    poles, vectors = np.linalg.eig(form.state)
    moving = np.abs(poles) > 1e-3  # a wheel that turns at constant speed has no displacement
    displacements = form.shapes(vectors[:, moving], poles[moving])
    velocities = form.basis @ vectors[form.velocities][:, moving]
    assert bool(system.cyclic) == (name == "focus_road")
    scale = np.abs(velocities).max(axis=0)
    np.testing.assert_allclose(poles[moving] * displacements / scale, velocities / scale, atol=1e-8)
    turned = np.abs(velocities[list(system.cyclic)])
    assert not turned.size or turned.max() > 1e-3
