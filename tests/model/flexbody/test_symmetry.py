"""Mirror symmetry: opposite nodes, and the parity of synthetic shapes."""

import numpy as np
import pytest

from vehicle.model.flexbody.symmetry import mirror_nodes, parity

POSITIONS = np.array([[0.0, 0.5, 0.0], [0.02, -0.5, 0.05], [1.0, 0.0, 0.0], [2.0, 0.4, 1.0]])  # pair, centre, lone
MASS = np.array([2.0, 2.0, 4.0, 8.0])


def test_nodes_face_their_counterpart_themselves_or_none():
    assert mirror_nodes(POSITIONS).tolist() == [1, 0, 2, -1]


@pytest.mark.parametrize(("right", "left", "centre", "expected"), [
    ([0.1, 0.2, 0.3], [0.1, -0.2, 0.3], [0.4, 0.0, 0.5], 1.0),
    ([0.1, 0.2, 0.3], [-0.1, 0.2, -0.3], [0.0, 0.4, 0.0], -1.0),
    ([0.1, 0.2, 0.3], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.0),
])  # fmt: skip
def test_parity_of_pure_shapes(right, left, centre, expected):
    shape = np.array([[right, left, centre, [0.0, 0.0, 0.0]]])
    shape /= np.sqrt(np.sum(MASS[:, None] * shape[0] ** 2))
    assert parity(shape, POSITIONS, MASS)[0] == pytest.approx(expected, abs=1e-14)  # round-off


def test_parity_splits_energy_of_a_sum_of_both():
    """A shape a s + b t of orthonormal symmetric s and antisymmetric t has parity a^2 - b^2."""
    s = np.array([[[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]]) / 2.0
    t = np.array([[[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]]) / 2.0
    assert parity(0.8 * s + 0.6 * t, POSITIONS, MASS)[0] == pytest.approx(0.28, abs=1e-14)  # round-off
