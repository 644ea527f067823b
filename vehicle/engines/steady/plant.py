"""Linear car between its ports, its inputs and its outputs, from its poles.

At the angular frequency w every motion of the car is y = Y0 z - Y p with the inputs z, its plates or the applied forces
of a model that has some, and the forces p of the ports, which act against their motions. The base rows are damper
velocities, then displacements of Jenkins groups and of laws over displacement. The base columns are the forces of the
same elements.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.linear_motion import SLOWEST
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.steady.channel_rows import ChannelRows, plain_rows


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Responses:
    """Responses of rows at m angular frequencies.

    Attributes:
        forces: to the forces of base columns, as they act along their rows; (rows, columns, m).
        slopes: to the slope velocities of rolling tyres; (rows, w, m), (rows, 0, m) for standing tyres.
        inputs: to the displacements of the plates, or to the applied forces; (rows, i, m).
    """

    forces: Complex
    slopes: Complex
    inputs: Complex


class Plant:
    """Linear car with rows of ports and of channels.

    Args:
        model: pole model.
        moved: stiffness of each base row that moves into its law, see `CarPorts`; (base rows,).
        channels: further rows.

    Attributes:
        base: number of the base rows, which come first.
    """

    def __init__(self, model: PoleModel, moved: Vector, channels: ChannelRows) -> None:
        self.model, self.moved, self.base = model, moved, len(moved)
        none = np.zeros((len(model.slip), model.height.shape[1]))
        slip = Outputs(poles=model.slip, height=none, velocity=none)
        self._rows = plain_rows(model, slip + model.scalar_rows) + channels

    def responses(self, speeds: Vector) -> Responses:
        """Return the responses at angular frequencies w [rad/s]; (m,)."""
        model, rows, wheels = self.model, self._rows.outputs, self.model.height.shape[1]
        columns = np.hstack([model.force, model.scalar_force, model.slope, model.height, model.velocity, model.applied])
        table = _transfer(model, rows.poles, columns, speeds)
        s = 1j * speeds
        ends = np.cumsum([len(self.moved), model.slope.shape[1], wheels, wheels])
        forces, slopes, height, velocity, applied = np.split(table, ends, axis=1)
        forces, slopes = forces + self._rows.forces[:, :, None], slopes + self._rows.slopes[:, :, None]
        inputs = height + s * velocity + rows.height[:, :, None] + s * rows.velocity[:, :, None]
        if applied.shape[1]:
            inputs = applied + self._rows.applied[:, :, None]
        # The rows of accelerations are displacements.
        second = np.where(self._rows.accelerations[:, None], s**2, 1.0)[:, None]
        forces, slopes, inputs = second * forces, second * slopes, second * inputs
        at = np.flatnonzero(self.moved)
        if at.size:
            # A stiffness k less in the car: its row has w = W - G (p - k w), so w = (1 - G k)^-1 (W - G p).
            inner = np.moveaxis(forces[at][:, at] * self.moved[at][None, :, None], -1, 0)
            inverse = np.moveaxis(np.linalg.inv(np.eye(at.size) - inner), 0, -1)
            gain = np.einsum("rim,ijm->rjm", forces[:, at] * self.moved[at][None, :, None], inverse)
            forces, slopes, inputs = (
                each + np.einsum("rjm,jcm->rcm", gain, each[at]) for each in (forces, slopes, inputs)
            )
        return Responses(forces=forces, slopes=slopes, inputs=inputs)


def _transfer(model: PoleModel, rows: Complex, columns: Complex, speeds: Vector) -> Complex:
    """Return Re(rows xi) by unit inputs with residues (p, c) at jw; (rows, c, m).

    A pair s, s* with the product a = row times residue has (a/(jw - s) + a*/(jw - s*))/2, which is
    (jw Re a - Re(a s*))/((jw)^2 - 2 jw Re s + |s|^2): real tables of all products, and one factor a pole.
    """
    pairs, s = model.pairs, model.poles
    products = rows[:, None, :] * columns.T[None]
    count = products.shape[0] * products.shape[1]
    rising = np.where(np.arange(len(s)) < pairs, products.real, 0.0)
    constant = np.where(np.arange(len(s)) < pairs, -(products * s.conj()).real, products.real)
    jw = 1j * speeds[:, None]
    held = (speeds[:, None] != 0.0) | (np.abs(s) > SLOWEST)
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = 1.0 / np.where(np.arange(len(s)) < pairs, jw**2 - 2.0 * jw * s.real + np.abs(s) ** 2, jw - s.real)
    # The constant part of a motion that nothing holds stays unknown.
    factor = np.where(held, factor, 0.0)
    parts = np.vstack([factor.real, factor.imag])
    first, second = (parts @ table.reshape(count, -1).T for table in (rising, constant))
    m = len(speeds)
    result = jw * (first[:m] + 1j * first[m:]) + second[:m] + 1j * second[m:]
    return np.asarray(result.T.reshape(products.shape[0], products.shape[1], m))
