"""Names of body modes by a computed rule: where the kinetic energy is, and likeness to global deformation patterns."""

from __future__ import annotations

import numpy as np

from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.frame_modes import rigid_shapes
from vehicle.model.flexbody.symmetry import parity

_LIKE = 0.30
"""Modal assurance with a global pattern from which a mode is called by it."""
_LONE = 0.50
"""Share of kinetic energy from which one node gives the mode its name."""
_SYMMETRY = 0.80
"""Parity from which a mode counts as symmetric, and below whose negative as antisymmetric."""
_DIRECTION = ("fore-aft", "lateral", "vertical")


def global_patterns(positions: FloatArray, node_mass: FloatArray) -> dict[str, FloatArray]:
    """Global deformation patterns, orthogonal to the rigid-body modes, mass-normalised.

    Torsion is a twist about x that grows with x, bending a parabola over x whose sections stay plane, lozenging a shear
    of every cross-section, racking the same growing with x.

    Args:
        positions: node positions [m], shape (n, 3).
        node_mass: lumped masses [kg], shape (n,).

    Returns:
        Name -> shape [kg^-1/2], shape (n, 3).
    """
    center = node_mass @ positions / node_mass.sum()
    x, y, z = (positions - center).T
    o = np.zeros_like(x)
    raw = {
        "torsion": (o, -x * z, x * y),
        "vertical bending": (-2.0 * x * z, o, x * x),
        "lateral bending": (-2.0 * x * y, x * x, o),
        "lozenging": (o, z, y),
        "racking": (o, x * z, x * y),
        "plan shear": (y, x, o),
        "breathing": (o, y, -z),
    }
    rigid = rigid_shapes(positions, center).reshape(6, -1)
    weight = np.repeat(node_mass, 3)
    gram = (rigid * weight) @ rigid.T
    patterns = {}
    for name, components in raw.items():
        shape = np.stack(components, axis=1).ravel()
        shape = shape - rigid.T @ np.linalg.solve(gram, (rigid * weight) @ shape)
        patterns[name] = (shape / np.sqrt(shape @ (weight * shape))).reshape(-1, 3)
    return patterns


def modal_assurance(shapes: FloatArray, pattern: FloatArray, node_mass: FloatArray) -> FloatArray:
    """Mass-weighted modal assurance (phi^T M p)^2 of mass-normalised shapes with one pattern [1], shape (modes,)."""
    return np.asarray(np.einsum("mni,ni,n->m", shapes, pattern, node_mass) ** 2)


def _region(position: FloatArray) -> str:
    x, _, z = position
    if z > 1.7:
        return "roof"
    if x < 1.2:
        return "front end"
    if x > 3.2:
        return "rear end"
    return "belt" if z > 1.0 else "floor"


def mode_names(
    shapes: FloatArray, nodes: tuple[str, ...], positions: FloatArray, node_mass: FloatArray
) -> tuple[str, ...]:
    """Name of every mode.

    The global pattern with a modal assurance of at least 0.3 gives its name; else one node with more than half of the
    kinetic energy; else the region with the most energy, and whether both sides move alike. Direction by energy.

    Args:
        shapes: mass-normalised shapes [kg^-1/2], shape (modes, n, 3).
        nodes: node names.
        positions: node positions [m], shape (n, 3).
        node_mass: lumped masses [kg], shape (n,).

    Returns:
        Names; equal names are numbered.
    """
    patterns = global_patterns(positions, node_mass)
    regions = [_region(position) for position in positions]
    names: list[str] = []
    for shape, likeness in zip(shapes, parity(shapes, positions, node_mass), strict=True):
        energy = node_mass[:, None] * shape**2  # (n, 3)
        lone = int(energy.sum(axis=1).argmax())
        assurance = {name: float(modal_assurance(shape[None], p, node_mass)[0]) for name, p in patterns.items()}
        best = max(assurance, key=lambda name: assurance[name])
        if assurance[best] >= _LIKE:
            name = best
        elif energy[lone].sum() > _LONE * energy.sum():
            name = f"{nodes[lone].replace('_', ' ')} {_DIRECTION[int(energy[lone].argmax())]}"
        else:
            share = {region: np.zeros(3) for region in regions}
            for region, part in zip(regions, energy, strict=True):
                share[region] += part
            most = max(share, key=lambda region: float(share[region].sum()))
            name = f"{most} {_DIRECTION[int(share[most].argmax())]}"
            if abs(likeness) >= _SYMMETRY:
                name += ", symmetric" if likeness > 0.0 else ", antisymmetric"
        names.append(name)
    return tuple(n if names.count(n) == 1 else f"{n} {names[: i + 1].count(n)}" for i, n in enumerate(names))
