"""Loads: against the full matrices of the frame, against combined rigid bodies, and in limiting cases."""

import dataclasses

import numpy as np
import pytest
import scipy

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.body_design import read_design
from vehicle.model.flexbody.body_frame import body_frame
from vehicle.model.flexbody.body_loads import BodyLoad, load_mass, with_loads
from vehicle.model.flexbody.body_model import BODY_DESIGN
from vehicle.model.flexbody.frame_modes import condense_rotations
from vehicle.model.flexbody.node_masses import NodeProperties
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of
from vehicle.runs.car import Car

TRUNK = (3.6, 0.1, 0.7)
AT_NODE = BodyLoad(80.0, (3.9, -0.5, 1.85), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))  # roof_left_rear
APART = BodyLoad(80.0, TRUNK, (3.0, 4.0, 5.0), (0.5, -0.3, 0.2))


@pytest.fixture(scope="module")
def frame():
    design, vehicle = read_design(BODY_DESIGN), load_vehicle()
    return body_frame(design, vehicle.points, NodeProperties.of_body(vehicle.body, design.least_ixx))


def full_frequencies(frame, added, count):
    """Solve (K - w2 M) phi = 0 of the complete frame by another solver, including rigid motions [Hz]."""
    stiffness, _ = condense_rotations(frame._stiffness(frame.design.factors))
    values = scipy.linalg.eigh(stiffness, np.diag(np.repeat(frame.node_mass, 3)) + added, eigvals_only=True)
    return np.sqrt(values[6 : 6 + count]) / (2.0 * np.pi)


@pytest.mark.parametrize("load", [AT_NODE, APART])
def test_a_load_on_a_frame_has_the_modes_of_the_full_matrices(frame, load):
    added = np.zeros((3 * len(frame.node_mass),) * 2)
    if load is AT_NODE:
        node = frame.skeleton.node_index("roof_left_rear")
        node_dofs = slice(3 * node, 3 * node + 3)
        added[node_dofs, node_dofs] = 80.0 * np.eye(3)
        overrides = ["load.bag.mass=80", "load.bag.at=roof_left_rear"]
    else:
        added = load_mass(frame.skeleton.positions, [load], 1e-3)
        overrides = ["load.bag.mass=80", f"load.bag.at={list(TRUNK)}", "load.bag.inertia=[3, 4, 5]"]
        overrides += ["load.bag.products=[0.5, -0.3, 0.2]"]
    body = Car.load("focus", overrides).trimmed_body
    np.testing.assert_allclose(body.frequencies, full_frequencies(frame, added, 9), rtol=1e-9)
    assert body.mass == pytest.approx(893.0, rel=1e-12)


@pytest.mark.parametrize("load", [AT_NODE, APART])
def test_a_load_on_modes_is_exact_where_they_are_all_modes(frame, load):
    count = 3 * len(frame.node_mass) - 6
    frequencies, shapes = frame.modes(frame.design.factors, count)
    every = {"frequencies": frequencies, "shapes": shapes, "damping_ratio": np.full(count, 0.03)}
    names = tuple(f"mode {number}" for number in range(1, count + 1))
    body = dataclasses.replace(frame.superelement(), **every, mode_names=names, derived=True)
    loaded = with_loads(body, [load])
    added = load_mass(frame.skeleton.positions, [load], 1e-3)
    np.testing.assert_allclose(loaded.frequencies[:30], full_frequencies(frame, added, 30), rtol=1e-9)
    # With the nine modes of an import, Rayleigh's quotient is from above.
    nine = with_loads(frame.superelement(), [load]).frequencies
    assert np.all(nine > loaded.frequencies[:9] * (1.0 - 1e-12)) and nine[0] < 1.05 * loaded.frequencies[0]


