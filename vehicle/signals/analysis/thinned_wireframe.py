"""A mesh as a wireframe that can be looked at: some of its nodes, and lines along its edges between them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy

Vector = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

MOST_NODES, MOST_LINES = 400, 1500
"""What a picture shows of a mesh: with more, the lines of a car are a dark patch and a film takes minutes longer."""


def thinned(positions: Vector, edges: Indices, nodes: int = MOST_NODES, lines: int = MOST_LINES) -> Indices:
    """Nodes that stand for a mesh, and the lines between them.

    Nodes without a line are left out where the mesh has lines: middle nodes of elements, and places that hang on
    others. Of more nodes than are wanted some are taken, farthest first, so that they spread evenly; each other one
    belongs to the nearest of them along the edges, and an edge between two regions is a line.

    Args:
        positions: of the nodes [m], (n, 3).
        edges: pairs of nodes, (m, 2).
        nodes: most nodes.
        lines: most lines.

    Returns:
        Pairs of nodes, (lines, 2), indices into `positions`; the nodes that are shown are those in it.
    """
    if not len(edges):
        return np.zeros((0, 2), dtype=np.intp)
    used = np.unique(edges)
    if len(used) <= nodes and len(edges) <= lines:
        return np.asarray(edges, dtype=np.intp)
    length = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1)
    graph = scipy.sparse.coo_matrix((np.maximum(length, 1e-9), edges.T), shape=(len(positions),) * 2).tocsr()
    count = min(nodes, len(used))
    while True:
        chosen = _spread(positions, used, count)
        _, _, owner = scipy.sparse.csgraph.dijkstra(
            graph, directed=False, indices=chosen, min_only=True, return_predecessors=True
        )
        pairs = np.sort(owner[edges], axis=1)
        found = np.unique(pairs[(pairs[:, 0] >= 0) & (pairs[:, 0] != pairs[:, 1])], axis=0)
        if len(found) <= lines or count < 4:
            return np.asarray(found, dtype=np.intp)
        count = count * 3 // 4


def neighbours(positions: Vector, nearest: int = 2) -> Indices:
    """Lines between points that have none: of each to the nearest others, and the shortest that join all of them.

    Args:
        positions: of the points [m], (n, 3).
        nearest: to how many others each point has a line.

    Returns:
        Pairs of points, (lines, 2); none of a single point.
    """
    count = len(positions)
    apart = np.maximum(scipy.spatial.distance.squareform(scipy.spatial.distance.pdist(positions)), 1e-9)
    np.fill_diagonal(apart, 0.0)
    tree = scipy.sparse.csgraph.minimum_spanning_tree(apart).tocoo()
    order = np.argsort(apart, axis=1)[:, 1 : nearest + 1]
    near = np.stack([np.repeat(np.arange(count), order.shape[1]), order.ravel()], axis=1)
    pairs = np.sort(np.concatenate([np.stack([tree.row, tree.col], axis=1), near]), axis=1)
    return np.asarray(np.unique(pairs, axis=0), dtype=np.intp).reshape(-1, 2)


def _spread(positions: Vector, among: Indices, count: int) -> Indices:
    """Nodes spread evenly over the mesh: each next one is the farthest from those before."""
    places, chosen = positions[among], [0]
    gap = np.linalg.norm(places - places[0], axis=1)
    for _ in range(count - 1):
        chosen.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(places - places[chosen[-1]], axis=1))
    return np.asarray(among[np.sort(chosen)], dtype=np.intp)
