"""Car on driven plates for the replication of a drive: its runs, and its FRFs linearised about the last run."""

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.digits import beside_limit
from vehicle.engines.reduced.equivalent_damping import equivalent_damping, linearised_response
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.plausibility import (
    LARGEST_ACCELERATION,
    LARGEST_DISPLACEMENT,
    band_limited_acceleration,
)
from vehicle.signals.excitation.rest import RAMP_S, start_from_rest
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.replication.iteration import Plant
from vehicle.studies.replication.target import Target


class DrivenCar(Plant):
    """Car on driven plates, the `Plant` of the iteration.

    Args:
        wheels: wheels on driven plates, (p,).
        engine: simulation engine, see `Car.run`.

    Attributes:
        settled: number of samples at the beginning in which a drive rises from rest; their errors are excluded.
        damping: equivalent viscous constants of the dampers [N s/m], (d,).
        last: the last run.
        stated_errors: see `Car.run`.
    """

    def __init__(self, car: Car, wheels: tuple[str, ...], target: Target, engine: str) -> None:
        self.car, self.wheels, self.engine, self.target = car, wheels, engine, target
        self.dampers = car.vehicle.composition.dampers
        car.vehicle.require_wheels(wheels)
        shaking = [force.path for force in car.vehicle.composition.forces if force.harmonics or force.recorded]
        if shaking:
            raise ConfigurationError(
                f"{shaking[0]}: this force shakes the car, and the plates would repeat its effect; remove it, or "
                "leave all forces out with --set apply_forces=false"
            )
        car.vehicle.require_channels(target.channels, car.vehicle.acceleration_channels)
        self.damping = np.array([equivalent_damping(damper.law, np.zeros(1), np.zeros(1)) for damper in self.dampers])
        step = float(target.time[1])
        self.settled = round(min(RAMP_S, 0.1 * float(target.time[-1])) / step)
        self.last: Run | None = None
        self.stated_errors = True
        self.ramp: tuple[str, ...] = ()

    def run(self, drive: Vector) -> Vector:
        """Run the car on plate displacements (p, n) and return its accelerations (k, n)."""
        moving = [f"{damper.name}_{quantity}" for damper in self.dampers for quantity in ("velocity", "force")]
        channels = dict.fromkeys([*self.target.channels, *moving])
        run = self.car.run(
            self.signal(drive), engine=self.engine, channels=tuple(channels), stated_errors=self.stated_errors
        )
        self.damping = np.array(
            [
                equivalent_damping(damper.law, run[f"{damper.name}_velocity"], run[f"{damper.name}_force"])
                for damper in self.dampers
            ]
        )
        self.last = run
        return np.array([run[name] for name in self.target.channels])

    def frf(self, frequency: Vector) -> Complex:
        """Return FRFs (k, p, m) [m/s2 per m] with the equivalent damping of the last run."""
        return linearised_response(self.car.poles, self.damping, self.target.channels, self.wheels, frequency)

    def signal(self, drive: Vector) -> Signal:
        """Return plate displacements (p, n) as a signal."""
        return Signal(
            time=self.target.time,
            displacement=dict(zip(self.wheels, drive, strict=True)),
            notices=self.ramp,
            source=f"drive of {self.target.source.name}",
        )

    def possible(self, drive: Vector) -> tuple[Vector, str]:
        """Return a drive that starts from rest, (p, n), and a message if a shaker cannot run it, else ""."""
        step = float(self.target.time[1])
        columns, self.ramp = start_from_rest(dict(zip(self.wheels, drive, strict=True)), timestep=step)
        for wheel, z in columns.items():
            for values, limit, unit, motion in (
                (z, LARGEST_DISPLACEMENT, "m", "displaced by"),
                (band_limited_acceleration(z, step), LARGEST_ACCELERATION, "m/s2", "accelerated by"),
            ):
                at = int(np.argmax(np.abs(values)))
                if abs(values[at]) > limit:
                    shown, allowed = beside_limit(abs(values[at]), limit, 4)
                    return drive, (
                        f"plate {wheel} would have to be {motion} {shown} {unit} at t = "
                        f"{at * step:.6g} s, must be at most {allowed} {unit}, the limit of a shaker; check the "
                        "unit of the target (--unit), or use a narrower --band than "
                        f"{self.target.band[0]:g}:{self.target.band[1]:g}"
                    )
        return np.array(list(columns.values())), ""