def test_a_rigid_body_with_a_load_is_the_body_of_both():
    """Reference: mass, CoG and tensor of body plus load by the parallel-axis theorem, in a file without loads."""
    loaded = Car.load("sedan", ["load.trunk.mass=80", f"load.trunk.at={list(TRUNK)}", "load.trunk.inertia=[3, 4, 5]"])
    body, table = loaded.vehicle.body, dict(Car.load("sedan").vehicle.table)
    mass = body.mass + 80.0
    cog = (body.mass * np.array(body.cog) + 80.0 * np.array(TRUNK)) / mass
    tensor = np.diag([3.0, 4.0, 5.0]) + np.diag([body.inertia.ixx, body.inertia.iyy, body.inertia.izz])
    tensor[0, 2] = tensor[2, 0] = -body.inertia.izx
    for each, position in ((body.mass, body.cog), (80.0, TRUNK)):
        r = np.array(position) - cog
        tensor += each * (r @ r * np.eye(3) - np.outer(r, r))
    components = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "izx": (2, 0), "iyz": (1, 2)}
    moments = {name: float(tensor[i, j]) * (1.0 if i == j else -1.0) for name, (i, j) in components.items()}
    body_table = {**table["body"], "mass": mass, "cog": cog.tolist(), "inertia": moments}
    built = Car(vehicle_of({**table, "body": body_table}))
    for actual, expected in zip(loaded.modes("sliding"), built.modes("sliding"), strict=True):
        assert actual.frequency == pytest.approx(expected.frequency, rel=1e-9)
        assert actual.damping_ratio == pytest.approx(expected.damping_ratio, rel=1e-8)
    assert loaded.static.tyre_load == pytest.approx(built.static.tyre_load, rel=1e-9)


def test_a_load_of_nothing_is_none_and_grows_by_the_short_way():
    override = f"load.trunk.at={list(TRUNK)}"
    bare, empty = Car.load("sedan"), Car.load("sedan", ["load.trunk.mass=0", override])
    assert [mode.frequency for mode in empty.modes()] == [mode.frequency for mode in bare.modes()]
    full, built = empty.with_(["load.trunk.mass=80"]), Car.load("sedan", ["load.trunk.mass=80", override])
    assert full.vehicle == built.vehicle and full._from_terms is not None
    for actual, expected in zip(full.modes(), built.modes(), strict=True):
        assert actual.frequency == pytest.approx(expected.frequency, rel=1e-9)
    # On a wheel carrier too, and on a flexible body the car is built.
    hub = ["load.hub.mass=1", "load.hub.at=wheel_center_fr", "load.hub.on=knuckle_fr"]
    assert Car.load("focus", hub).with_(["load.hub.mass=2"])._from_terms is not None
    assert Car.load("focus", ["load.trunk.mass=0", override]).with_(["load.trunk.mass=80"])._from_terms is None


@pytest.mark.parametrize(("overrides", "message"), [
    (["load.a.mass=80"], r"load\.a\.at: missing"),
    (["load.a.mass=-1", "load.a.at=seat"], r"load\.a\.mass: found -1\.0 kg, must be at least 0"),
    (["load.a.mass=1", "load.a.at=seet"], r"load\.a\.at: unknown point 'seet'; did you mean seat"),
    (["load.a.mass=1", "load.a.at=seat", "load.a.on=nose"], r"load\.a\.on: unknown part 'nose'; did you mean"),
    (["load.a.mass=1", "load.a.at=seat", "load.a.on=main_spring_upper_fr"], r"did you mean main_sp"),
    (["load.a.mass=1", "load.a.at=seat", "load.a.inertia=[1, 1, 9]"], r"load\.a\.inertia: .* the two smaller"),
    (["load.a.mass=1", "load.a.at=seat", "load.a.weight=2"], r"unknown parameter load\.a\.weight"),
])  # fmt: skip
def test_loads_that_are_none_are_refused(overrides, message):
    with pytest.raises(ConfigurationError, match=message):
        load_vehicle(None, overrides)
