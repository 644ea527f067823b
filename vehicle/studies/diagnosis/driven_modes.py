"""Modes of the driven car: natural frequency and damping of body and wheels about the motion on its road.

Friction and bent curves of a damper depend on the motion, so each damper of a simulated drive is replaced by the
viscous constant of least mean square error, which dissipates the same energy (statistical linearisation),

    c = mean((F - mean F) v)/mean(v^2),    A = A_D - N diag(c - D) V,

with the first-order form of the car (`vehicle.engines.linear.first_order`), whose poles contain the constants D. Of the
eigenvalues s of A, the mode of a motion, for example the heave of the body, is that with the largest share of the
motion in its kinetic energy: the frequency is |s|/(2 pi), the damping ratio -Re(s)/|s|. Both are further unknowns of
the regression (`learned`). A damper that sticks ties its wheel to the body: the wheel hop rises towards 25 Hz.

Source: Caughey, J. Acoust. Soc. Am. 35 (1963) 1706; Roberts and Spanos, Random Vibration and Statistical Linearization,
1990, chapter 2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.part_motions import rigid_rows
from vehicle.engines.reduced.batch_simulation import BatchRuns
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.studies.diagnosis.learned import Learned, Posterior

FASTEST = 45.0
"""Largest natural frequency [Hz]: above the hop of a wheel with a damper that sticks (25 to 30 Hz)."""

BODY = {"body heave": 2, "body pitch": 4, "body roll": 3}
"""Motions of the body, and their rows in `rigid_rows`."""


class ModeValues(NamedTuple):
    """Natural frequency [Hz] and damping ratio [-] of a mode."""

    frequency: float
    damping: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DrivenMode:
    """Mode of the driven car.

    Attributes:
        motion: "body heave", "body pitch", "body roll", or "hop" and a wheel.
        frequency: log10 of the natural frequency [Hz].
        damping: damping ratio [-].
        nominal: values of the car that is not worn, on a road of the same level.
    """

    motion: str
    frequency: Posterior
    damping: Posterior
    nominal: ModeValues


def damper_channels(poles: PoleModel) -> tuple[str, ...]:
    """Return the channels of velocities and of forces of all dampers."""
    names = poles.matrices.damper_names
    return tuple(f"{name}_{quantity}" for quantity in ("velocity", "force") for name in names)


def equivalent_constants(batch: BatchRuns, poles: PoleModel, skipped: int) -> Vector:
    """Return the constants c of the dampers [N s/m], (cars, dampers), from samples after the first `skipped` ones."""
    samples = np.stack([batch.channels[name][:, skipped:] for name in damper_channels(poles)], axis=1)
    velocity, force = np.split(samples - samples.mean(axis=2, keepdims=True), 2, axis=1)
    return np.asarray(np.mean(force * velocity, axis=2) / np.mean(velocity**2, axis=2))


def driven_modes(poles: PoleModel, constants: Vector) -> dict[str, ModeValues]:
    """Return the modes of a car by motion.

    Args:
        poles: car with the constants D.
        constants: constants c of its dampers [N s/m]; (dampers,).
    """
    matrices, form = poles.matrices, first_order(poles.matrices.system)
    state = form.state - form.friction @ ((constants - matrices.viscous)[:, None] * form.slide)
    eigenvalues, vectors = np.linalg.eig(state)
    swinging = (eigenvalues.imag > 0.0) & (np.abs(eigenvalues) < 2.0 * np.pi * FASTEST)
    s = eigenvalues[swinging]
    shape = form.shapes(vectors[:, swinging], s)
    energy = np.einsum("ni,nm,mi->i", shape.conj(), matrices.system.mass, shape).real
    modes = {}
    for motion, row in _rows(matrices).items():
        pole = s[np.argmax(np.abs(row @ shape) ** 2 / energy)]
        modes[motion] = ModeValues(float(np.abs(pole)) / (2.0 * np.pi), float(-pole.real / np.abs(pole)))
    return modes


def _rows(matrices: CarMatrices) -> dict[str, Vector]:
    """Return the rows of the energy coordinates of the motions; motion to (n,)."""
    rigid = rigid_rows(matrices)
    rows = {motion: rigid["body"][axis] for motion, axis in BODY.items() if "body" in rigid}
    wheels = {f"hop {wheel}": f"wheel_{wheel}" for wheel in matrices.system.inputs}
    return rows | {motion: rigid[group][2] for motion, group in wheels.items() if group in rigid}


class ModeFit:
    """Regression of the modes over the features of a record.

    Args:
        features: features of simulated drives; (n, p).
        modes: modes of the first drives.
        level: level of the roads of the drives; (n,).
        block: number of successive drives that are left out as one.
    """

    def __init__(self, features: Vector, modes: Sequence[Mapping[str, ModeValues]], level: Vector, block: int) -> None:
        self.motions = tuple(modes[0])
        values = np.array([[each[motion] for motion in self.motions] for each in modes])
        columns = np.concatenate([np.log10(values[:, :, 0]), values[:, :, 1], level[: len(modes), None]], axis=1)
        self.learned = Learned(features[: len(modes)], columns, block)

    def modes(self, features: Vector, widened: float, nominal: Mapping[str, ModeValues]) -> tuple[DrivenMode, ...]:
        """Return the modes of a record.

        Args:
            features: features of the record; (p,).
            widened: factor of the scale of the errors.
            nominal: modes of the car that is not worn.
        """
        posteriors = self.learned.posteriors(features, widened)
        count = len(self.motions)
        return tuple(
            DrivenMode(
                motion=motion, frequency=posteriors[row], damping=posteriors[count + row], nominal=nominal[motion]
            )
            for row, motion in enumerate(self.motions)
        )
