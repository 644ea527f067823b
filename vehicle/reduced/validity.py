"""Where the motion leaves what the matrices can say.

The matrices are those of the design position. A part that turns by an angle a changes the direction of its forces by a
and lengths by a^2/2; a tyre that lifts off would pull; a spring with a table, or a stop, is its tangent only on the
piece on which the car stands. All are watched, and the run says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from vehicle.reduced.pole_model import Outputs, PoleModel
from vehicle.reduced.readout import Readout
from vehicle.reduced.step_factors import StepFactors

Vector = npt.NDArray[np.float64]

LARGEST_ANGLE = 0.05
"""Rotation of a part [rad] up to which the matrices hold. Measured against MuJoCo on roads of growing level: up to here
the comfort value agrees within 0.1 %, the RMS of every channel of body, engine and dampers within 0.2 %, and only the
lateral acceleration of the knuckle, which is made of such rotations, is 1 % off. At 0.13 rad (a road of 43 mm RMS) that
one is 5 % off, and comfort still below 0.1 %."""

LOOK_EVERY = 16
"""Samples between two looks: 16 ms at 1 kHz, a tenth of the period of the fastest rigid-body mode."""


class ValidityWatch:
    """Largest rotation of the parts and lowest tyre loads of a run.

    Args:
        model: the car.
        factors: of the step.
        columns: driven columns, as for `Readout`.
        tyre_load: static tyre loads [N] by wheel.
    """

    def __init__(
        self, model: PoleModel, factors: StepFactors, columns: Sequence[int], tyre_load: Mapping[str, float]
    ) -> None:
        rows = model.matrices.body_rows
        self.bodies, self.wheels = tuple(rows), model.matrices.system.inputs
        turns = np.vstack([rows[body][3:] for body in self.bodies]) @ model.modal
        none = np.zeros((len(turns), len(model.matrices.system.inputs)))
        rotations = Outputs(poles=turns, height=none, velocity=none)
        self.rotations = Readout(rotations, factors, model.pairs, columns)
        self.tyres = Readout(
            model.outputs([f"tyre_{wheel}_force_z" for wheel in self.wheels]), factors, model.pairs, columns
        )
        self.bends, self.one_sided = model.matrices.bends, model.matrices.one_sided
        rows_of = [bend.row @ model.modal for bend in self.bends]
        stretch = np.array(rows_of, dtype=complex).reshape(-1, len(model.poles))
        height = np.array([-1.0 * (np.arange(len(self.wheels)) == bend.plate) for bend in self.bends])
        height = height.reshape(-1, len(self.wheels))
        stretches = Outputs(poles=stretch, height=height, velocity=np.zeros_like(height))
        self.stretches = Readout(stretches, factors, model.pairs, columns)
        self.left: dict[str, float] = {}
        self.static = np.array([tyre_load[wheel] for wheel in self.wheels])
        self.angle = np.zeros(len(self.bodies))
        self.load = self.static.copy()

    def look(self, states: Vector, plates: Vector, before: Vector) -> None:
        """Take a block of samples into account; arguments as of `Readout.at`."""
        seen = slice(None, None, LOOK_EVERY)
        turns = self.rotations.at(states[seen], plates[seen], before[seen]).reshape(len(self.bodies), 3, -1)
        self.angle = np.maximum(self.angle, np.sqrt(np.max(np.sum(turns**2, axis=1), axis=1)))
        loads = self.tyres.at(states[seen], plates[seen], before[seen]) + self.static[:, None]
        self.load = np.minimum(self.load, np.min(loads, axis=1))

        if self.bends:
            for bend, values in zip(self.bends, self.stretches.at(states, plates, before), strict=True):
                worst = float(max(bend.low - np.min(values), np.max(values) - bend.high))
                if worst > 0.0:
                    self.left[bend.name] = max(worst, self.left.get(bend.name, 0.0))

    @property
    def small_angles(self) -> bool:
        """Whether all parts turned little enough."""
        return bool(np.max(self.angle) <= LARGEST_ANGLE)

    @property
    def held(self) -> bool:
        """Whether the motion stayed within what the matrices hold for."""
        return self.small_angles and not self.left and not self.lifted

    @property
    def lifted(self) -> dict[str, float]:
        """Lowest load [N] of each one-sided tyre that would have to pull: MuJoCo lets it go."""
        loads = zip(self.wheels, self.load.tolist(), strict=True)
        return {wheel: load for wheel, load in loads if wheel in self.one_sided and load < 0.0}

    def warnings(self) -> tuple[str, ...]:
        """A sentence for each way in which the motion left the validity of the matrices."""
        found = []
        worst = int(np.argmax(self.angle))
        if not self.small_angles:
            found.append(
                f"{self.bodies[worst]} turned by {self.angle[worst]:.3f} rad; the reduced engine, which takes the car "
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
        for wheel, load in zip(self.wheels, self.load, strict=True):
            if load < 0.0 and wheel not in self.lifted:
                found.append(
                    f"tyre {wheel} would lift off its plate (lowest load {load:.0f} N); the model pulls there, so the "
                    "result is out of its validity"
                )
        return tuple(found)
