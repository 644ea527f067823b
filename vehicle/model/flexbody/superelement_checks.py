"""Checks of a modal superelement before a simulation uses it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.analysis.modal_assurance import mac

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement

NORMALISATION = 1e-6
"""Maximum deviation of phi^T M phi from the identity, and of R^T M phi (R: rigid motions) from zero [1]."""
_RIGID_LIKENESS = 0.999
"""Maximum share of rigid motion in a shape if node masses are unknown [1]: elastic modes of cars at some twenty points
have 0.1 to 0.8, rigid-body modes 1; the margin is the noise of a modal test."""
_SOFTEST_RESIDUAL = 1e-4  # m/N; towers and mounts of car bodies are stiffer than 1e6 N/m, exports in mm/N 1000 times
_SYMMETRY = 1e-6  # of a residual flexibility; exports have seven digits
_LARGEST_BODY = 30.0  # m; a road vehicle in millimetres is thousands
_SMALLEST_BODY = 0.05  # m; a road vehicle in kilometres is below
HIGHEST_DAMPING = 0.3
"""Maximum damping ratio [1]: car bodies have 0.01 to 0.08; with ten times as much a mode hardly vibrates."""
LARGEST_TOLERANCE = 0.05
"""Maximum distance of a node from its point [m]: half the smallest distance between two interface nodes."""
HIGHEST_FIRST_MODE = 90.0
"""Maximum frequency of the first mode of a car body [Hz]: typical are 15 to 60 Hz, which is 94 rad/s and more."""
LOWEST_FIRST_MODE = 5.0
"""Minimum frequency of the first elastic mode of a vehicle body [Hz]: convertibles have 12, vans and buses 8."""


def check_superelement(body: Superelement) -> None:
    """Check that a body model is consistent, in SI units, mass-normalised and free of rigid motion.

    Raises:
        DataError: a check failed; the message contains the item, its value, the limit and the remedy.
    """
    for faults in (_counts(body), _values(body), _units(body), _rigid(body), _modes(body)):
        for fault in faults:
            raise DataError(f"superelement {body.name!r}, {fault}")


def _counts(body: Superelement) -> Iterator[str]:
    nodes, modes = len(body.nodes), body.frequencies.size
    if nodes < 3:
        yield f"size: found {nodes} nodes, must be at least 3."
    required: dict[str, tuple[int, ...]] = {
        "positions": (nodes, 3),
        "frequencies": (modes,),
        "damping_ratio": (modes,),
        "shapes": (modes, nodes, 3),
    }
    if body.node_mass is not None:
        required["node_mass"] = (nodes,)
    for name, shape in required.items():
        actual = getattr(body, name).shape
        if actual != shape:
            yield (
                f"{name}: has the shape {actual} but must have {shape} for {nodes} nodes and {modes} frequencies. "
                "Export every array for the same nodes and modes."
            )
    if len(body.mode_names) != modes:
        yield f"mode_names: found {len(body.mode_names)} names for {modes} frequencies. Give a name for each mode."
    duplicates = sorted(name for name, count in Counter(body.nodes).items() if count > 1)
    if duplicates:
        yield f"nodes: {', '.join(map(repr, duplicates))} appear more than once. Node names must be unique."
    if body.edges.size and not (body.edges.min() >= 0 and body.edges.max() < nodes):
        yield f"edges: found index {body.edges.min()} to {body.edges.max()}, must be 0 to {nodes - 1}."
    for name, node_values in (("rotations", body.rotations), ("residual", body.residual)):
        for node in node_values:
            if node not in body.nodes:
                yield f"{name}: no node {node!r}. Its nodes are: {', '.join(body.nodes)}."
    for node, rotation in body.rotations.items():
        if rotation.shape != (modes, 3) or not np.all(np.isfinite(rotation)):
            yield (
                f"rotations of node {node!r}: found the shape {rotation.shape}, must be {modes} rows of three "
                "finite numbers."
            )
    for node, flexibility in body.residual.items():
        if flexibility.shape != (3, 3):
            yield (
                f"residual flexibility of node {node!r}: found the shape {flexibility.shape}, must be three rows "
                "of three numbers."
            )
        yield from _residual(node, flexibility)


def _residual(node: str, flexibility: Vector) -> Iterator[str]:
    if not np.all(np.isfinite(flexibility)):
        yield (
            f"residual flexibility of node {node!r}: found {flexibility.tolist()} m/N, every number must be "
            "finite. Correct the export."
        )
    largest = float(np.abs(flexibility).max())
    if np.abs(flexibility - flexibility.T).max() > _SYMMETRY * largest:
        yield (
            f"residual flexibility of node {node!r}: {flexibility.tolist()} m/N is not symmetric. Give a "
            "symmetric matrix."
        )
    lowest = float(np.linalg.eigvalsh(flexibility)[0])
    if lowest < -_SYMMETRY * largest:
        yield (
            f"residual flexibility of node {node!r}: its smallest principal value is {lowest:.4g} m/N but must be "
            "at least 0 (below 0 is a negative spring). Use modes and residual flexibility of the same model."
        )
    if largest > _SOFTEST_RESIDUAL:
        yield (
            f"residual flexibility of node {node!r}: found {largest:.4g} m/N, must be at most "
            f"{_SOFTEST_RESIDUAL:g} m/N for a car; the file is probably in mm/N, or the node lies at a soft "
            "spot. Convert to m/N, or write [mm/N] into the header of a --residual table; import matrices with "
            "their --length-unit and --mass-unit, and soft spots with --spread."
        )


def _values(body: Superelement) -> Iterator[str]:
    for name in ("positions", "node_mass", "frequencies", "damping_ratio", "shapes"):
        array = getattr(body, name)
        if array is not None and not np.all(np.isfinite(array)):
            where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
            yield f"{name}{list(where)}: found {array[where]}, every number must be finite. Correct the export."
    if body.node_mass is not None and (body.node_mass.min() < 0.0 or body.node_mass.sum() <= 0.0):
        worst = int(body.node_mass.argmin())
        yield (
            f"node_mass of {body.nodes[worst]!r}: found {body.node_mass[worst]:g} kg; masses must be at least 0 "
            "and their sum above 0."
        )
    if not 0.0 < body.hardpoint_tolerance <= LARGEST_TOLERANCE:
        yield (
            f"hardpoint_tolerance: found {body.hardpoint_tolerance:g} m, must be above 0 and at most "
            f"{LARGEST_TOLERANCE:g} m: a node farther away is a different point of the body."
        )
    if np.any(body.frequencies <= 0.0):
        worst = int(body.frequencies.argmin())
        yield (
            f"frequencies[{worst}]: {body.frequencies[worst]:g} Hz; elastic modes have positive frequencies. "
            "Leave out rigid-body modes: they follow from the masses."
        )
    falls = np.flatnonzero(np.diff(body.frequencies) < 0.0)
    if falls.size:
        i = int(falls[0])
        yield (
            f"frequencies: mode {i + 2} ({body.frequencies[i + 1]:g} Hz) is below mode {i + 1} "
            f"({body.frequencies[i]:g} Hz). Sort the modes by frequency, with their shapes and damping."
        )
    bad = np.flatnonzero((body.damping_ratio < 0.0) | (body.damping_ratio > HIGHEST_DAMPING))
    if bad.size:
        i = int(bad[0])
        yield (
            f"damping_ratio[{i}]: found {body.damping_ratio[i]:g}, must be 0 to {HIGHEST_DAMPING:g}. Give the "
            "fraction of critical damping, 0.02 for 2 %."
        )


def _units(body: Superelement) -> Iterator[str]:
    extent = float(np.ptp(body.positions, axis=0).max())
    if extent > _LARGEST_BODY:
        limit = f"but must be at most {_LARGEST_BODY:g} m"
        yield f"positions: the body is {extent:g} m long {limit}; probably mm. Convert to m."
    if extent < _SMALLEST_BODY:
        yield f"positions: the body is {extent:g} m long but must be at least {_SMALLEST_BODY:g} m. Convert to m."
    first = float(body.frequencies[0]) if body.frequencies.size else 0.0
    if first > HIGHEST_FIRST_MODE:
        yield (
            f"frequencies: the first mode is at {first:g} Hz but must be at most {HIGHEST_FIRST_MODE:g} Hz; probably "
            f"rad/s ({first / (2.0 * np.pi):.4g} Hz). Convert to Hz."
        )


def _rigid(body: Superelement) -> Iterator[str]:
    """Check mass, CoG and inertia, from the node masses or specified directly."""
    if (body.node_mass is None) == (body.mass_properties is None):
        mass_data = "neither" if body.node_mass is None else "both"
        yield f"mass: found {mass_data}; give mass, CoG and inertia, or the mass of every node."
    rigid = body.rigid
    numbers = np.array([rigid.mass, *np.ravel(rigid.cog), *np.ravel(rigid.inertia)])
    if numbers.size != 13 or not np.all(np.isfinite(numbers)) or rigid.mass <= 0.0:
        yield (
            f"mass {rigid.mass:g} kg, cog {np.ravel(rigid.cog).tolist()} m, inertia "
            f"{np.ravel(rigid.inertia).tolist()} kg m2: give a positive mass, and three and nine finite numbers."
        )
    low, high = body.positions.min(axis=0), body.positions.max(axis=0)
    room = 0.5 * float(np.max(high - low))
    if np.any(rigid.cog < low - room) or np.any(rigid.cog > high + room):
        yield (
            f"cog: {np.asarray(rigid.cog).tolist()} m is far outside the nodes, {low.tolist()} to "
            f"{high.tolist()} m. Give the CoG in the axes and unit of the nodes."
        )
    if not body.frequencies.size:
        return
    low_moment, middle, top = np.linalg.eigvalsh(rigid.inertia)
    if low_moment <= 1e-9 * top:
        yield (
            "node_mass: all mass is on one axis, so the body has no inertia about this axis. Add mass at points "
            "that do not lie on this axis."
        )
    if not np.allclose(rigid.inertia, np.transpose(rigid.inertia), rtol=0.0, atol=_SYMMETRY * top):
        yield f"inertia: {np.asarray(rigid.inertia).tolist()} kg m2 is not symmetric."
    # I1 + I2 - I3 = 2 times the integral of z^2 dm, z along the axis of I3: at least 0 for real masses.
    if low_moment + middle < top * (1.0 - 1e-6):
        yield (
            f"inertia: principal moments {low_moment:.4g}, {middle:.4g} and {top:.4g} kg m2; the sum of the two "
            "smaller must be at least the largest. Give the tensor about the CoG, with the products of inertia "
            "as negative integrals."
        )


def _modes(body: Superelement) -> Iterator[str]:
    """Check shapes; without node masses: plausible unit, different shapes, and no shape a rigid motion."""
    if not body.frequencies.size:
        return
    if body.node_mass is not None:
        yield from _normalised(body, body.node_mass)
        return
    # A translation with modal mass 1 is 1 / sqrt(m) in one of three directions: its RMS is 1 / sqrt(3 m).
    level = float(np.sqrt(np.mean(body.shapes**2)) * np.sqrt(3.0 * body.mass))
    if not 1e-2 < level < 1e2:
        yield (
            f"shapes: their RMS is {level:.3g} times that of a rigid motion with modal mass 1 but must be about 1. "
            "Use shapes with modal masses of 1 kg in kg^-1/2 (from mm and tonnes: divide by sqrt(1000))."
        )
    # Share |Q^T phi|^2 / |phi|^2, Q: orthonormal basis of the six rigid motions, (3 nodes, 6).
    motions, _ = body.rigid.rigid_motions(body.positions)
    basis, _ = np.linalg.qr(motions.reshape(6, -1).T)
    flat = body.shapes.reshape(len(body.shapes), -1)
    still = np.flatnonzero(~flat.any(axis=1))
    if still.size:
        yield f"shapes: mode {still[0] + 1} is zero at all nodes. Leave the mode out, or add nodes that it moves."
    share = np.sum((flat @ basis) ** 2, axis=1) / np.sum(flat**2, axis=1)
    if share.max() > _RIGID_LIKENESS:
        mode = int(share.argmax())
        yield (
            f"shapes: mode {mode + 1} ({body.frequencies[mode]:g} Hz) is a rigid motion (share "
            f"{share[mode]:.4%}, must be at most {_RIGID_LIKENESS:.1%}). Leave out rigid-body modes: they follow "
            "from mass and inertia."
        )
    twins = mac(body.shapes, body.shapes) - np.eye(len(body.shapes))
    if twins.max(initial=0.0) > _RIGID_LIKENESS:
        mode_a, mode_b = sorted(int(k) for k in np.unravel_index(int(twins.argmax()), twins.shape))
        yield (
            f"shapes: modes {mode_a + 1} ({body.frequencies[mode_a]:g} Hz) and {mode_b + 1} "
            f"({body.frequencies[mode_b]:g} Hz) have the same shape (MAC {twins.max():.4f}). Leave out one of "
            "them, or add nodes."
        )


def _normalised(body: Superelement, node_mass: Vector) -> Iterator[str]:
    # phi^T M phi, (modes, modes).
    gram = np.einsum("ank,bnk,n->ab", body.shapes, body.shapes, node_mass)
    scale = np.diag(gram)
    for factor, unit in ((1e6, "probably mm: divide the shapes by 1000"), (1e-6, "probably km: multiply by 1000")):
        if np.allclose(scale, factor, rtol=0.01):
            yield f"shapes: modal masses are {scale[0]:.4g} instead of 1; {unit}."
    for factor, unit in ((1e3, "masses or shapes"), (1e-3, "masses or shapes")):
        if np.allclose(scale, factor, rtol=0.01):
            yield f"shapes: modal masses are {scale[0]:.4g} instead of 1; probably tonnes in {unit}. Use kg."
    error = np.abs(gram - np.eye(len(gram)))
    if error.max() > NORMALISATION:
        i, j = (int(k) for k in np.unravel_index(int(error.argmax()), error.shape))
        yield (
            f"shapes: modes {i + 1} and {j + 1} have phi^T M phi = {gram[i, j]:.8g} instead of {float(i == j):g} "
            f"(within {NORMALISATION:g}), so the modes are not mass-normalised with these node masses. Export "
            "mass-normalised modes and the corresponding masses."
        )
    rigid, _ = body.rigid.rigid_motions(body.positions)
    # R^T M phi, (6, modes): a free-free mode has neither momentum nor angular momentum.
    content = np.abs(np.einsum("ank,bnk,n->ab", rigid, body.shapes, node_mass))
    if content.max() > NORMALISATION:
        motion, mode = (int(k) for k in np.unravel_index(int(content.argmax()), content.shape))
        rigid_motion = "translation along" if motion < 3 else "rotation about"
        yield (
            f"shapes: mode {mode + 1} ({body.frequencies[mode]:g} Hz) contains {content[motion, mode]:.3g} of "
            f"the rigid {rigid_motion} {'xyz'[motion % 3]}, must be at most {NORMALISATION:g}, so it is not a "
            "free-free mode of these masses. Export free-free modes and the masses of their computation, "
            "without rigid-body modes."
        )
