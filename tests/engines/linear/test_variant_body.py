"""A body of another mass or centre of gravity by the short way, against cars that are built, and closed forms."""

import numpy as np
import pytest

from tests.engines.linear.test_variant_matrices import require_same
from vehicle.runs.car import Car


@pytest.mark.parametrize(
    "changes",
    [["body.mass=1300"], ["body.cog=[2.3, 0.05, 0.95]"], ["body.cog.z=1.0", "body.mass=1300", "body.inertia.iyy=2100"]],
)
def test_a_rigid_body_varied_is_the_body_built(sedan, changes):
    """M, C, K, rows, static loads within 1e-9; no MuJoCo model is made."""
    require_same(sedan, "sedan", (), changes)


def test_a_flexible_body_varied_is_the_body_built():
    """Compare matrices within 1e-9 of their largest entry; frequencies within 1e-7: see
    `vehicle.engines.linear.body_change`.
    """
    car, changes = Car.load("focus"), ["body.mass=829.26"]
    require_same(car, "focus", (), changes)
    pairs = zip(car.with_(changes).modes(), Car.load("focus", changes).modes(), strict=True)
    assert max(abs(mode.frequency / other.frequency - 1.0) for mode, other in pairs) < 1e-7
    # Its modal coordinates are mass-normalised again.
    matrices = car.with_(changes).matrices
    np.testing.assert_allclose(matrices.system.mass[matrices.modal, matrices.modal], np.eye(9), atol=1e-12)


def test_another_elastic_body_is_built(car):
    for changes in (["body.cog.z=1.0"], ["body.inertia.iyy=5300"], ["body.mass=829.26", "body.inertia.izz=4700"]):
        assert car.with_(changes)._from_terms is None, changes
