"""What a modal superelement must satisfy before a simulation may use it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vehicle.errors import DataError
from vehicle.flexbody.modes import rigid_shapes

if TYPE_CHECKING:
    from vehicle.flexbody.superelement import Superelement

NORMALISATION = 1e-6
"""largest deviation of phi^T M phi from the identity, and of the modes' rigid content from zero [1]"""
_LARGEST_BODY = 30.0  # m; a road vehicle in millimetres is thousands
_SMALLEST_BODY = 0.05  # m; a road vehicle in kilometres is below
_HIGHEST_DAMPING = 0.3  # trimmed bodies have 0.01 to 0.08; ten times that is no vibration any more
LARGEST_TOLERANCE = 0.05
"""Largest distance of a node from its point [m]: half that of the two interface nodes nearest to each other."""
_HIGHEST_FIRST_MODE = 90.0  # Hz; trimmed bodies begin between 15 and 60 Hz, which is 94 rad/s and more


def check_superelement(body: Superelement) -> None:
    """Refuse a body model that is inconsistent, in a wrong unit, not mass-normalised or not free of rigid motion.

    Raises:
        DataError: what is wrong, where, the value found, what is allowed and how to mend it.
    """
    _check_counts(body)
    _check_values(body)
    _check_units(body)
    if body.frequencies.size:
        _check_modes(body)


def _refuse(body: Superelement, text: str) -> None:
    raise DataError(f"superelement {body.name!r}, {text}")


def _check_counts(body: Superelement) -> None:
    nodes, modes = len(body.nodes), body.frequencies.size
    if nodes < 3:
        _refuse(body, f"size: {nodes} nodes; at least 3 are needed.")
    wanted = {
        "positions": (nodes, 3),
        "node_mass": (nodes,),
        "frequencies": (modes,),
        "damping_ratio": (modes,),
        "shapes": (modes, nodes, 3),
    }
    for name, shape in wanted.items():
        found = getattr(body, name).shape
        if found != shape:
            _refuse(
                body,
                f"{name}: shape {found}, but {nodes} nodes and {modes} frequencies need {shape}. "
                "Export every array for the same nodes and modes.",
            )
    if len(body.mode_names) != modes:
        _refuse(body, f"mode_names: {len(body.mode_names)} names for {modes} frequencies. Name every mode once.")
    twice = sorted({name for name in body.nodes if body.nodes.count(name) > 1})
    if twice:
        _refuse(body, f"nodes: {', '.join(map(repr, twice))} given more than once. Node names must be unique.")
    if body.edges.size and not (body.edges.min() >= 0 and body.edges.max() < nodes):
        _refuse(body, f"edges: index {body.edges.min()} to {body.edges.max()}; allowed are 0 to {nodes - 1}.")
    for node, stiffness in body.attachment_stiffness.items():
        if node not in body.nodes:
            _refuse(body, f"attachment_stiffness: no node {node!r}. Its nodes are: {', '.join(body.nodes)}.")
        if stiffness.shape != (3,) or not np.all(np.isfinite(stiffness) & (stiffness > 0.0)):
            _refuse(
                body,
                f"attachment_stiffness of {node!r}: {stiffness.tolist()} N/m; three positive finite numbers are "
                "needed. Leave the node out where it is rigid.",
            )


def _check_values(body: Superelement) -> None:
    for name in ("positions", "node_mass", "frequencies", "damping_ratio", "shapes"):
        array = getattr(body, name)
        if not np.all(np.isfinite(array)):
            where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
            _refuse(body, f"{name}{list(where)}: {array[where]}; every number must be finite. Repair the export.")
    if body.node_mass.min() < 0.0 or body.mass <= 0.0:
        worst = int(body.node_mass.argmin())
        _refuse(
            body,
            f"node_mass of {body.nodes[worst]!r}: {body.node_mass[worst]:g} kg; masses must not be negative and "
            "their sum must be positive.",
        )
    if not 0.0 < body.hardpoint_tolerance <= LARGEST_TOLERANCE:
        _refuse(
            body,
            f"hardpoint_tolerance: {body.hardpoint_tolerance:g} m; allowed is above 0, up to {LARGEST_TOLERANCE:g} m: "
            "a node farther away is another point of the body.",
        )
    if np.any(body.frequencies <= 0.0):
        worst = int(body.frequencies.argmin())
        _refuse(
            body,
            f"frequencies[{worst}]: {body.frequencies[worst]:g} Hz; elastic modes have positive frequencies. "
            "Leave rigid-body modes out: they follow from the masses.",
        )
    falls = np.flatnonzero(np.diff(body.frequencies) < 0.0)
    if falls.size:
        i = int(falls[0])
        _refuse(
            body,
            f"frequencies: mode {i + 2} ({body.frequencies[i + 1]:g} Hz) is below mode {i + 1} "
            f"({body.frequencies[i]:g} Hz). Sort the modes by frequency, their shapes and damping with them.",
        )
    bad = np.flatnonzero((body.damping_ratio < 0.0) | (body.damping_ratio > _HIGHEST_DAMPING))
    if bad.size:
        i = int(bad[0])
        _refuse(
            body,
            f"damping_ratio[{i}]: {body.damping_ratio[i]:g}; allowed is 0 to {_HIGHEST_DAMPING:g}. Give the share of "
            "critical damping, 0.02 for 2 %.",
        )


