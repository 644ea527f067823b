"""Wireframes of meshes: few enough lines for a picture, spread over the whole mesh and connected as it is."""

import numpy as np
import pytest
import scipy

from vehicle.drawing.rendering.canvas import MOST_GEOMS
from vehicle.signals.analysis.thinned_wireframe import MOST_LINES, MOST_NODES, neighbours, thinned


def plate(columns, rows, apart=0.05):
    """A flat mesh with diagonals: nodes, edges."""
    index = np.arange(columns * rows).reshape(columns, rows)
    x, y = np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij")
    positions = apart * np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    pairs = [(index[:-1], index[1:]), (index[:, :-1], index[:, 1:]), (index[:-1, :-1], index[1:, 1:])]
    return positions, np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in pairs])


def test_a_mesh_of_5000_nodes_is_thinned_and_stays_whole():
    positions, edges = plate(100, 50)
    lines = thinned(positions, edges)
    shown = np.unique(lines)
    assert 300 < len(shown) <= MOST_NODES and 600 < len(lines) <= MOST_LINES
    # Even: 400 nodes on 12.5 m2 are 0.18 m apart, so none of the mesh is farther from the next one shown.
    gap, _ = scipy.spatial.cKDTree(positions[shown]).query(positions)
    assert gap.max() < 0.2
    count, _ = scipy.sparse.csgraph.connected_components(
        scipy.sparse.coo_matrix((np.ones(len(lines)), lines.T), shape=(len(positions),) * 2)
    )
    assert count == len(positions) - len(shown) + 1
    assert MOST_NODES + MOST_LINES < MOST_GEOMS - 1000  # what a film draws of it; the rest is for the car


def test_two_parts_are_not_joined_and_lines_have_their_own_limit():
    positions, edges = plate(40, 40)
    both, pairs = (
        np.concatenate([positions, positions + np.array([0.0, 0.0, 0.3])]),
        np.concatenate([edges, edges + 1600]),
    )
    lines = thinned(both, pairs, nodes=200, lines=300)
    assert len(lines) <= 300
    assert np.all((lines[:, 0] < 1600) == (lines[:, 1] < 1600))


def test_a_small_mesh_stays_and_loose_nodes_are_left_out():
    positions, edges = plate(6, 5)
    loose = np.concatenate([positions, [[9.0, 9.0, 9.0]]])
    assert thinned(loose, edges) == pytest.approx(edges)
    assert thinned(loose, np.zeros((0, 2), dtype=int)).shape == (0, 2)
    # Middle nodes of elements have no lines; they are no nodes of a picture, however many they are.
    middle = np.concatenate([positions, np.random.default_rng(1).random((3000, 3))])
    assert thinned(middle, edges) == pytest.approx(edges)


def test_points_of_a_modal_test_are_joined_to_their_neighbours():
    random = np.random.default_rng(4)
    points = np.concatenate([random.random((12, 3)), random.random((8, 3)) + np.array([5.0, 0.0, 0.0])])
    lines = neighbours(points)
    assert np.all(lines[:, 0] < lines[:, 1]) and len(np.unique(lines, axis=0)) == len(lines)
    assert 19 <= len(lines) <= 19 + 2 * 20
    count, _ = scipy.sparse.csgraph.connected_components(
        scipy.sparse.coo_matrix((np.ones(len(lines)), lines.T), shape=(20, 20))
    )
    assert count == 1
    # Two heaps apart are joined once.
    assert np.sum((lines[:, 0] < 12) & (lines[:, 1] >= 12)) == 1
    twice = np.concatenate([points[:3], points[:3]])  # places given twice
    assert len(neighbours(twice)) >= 5
    assert neighbours(points[:1]).shape == (0, 2)
