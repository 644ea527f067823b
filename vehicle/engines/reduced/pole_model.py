"""The car as a sum over its poles: on the rig all that is nonlinear is the force of the dampers.

With the matrices of `vehicle.engines.linear` (dampers sliding, ideal joints eliminated) the state x = (y, y', f_b)
obeys

    x' = A x + B_z z + B_c z' + E f

with the plate heights z and the nonlinear damper forces f (friction, and what a degressive law adds to D v).
A = V diag(s) V^-1 turns that into one scalar equation for each pole, xi' = s xi + b_z z + b_c z' + e f, and every
channel into a sum over the poles plus what z, z' and f give directly. Of a conjugate pair only one pole is kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.matrices import CarMatrices

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Outputs:
    """Linear outputs w = Re(poles xi) + height z + velocity z'.

    Attributes:
        poles: (outputs, p), twice the row for a pole that stands for a pair.
        height, velocity: (outputs, w) each, in the order of the inputs.
    """

    poles: Complex
    height: Vector
    velocity: Vector

    def __add__(self, other: Outputs) -> Outputs:
        """These outputs, and others behind them."""
        return Outputs(
            poles=np.concatenate([self.poles, other.poles]),
            height=np.concatenate([self.height, other.height]),
            velocity=np.concatenate([self.velocity, other.velocity]),
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PoleModel:
    """Scalar equations of the poles, and what can be read from them.

    Attributes:
        poles: s [rad/s] with imag(s) >= 0, complex ones first; (p,).
        pairs: number of complex ones.
        height, velocity, force: b_z, b_c and e; (p, w) each, in the order of the inputs and of the dampers.
        slip: rows of the damper velocities, real part taken; (w, p).
        modal: displacements u = Re(modal xi) of the velocity coordinates of MuJoCo; (n, p).
        branch: forces f_b = Re(branch xi) of the Maxwell branches; (b, p).
        slope: effect of the velocity of each plate by the static load on the slope, which b_c contains; (p, w), (p, 0)
            for tyres that stand.
        matrices: what the model was made from.
    """

    poles: Complex
    pairs: int
    height: Complex
    velocity: Complex
    force: Complex
    slip: Complex
    modal: Complex
    branch: Complex
    slope: Complex
    matrices: CarMatrices

    def outputs(self, channels: Sequence[str]) -> Outputs:
        """Rows of acceleration channels, as positions, and of tyre force channels (without the static tyre load).

        Args:
            channels: names of `vehicle.names`.
        """
        found = [self._tyre(name) if name.startswith("tyre_") else self._position(name) for name in channels]
        count, wheels = len(self.poles), len(self.matrices.system.inputs)
        return Outputs(
            poles=np.array([row[0] for row in found]).reshape(-1, count),
            height=np.array([row[1] for row in found]).reshape(-1, wheels),
            velocity=np.array([row[2] for row in found]).reshape(-1, wheels),
        )

    def _position(self, channel: str) -> tuple[Complex, Vector, Vector]:
        """Displacement of the place, of which `vehicle.engines.simulation.recorded_acceleration` makes the channel."""
        still = np.zeros(len(self.matrices.system.inputs))
        return self.matrices.system.output(channel)[0] @ self.modal, still, still

    def _tyre(self, channel: str) -> tuple[Complex, Vector, Vector]:
        """Tyre force on the wheel: k (z - J u) + c (z' - J u')."""
        m, wheels = self.matrices, self.matrices.system.inputs
        index = wheels.index(channel.removeprefix("tyre_").removesuffix("_force_z"))
        spring = (m.tyre_rows[index] * m.tyre_stiffness[index]) @ self.modal
        drag = ((m.tyre_rows[index] * m.tyre_damping[index]) @ self.modal) * self.poles
        here = np.zeros(len(wheels))
        here[index] = 1.0
        return -(spring + drag), m.tyre_stiffness[index] * here, m.tyre_damping[index] * here


def pole_model(matrices: CarMatrices) -> PoleModel:
    """Poles, residues and outputs of a car.

    Args:
        matrices: of the assembled car.

    Returns:
        The model, in continuous time.
    """
    form = first_order(matrices.system)
    w = len(form.system.inputs)
    slope = np.zeros((len(form.state), matrices.slope.shape[1]))
    if slope.size:
        mass = form.basis.T @ form.system.mass @ form.basis
        slope[form.velocities] = np.linalg.solve(mass, form.basis.T @ matrices.slope)
    inputs = np.hstack([form.input, form.input_rate, form.friction, slope])
    poles, vectors = np.linalg.eig(form.state)
    kept = np.concatenate([np.flatnonzero(poles.imag > 0.0), np.flatnonzero(poles.imag == 0.0)])
    pairs = int(np.count_nonzero(poles.imag > 0.0))
    residues = np.linalg.solve(vectors, inputs.astype(complex))[kept]
    # A kept pole of a pair stands for its conjugate too.
    weighted = vectors[:, kept] * np.where(np.arange(len(kept)) < pairs, 2.0, 1.0)
    return PoleModel(
        poles=poles[kept].astype(complex),
        pairs=pairs,
        height=residues[:, :w],
        velocity=residues[:, w : 2 * w],
        force=residues[:, 2 * w : residues.shape[1] - slope.shape[1]],
        slip=form.slide @ weighted,
        modal=form.shapes(weighted, poles[kept]),
        branch=weighted[form.branches],
        slope=residues[:, residues.shape[1] - slope.shape[1] :],
        matrices=matrices,
    )
