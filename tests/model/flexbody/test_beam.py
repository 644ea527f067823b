"""Beam elements against closed forms of beam theory."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from tests.validation import validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.beam import BeamSection, beam_stiffness, frame_stiffness, local_axes
from vehicle.model.flexbody.frame_modes import condense_rotations, free_free_modes, rigid_shapes

SECTION = BeamSection(axial=3.0e7, torsion=4.0e4, bending_y=5.0e4, bending_z=9.0e4)
LENGTH = 1.7
TURNS = [Rotation.identity(), Rotation.from_rotvec([0.4, -1.1, 0.7]), Rotation.from_rotvec([2.0, 0.3, -0.5])]


def cantilever_tip(direction, load, elements=3):
    """Compute tip displacement and rotation of a cantilever along `direction` under a tip load, shape (6,)."""
    points = np.outer(np.linspace(0.0, LENGTH, elements + 1), direction)
    k = frame_stiffness(points, [(i, i + 1, SECTION) for i in range(elements)])
    force = np.zeros(len(k) - 6)
    force[-6:] = load
    return np.linalg.solve(k[6:, 6:], force)[-6:]


@pytest.mark.parametrize("turn", TURNS)
def test_cantilever_has_the_textbook_deflection_and_slope_in_both_planes(turn):
    direction = turn.apply([1.0, 0.0, 0.0])
    axes = local_axes(np.zeros(3), direction)
    force = 120.0
    for axis, stiffness, slope_axis, sign in ((1, SECTION.bending_z, 2, 1.0), (2, SECTION.bending_y, 1, -1.0)):
        tip = cantilever_tip(direction, np.r_[force * axes[axis], 0.0, 0.0, 0.0])
        deflection = force * LENGTH**3 / (3.0 * stiffness) * axes[axis]
        slope = sign * force * LENGTH**2 / (2.0 * stiffness) * axes[slope_axis]
        # exact cubic elements: only round-off of a 18 x 18 solve is left
        validated(
            "Body models", f"cantilever {TURNS.index(turn) + 1}, bending in plane {axis}, deflection and slope", tip,
            np.r_[deflection, slope], rel=1e-9, abs=1e-12, source="closed form: F l^3 / (3 E I), F l^2 / (2 E I)",
        )  # fmt: skip


@pytest.mark.parametrize("turn", TURNS)
def test_cantilever_stretches_and_twists_as_the_textbook_says(turn):
    direction = turn.apply([1.0, 0.0, 0.0])
    tip = cantilever_tip(direction, np.r_[500.0 * direction, 70.0 * direction])
    stretch = 500.0 * LENGTH / SECTION.axial * direction
    twist = 70.0 * LENGTH / SECTION.torsion * direction
    validated(
        "Body models", f"cantilever {TURNS.index(turn) + 1}, stretch and twist", tip, np.r_[stretch, twist], rel=1e-9,
        abs=1e-13, source="closed form: F l / (E A), M l / (G J)",
    )  # fmt: skip


def test_tip_moment_bends_a_cantilever_into_a_parabola():
    tip = cantilever_tip(np.array([1.0, 0.0, 0.0]), [0.0, 0.0, 0.0, 0.0, 0.0, 35.0])
    validated(
        "Body models", "cantilever under a moment, deflection", tip[1], 35.0 * LENGTH**2 / (2.0 * SECTION.bending_z),
        rel=1e-9, unit="m", source="closed form: M l^2 / (2 E I)",
    )  # fmt: skip
    validated(
        "Body models", "cantilever under a moment, slope", tip[5], 35.0 * LENGTH / SECTION.bending_z, rel=1e-9,
        unit="rad", source="closed form: M l / (E I)",
    )  # fmt: skip


def test_rigid_motion_of_a_beam_needs_no_force():
    ends = np.array([[0.3, -0.2, 0.5], [1.1, 0.7, 1.9]])
    k = beam_stiffness(ends[0], ends[1], SECTION)
    for i, shape in enumerate(rigid_shapes(ends, np.array([0.4, 0.1, -0.3]))):
        rotation = np.eye(3)[i - 3] if i >= 3 else np.zeros(3)
        motion = np.concatenate([np.r_[shape[0], rotation], np.r_[shape[1], rotation]])
        np.testing.assert_allclose(k @ motion, 0.0, atol=1e-13 * np.abs(k).max())  # round-off of twelve products


def free_beam_frequencies(elements, count):
    """Compute the bending frequencies of a free beam in its softer plane, with mass lumped at the nodes."""
    points = np.outer(np.linspace(0.0, LENGTH, elements + 1), [1.0, 0.0, 0.0])
    mass_per_length = 4.0
    masses = np.full(elements + 1, mass_per_length * LENGTH / elements)
    masses[[0, -1]] /= 2.0
    k = frame_stiffness(points, [(i, i + 1, SECTION) for i in range(elements)])
    k[3::6, 3::6] += np.eye(elements + 1)  # torsion of a straight line is no translation; hold it weakly
    condensed, _ = condense_rotations(k)
    # bending in z only: a line has no rotational inertia about itself, so the three-dimensional routine does not apply
    root = np.sqrt(masses)
    values = np.linalg.eigvalsh(condensed[2::3, 2::3] / np.outer(root, root))
    return np.sqrt(values[2 : 2 + count]) / (2.0 * np.pi), mass_per_length


def test_free_beam_with_lumped_masses_converges_to_euler_bernoulli_at_second_order():
    roots = np.array([brentq(lambda b: np.cos(b) * np.cosh(b) - 1.0, low, low + 1.0) for low in (4.2, 7.4)])
    errors = []
    for elements in (16, 32, 64):
        frequencies, density = free_beam_frequencies(elements, 2)
        exact = roots**2 / LENGTH**2 * np.sqrt(SECTION.bending_y / density) / (2.0 * np.pi)
        errors.append(np.abs(frequencies / exact - 1.0))
    order = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    # higher terms still matter at 16 elements
    validated(
        "Body models", "order of convergence of the frequencies of a free beam", order, 2.0, abs=0.1,
        source="closed form: Euler-Bernoulli, cos b cosh b = 1",
    )  # fmt: skip
    validated(
        "Body models", "frequencies of a free beam of 64 elements, relative error", errors[-1], 0.0, abs=2e-3,
        source="closed form: Euler-Bernoulli, cos b cosh b = 1",
    )  # fmt: skip


def test_free_frame_modes_are_orthogonal_to_rigid_motion_and_mass_normalised():
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [1.3, 1.0, 0.4], [0.2, 0.5, 1.2]])
    k = frame_stiffness(points, [(0, 1, SECTION), (1, 2, SECTION), (2, 3, SECTION), (3, 0, SECTION), (0, 2, SECTION)])
    masses = np.array([1.0, 2.0, 3.0, 1.5])
    condensed, recovery = condense_rotations(k)
    frequencies, shapes = free_free_modes(condensed, masses, points, 6)
    held, _ = condense_rotations(frame_stiffness(points[:3], [(0, 1, SECTION), (1, 2, SECTION), (2, 0, SECTION)]))
    loose = np.pad(held, (0, 3))  # nothing holds the last node
    with pytest.raises(DataError, match="body frame: a part can move with no or almost no stiffness"):
        free_free_modes(loose, masses, points, 6)
    flat = shapes.reshape(6, -1)
    weight = np.repeat(masses, 3)
    np.testing.assert_allclose((flat * weight) @ flat.T, np.eye(6), atol=1e-12)  # round-off
    rigid = rigid_shapes(points, masses @ points / masses.sum()).reshape(6, -1)
    np.testing.assert_allclose((rigid * weight) @ flat.T, 0.0, atol=1e-11)  # round-off
    # second derivation: the uncondensed matrices with a vanishing rotary inertia
    full_mass = np.full(24, 1e-9)
    full_mass[np.arange(24) % 6 < 3] = weight
    root = np.sqrt(full_mass)
    values = np.linalg.eigvalsh(k / np.outer(root, root))
    # eps * 1e14 / w^2
    validated(
        "Body models", "frequencies of a free frame", frequencies, np.sqrt(values[6:12]) / (2 * np.pi), rel=1e-5,
        unit="Hz", source="second derivation: uncondensed matrices",
    )  # fmt: skip
    assert recovery.shape == (24, 12)


def test_beam_of_no_length_and_loose_node_are_refused():
    with pytest.raises(ConfigurationError, match=r"both ends are at \[1\.0, 0\.0, 0\.0\] m"):
        beam_stiffness([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], SECTION)
    strut = BeamSection(axial=1.0e6, torsion=0.0, bending_y=0.0, bending_z=0.0)
    with pytest.raises(ConfigurationError, match="a node can rotate freely"):
        condense_rotations(frame_stiffness(np.eye(3)[:2], [(0, 1, strut)]))
    with pytest.raises(ConfigurationError, match=r"torsion is -1.0"):
        BeamSection(axial=1.0, torsion=-1.0, bending_y=1.0, bending_z=1.0)
