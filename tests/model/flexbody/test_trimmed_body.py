"""Shipped body: published properties, assumed properties, and reproduction of its file."""

import numpy as np
import pytest
import scipy.optimize

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.body_design import read_design
from vehicle.model.flexbody.body_frame import body_frame
from vehicle.model.flexbody.body_model import BODY_DESIGN, TRIMMED_BODY
from vehicle.model.flexbody.inertia_tensor import about_cog, inertia_tensor, second_moments
from vehicle.model.flexbody.mode_names import global_patterns, modal_assurance
from vehicle.model.flexbody.node_masses import NodeProperties, matched_masses
from vehicle.model.flexbody.superelement_file import read_superelement
from vehicle.model.flexbody.symmetry import mirror_nodes, parity
from vehicle.model.parameters.vehicle import load_vehicle


@pytest.fixture(scope="module")
def body():
    return read_superelement(TRIMMED_BODY)


@pytest.fixture(scope="module")
def design():
    return read_design(BODY_DESIGN)


@pytest.fixture(scope="module")
def frame(design):
    vehicle = load_vehicle()
    return body_frame(design, vehicle.points, NodeProperties.of_body(vehicle.body, design.least_ixx))


def test_the_exported_file_is_what_the_design_gives_on_the_shipped_car(body, frame):
    built = frame.superelement()
    assert (built.nodes, built.mode_names, built.provenance) == (body.nodes, body.mode_names, body.provenance)
    np.testing.assert_array_equal(built.positions, body.positions)
    np.testing.assert_array_equal(built.edges, body.edges)
    # other BLAS libraries round differently: eps times the condition of K (1e6) and of the mode separation (1e2)
    np.testing.assert_allclose(built.node_mass, body.node_mass, rtol=1e-9)
    np.testing.assert_allclose(built.frequencies, body.frequencies, rtol=1e-8)
    np.testing.assert_allclose(built.shapes, body.shapes, atol=1e-6)
    assert set(body.residual) == set(built.residual)
    for node, flexibility in built.residual.items():
        np.testing.assert_array_equal(body.residual[node], flexibility)


def test_published_counts_frequencies_and_mass_properties(body):
    assert (len(body.nodes), len(body.frequencies)) == (43, 9)
    trimmed = "publication: Bommer 2006, trimmed body"
    # published with two digits; fitted to 0.01
    for name, value, exact in (("first", body.frequencies[0], 19.0), ("ninth", body.frequencies[-1], 43.0)):
        validated(
            "Published cars", f"{name} frequency of the trimmed body, fitted", value, exact, abs=0.01, unit="Hz",
            source=trimmed,
        )  # fmt: skip
    # matched, so round-off only
    validated(
        "Published cars", "mass of the trimmed body, matched", body.mass, 813.0, rel=1e-12, unit="kg", source=trimmed,
    )  # fmt: skip
    np.testing.assert_allclose(body.cog, [2.157, 0.0, 1.011], atol=1e-12)
    origin = inertia_tensor(ixx=1200.0, iyy=5268.0, izz=4600.0, ixy=0.0, izx=1800.0, iyz=0.0)  # symmetric on purpose
    np.testing.assert_allclose(body.inertia, about_cog(origin, 813.0, [2.157, 0.0, 1.011]), rtol=1e-10, atol=1e-8)


def test_torsion_is_where_it_was_fitted_and_the_next_mode_is_above_the_range(body, frame):
    torsion = modal_assurance(body.shapes, global_patterns(body.positions, body.node_mass)["torsion"], body.node_mass)
    mode = int(torsion.argmax())
    assert torsion[mode] > 1.5 * np.sort(torsion)[-2]  # the next best has 0.19 against 0.33
    assert body.frequencies[mode] == pytest.approx(25.5, abs=0.05)
    assert body.mode_names[mode] == "torsion"
    assert parity(body.shapes[:1], body.positions, body.node_mass)[0] > 0.95  # the first is symmetric
    left, right = body.shape_at("strut_top_fl")[2, mode], body.shape_at("strut_top_fr")[2, mode]
    rear_left = body.shape_at("rear_support_left")[2, mode]
    assert left * right < 0.0  # the towers move against each other,
    assert left * rear_left < 0.0  # and the rear against the front
    assert frame.modes(frame.design.factors, 10)[0][9] > 45.0


def test_the_body_is_nearly_the_same_on_both_sides(body):
    likeness = parity(body.shapes, body.positions, body.node_mass)
    assert np.abs(likeness).min() > 0.95  # 1 would be a perfect mirror image; the seat and the engine mounts are not
    facing = mirror_nodes(body.positions)
    for i, name in enumerate(body.nodes):
        j = facing[i]
        if j < 0:
            continue
        if "seat" not in name:  # the seat itself hangs on the left one only
            assert body.node_mass[i] == pytest.approx(body.node_mass[j], rel=0.03), name
        if name not in body.residual:
            continue
        for mode, (motion, mirrored) in enumerate(np.linalg.norm(body.shapes[:, [i, j]], axis=2)):
            if max(motion, mirrored) > 0.018:  # where it moves: half of the mean motion 813^-1/2
                allowed = 0.25 if "mount" in name else 0.15  # the engine mounts are 82 mm from mirrored
                assert motion == pytest.approx(mirrored, rel=allowed), f"{name}, mode {mode + 1}"
    right, left = (np.abs(body.shape_at(f"strut_top_{wheel}")[2]) for wheel in ("fr", "fl"))
    # These couple with the wheels; 3e-4 is a hundredth of the mean motion 813^-1/2 and couples with nothing.
    np.testing.assert_allclose(right, left, rtol=0.05, atol=3e-4)
    seat = body.node_mass[[body.node_index("seat"), body.node_index("seat_rail")]].sum()
    assert seat == pytest.approx(body.node_mass[body.node_index("seat_rail_right")], rel=0.06)


