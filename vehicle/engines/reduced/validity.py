"""Where the motion leaves what the matrices can say.

The matrices are those of the design position. A part that turns by an angle a changes the direction of its forces by a
and lengths by a^2/2; a tyre that lifts off would pull; a spring with a table, or a stop, is its tangent only on the
piece on which the car stands. All are watched, and the run says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.car_matrices import CarMatrices, LinearSegment
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.readout import Readout
from vehicle.engines.reduced.step_factors import StepFactors

Vector = npt.NDArray[np.float64]

LARGEST_ANGLE = 0.05
"""Rotation of a part [rad] up to which the matrices hold. Measured against MuJoCo on roads of growing level: up to here
the comfort value agrees within 0.1 %, the RMS of every channel of body, engine and dampers within 0.2 %, and only the
lateral acceleration of the knuckle, which is made of such rotations, is 1 % off. At 0.13 rad (a road of 43 mm RMS) that
one is 5 % off, and comfort still below 0.1 %. Where it is small it may be more: with one rear wheel of `focus_road`
driven alone 20 %, of a lateral acceleration that is a tenth of the vertical one."""

LOOK_EVERY = 16
"""Samples between two looks: 16 ms at 1 kHz, a tenth of the period of the fastest rigid-body mode."""

LONGEST_LOOK = 0.016
"""Longest time between two looks [s]: where samples are further apart than at 1 kHz, fewer are passed over."""


def check_stride(interval: float) -> int:
    """From one sample that is looked at to the next, samples being `interval` [s] apart."""
    return max(min(LOOK_EVERY, int(LONGEST_LOOK / interval + 1e-9)), 1)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Validity:
    """What a run has shown of the limits of the matrices.

    Attributes:
        angles: largest rotation of each body [rad].
        loads: lowest tyre load of each wheel [N].
        one_sided: wheels whose tyres do not pull.
        left: how far a law over displacement left its piece [m], where it did.
    """

    angles: Mapping[str, float]
    loads: Mapping[str, float]
    one_sided: frozenset[str]
    left: Mapping[str, float]

    @property
    def small_angles(self) -> bool:
        """Whether all parts turned little enough."""
        return all(angle <= LARGEST_ANGLE for angle in self.angles.values())

    @property
    def held(self) -> bool:
        """Whether the motion stayed within what the matrices hold for."""
        return self.small_angles and not self.left and not self.lifted

    @property
    def lifted(self) -> dict[str, float]:
        """Lowest load [N] of each one-sided tyre that would have to pull: MuJoCo lets it go."""
        return {wheel: load for wheel, load in self.loads.items() if wheel in self.one_sided and load < 0.0}

    def warnings(self) -> tuple[str, ...]:
        """A sentence for each way in which the motion left the validity of the matrices."""
        found = []
        worst = max(self.angles, key=lambda body: self.angles[body])
        if not self.small_angles:
            found.append(
                f"{worst} turned by {self.angles[worst]:.3f} rad; the reduced engine, which takes the car "
                f"as linear but for its dampers, holds up to {LARGEST_ANGLE:g} rad: use the MuJoCo engine"
            )
        for name, distance in self.left.items():
            found.append(
                f"{name} left the piece of its table on which the car stands by {1e3 * distance:.2g} mm; the reduced "
                "engine knows that piece alone: use the MuJoCo engine"
            )
        for wheel, load in self.lifted.items():
            found.append(
                f"tyre {wheel} lifts off its plate (load {load:.0f} N in the reduced engine, which is linear): use the "
                "MuJoCo engine"
            )
        for wheel, load in self.loads.items():
            if load < 0.0 and wheel not in self.lifted:
                found.append(
                    f"tyre {wheel} would lift off its plate (lowest load {load:.0f} N); the model pulls there, so the "
                    "result is out of its validity"
                )
        return tuple(found)


def rotating_bodies(matrices: CarMatrices) -> tuple[str, ...]:
    """The first body of each part that turns by itself: bodies that are fixed to each other turn alike."""
    first: dict[str, str] = {}
    for body in matrices.body_rows:
        first.setdefault(matrices.carried_by.get(body, body), body)
    return tuple(body for body in first.values() if body not in matrices.spinning)


def rotation_outputs(model: PoleModel, bodies: Sequence[str]) -> Outputs:
    """Rotations of bodies about three axes; (3 bodies, ...)."""
    turns = np.vstack([model.matrices.body_rows[body][3:] for body in bodies]) @ model.modal
    none = np.zeros((len(turns), len(model.matrices.system.inputs)))
    return Outputs(poles=turns, height=none, velocity=none)


def segment_outputs(model: PoleModel) -> Outputs:
    """Displacements of the laws that bend; (bends, ...)."""
    segments, wheels = model.matrices.segments, len(model.matrices.system.inputs)
    displacements = np.array([segment.row @ model.modal for segment in segments], dtype=complex).reshape(
        -1, len(model.poles)
    )
    height = np.array([-1.0 * (np.arange(wheels) == segment.plate) for segment in segments]).reshape(-1, wheels)
    return Outputs(poles=displacements, height=height, velocity=np.zeros_like(height))


def tyre_outputs(model: PoleModel) -> Outputs:
    """Tyre loads without their static values."""
    return model.outputs([f"tyre_{wheel}_force_z" for wheel in model.matrices.system.inputs])


def exceeded_segments(segments: Sequence[LinearSegment], low: Vector, high: Vector) -> dict[str, float]:
    """How far each bend left its piece [m], of those that did; low, high: extremes of the displacements; (bends,)."""
    excess = [
        max(segment.low - a, b - segment.high)
        for segment, a, b in zip(segments, low.tolist(), high.tolist(), strict=True)
    ]
    return {segment.name: distance for segment, distance in zip(segments, excess, strict=True) if distance > 0.0}


class ValidityWatch:
    """Largest rotation of the parts and lowest tyre loads of a run.

    Args:
        model: the car.
        factors: of the step.
        columns: driven columns, as for `Readout`.
        tyre_load: static tyre loads [N] by wheel.
        interval: between two samples [s].
    """

    def __init__(
        self,
        model: PoleModel,
        factors: StepFactors,
        columns: Sequence[int],
        tyre_load: Mapping[str, float],
        interval: float,
    ) -> None:
        self.every = check_stride(interval)
        self.matrices, self.bodies = (
            model.matrices,
            tuple(body for body in model.matrices.body_rows if body not in model.matrices.spinning),
        )
        self.rotations, self.tyres, self.stretches = (
            Readout(outputs, factors, model.pairs, columns)
            for outputs in (rotation_outputs(model, self.bodies), tyre_outputs(model), segment_outputs(model))
        )
        self.static = np.array([tyre_load[wheel] for wheel in model.matrices.system.inputs])
        self.angle, self.load = np.zeros(len(self.bodies)), self.static.copy()
        self.low, self.high = np.zeros((2, len(model.matrices.segments)))

    def look(self, states: Vector, plates: Vector, before: Vector) -> None:
        """Take a block of samples into account; arguments as of `Readout.at`."""
        seen = slice(None, None, self.every)
        turns = self.rotations.at(states[seen], plates[seen], before[seen]).reshape(len(self.bodies), 3, -1)
        self.angle = np.maximum(self.angle, np.sqrt(np.max(np.sum(turns**2, axis=1), axis=1)))
        loads = self.tyres.at(states[seen], plates[seen], before[seen]) + self.static[:, None]
        self.load = np.minimum(self.load, np.min(loads, axis=1))
        if self.matrices.segments:
            values = self.stretches.at(states, plates, before)
            self.low, self.high = np.minimum(self.low, values.min(axis=1)), np.maximum(self.high, values.max(axis=1))

    def found(self) -> Validity:
        """What was seen."""
        return Validity(
            angles=dict(zip(self.bodies, self.angle.tolist(), strict=True)),
            loads=dict(zip(self.matrices.system.inputs, self.load.tolist(), strict=True)),
            one_sided=self.matrices.one_sided,
            left=exceeded_segments(self.matrices.segments, self.low, self.high),
        )
