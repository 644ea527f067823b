"""Conversion of computed or measured modes to real, mass-normalised elastic modes of a free body."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources.body_matrices import BodyNodes
from vehicle.model.flexbody.sources.superelement_of import BodyModes
from vehicle.model.parameters.hardpoints import Point
from vehicle.signals.formats.channel import Measurement

LARGEST_IMAGINARY = 0.3
"""Maximum imaginary part of a shape over its real part, after the phase rotation that minimises it [1]: shapes of
lightly damped bodies have 0.01 to 0.1; larger values mean two mixed modes, or damping that is far from modal."""
_LOWEST_ELASTIC = 3.0
"""Maximum frequency of rigid-body modes on the soft springs of a test rig [Hz]; car bodies bend from 12 Hz on."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class GivenModes:
    """Modes as stored in a source, in the axes of the source and in metres.

    Attributes:
        body: nodes, with the node and direction of each row of the vectors.
        frequencies: natural frequencies [Hz], shape (modes,).
        damping_ratio: modal damping ratios [1], shape (modes,); NaN where unknown.
        vectors: shapes, complex or real, shape (dofs, modes).
        modal_mass: modal masses of the shapes [kg], shape (modes,); NaN where unknown.
    """

    body: BodyNodes
    frequencies: Vector
    damping_ratio: Vector
    vectors: np.ndarray
    modal_mass: Vector

    def placed(self, axes: str, origin: Point) -> GivenModes:
        """Transform the modes to the vehicle frame; see `BodyNodes.frame`."""
        body, sign = self.body.frame(axes, origin)
        return replace(self, body=body, vectors=self.vectors * sign[:, None])


def modes_of_measurement(measurement: Measurement) -> GivenModes:
    """Return the modes of a universal file: datasets 55 or 2414, with nodes of datasets 15 or 2411.

    Raises:
        DataError: the file contains no shape, or too few nodes with a position.
    """
    if not measurement.shapes:
        raise DataError(
            f"{measurement.path}: contains no mode shapes (datasets 55, 2414), only "
            f"{len(measurement.channels)} channels; export mode shapes."
        )
    points = [
        name for name in measurement.shapes[0].points if all(name in shape.points for shape in measurement.shapes)
    ]
    unplaced = [name for name in points if name not in measurement.geometry.points]
    if unplaced or len(points) < 3:
        raise DataError(
            f"{measurement.path}: {len(points)} nodes appear in all mode shapes; there must be at least 3, and "
            f"{len(unplaced)} of them have no position. Export the geometry (datasets 15, 2411) with the modes."
        )
    rows = [[shape.points.index(name) for name in points] for shape in measurement.shapes]
    table = np.array([shape.shape[row] for shape, row in zip(measurement.shapes, rows, strict=True)])  # (modes, n, 6)
    axes = 6 if np.any(table[:, :, 3:]) else 3
    index = {name: i for i, name in enumerate(points)}
    lines = {
        (min(index[a], index[b]), max(index[a], index[b]))
        for line in measurement.geometry.lines
        for a, b in itertools.pairwise(line)
        if a in index and b in index and a != b
    }
    masses = []
    for shape in measurement.shapes:
        damped = 2.0 * np.pi * shape.frequency * np.sqrt(max(0.0, 1.0 - shape.damping_ratio**2))
        # For a complex mode with small damping, Modal A = 2 j wd m.
        scale = abs(shape.modal_a) / (2.0 * damped) if shape.modal_a and damped else 0.0
        masses.append(shape.modal_mass or scale or np.nan)
    count, origin = len(points), (measurement.format, measurement.program)
    return GivenModes(
        body=BodyNodes(
            nodes=tuple(points),
            positions=np.array([measurement.geometry.points[name] for name in points], dtype=float),
            node=np.repeat(np.arange(count), axes),
            direction=np.tile(np.arange(axes), count),
            edges=np.array(sorted(lines), dtype=int).reshape(-1, 2),
            source=f"modes of {measurement.path.name} ({', '.join(filter(None, origin))})",
        ),
        frequencies=np.array([shape.frequency for shape in measurement.shapes]),
        damping_ratio=np.array([shape.damping_ratio or np.nan for shape in measurement.shapes]),
        vectors=table[:, :, :axes].reshape(len(table), -1).T,
        modal_mass=np.array(masses),
    )


