"""Small body for tests: a box of steel tubes with unequal corner masses."""

import itertools

import numpy as np
import scipy

from vehicle.model.flexbody.beam import BeamSection, frame_stiffness
from vehicle.model.flexbody.frame_modes import condense_rotations, free_free_modes
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices

SECTION = BeamSection(axial=2.0e7, torsion=2.0e4, bending_y=2.5e4, bending_z=2.5e4)
POSITIONS = np.array(list(itertools.product([0.0, 2.0], [-0.5, 0.5], [0.4, 1.3])))
MASSES = np.array([30.0, 40.0, 35.0, 25.0, 50.0, 45.0, 20.0, 30.0])
PAIRS = [(a, b) for a, b in itertools.combinations(range(8), 2) if np.sum(POSITIONS[a] != POSITIONS[b]) == 1]


def box_stiffness():
    """Return the translational stiffness of the box [N/m], shape (24, 24)."""
    return condense_rotations(frame_stiffness(POSITIONS, [(a, b, SECTION) for a, b in PAIRS]))[0]


def box_fields(modes=4):
    """Return keyword arguments of a valid `Superelement`, with new arrays at every call."""
    frequencies, shapes = free_free_modes(box_stiffness(), MASSES, POSITIONS, modes)
    return {
        "name": "box",
        "nodes": tuple(f"corner_{i}" for i in range(8)),
        "positions": POSITIONS.copy(),
        "edges": np.array(PAIRS),
        "node_mass": MASSES.copy(),
        "frequencies": frequencies,
        "damping_ratio": np.full(modes, 0.02),
        "shapes": shapes,
        "residual": {"corner_1": np.diag([1e-7, 5e-8, 4e-8])},
        "mode_names": tuple(f"mode {i + 1}" for i in range(modes)),
        "provenance": "computed for a test",
    }


def matrices(positions, pairs, section, masses):
    """Return K and M of a frame of beams with point masses, six degrees of freedom per node."""
    count = len(positions)
    mass = np.zeros((count, 6))
    mass[:, :3] = masses[:, None]
    return BodyMatrices(
        stiffness=scipy.sparse.csc_matrix(frame_stiffness(positions, [(a, b, section) for a, b in pairs])),
        mass=scipy.sparse.diags(mass.ravel()).tocsc(),
        nodes=tuple(str(10 * i + 1) for i in range(count)),  # numbers of nodes need not be dense
        positions=positions,
        node=np.repeat(np.arange(count), 6),
        direction=np.tile(np.arange(6), count),
        edges=np.array(pairs),
        source="a box",
    )


def box_matrices():
    """Return K and M of the box with all six degrees of freedom of its corners."""
    return matrices(POSITIONS, PAIRS, SECTION, MASSES)
