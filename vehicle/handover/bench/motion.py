"""Motions of a car for moving pictures, over its velocity coordinates: a run of the reduced engine, or a mode."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from vehicle.drawing.rendering.mode_motion import FARTHEST
from vehicle.drawing.rendering.wireframe import CarWireframe, unit_factor
from vehicle.engines.linear.load_rows import displacement_rows
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.handover.bench.drive import BenchDrive
from vehicle.runs.car import Car
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.threads import one_blas_thread

SECONDS = 4.0
"""Length of the motion of a run [s]."""

RATE = 200.0
"""Samples a second of the motion of a run [Hz]: seven in a period of the wheel mode, linear between them."""

PHASES = 48
"""Samples in a cycle of a mode: linear between them within 0.2 % of the amplitude."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarPose:
    """Instant of a motion."""

    coordinates: Vector  # displacements u over the velocity coordinates of `Car.geometry`; (n,)
    plates: Mapping[str, float]  # wheel to displacement of its plate [m]
    time: float  # time in the record of the input [s]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarMotion:
    """Small motion about the design position."""

    # displacements u over the velocity coordinates of `Car.geometry`, at equal intervals; (n, samples)
    coordinates: Vector
    plates: Mapping[str, Vector]  # wheel to displacement of its plate [m]; (samples,). Empty for a mode.
    rate: float  # samples a second [Hz]
    start: float = 0.0  # time of the first sample in the record of the input [s]
    on_road: bool = False  # True for a run on a road

    def pose(self, time: float) -> CarPose:
        """Return the motion at a time [s] after its begin; it repeats."""
        samples = self.coordinates.shape[1] - 1
        index, share = divmod((time * self.rate) % samples, 1.0)
        first = min(int(index), samples - 1)

        def at(values: Vector) -> Vector:
            return np.asarray((1.0 - share) * values[..., first] + share * values[..., first + 1])

        return CarPose(
            coordinates=at(self.coordinates),
            plates={wheel: float(at(values)) for wheel, values in self.plates.items()},
            time=self.start + (first + share) / self.rate,
        )


@one_blas_thread()
def car_motion(car: Car, drive: BenchDrive) -> CarMotion:
    """Simulate the shown part of the excerpt, from `BenchDrive.shown` on, and return the motion of all coordinates."""
    drive = drive.under(car)
    record = drive.record
    count = min(round((drive.shown + SECONDS) / record.timestep) + 1, record.time.size)
    short = replace(
        record,
        time=record.time[:count],
        displacement={wheel: z[:count] for wheel, z in record.displacement.items()},
        slope_velocity={wheel: v[:count] for wheel, v in record.slope_velocity.items()},
        profile={},
    )
    rows = displacement_rows(car.matrices, np.eye(len(car.matrices.system.mass)))
    recording = simulate_reduced(
        car.poles,
        short,
        dampers=[damper.law for damper in car.vehicle.composition.dampers],
        record_rate=RATE,
        tyre_load=car.static.tyre_load,
        channels=[*rows.names, *(f"plate_{wheel}_displacement" for wheel in car.vehicle.wheels)],
        loads=rows,
    )
    first = round(drive.shown * RATE)
    return CarMotion(
        coordinates=car.geometry_motion(np.array([recording[name][first:] for name in rows.names])),
        plates={wheel: recording[f"plate_{wheel}_displacement"][first:] for wheel in car.vehicle.wheels},
        rate=RATE,
        start=first / RATE,
        on_road=drive.road is not None,
    )


def mode_motion(wire: CarWireframe, shape: Complex, frequency: float) -> CarMotion:
    """Return a cycle of a mode without its decay, u = Re(shape exp(i phase)); the farthest point moves `FARTHEST`.

    Args:
        shape: mode shape over the velocity coordinates of `Car.geometry`; (n,).
        frequency: natural frequency [Hz], above 0.
    """
    scaled = FARTHEST * unit_factor(wire.displacement(shape)) * shape
    phasor = np.exp(2j * np.pi * np.arange(PHASES + 1) / PHASES)
    return CarMotion(coordinates=np.outer(scaled, phasor).real, plates={}, rate=PHASES * frequency)
