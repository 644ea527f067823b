"""Car as a sum over its poles, with nonlinear forces of dampers and of laws over one displacement each.

With the matrices of `vehicle.engines.linear` (dampers sliding, ideal joints eliminated) the state x = (y, y', f_b)
obeys

    x' = A x + B_z z + B_c z' + E f

with the plate displacements z and the nonlinear forces f: of the dampers (friction, and the excess of a degressive law
over D v), and of the scalar elements, each over one displacement (groups of Jenkins elements of presliding friction,
then the laws of `vehicle.engines.linear.displacement_laws` beyond their tangent). A = V diag(s) V^-1 transforms this
into one scalar equation for each pole, xi' = s xi + b_z z + b_c z' + e f, and every channel into a sum over the poles
plus direct terms of z, z' and f. Only one pole of a conjugate pair is stored.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.displacement_laws import DisplacementLaw, law_rows
from vehicle.engines.linear.first_order import first_order


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Outputs:
    """Linear outputs w = Re(poles xi) + height z + velocity z'.

    Attributes:
        poles: rows over the poles (outputs, p), doubled for a pole that represents a conjugate pair.
        height, velocity: rows over z and z', (outputs, w) each, in the order of the inputs.
    """

    poles: Complex
    height: Vector
    velocity: Vector

    def changed(self, change: Callable[[Any], Any]) -> Outputs:
        """Return the outputs with a change of each array."""
        return Outputs(poles=change(self.poles), height=change(self.height), velocity=change(self.velocity))

    def part(self, rows: slice | list[int]) -> Outputs:
        """Return some of the outputs."""
        return self.changed(lambda array: array[rows])

    def __add__(self, other: Outputs) -> Outputs:
        """Return these outputs followed by others."""
        return Outputs(
            poles=np.concatenate([self.poles, other.poles]),
            height=np.concatenate([self.height, other.height]),
            velocity=np.concatenate([self.velocity, other.velocity]),
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PoleModel:
    """Scalar equations of the poles and their outputs.

    Attributes:
        poles: s [rad/s] with imag(s) >= 0, complex poles first; (p,).
        pairs: number of complex poles.
        height, velocity, force: b_z, b_c and e; (p, w) each, in the order of the inputs and of the dampers.
        slip: rows of the damper velocities, real part taken; (w, p).
        modal: displacements u = Re(modal xi) of the velocity coordinates of MuJoCo; (n, p).
        branch: forces f_b = Re(branch xi) of the Maxwell branches; (b, p).
        slope: effect of the velocity of each plate due to the static load on the slope, a part of b_c; (p, w), (p, 0)
            for standing tyres.
        applied: effect of each history of the applied forces; (p, lines).
        matrices: matrices of the car.
        scalar_rows: displacements x of the g scalar elements: groups of Jenkins elements, then the laws.
        scalar_force: effect of their forces; (p, g).
        laws: nonlinear laws over displacement.
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
    applied: Complex
    matrices: CarMatrices
    scalar_rows: Outputs
    scalar_force: Complex
    laws: tuple[DisplacementLaw, ...] = ()

    def __repr__(self) -> str:
        """One line."""
        return f"PoleModel({len(self.poles)} poles, {self.pairs} of them complex, {self.slip.shape[0]} dampers)"

    @property
    def groups(self) -> int:
        """Return the number of groups of Jenkins elements, which come before the laws over displacement."""
        return int(self.scalar_force.shape[1]) - len(self.laws)

    @property
    def law_outputs(self) -> Outputs:
        """Return the displacements x of the laws over displacement as outputs."""
        return self.scalar_rows.part(slice(self.groups, None))

    @property
    def element_forces(self) -> Complex:
        """Return the effects of the forces of all nonlinear elements: dampers, then laws over displacement; (p, e).

        The force of a damper contains those of its Jenkins elements.
        """
        return np.hstack([self.force, self.scalar_force[:, self.groups :]])

    @property
    def element_outputs(self) -> Outputs:
        """Return the displacements of all nonlinear elements, in the order of `element_forces`, as outputs."""
        none = np.zeros((self.force.shape[1], self.height.shape[1]))
        slides = Outputs(poles=self.matrices.system.slide_rows @ self.modal, height=none, velocity=none)
        return slides + self.law_outputs

    @property
    def forced(self) -> bool:
        """True if forces or tyres of the car shake it on a level road too."""
        return self.matrices.forced

    def without_forces(self) -> PoleModel:
        """Return the model without applied forces."""
        return replace(self, applied=self.applied[:, :0], matrices=self.matrices.without_forces())

    def outputs(self, channels: Sequence[str]) -> Outputs:
        """Return the rows of acceleration channels, as displacements, and of dynamic tyre force channels."""
        m, wheels = self.matrices, self.matrices.system.inputs
        poles = np.zeros((len(channels), len(self.poles)), dtype=np.complex128)
        height, velocity = np.zeros((2, len(channels), len(wheels)))
        for row, channel in enumerate(channels):
            if not channel.startswith("tyre_"):
                poles[row] = m.system.output(channel)[0] @ self.modal
                continue
            # The tyre force on the wheel: k (z - J u) + c (z' - J u').
            index = wheels.index(channel.removeprefix("tyre_").removesuffix("_force_z"))
            spring = (m.tyre_rows[index] * m.tyre_stiffness[index]) @ self.modal
            drag = ((m.tyre_rows[index] * m.tyre_damping[index]) @ self.modal) * self.poles
            poles[row] = -(spring + drag)
            height[row, index], velocity[row, index] = m.tyre_stiffness[index], m.tyre_damping[index]
        return Outputs(poles=poles, height=height, velocity=velocity)


