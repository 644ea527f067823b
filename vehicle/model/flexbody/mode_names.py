"""Names of body modes, from the modal assurance with global deformation patterns and the kinetic energy by region."""

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.flexbody.frame_modes import rigid_shapes
from vehicle.model.flexbody.symmetry import parity

_LIKE = 0.30
"""Minimum modal assurance with a global pattern for a mode to be named after the pattern [1]."""
_LONE = 0.50
"""Minimum share of a node in the kinetic energy for a mode to be named after the node [1]."""
_SYMMETRY = 0.80
"""Minimum |parity| of a mode named symmetric (positive) or antisymmetric (negative) [1]."""
_DIRECTION = ("fore-aft", "lateral", "vertical")


def global_patterns(positions: Vector, node_mass: Vector) -> dict[str, Vector]:
    """Return global deformation patterns, mass-normalised, orthogonal to rigid motions [kg^-1/2], (n, 3) by name.

    Torsion is a twist about x that grows with x, bending a parabola over x with plane sections, lozenging a uniform
    shear of the cross-sections, racking a shear of the cross-sections that grows with x.

    Args:
        positions: node positions [m], shape (n, 3).
        node_mass: lumped masses [kg], shape (n,).
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
    # Projection in M: p - R (R' M R)^-1 R' M p.
    gram = (rigid * weight) @ rigid.T
    patterns = {}
    for name, components in raw.items():
        shape = np.stack(components, axis=1).ravel()
        shape = shape - rigid.T @ np.linalg.solve(gram, (rigid * weight) @ shape)
        patterns[name] = (shape / np.sqrt(shape @ (weight * shape))).reshape(-1, 3)
    return patterns


def modal_assurance(shapes: Vector, pattern: Vector, node_mass: Vector) -> Vector:
    """Return the modal assurance (phi^T M p)^2 of mass-normalised shapes with one pattern [1], shape (modes,)."""
    return np.asarray(np.einsum("mni,ni,n->m", shapes, pattern, node_mass) ** 2)


def _region(position: Vector) -> str:
    x, _, z = position
    if z > 1.7:
        return "roof"
    if x < 1.2:
        return "front end"
    if x > 3.2:
        return "rear end"
    return "belt" if z > 1.0 else "floor"


def mode_names(shapes: Vector, nodes: tuple[str, ...], positions: Vector, node_mass: Vector) -> tuple[str, ...]:
    """Return a name for every mode; equal names get a number.

    A mode is named after the global pattern with the highest modal assurance, if at least 0.3; else after a node with
    more than half of the kinetic energy; else after the region with the highest energy, with the parity. The direction
    is the axis with the highest energy.

    Args:
        shapes: mass-normalised shapes [kg^-1/2], shape (modes, n, 3).
        nodes: node names.
        positions: node positions [m], shape (n, 3).
        node_mass: lumped masses [kg], shape (n,).
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
            region_of_mode = max(share, key=lambda region: float(share[region].sum()))
            name = f"{region_of_mode} {_DIRECTION[int(share[region_of_mode].argmax())]}"
            if abs(likeness) >= _SYMMETRY:
                name += ", symmetric" if likeness > 0.0 else ", antisymmetric"
        names.append(name)
    return tuple(n if names.count(n) == 1 else f"{n} {names[: i + 1].count(n)}" for i, n in enumerate(names))
