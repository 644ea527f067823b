"""Inertia tensors: the tensor of the thesis is not physical; the nearest and the improved tensor are physical."""

import mujoco
import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.inertia_tensor import (
    about_cog,
    inertia_tensor,
    nearest_physical,
    second_moments,
    triangle_shortfall,
)

MASS, COG = 813.0, np.array([2.157, 0.0, 1.011])


def body_tensor(ixx):
    origin = inertia_tensor(ixx=ixx, iyy=5268.0, izz=4600.0, ixy=82.03, izx=1800.0, iyz=-50.04)
    return about_cog(origin, MASS, COG)


@pytest.mark.parametrize(
    ("ixx", "moments", "shortfall"), [(1000.0, [155, 651, 835], 30.0), (1200.0, [347, 657, 837], 0.0)]
)
def test_published_and_improved_principal_moments(ixx, moments, shortfall):
    tensor = body_tensor(ixx)
    # published rounded to whole numbers
    validated(
        "Published cars", f"principal moments of the body, Ixx {ixx:g} kg m2", np.linalg.eigvalsh(tensor),
        np.array(moments), abs=0.5, unit="kg m2", source="publication: Bommer 2006, mass properties of the body",
    )  # fmt: skip
    assert triangle_shortfall(tensor) == pytest.approx(shortfall, abs=1.0)  # sums of three rounded numbers


def test_tensor_and_parallel_axis_agree_with_sums_over_points():
    rng = np.random.default_rng(5)
    m, r = rng.uniform(1.0, 4.0, 20), rng.normal(loc=[2.0, 0.3, 1.0], size=(20, 3))
    x, y, z = r.T
    origin = inertia_tensor(
        ixx=m @ (y**2 + z**2), iyy=m @ (x**2 + z**2), izz=m @ (x**2 + y**2), ixy=m @ (x * y), izx=m @ (z * x),
        iyz=m @ (y * z),
    )  # fmt: skip
    cog = m @ r / m.sum()
    arm = r - cog
    direct = sum(mi * (a @ a * np.eye(3) - np.outer(a, a)) for mi, a in zip(m, arm, strict=True))
    # round-off
    validated(
        "Body models", "inertia about the centre of gravity", about_cog(origin, m.sum(), cog), direct, rel=1e-10,
        abs=1e-10, unit="kg m2", source="closed form: sum over points",
    )  # fmt: skip
    np.testing.assert_allclose(second_moments(direct), (arm.T * m) @ arm, atol=1e-10)  # round-off


def compiles(tensor):
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(mass=MASS, ipos=[0, 0, 0], explicitinertial=True)
    body.fullinertia = [*np.diag(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2]]
    body.add_freejoint()
    try:
        spec.compile()
    except ValueError:
        return False
    return True


def test_nearest_physical_tensor_is_accepted_by_mujoco_and_no_other_is_nearer():
    published = body_tensor(1000.0)
    repair = nearest_physical(published)
    assert repair.repaired
    assert not compiles(published)
    assert compiles(repair.inertia)
    assert triangle_shortfall(repair.inertia) == 0.0
    # only the negative second moment moves, from -15 to zero, so the change of S has that norm
    assert np.linalg.norm(second_moments(repair.change)) == pytest.approx(repair.shortfall / 2.0, rel=1e-3)  # floor
    assert repair.shortfall == pytest.approx(30.0, abs=0.5)  # published, rounded
    rng = np.random.default_rng(2)
    best = np.linalg.norm(second_moments(repair.change))
    for _ in range(200):
        factor = np.linalg.cholesky(second_moments(repair.inertia)) + rng.normal(scale=0.3, size=(3, 3))
        assert np.linalg.norm(factor @ factor.T - second_moments(published)) > best
    assert "breaks the triangle inequality of principal moments by 29.6 kg m2" in repair.describe()


def test_physical_tensor_is_left_alone():
    tensor = body_tensor(1200.0)
    repair = nearest_physical(tensor)
    assert not repair.repaired
    np.testing.assert_array_equal(repair.inertia, tensor)
    assert repair.describe() == "The inertia tensor is physical and used as given."


def test_senseless_tensors_are_refused():
    with pytest.raises(ConfigurationError, match="finite symmetric 3 x 3"):
        nearest_physical([[1.0, 2.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    with pytest.raises(ConfigurationError, match=r"its principal second moments is positive\)\. Check"):
        nearest_physical(-np.eye(3))