# Cars that differ in friction or in curves beyond their softest slope share their matrices (`VariantTerms.variant`).
@lru_cache(maxsize=16)
def pole_model(matrices: CarMatrices) -> PoleModel:
    """Return poles, residues and outputs of an assembled car in continuous time."""
    form = first_order(matrices.system)
    w = len(form.system.inputs)
    scalars = np.concatenate(
        [matrices.sliders.rows.reshape(-1, matrices.system.size), law_rows(matrices.laws, matrices.system.size)]
    )
    lines = matrices.coefficients.shape[1]
    further = np.zeros((len(form.state), matrices.slope.shape[1] + len(scalars) + lines))
    if further.size:
        mass = form.basis.T @ form.system.mass @ form.basis
        slope = matrices.slope.reshape(len(form.basis), -1)
        effects = np.hstack([slope, scalars.T, matrices.applied])
        # A force along the row l changes the velocities of the free motions by (N' M N)^-1 N' l.
        further[form.velocities] = np.linalg.solve(mass, form.basis.T @ effects)
    if lines:
        # The velocity of a tread strains the branch of its slip, without a force on a coordinate.
        further[form.branches, further.shape[1] - lines :] = matrices.slips
    inputs = np.hstack([form.input, form.input_rate, form.friction, further])
    # x = V xi: b = V^-1 B are the residues, and the outputs are rows times V.
    poles, vectors = np.linalg.eig(form.state)
    selected = np.concatenate([np.flatnonzero(poles.imag > 0.0), np.flatnonzero(poles.imag == 0.0)])
    pairs = int(np.count_nonzero(poles.imag > 0.0))
    residues = np.linalg.solve(vectors, inputs.astype(complex))[selected]
    # A stored pole of a pair represents its conjugate too.
    weighted = vectors[:, selected] * np.where(np.arange(len(selected)) < pairs, 2.0, 1.0)
    modal = form.shapes(weighted, poles[selected])
    # Ends of the columns of forces and of slopes; scalar forces and applied forces follow.
    forces, slopes = np.cumsum([2 * w + form.friction.shape[1], matrices.slope.shape[1]])
    # Displacements x = d + tau d' of the scalar elements, over the plates of their tyres.
    displacements, groups = scalars @ modal, len(scalars) - len(matrices.laws)
    rate_time = np.concatenate([np.zeros(groups), [law.rate_time for law in matrices.laws]])[:, None]
    plates = np.array([-1] * groups + [law.plate for law in matrices.laws], dtype=int)[:, None]
    # -1 in the column of the plate of a tyre: the deflection is the wheel less the plate; (g, w).
    over = -1.0 * (plates == np.arange(w))
    return PoleModel(
        poles=poles[selected].astype(complex),
        pairs=pairs,
        height=residues[:, :w],
        velocity=residues[:, w : 2 * w],
        force=residues[:, 2 * w : forces],
        slip=form.slide @ weighted,
        modal=modal,
        branch=weighted[form.branches],
        slope=residues[:, forces:slopes],
        matrices=matrices,
        scalar_rows=Outputs(
            # d' of a pole is s d.
            poles=displacements + rate_time * displacements * poles[selected],
            height=over,
            velocity=rate_time * over,
        ),
        scalar_force=residues[:, slopes : residues.shape[1] - lines],
        applied=residues[:, residues.shape[1] - lines :],
        laws=matrices.laws,
    )
