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
        forces = (damping - self.viscous)[:, None, None] * self.velocities(damping)
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
    rows = np.concatenate([outputs.poles, model.slip])
    # Re(a xi) = (a xi + conj(a xi))/2: a stored pole and its conjugate.
    by_input = np.zeros((len(rows), plates.shape[1], s.size), dtype=np.complex128)
    by_force = np.zeros((len(rows), model.force.shape[1], s.size), dtype=np.complex128)
    pole = (model.poles, 0.5 * rows, model.height, model.velocity, model.force)
    for poles, half, height, velocity, force in (pole, tuple(np.conj(array) for array in pole)):
        resolvent = 1.0 / (s - poles[:, None])
        for number in range(plates.shape[1]):
            by_input[:, number] += half @ ((height @ plates[:, number] + velocity @ rates[:, number]) * resolvent)
        by_force += (half[:, None, :] * force.T) @ resolvent
    count = len(outputs.poles)
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
