"""Modes that a program or a modal test gives at points: real, mass-normalised, without rigid-body modes."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources.body_matrices import BodyNodes
from vehicle.model.flexbody.sources.superelement_of import BodyModes
from vehicle.model.parameters.hardpoints import Point
from vehicle.signals.records.channel import Measurement

LARGEST_IMAGINARY = 0.3
"""Largest imaginary part of a shape over its real one, after the phase that makes it smallest [1]: shapes of lightly
damped bodies have 0.01 to 0.1; beyond, two modes are mixed, or damping is not spread as modal damping assumes."""
_LOWEST_ELASTIC = 3.0
"""Frequency up to which a mode is one of a body on the soft springs of its test rig [Hz]; cars bend from 12 Hz on."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class GivenModes:
    """Modes as a source has them, in its axes and in metres.

    Attributes:
        body: nodes, and what each row of the vectors is.
        frequencies: [Hz], shape (modes,).
        damping_ratio: [1], shape (modes,); NaN where the source tells none.
        vectors: shapes, complex or real, shape (dofs, modes).
        modal_mass: of them [kg], shape (modes,); NaN where the source tells none.
    """

    body: BodyNodes
    frequencies: FloatArray
    damping_ratio: FloatArray
    vectors: np.ndarray
    modal_mass: FloatArray

    def placed(self, axes: str, origin: Point) -> GivenModes:
        """The same in the vehicle frame, as of `BodyNodes.frame`."""
        body, sign = self.body.frame(axes, origin)
        return replace(self, body=body, vectors=self.vectors * sign[:, None])


def modes_of_measurement(found: Measurement) -> GivenModes:
    """The modes of a universal file: datasets 55 or 2414, with nodes of 15 or 2411.

    Raises:
        DataError: it holds no shape, or no place of a node.
    """
    if not found.shapes:
        raise DataError(f"{found.path}: no mode shapes (datasets 55, 2414); it has {len(found.channels)} channels.")
    points = [name for name in found.shapes[0].points if all(name in shape.points for shape in found.shapes)]
    lost = [name for name in points if name not in found.geometry.points]
    if lost or len(points) < 3:
        raise DataError(
            f"{found.path}: {len(points)} nodes are in all shapes, {len(lost)} of them without a place; at least 3 "
            "with a place are needed. Export the geometry (datasets 15, 2411) with the modes."
        )
    rows = [[shape.points.index(name) for name in points] for shape in found.shapes]
    table = np.array([shape.shape[row] for shape, row in zip(found.shapes, rows, strict=True)])  # (modes, n, 6)
    axes = 6 if np.any(table[:, :, 3:]) else 3
    index = {name: i for i, name in enumerate(points)}
    lines = {
        (min(index[a], index[b]), max(index[a], index[b]))
        for line in found.geometry.lines
        for a, b in itertools.pairwise(line)
        if a in index and b in index and a != b
    }
    masses = []
    for shape in found.shapes:
        damped = 2.0 * np.pi * shape.frequency * np.sqrt(max(0.0, 1.0 - shape.damping_ratio**2))
        # Of a complex mode with small damping, Modal A = 2 j wd m.
        scale = abs(shape.modal_a) / (2.0 * damped) if shape.modal_a and damped else 0.0
        masses.append(shape.modal_mass or scale or np.nan)
    count = len(points)
    return GivenModes(
        body=BodyNodes(
            nodes=tuple(points),
            positions=np.array([found.geometry.points[name] for name in points], dtype=float),
            node=np.repeat(np.arange(count), axes),
            direction=np.tile(np.arange(axes), count),
            edges=np.array(sorted(lines), dtype=int).reshape(-1, 2),
            source=f"modes of {found.path.name} ({found.format}{', ' + found.program if found.program else ''})",
        ),
        frequencies=np.array([shape.frequency for shape in found.shapes]),
        damping_ratio=np.array([shape.damping_ratio or np.nan for shape in found.shapes]),
        vectors=table[:, :, :axes].reshape(len(table), -1).T,
        modal_mass=np.array(masses),
    )