def normalised(
    modes: GivenModes,
    rigid: MassProperties,
    stated_mass: float | None,
    up_to: float,
    residual: Mapping[str, Vector] = MappingProxyType({}),
) -> BodyModes:
    """Select the elastic modes of a source, make them real and scale them to modal mass 1.

    Args:
        modes: modes of the source in the vehicle frame.
        rigid: mass properties of the body.
        stated_mass: modal mass specified by the user, for modes without one in the source [kg].
        up_to: highest frequency of the modes [Hz].
        residual: point name -> measured residual flexibility beyond these modes [m/N], shape (3, 3).

    Raises:
        DataError: a shape has no modal mass or is far from real, or the source has no elastic mode.
    """
    frequencies, vectors, modal_mass = modes.frequencies, modes.vectors, modes.modal_mass
    for k in np.flatnonzero(~(np.isfinite(frequencies) & np.isfinite(vectors).all(axis=0))):
        raise DataError(
            f"mode {k + 1}, at {frequencies[k]:g} Hz: its frequency or shape is not finite. Leave the mode out."
        )
    for k in np.flatnonzero(~vectors.any(axis=0)):
        raise DataError(f"mode {k + 1}, at {frequencies[k]:g} Hz: its shape is zero everywhere. Leave the mode out.")
    order = np.argsort(frequencies, kind="stable")
    elastic = [int(i) for i in order if _LOWEST_ELASTIC < frequencies[i] <= up_to]
    remarks = []
    if low := int(np.sum(frequencies <= _LOWEST_ELASTIC)):
        remarks.append(f"{low} modes up to {_LOWEST_ELASTIC:g} Hz are left out as rigid-body modes")
    if high := int(np.sum(frequencies > up_to)):
        remarks.append(f"{high} modes above {up_to:g} Hz are left out (--up-to)")
    if not elastic:
        raise DataError(
            f"found no mode between {_LOWEST_ELASTIC:g} and {up_to:g} Hz; a body model needs elastic modes "
            "of the free body. Raise --up-to, or export more modes."
        )
    columns, largest = [], 0.0
    for i in elastic:
        shape = vectors[:, i]
        if np.any(np.imag(shape)):
            # The phase that makes the sum of squares real and positive makes the imaginary part smallest.
            rotated = shape * np.exp(-0.5j * np.angle(np.sum(shape**2)))
            part = float(np.linalg.norm(rotated.imag) / np.linalg.norm(rotated.real))
            if part > LARGEST_IMAGINARY:
                raise DataError(
                    f"mode at {frequencies[i]:g} Hz: the shape is complex: its imaginary part is {part:.0%} of "
                    f"the real part, must be at most {LARGEST_IMAGINARY:.0%}. Fit real modes in the modal "
                    "analysis."
                )
            largest, shape = max(largest, part), rotated
        mass = modal_mass[i] if np.isfinite(modal_mass[i]) and modal_mass[i] > 0.0 else stated_mass
        if mass is None:
            raise DataError(
                f"mode at {frequencies[i]:g} Hz: the modal mass is missing, so the shape has no scale. Export "
                "shapes with their modal mass (a modal test needs a driving-point FRF for it), or set "
                "--modal-mass KG."
            )
        columns.append(np.real(shape) / np.sqrt(mass))
    masses = modal_mass[elastic]
    if np.isfinite(masses).any():
        lowest, highest = np.nanmin(masses), np.nanmax(masses)
        remarks.append(
            f"mode shapes are divided by the square root of their modal masses, {lowest:.4g} to {highest:.4g} kg"
        )
    if stated_mass is not None and not np.isfinite(masses).all():
        remarks.append(f"modal mass {stated_mass:g} kg, as requested")
    if largest > 0.0:
        remarks.append(
            f"complex mode shapes are made real; their imaginary part is at most {largest:.2%} of the real part"
        )
    if residual:
        remarks.append(f"measured residual flexibility at {len(residual)} points")
    else:
        remarks.append("no residual flexibility, which needs K and M: a force at a node excites only these modes")
    return BodyModes(
        body=modes.body,
        residual=residual,
        frequencies=frequencies[elastic],
        damping_ratio=modes.damping_ratio[elastic],
        vectors=np.array(columns).T,
        rigid=rigid,
        names=tuple(f"mode {number}" for number in range(1, len(elastic) + 1)),
        remarks=tuple(remarks),
    )
