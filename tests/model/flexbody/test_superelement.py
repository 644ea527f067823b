"""Checks of a modal superelement: all invalid data are rejected with a message that contains the remedy."""

import re

import numpy as np
import pytest

from tests.model.flexbody.box_body import MASSES, POSITIONS, box_fields
from tests.validation import validated
from vehicle.errors import DataError
from vehicle.model.flexbody.superelement import Superelement, attached_nodes


def test_mass_properties_are_those_of_the_lumped_masses():
    body = Superelement(**box_fields())
    assert body.mass == pytest.approx(275.0)
    np.testing.assert_allclose(body.cog, MASSES @ POSITIONS / 275.0, rtol=1e-14)  # round-off
    arm = POSITIONS - body.cog
    direct = sum(m * (a @ a * np.eye(3) - np.outer(a, a)) for m, a in zip(MASSES, arm, strict=True))
    # round-off
    validated(
        "Body models", "inertia of a superelement", body.inertia, direct, rel=1e-12, abs=1e-12, unit="kg m2",
        source="closed form: sum of m (a a 1 - a a')",
    )  # fmt: skip
    assert body.node_index("corner_3") == 3
    np.testing.assert_array_equal(body.shape_at("corner_3"), body.shapes[:, 3].T)


def test_arrays_cannot_be_changed_afterwards():
    body = Superelement(**box_fields())
    with pytest.raises(ValueError, match="read-only"):
        body.shapes[0, 0, 0] = 1.0
    with pytest.raises(TypeError):
        body.residual["corner_0"] = np.ones((3, 3))  # type: ignore[index]


def test_unknown_node_lists_the_names():
    with pytest.raises(DataError, match=re.escape("has no node 'corner'. Its nodes are: corner_0, corner_1, corner_2")):
        Superelement(**box_fields()).node_index("corner")


def scaled(name, factor):
    def change(fields):
        fields[name] = fields[name] * factor

    return change


def at(name, where, value):
    def change(fields):
        fields[name][where] = value

    return change


def put(name, value):
    def change(fields):
        fields[name] = value(fields[name]) if callable(value) else value

    return change


def swap_modes(fields):
    for name in ("frequencies", "shapes"):
        fields[name][[1, 2]] = fields[name][[2, 1]]


def rigid_part(fields):
    fields["shapes"][0] += 1e-5 / np.sqrt(275.0) * np.array([0.0, 0.0, 1.0])  # 1e-5 of a rigid heave


def rigid_turn(fields):
    cog = MASSES @ POSITIONS / 275.0
    fields["shapes"][1] += 1e-5 / np.sqrt(300.0) * np.cross([0.0, 0.0, 1.0], POSITIONS - cog)


