"""Masses attached to a flexible body: component-mode assembly against second derivations."""

import numpy as np
import pytest
import scipy.linalg

from tests.model.flexbody.box_body import MASSES, POSITIONS, box_fields, box_stiffness
from tests.validation import validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.attached_mass import with_attached_masses
from vehicle.model.flexbody.frame_modes import free_free_modes
from vehicle.model.flexbody.superelement import Superelement

ADDED = {"corner_5": 1.2, "corner_7": 20.0}


def test_frequencies_are_those_of_the_constrained_two_body_problem():
    """Second derivation: body and point masses kept apart, joined by constraints, the null space taken."""
    body = Superelement(**box_fields())
    count = len(body.frequencies)
    rigid = np.zeros((6, 8, 3))
    for axis in range(3):
        rigid[axis, :, axis] = 1.0
        rigid[3 + axis] = np.cross(np.eye(3)[axis], POSITIONS)  # about the origin: another choice than in the code
    basis = np.concatenate([rigid, body.shapes])
    weight = np.repeat(MASSES, 3)
    flat = basis.reshape(6 + count, -1)
    mass = scipy.linalg.block_diag((flat * weight) @ flat.T, *[m * np.eye(3) for m in ADDED.values()])
    stiffness = np.zeros_like(mass)
    stiffness[6 : 6 + count, 6 : 6 + count] = np.diag((2.0 * np.pi * body.frequencies) ** 2)
    joints = np.zeros((6, len(mass)))
    for i, node in enumerate(ADDED):
        joints[3 * i : 3 * i + 3, : 6 + count] = basis[:, body.node_index(node), :].T
        joints[3 * i : 3 * i + 3, 6 + count + 3 * i : 9 + count + 3 * i] = -np.eye(3)
    free = scipy.linalg.null_space(joints)
    values = scipy.linalg.eigh(free.T @ stiffness @ free, free.T @ mass @ free, eigvals_only=True)
    loaded = with_attached_masses(body, ADDED)
    # round-off
    validated(
        "Body models", "frequencies of a body with attached masses", loaded.frequencies,
        np.sqrt(values[6:]) / (2.0 * np.pi), rel=1e-8, unit="Hz",
        source="second derivation: masses joined by constraints, null space",
    )  # fmt: skip


def test_with_all_modes_it_is_the_frame_solved_again():
    body = Superelement(**box_fields(modes=18))  # 24 degrees of freedom less six rigid motions: the space is complete
    heavier = MASSES.copy()
    heavier[[5, 7]] += list(ADDED.values())
    frequencies, shapes = free_free_modes(box_stiffness(), heavier, POSITIONS, 18)
    loaded = with_attached_masses(body, ADDED)
    # round-off of modes a decade apart
    validated(
        "Body models", "frequencies of a body of all modes with attached masses", loaded.frequencies, frequencies,
        rel=1e-7, unit="Hz", source="second derivation: heavier frame solved again",
    )  # fmt: skip
    np.testing.assert_allclose(loaded.shapes[:3], shapes[:3], atol=1e-7 * np.abs(shapes).max())


def test_result_has_the_mass_and_nothing_changes_without_any():
    body = Superelement(**box_fields())
    assert with_attached_masses(body, ADDED).mass == pytest.approx(body.mass + 21.2, rel=1e-14)
    same = with_attached_masses(body, {})
    np.testing.assert_allclose(same.frequencies, body.frequencies, rtol=1e-12)  # round-off
    np.testing.assert_allclose(same.shapes, body.shapes, atol=1e-10)  # round-off
    np.testing.assert_allclose(same.damping_ratio, body.damping_ratio, rtol=1e-10)  # round-off
    assert same.mode_names == body.mode_names


def test_wrong_masses_and_nodes_are_refused():
    body = Superelement(**box_fields())
    with pytest.raises(ConfigurationError, match=r"mass attached to body node 'corner_1': found -1.0 kg"):
        with_attached_masses(body, {"corner_1": -1.0})
    with pytest.raises(DataError, match="has no node 'nose'"):
        with_attached_masses(body, {"nose": 1.0})