def _check_units(body: Superelement) -> None:
    extent = float(np.ptp(body.positions, axis=0).max())
    if extent > _LARGEST_BODY:
        _refuse(body, f"positions: the body is {extent:g} m long, at most {_LARGEST_BODY:g} m; looks like mm. Give m.")
    if extent < _SMALLEST_BODY:
        _refuse(body, f"positions: the body is {extent:g} m long, at least {_SMALLEST_BODY:g} m. Give metres.")
    first = float(body.frequencies[0]) if body.frequencies.size else 0.0
    if first > _HIGHEST_FIRST_MODE:
        _refuse(
            body,
            f"frequencies: the first mode is at {first:g} Hz, at most {_HIGHEST_FIRST_MODE:g} Hz is expected; looks "
            f"like rad/s ({first / (2.0 * np.pi):.4g} Hz). Give Hz.",
        )


def _check_modes(body: Superelement) -> None:
    gram = np.einsum("ank,bnk,n->ab", body.shapes, body.shapes, body.node_mass)
    scale = np.diag(gram)
    for factor, unit in ((1e6, "looks like mm: divide the shapes by 1000"), (1e-6, "looks like km: multiply by 1000")):
        if np.allclose(scale, factor, rtol=0.01):
            _refuse(body, f"shapes: modal masses are {scale[0]:.4g} instead of 1; {unit}.")
    for factor, unit in ((1e3, "masses or shapes"), (1e-3, "masses or shapes")):
        if np.allclose(scale, factor, rtol=0.01):
            _refuse(body, f"shapes: modal masses are {scale[0]:.4g} instead of 1; looks like tonne in {unit}. Give kg.")
    error = np.abs(gram - np.eye(len(gram)))
    if error.max() > NORMALISATION:
        i, j = (int(k) for k in np.unravel_index(int(error.argmax()), error.shape))
        _refuse(
            body,
            f"shapes: modes {i + 1} and {j + 1} have phi^T M phi = {gram[i, j]:.8g} instead of {float(i == j):g} "
            f"(within {NORMALISATION:g}): not mass-normalised with the node masses given. Export mass-normalised "
            "modes and the masses that belong to them.",
        )
    moments = np.linalg.eigvalsh(body.inertia)
    if moments[0] <= 1e-9 * moments[-1]:
        _refuse(body, "node_mass: all mass lies on one line, so the body has no inertia about it. Add mass beside it.")
    rigid = rigid_shapes(body.positions, body.cog)
    normal = np.linalg.inv(np.linalg.cholesky(body.inertia))  # makes the three rotations mass-normalised
    rigid[:3] /= np.sqrt(body.mass)
    rigid[3:] = np.einsum("ab,bnk->ank", normal, rigid[3:])
    content = np.abs(np.einsum("ank,bnk,n->ab", rigid, body.shapes, body.node_mass))
    if content.max() > NORMALISATION:
        motion, mode = (int(k) for k in np.unravel_index(int(content.argmax()), content.shape))
        kind = "translation along" if motion < 3 else "rotation about"
        _refuse(
            body,
            f"shapes: mode {mode + 1} ({body.frequencies[mode]:g} Hz) holds {content[motion, mode]:.3g} of the rigid "
            f"{kind} {'xyz'[motion % 3]} (at most {NORMALISATION:g}): it is not a free-free mode of these masses. "
            "Export free-free modes with the masses they were computed with, rigid-body modes left out.",
        )