BAD = {
    "8 frequencies for 9 shapes": (
        put("frequencies", lambda f: f[:-1]),
        "damping_ratio: has the shape (4,) but must have (3,) for",
    ),
    "one shape too few": (
        put("shapes", lambda s: s[:-1]),
        "shapes: has the shape (3, 8, 3) but must have (4, 8, 3) for 8 nodes and 4",
    ),
    "one name too many": (put("mode_names", lambda n: (*n, "x")), "mode_names: found 5 names for 4 frequencies."),
    "ragged positions": (
        put("positions", [[0.0, 1.0], [1.0]]),
        "positions: is not a regular array of numbers (setting",
    ),
    "node twice": (put("nodes", lambda n: (n[1], *n[1:])), "nodes: 'corner_1' appear more than once. Node"),
    "edge to nowhere": (at("edges", (0, 0), 8), "edges: found index 0 to 8, must be 0 to 7"),
    "flexibility at no node": (put("residual", {"nose": np.eye(3)}), "residual: no node 'nose'"),
    "flexibility of three numbers": (
        put("residual", {"corner_1": np.ones(3)}),
        "node 'corner_1': found the shape (3,), must be",
    ),
    "flexibility one-sided": (put("residual", {"corner_1": np.eye(3, k=1) * 1e-7}), "m/N is not symmetric"),
    "flexibility negative": (
        put("residual", {"corner_1": -1e-7 * np.eye(3)}),
        "value is -1e-07 m/N but must be at least",
    ),
    "flexibility in mm/N": (put("residual", {"corner_1": 1e-3 * np.eye(3)}), "probably in mm/N, or the node"),
    "flexibility NaN": (put("residual", {"corner_1": np.full((3, 3), np.nan)}), "every number must be finite"),
    "NaN in a shape": (at("shapes", (1, 2, 0), np.nan), "shapes[1, 2, 0]: found nan, every number must be finite."),
    "infinite mass": (at("node_mass", 3, np.inf), "node_mass[3]: found inf, every"),
    "negative mass": (at("node_mass", 3, -1.0), "node_mass of 'corner_3': found -1 kg; masses must be at least 0 and"),
    "negative frequency": (at("frequencies", 0, -19.0), "frequencies[0]: -19 Hz; elastic modes have positive"),
    "unsorted": (swap_modes, "Sort the modes by frequency"),
    "damping in percent": (at("damping_ratio", 2, 2.0), "damping_ratio[2]: found 2, must be 0 to 0.3"),
    "positions in mm": (scaled("positions", 1e3), "the body is 2000 m long but must be at most 30 m; probably mm"),
    "positions in km": (scaled("positions", 1e-3), "the body is 0.002 m long"),
    "shapes in mm": (scaled("shapes", 1e3), "modal masses are 1e+06 instead of 1; probably mm"),
    "shapes 1000 too small": (scaled("shapes", 1e-3), "modal masses are 1e-06 instead of 1; probably km"),
    "masses in tonnes": (scaled("node_mass", 1e-3), "modal masses are 0.001 instead of 1; probably tonnes"),
    "radians": (scaled("frequencies", 2.0 * np.pi), "probably rad/s"),
    "not normalised": (at("shapes", (0, 0, 0), 0.5), "not mass-normalised with these node masses"),
    "a little off": (scaled("shapes", 1.0 + 1e-6), "instead of 1 (within 1e-06), so the modes are not mass-normalised"),
    "rigid heave in it": (rigid_part, "of the rigid translation along z, must be at most 1e-06"),
    "rigid yaw in it": (rigid_turn, "of the rigid rotation about z, must be at most 1e-06"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_data_is_refused(case):
    change, message = BAD[case]
    fields = box_fields()
    if (
        case == "radians"
    ):  # the box is softer than a car: scale its frequencies to those of a car, for which rad/s are detected
        fields["frequencies"] = fields["frequencies"] * (19.0 / fields["frequencies"][0])
    change(fields)
    with pytest.raises(DataError, match="superelement 'box', .*" + re.escape(message)):
        Superelement(**fields)


def test_the_limits_of_the_checks_are_not_tighter_than_stated():
    fields = box_fields()
    fields["shapes"] = fields["shapes"] * (1.0 + 4e-7)  # phi^T M phi is 8e-7 off, 1e-6 is allowed
    Superelement(**fields)


def test_one_mode_is_enough():
    assert len(Superelement(**box_fields(modes=1)).frequencies) == 1


def test_nodes_are_found_by_place_and_never_by_name():
    body = Superelement(**box_fields())
    near, far = (tuple(POSITIONS[0] + [0.0, 0.0, up]) for up in (9e-4, 1.1e-3))
    assert attached_nodes(body, {"strut_top_fr": near}) == {near: "corner_0"}
    with pytest.raises(
        DataError,
        match="no node at the attachment strut_top_fr of the car, \\[np\\.float64\\(0\\.0\\), np\\.float64\\(-0\\.5\\)",
    ):
        attached_nodes(body, {"strut_top_fr": far})
    # A rigid body uses only the local stiffness of a node.
    assert attached_nodes(body.without_modes(), {"a": far, "b": (9.0, 0.0, 0.0)}) == {far: "corner_0"}
