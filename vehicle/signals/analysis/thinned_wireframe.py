"""Reduction of a mesh to a wireframe for pictures: a subset of its nodes, and lines between them."""

import numpy as np
import scipy

from vehicle.arrays import Indices
from vehicle.signals.analysis.samples import Vector

MOST_NODES, MOST_LINES = 400, 1500
"""Maximum nodes and lines of a mesh in a picture: with more, the lines merge to a dark area and a film takes minutes
longer."""


def thinned(positions: Vector, edges: Indices, nodes: int = MOST_NODES, lines: int = MOST_LINES) -> Indices:
    """Return the lines of a wireframe with a limited number of nodes and lines.

    Nodes without an edge are omitted, as middle nodes of elements. If the mesh is too large, nodes are selected by
    farthest-point sampling. Each other node belongs to the region of the nearest selected node along the edges, and two
    regions with a common edge are connected by a line.

    Args:
        positions: positions of the nodes [m], (n, 3).
        edges: pairs of nodes, (m, 2).
        nodes: maximum number of nodes.
        lines: maximum number of lines.

    Returns:
        Pairs of indices into `positions`, (lines, 2); only nodes of these lines are shown.
    """
    if not len(edges):
        return np.zeros((0, 2), dtype=np.intp)
    connected = np.unique(edges)
    if len(connected) <= nodes and len(edges) <= lines:
        return np.asarray(edges, dtype=np.intp)
    length = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1)
    graph = scipy.sparse.coo_matrix((np.maximum(length, 1e-9), edges.T), shape=(len(positions),) * 2).tocsr()
    # Fewer nodes until the lines between their regions are few enough.
    count = min(nodes, len(connected))
    while True:
        chosen = _spread(positions, connected, count)
        _, _, region = scipy.sparse.csgraph.dijkstra(
            graph, directed=False, indices=chosen, min_only=True, return_predecessors=True
        )
        pairs = np.sort(region[edges], axis=1)
        lines_between = np.unique(pairs[(pairs[:, 0] >= 0) & (pairs[:, 0] != pairs[:, 1])], axis=0)
        if len(lines_between) <= lines or count < 4:
            return np.asarray(lines_between, dtype=np.intp)
        count = count * 3 // 4


def neighbours(positions: Vector, nearest: int = 2) -> Indices:
    """Return lines between points without edges: to the nearest points, and a minimum spanning tree.

    Args:
        positions: positions of the points [m], (n, 3).
        nearest: number of nearest points connected to each point.

    Returns:
        Pairs of indices of points, (lines, 2); empty for a single point.
    """
    count = len(positions)
    distances = np.maximum(scipy.spatial.distance.squareform(scipy.spatial.distance.pdist(positions)), 1e-9)
    np.fill_diagonal(distances, 0.0)
    tree = scipy.sparse.csgraph.minimum_spanning_tree(distances).tocoo()
    # Index 0 is the point; its neighbours follow.
    order = np.argsort(distances, axis=1)[:, 1 : nearest + 1]
    nearest_pairs = np.stack([np.repeat(np.arange(count), order.shape[1]), order.ravel()], axis=1)
    pairs = np.sort(np.concatenate([np.stack([tree.row, tree.col], axis=1), nearest_pairs]), axis=1)
    return np.asarray(np.unique(pairs, axis=0), dtype=np.intp).reshape(-1, 2)


def _spread(positions: Vector, indices: Indices, count: int) -> Indices:
    """Select nodes by farthest-point sampling: each next node is the farthest from the selected nodes."""
    candidates, chosen = positions[indices], [0]
    distance = np.linalg.norm(candidates - candidates[0], axis=1)
    for _ in range(count - 1):
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(candidates - candidates[chosen[-1]], axis=1))
    return np.asarray(indices[np.sort(chosen)], dtype=np.intp)
