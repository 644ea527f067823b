"""Linear car with viscous dampers: responses over frequency for any damping constants, from the poles of one car.

The poles contain the damping constants D. Other constants c act as forces f = -(c - D) v of the damper velocities v, so
that with the inputs z at each line

    v = (I + T_vf (c - D))^-1 T_vz z,    y = T_yz z - T_yf (c - D) v,

where T_yz and T_yf are sums over the poles. Other constants need no new poles, only one small system for each line, of
the size of the number of dampers. The linear car whose constants dissipate the energy of a run is the twin of the run.

Source: Woodbury identity for a change of low rank; Golub and Van Loan, Matrix Computations, section 2.1.4.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.pole_model import Outputs, PoleModel


@dataclass(frozen=True, kw_only=True, eq=False)
class LinearTwin:
    """Responses of k outputs and d damper velocities to i inputs and to the forces of the dampers, at m lines.

    Attributes:
        frequency: lines [Hz]; (m,).
        viscous: damping constants D in the poles [N s/m]; (d,).
        outputs: responses T_yz of the outputs to the inputs; (k, i, m).
        slip: responses T_vz of the damper velocities to the inputs; (d, i, m).
        outputs_by_force, slip_by_force: responses T_yf and T_vf to the forces of the dampers; (k, d, m), (d, d, m).
    """

    frequency: Vector
    viscous: Vector
    outputs: Complex
    slip: Complex
    outputs_by_force: Complex
    slip_by_force: Complex

    @cached_property
    def _lines_first(self) -> tuple[Complex, Complex]:
        """Return T_vf and T_vz with the lines first, (m, d, d) and (m, d, i), for the solution of all lines."""
        first, second = (np.moveaxis(response, -1, 0) for response in (self.slip_by_force, self.slip))
        return np.ascontiguousarray(first), np.ascontiguousarray(second)

    def velocities(self, damping: Vector) -> Complex:
        """Return the responses of the damper velocities with damping constants c [N s/m], (d,); (d, i, m)."""
        by_force, by_input = self._lines_first
        # I + T_vf (c - D); (m, d, d).
        coupling = np.eye(len(self.viscous)) + by_force * (damping - self.viscous)
        return np.asarray(np.moveaxis(np.linalg.solve(coupling, by_input), 0, -1))

    def responses(self, damping: Vector) -> Complex:
        """Return the responses of the outputs with damping constants c [N s/m], (d,); (k, i, m)."""
        return self.with_velocities(damping, self.velocities(damping))

    def with_velocities(self, damping: Vector, velocities: Complex) -> Complex:
        """Return the responses of the outputs with damping constants c and the velocities that belong to them."""
        forces = (damping - self.viscous)[:, None, None] * velocities
        return np.asarray(self.outputs - np.einsum("kdm,dim->kim", self.outputs_by_force, forces))


def linear_twin(
    model: PoleModel,
    channels: Sequence[str],
    frequency: Vector,
    plates: Complex | Vector,
    rates: Complex | None = None,
    further: Outputs | None = None,
) -> LinearTwin:
    """Return the responses of channels of a car to inputs, each of which moves all plates.

    Args:
        model: pole model of the car.
        channels: names of accelerations [m/s2] and tyre forces [N].
        frequency: lines [Hz]; (m,).
        plates: displacement of each plate for a unit of each input [m]; (w, i, m), or (w, i, 1) for all lines.
        rates: velocity of each plate [m/s], where it is not the derivative of the displacement (cams); as `plates`.
        further: outputs after the channels.
    """
    s = np.asarray(2j * np.pi * np.asarray(frequency), dtype=np.complex128)
    rates = s * plates if rates is None else rates
    outputs = model.outputs(channels) if further is None else model.outputs(channels) + further
    rows, poles = np.concatenate([outputs.poles, model.slip]), model.poles
    count, force = len(outputs.poles), model.force
    # Re(a xi) for a pole s0 = -sigma + i w, its conjugate and the input u: with a u = A + i B,
    # (A s + A sigma - B w)/((s - s0)(s - s0*)), where A and B are real coefficients times plates.
    sigma, omega = -poles.real, poles.imag
    both = 1.0 / ((s - poles[:, None]) * (s - poles[:, None].conj()))
    residues = np.hstack([model.height, model.velocity])
    turned = residues * (sigma + 1j * omega)[:, None]
    real, imaginary = (np.hstack([part(turned), part(residues)]) for part in (np.real, np.imag))
    parts = np.hstack([rows.real, -rows.imag])
    by_input = np.empty((len(rows), plates.shape[1], s.size), dtype=np.complex128)
    for number in range(plates.shape[1]):
        motion = np.concatenate([np.broadcast_to(plates[:, number], rates[:, number].shape), rates[:, number]])
        motion = np.concatenate([motion, s * motion])
        by_pole = np.concatenate([both * _real_product(each, motion) for each in (real, imaginary)])
        by_input[:, number] = _real_product(parts, by_pole)
    # A constant input: A and A sigma - B w of each row and damper.
    of_force = rows[:, None, :] * force.T
    terms = np.stack([of_force.real, (of_force * (sigma + 1j * omega)).real]).reshape(-1, len(poles))
    slope, level = _real_product(terms, both).reshape(2, len(rows), force.shape[1], s.size)
    by_force = s * slope + level
    by_input[:count] += np.tensordot(outputs.height, plates, 1) + np.tensordot(outputs.velocity, rates, 1)
    # The rows of an acceleration return its displacement.
    accelerations = [not channel.startswith("tyre_") for channel in channels]
    scale = np.ones((count, 1, s.size), dtype=np.complex128)
    scale[np.flatnonzero(accelerations)] = s**2
    return LinearTwin(
        frequency=np.asarray(frequency),
        viscous=model.matrices.viscous,
        outputs=scale * by_input[:count],
        slip=by_input[count:],
        outputs_by_force=scale * by_force[:count],
        slip_by_force=by_force[count:],
    )


def _real_product(matrix: Vector, lines: Complex | Vector) -> Complex:
    """Return the product of a real matrix (a, b) and complex lines (b, m) by real numbers; (a, m)."""
    lines = np.ascontiguousarray(lines, dtype=np.complex128)
    return np.asarray((matrix @ lines.view(np.float64)).view(np.complex128))
