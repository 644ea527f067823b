"""Reductions of Rubin and of Craig and Bampton against closed sums and the classical partitioned matrices."""

import numpy as np
import pytest
import scipy

from tests.model.flexbody.box_body import MASSES, POSITIONS, box_matrices, box_stiffness
from tests.validation import validated
from vehicle.model.flexbody.frame_modes import free_free_modes
from vehicle.model.flexbody.sources import superelement_of
from vehicle.model.flexbody.sources.craig_bampton import craig_bampton
from vehicle.model.flexbody.sources.free_body_modes import free_modes
from vehicle.model.flexbody.sources.interfaces import interfaces
from vehicle.model.flexbody.sources.superelement_of import modes_of_matrices

PLACES = {"a": tuple(POSITIONS[1]), "b": tuple(POSITIONS[6])}


@pytest.fixture(scope="module")
def box():
    return box_matrices()


def test_modes_of_the_attachments_hold_the_whole_residual_flexibility(box):
    """Static flexibility of attachment modes plus residual is that of all truncated modes."""
    attachments = interfaces(box, PLACES, tolerance=1e-3)
    static = modes_of_matrices(box, 16.0, attachments)
    for limit in (40.0, 1e6):
        rubin = modes_of_matrices(box, 16.0, attachments, "rubin", limit)
        added = rubin.vectors[:, len(static.frequencies) :] / (
            2.0 * np.pi * rubin.frequencies[len(static.frequencies) :]
        )
        assert rubin.frequencies.max() <= limit and np.all(np.diff(rubin.frequencies) > 0.0)
        for attachment in attachments:
            at = attachment.moved.T @ added
            whole = static.residual[attachment.name]
            left = rubin.residual.get(attachment.name, np.zeros((3, 3)))
            validated(
                "Body models", f"flexibility by Rubin to {limit:g} Hz, added and residual, place {attachment.name}",
                at @ at.T + left, whole, abs=1e-9 * whole.max(), unit="m/N",
                source="closed form: flexibility of all modes left out",
            )  # fmt: skip
        gram = rubin.vectors.T @ (box.mass @ rubin.vectors)
        np.testing.assert_allclose(gram, np.eye(len(gram)), atol=1e-9)
    # Two places of three directions: six shapes, and they reach above the first mode left out (Rayleigh).
    assert len(rubin.frequencies) - len(static.frequencies) == 6 and not rubin.residual
    left_out = free_free_modes(box_stiffness(), MASSES, POSITIONS, 18)[0][len(static.frequencies)]
    assert left_out < rubin.frequencies[len(static.frequencies)] < 2.0 * left_out


def test_craig_bampton_with_all_modes_of_the_held_body_is_the_body(box):
    """All fixed-interface modes and constraint modes span every motion; with few modes, frequencies are higher."""
    attachments = interfaces(box, PLACES, tolerance=1e-3)
    frequencies, shapes = free_free_modes(box_stiffness(), MASSES, POSITIONS, 18)
    whole = modes_of_matrices(box, 1e6, attachments, "craig-bampton")
    validated(
        "Body models", "frequencies by Craig-Bampton with all modes of the held body", whole.frequencies, frequencies,
        rel=1e-7, unit="Hz", source="second derivation: free body",
    )  # fmt: skip
    part = modes_of_matrices(box, 60.0, attachments, "craig-bampton", 20.0)
    assert np.all(part.frequencies > frequencies[: len(part.frequencies)] * (1.0 - 1e-9))
    assert part.frequencies[0] < 1.01 * frequencies[0] and "Craig-Bampton: 17 modes up" in part.remarks[0]
    at = attachments[0].moved.T @ part.vectors / (2.0 * np.pi * part.frequencies)
    static = shapes[:, 1].T / (2.0 * np.pi * frequencies) ** 2 @ shapes[:, 1]
    np.testing.assert_allclose(at @ at.T + part.residual["a"], static, atol=0.02 * static.max())


def test_craig_bampton_is_the_classical_reduction_of_partitioned_matrices(box):
    """Reference: T = [[1, 0], [-K_ii^-1 K_ib, Phi]] for three corners b and other nodes i, with Phi of K_ii, M_ii."""
    attachments = interfaces(box, {f"{i}": tuple(POSITIONS[i]) for i in (0, 3, 5)}, tolerance=1e-3)
    free = free_modes(box, 20.0)
    reduced, _ = craig_bampton(box, free, [attachment.moved for attachment in attachments], 1e6, 20.0)
    stiffness, mass = box.stiffness.toarray(), box.mass.toarray()
    b = np.isin(box.node, (0, 3, 5)) & (box.direction < 3)
    inner = np.ix_(~b, ~b)
    inverse, held = scipy.linalg.eigh(mass[inner], stiffness[inner])
    held = held[:, inverse > 1.0 / (2.0 * np.pi * 20.0) ** 2]
    reduction = np.zeros((len(b), b.sum() + held.shape[1]))
    reduction[b, : b.sum()] = np.eye(b.sum())
    reduction[~b, : b.sum()] = -np.linalg.solve(stiffness[inner], stiffness[np.ix_(~b, b)])
    reduction[~b, b.sum() :] = held
    values = scipy.linalg.eigh(reduction.T @ stiffness @ reduction, reduction.T @ mass @ reduction, eigvals_only=True)
    assert 0 < held.shape[1] < 10
    validated(
        "Body models", "frequencies by Craig-Bampton", reduced.frequencies, np.sqrt(values[6:]) / (2.0 * np.pi),
        rel=1e-7, unit="Hz", source="second derivation: partitioned matrices, T' K T and T' M T",
    )  # fmt: skip


def test_craig_bampton_keeps_enough_modes_or_says_how_wrong_they_are(box, monkeypatch):
    """The stated error is that of the frequencies; if too large, more fixed-interface modes are used."""
    attachments = interfaces(box, PLACES, tolerance=1e-3)
    free = free_modes(box, 20.0)
    count, errors = len(free.frequencies), {}
    monkeypatch.setattr(superelement_of, "HELD_TO", (1.0, 50.0))
    for near in (0.01, 0.001):
        monkeypatch.setattr(superelement_of, "NEAR", near)
        reduced = modes_of_matrices(box, 20.0, attachments, "craig-bampton", 60.0)
        error = errors[near] = float(np.max(reduced.frequencies[:count] / free.frequencies - 1.0))
        assert f"the modes up to 20 Hz are up to {error:.2%} higher" in reduced.notices[0]
        assert f"at most {error:.2%} above the {count} free-free modes" in reduced.remarks[0]
    assert 0.001 < errors[0.01] < 0.01 and errors[0.001] < 0.1 * errors[0.01]
    assert not modes_of_matrices(box, 20.0, attachments).notices