def normalised(
    given: GivenModes,
    rigid: MassProperties,
    stated_mass: float | None,
    up_to: float,
    residual: Mapping[str, FloatArray] = MappingProxyType({}),
) -> BodyModes:
    """Elastic modes with modal mass 1.

    Args:
        given: modes as the source has them, in the vehicle frame.
        rigid: mass properties of the body.
        stated_mass: modal mass that the user states where the source tells none [kg].
        up_to: modes above are left out [Hz].
        residual: flexibility of attachments beyond these modes [m/N], (3, 3) each, where it was measured.

    Raises:
        DataError: a shape without modal mass, one that is far from real, or no elastic mode.
    """
    frequencies, vectors, modal_mass = given.frequencies, given.vectors, given.modal_mass
    for k in np.flatnonzero(~(np.isfinite(frequencies) & np.isfinite(vectors).all(axis=0))):
        raise DataError(f"mode {k + 1}, at {frequencies[k]:g} Hz: its frequency or shape is not finite.")
    for k in np.flatnonzero(~vectors.any(axis=0)):
        raise DataError(f"mode {k + 1}, at {frequencies[k]:g} Hz: its shape is zero everywhere. Leave it out.")
    order = np.argsort(frequencies, kind="stable")
    elastic = [int(i) for i in order if _LOWEST_ELASTIC < frequencies[i] <= up_to]
    remarks = []
    if low := int(np.sum(frequencies <= _LOWEST_ELASTIC)):
        remarks.append(f"{low} modes up to {_LOWEST_ELASTIC:g} Hz left out as rigid-body modes")
    if high := int(np.sum(frequencies > up_to)):
        remarks.append(f"{high} modes above {up_to:g} Hz left out")
    if not elastic:
        raise DataError(
            f"no mode between {_LOWEST_ELASTIC:g} and {up_to:g} Hz; a body model needs elastic modes of the free body."
        )
    columns, largest = [], 0.0
    for i in elastic:
        shape = vectors[:, i]
        if np.any(np.imag(shape)):
            turned = shape * np.exp(-0.5j * np.angle(np.sum(shape**2)))
            part = float(np.linalg.norm(turned.imag) / np.linalg.norm(turned.real))
            if part > LARGEST_IMAGINARY:
                raise DataError(
                    f"mode at {frequencies[i]:g} Hz: complex, its imaginary part is {part:.0%} of the real one, "
                    f"allowed are {LARGEST_IMAGINARY:.0%}. Fit real normal modes in the modal analysis."
                )
            largest, shape = max(largest, part), turned
        mass = modal_mass[i] if np.isfinite(modal_mass[i]) and modal_mass[i] > 0.0 else stated_mass
        if mass is None:
            raise DataError(
                f"mode at {frequencies[i]:g} Hz: no modal mass, and so no scale. Export scaled shapes with their modal "
                "mass (a driving-point FRF scales a modal test), or say which it is with --modal-mass."
            )
        columns.append(np.real(shape) / np.sqrt(mass))
    masses = modal_mass[elastic]
    if np.isfinite(masses).any():
        least, most = np.nanmin(masses), np.nanmax(masses)
        remarks.append(f"shapes divided by the root of their modal masses, {least:.4g} to {most:.4g} kg")
    if stated_mass is not None and not np.isfinite(masses).all():
        remarks.append(f"modal mass {stated_mass:g} kg stated by the user")
    if largest > 0.0:
        remarks.append(f"complex shapes made real; their imaginary part is at most {largest:.2%} of the real one")
    if residual:
        remarks.append(f"residual flexibility of {len(residual)} points as measured")
    else:
        remarks.append("without K and M there is no residual flexibility: forces at a node bend the kept modes only")
    return BodyModes(
        body=given.body,
        residual=residual,
        frequencies=frequencies[elastic],
        damping_ratio=given.damping_ratio[elastic],
        vectors=np.array(columns).T,
        rigid=rigid,
        names=tuple(f"mode {number}" for number in range(1, len(elastic) + 1)),
        remarks=tuple(remarks),
    )