def test_no_mode_is_the_lone_wobble_of_an_interface(body):
    energy = body.node_mass * np.sum(body.shapes**2, axis=2)  # (modes, nodes), each row sums to one
    np.testing.assert_allclose(energy.sum(axis=1), 1.0, rtol=1e-6)
    for node in body.residual:
        share = energy[:, body.node_index(node)].max()
        assert share < 0.10, f"{node} alone has {share:.0%} of the kinetic energy of a mode"
        amplitude = np.linalg.norm(body.shape_at(node), axis=0).max()
        assert amplitude < 0.06, f"{node} moves {amplitude:.3f} kg^-1/2"  # effective mass above 270 kg
    for mode in energy:  # no node but a heavy one of the floor has much of a mode for itself
        assert mode.max() < 0.27


def test_the_seat_rail_is_near_node_lines_and_the_masses_are_a_cars(body, design):
    rail = np.abs(body.shape_at("seat_rail")[2])
    assert rail.max() < 0.015  # the mean of the body is 813^-1/2 = 0.035
    mass = {name: float(body.node_mass[body.node_index(name)]) for name in body.nodes}
    assert max(mass.values()) < 80.0  # a floor half with its seat, or a side with two doors
    for heavy in ("cowl_right", "sill_front_right", "rear_support_right", "c_pillar_belt_right"):
        assert mass[heavy] > 10.0
    assert all(1.0 / 4.0 <= factor <= 4.0 for factor in design.factors.values())


def test_nodes_are_symmetric_where_the_car_is_and_masses_positive(body):
    positions = {tuple(np.round(p, 9)) for p in body.positions}
    lone = [
        n
        for n, p in zip(body.nodes, body.positions, strict=True)
        if tuple(np.round(p * [1, -1, 1], 9)) not in positions
    ]
    assert sorted(lone) == ["hydromount", "linear_mount", "seat"]
    assert body.node_mass.min() > 0.1
    assert TRIMMED_BODY.stat().st_size < 300_000


def guesses(frame):
    placed = frame.design.placed(load_vehicle().points)
    entries = [frame.design.nodes[name] for name, nodes in placed.items() for _ in nodes]
    return np.array([entry.mass for entry in entries]), np.array([entry.freedom for entry in entries])


def test_masses_near_the_guess_or_a_refusal(frame):
    guess, freedom = guesses(frame)
    points = frame.skeleton.positions
    cog = guess @ points / guess.sum()
    arm = points - cog
    moments = (arm.T * guess) @ arm
    inertia = np.trace(moments) * np.eye(3) - moments
    same = matched_masses(guess, freedom, points, mass=guess.sum(), cog=cog, inertia_about_cog=inertia)
    np.testing.assert_allclose(same, guess, rtol=1e-9)  # an estimate that already fits changes by round-off only
    published = inertia_tensor(ixx=1000.0, iyy=5268.0, izz=4600.0, ixy=82.03, izx=1800.0, iyz=-50.04)
    cog = np.array([2.157, 0.0, 1.011])
    with pytest.raises(ConfigurationError, match=r"have positive masses that give the mass 813 kg, the CoG \[2\.157"):
        matched_masses(guess, freedom, points, mass=813.0, cog=cog, inertia_about_cog=about_cog(published, 813.0, cog))


@pytest.mark.parametrize(
    ("change", "possible"),
    [({"mass": mass}, mass > 712) for mass in (690, 705, 720, 750, 760, 800, 815)]
    + [({"ixx": ixx}, 1050 < ixx < 1350) for ixx in (1000, 1040, 1060, 1100, 1300, 1400)]
    + [({"cog": (2.157, 0.01, 1.011)}, True)],
)
def test_masses_are_found_where_a_linear_program_finds_any(frame, change, possible):
    """Second derivation by a linear program, without estimate and Newton's method: any m >= 0 with A m = b."""
    mass, cog, points = change.get("mass", 813.0), change.get("cog", (2.157, 0.0, 1.011)), frame.skeleton.positions
    inertia = {"ixx": change.get("ixx", 1200.0), "iyy": 5268.0, "izz": 4600.0, "izx": 1800.0}
    arm = points - cog
    tensor = about_cog(inertia_tensor(**inertia, ixy=0.0, iyz=0.0), mass, cog)
    tensor[1, [0, 2]] = tensor[[0, 2], 1] = 0.0
    body = NodeProperties(mass, cog, tensor[0, 0], tensor[1, 1], tensor[2, 2], -tensor[2, 0])
    moments = second_moments(tensor)
    moments[1, [0, 2]] = moments[[0, 2], 1] = 0.0
    products = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    rows = np.vstack([np.ones(len(arm)), arm.T, [arm[:, i] * arm[:, j] for i, j in products]])
    wanted = np.r_[mass, np.zeros(3), [moments[i, j] for i, j in products]]
    program = scipy.optimize.linprog(np.zeros(len(arm)), A_eq=rows, b_eq=wanted, bounds=(0.0, None))
    assert (program.status == 0) == possible
    guess, freedom = guesses(frame)
    if possible:
        masses = body.masses(guess, freedom, points)
        assert masses.min() > 0.0
        np.testing.assert_allclose(rows @ masses, wanted, atol=1e-9)  # round-off of sums of 800 kg at 2 m
    else:
        with pytest.raises(ConfigurationError, match=r"^body\.mass .*the 43 nodes cannot have positive masses"):
            body.masses(guess, freedom, points)
