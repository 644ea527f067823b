"""Car on plates that repeat: its ports in the periodic state, and every channel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.linear_motion import SLOWEST
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.simulation.recorded_acceleration import acceleration_gain
from vehicle.engines.steady.car_ports import car_ports
from vehicle.engines.steady.channel_rows import ChannelRows, plain_rows, tyre_rows
from vehicle.engines.steady.cycle import Cycle
from vehicle.engines.steady.plant import Plant
from vehicle.engines.steady.splitting import LADDER, PeriodicForces, PresentLoad, periodic_forces
from vehicle.model.parameters.force_elements import Damper

LINES = 2**14
"""Lines that are computed together, which limits the memory."""

SCALED = (1.0, 8.0)
"""Band whose mean |G| sets the scaling of a random road [Hz]: the body and its dampers move there."""


class DrivenCar:
    """Linear car on periodic plates, between the ports of its laws.

    Args:
        model: pole model.
        dampers: laws of the dampers.
        tyre_load: static tyre loads by wheel [N].
        plates: lines of the plates, see `plate_lines`; (w, k).
        period: period T [s].

    Attributes:
        ports: laws.
        cycle: samples of the period.
        effects: G, motions of the ports against their forces; (ports, ports, k).
        drive: W, motions without these forces; (ports, k).
        slopes: effect of the slope velocities of rolling tyres on the motions; (ports, w, k).
        present: forces of rolling tyres by their present load; None for standing tyres.
    """

    def __init__(
        self,
        model: PoleModel,
        dampers: Sequence[Damper],
        tyre_load: Mapping[str, float],
        plates: Complex,
        period: float,
    ) -> None:
        self.model, self.plates, self.period = model, plates, period
        self.ports, self.moved = car_ports(model, dampers)
        self.at = [port.base for port in self.ports]
        self.cycle = Cycle(2 * plates.shape[1], False)
        self.speeds: Vector = np.asarray(2.0 * np.pi / period * self.cycle.harmonics, dtype=np.float64)
        wheels = model.matrices.system.inputs
        rolling = model.slope.shape[1] > 0
        plant = Plant(model, self.moved, tyre_rows(model, wheels) if rolling else plain_rows(model, model.outputs([])))
        rows = [*self.at, *range(plant.base, plant.base + len(wheels) * rolling)]
        shape, count = plates.shape[1], len(self.at)
        forces = np.empty((len(rows), count, shape), dtype=complex)
        slopes = np.empty((len(rows), model.slope.shape[1], shape), dtype=complex)
        drive = np.empty((len(rows), shape), dtype=complex)
        for first in range(0, shape, LINES):
            part = slice(first, first + LINES)
            table = plant.responses(self.speeds[part])
            forces[..., part], slopes[..., part] = table.forces[rows][:, self.at], table.slopes[rows]
            drive[:, part] = np.einsum("rwk,wk->rk", table.inputs[rows], plates[:, part])
        self.effects, self.drive, self.slopes = forces[:count], drive[:count], slopes[:count]
        self.present: PresentLoad | None = None
        if rolling:
            self.present = PresentLoad(
                ports=slopes[None, :count],
                tyres=forces[None, count:],
                slopes=slopes[None, count:],
                plates=drive[None, count:],
                rate=self.cycle.histories(1j * self.speeds * plates)[None],
                load=np.array([tyre_load[wheel] for wheel in wheels]),
            )

    def scaling(self) -> Vector:
        """Return lambda of the ports; (1, ports)."""
        low, high = (max(1, round(limit * self.period)) for limit in SCALED)
        diagonal = np.abs(self.effects[range(len(self.at)), range(len(self.at)), low : high + 1])
        mean = np.exp(np.mean(np.log(np.maximum(diagonal, 1e-30)), axis=1))
        return np.array([[float(port.scaling(effect)) for port, effect in zip(self.ports, mean, strict=True)]])

    def state(
        self,
        tolerance: float,
        *,
        limit: int = 250,
        start: PeriodicForces | None = None,
    ) -> PeriodicForces:
        """Return the periodic state as the only point of an iteration with one scaling; see `periodic_forces`."""
        return periodic_forces(
            self.ports, self.cycle, self.effects[None], self.drive[None], self.scaling(), present=self.present,
            tolerance=tolerance, limit=limit, ladder=LADDER[:1], start=start,
        )  # fmt: skip

    def lines(self, rows: ChannelRows, forces: Complex, motions: Complex, slopes: Complex, interval: float) -> Complex:
        """Return the lines of channels; (rows, m) for the first m lines of the period.

        Args:
            rows: the channels; accelerations get the gain of `recorded_acceleration`.
            forces, motions: lines of the ports; (ports, m).
            slopes: slope velocities of rolling tyres; (w, m), (0, m).
            interval: sampling interval of a record [s].
        """
        model, outputs = self.model, rows.outputs
        result = np.empty((len(outputs.poles), forces.shape[1]), dtype=complex)
        base = np.zeros((len(self.moved), forces.shape[1]), dtype=complex)
        # The law itself has the force p - k w: the matrices keep their stiffness k.
        base[self.at] = forces - self.moved[self.at, None] * motions
        pairs, half = model.pairs, np.where(np.arange(len(model.poles)) < model.pairs, 0.5, 1.0)[:, None]
        columns = np.hstack([model.height, model.velocity, -model.force, -model.scalar_force, model.slope])
        conjugate = outputs.poles[:, :pairs].conj()
        for first in range(0, forces.shape[1], LINES):
            part = slice(first, min(first + LINES, forces.shape[1]))
            s: Complex = np.asarray(1j * self.speeds[part], dtype=np.complex128)
            z = self.plates[:, part]
            inputs = np.vstack([z, s * z, base[:, part], slopes[:, part]])
            # Re(a xi) in time: a pole and its conjugate, with half of the residue each.
            x = half * (columns @ inputs) / self._distance(model.poles, s)
            y = 0.5 * (columns[:pairs].conj() @ inputs) / self._distance(model.poles[:pairs].conj(), s)
            direct = outputs.height @ z + outputs.velocity @ (s * z) - rows.forces @ base[:, part]
            result[:, part] = outputs.poles @ x + conjugate @ y + direct + rows.slopes @ slopes[:, part]
        gain = acceleration_gain(self.speeds[: forces.shape[1]] * interval) / interval**2
        result[rows.accelerations] = result[rows.accelerations] * gain
        return result

    @staticmethod
    def _distance(poles: Complex, s: Complex) -> Complex:
        """Return jw - s of each pole; infinite for the constant part of a motion that nothing holds."""
        distance = s - poles[:, None]
        distance[(np.abs(poles) <= SLOWEST)[:, None] & (s == 0.0)] = np.inf
        return distance
