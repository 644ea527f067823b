"""The car on the plates that are to be found: its runs, and its FRFs about the motion of the last one."""

from __future__ import annotations

import numpy as np

from vehicle.engines.reduced.equivalent_damping import equivalent_damping, linearised_response
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.plausibility import (
    LARGEST_ACCELERATION,
    LARGEST_DISPLACEMENT,
    band_limited_acceleration,
)
from vehicle.signals.excitation.rest import RAMP_S, start_from_rest
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.replication.inverse import Complex, Vector
from vehicle.studies.replication.target import Target


class DrivenCar:
    """Plates of a car, as the iteration asks for them.

    Args:
        car: the car.
        wheels: whose plates move, p.
        target: what is to be met.
        engine: as of `Car.run`.

    Attributes:
        settled: samples in which a drive may rise from rest, and whose errors do not count.
        damping: equivalent constants of the dampers [N s/m], (d,).
        last: the last run.
    """

    def __init__(self, car: Car, wheels: tuple[str, ...], target: Target, engine: str) -> None:
        self.car, self.wheels, self.engine, self.target = car, wheels, engine, target
        self.dampers = car.vehicle.composition.dampers
        car.vehicle.require_wheels(wheels)
        car.vehicle.require_channels(target.channels, car.vehicle.acceleration_channels)
        self.damping = np.array([equivalent_damping(one.law, np.zeros(1), np.zeros(1)) for one in self.dampers])
        step = float(target.time[1])
        self.settled = round(min(RAMP_S, 0.1 * float(target.time[-1])) / step)
        self.last: Run | None = None
        self.ramp: tuple[str, ...] = ()

    def run(self, drive: Vector) -> Vector:
        """Accelerations (k, n) of a run on plate displacements (p, n)."""
        moving = [f"{one.name}_{kind}" for one in self.dampers for kind in ("velocity", "force")]
        channels = dict.fromkeys([*self.target.channels, *moving])
        run = self.car.run(self.signal(drive), engine=self.engine, channels=tuple(channels))
        self.damping = np.array(
            [equivalent_damping(one.law, run[f"{one.name}_velocity"], run[f"{one.name}_force"]) for one in self.dampers]
        )
        self.last = run
        return np.array([run[name] for name in self.target.channels])

    def frf(self, frequency: Vector) -> Complex:
        """FRFs (k, p, m) [m/s2 per m] with the dampers as the last run has left them."""
        return linearised_response(self.car.poles, self.damping, self.target.channels, self.wheels, frequency)

    def signal(self, drive: Vector) -> Signal:
        """Drives (p, n) as a signal."""
        return Signal(
            time=self.target.time,
            displacement=dict(zip(self.wheels, drive, strict=True)),
            notices=self.ramp,
            source=f"drive of {self.target.source.name}",
        )

    def possible(self, drive: Vector) -> tuple[Vector, str]:
        """The drive from rest on, and why no shaker can run it; empty where one can."""
        step = float(self.target.time[1])
        columns, self.ramp = start_from_rest(dict(zip(self.wheels, drive, strict=True)), timestep=step)
        for wheel, z in columns.items():
            for values, limit, unit, what in (
                (z, LARGEST_DISPLACEMENT, "m", "displaced by"),
                (band_limited_acceleration(z, step), LARGEST_ACCELERATION, "m/s2", "accelerated by"),
            ):
                at = int(np.argmax(np.abs(values)))
                if abs(values[at]) > limit:
                    return drive, (
                        f"plate {wheel} would have to be {what} {abs(values[at]):.4g} {unit} at "
                        f"t = {at * step:.4g} s, a shaker does up to {limit:g} {unit}; look at the unit of the target "
                        f"(--unit), or give a narrower --band than {self.target.band[0]:g}:{self.target.band[1]:g}"
                    )
        return np.array(list(columns.values())), ""
