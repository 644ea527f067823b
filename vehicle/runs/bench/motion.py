"""Motion of a car over a few seconds in its velocity coordinates, from the reduced engine, for moving pictures."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.load_rows import displacement_rows
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.runs.bench.drive import BenchDrive
from vehicle.runs.car import Car
from vehicle.threads import one_blas_thread

Vector = npt.NDArray[np.float64]

SECONDS = 4.0
"""Length of the motion [s]."""

RATE = 200.0
"""Samples a second [Hz]: seven in a period of the wheel mode, linear between them."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarMotion:
    """Small motion about the design position.

    Attributes:
        coordinates: displacements u over the velocity coordinates, at `RATE`; (n, samples).
        plates: wheel to displacement of its plate [m]; (samples,).
    """

    coordinates: Vector
    plates: dict[str, Vector]


@one_blas_thread()
def car_motion(car: Car, drive: BenchDrive) -> CarMotion:
    """Simulate the begin of the evaluated excerpt and return the motion of all coordinates.

    Args:
        car: the car, with the overrides of the drive.
        drive: input of the bench.
    """
    record = drive.record
    count = min(round((drive.skip + SECONDS) / record.timestep) + 1, record.time.size)
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
    part = slice(round(drive.skip * RATE), None)
    return CarMotion(
        coordinates=np.array([recording[name][part] for name in rows.names]),
        plates={wheel: recording[f"plate_{wheel}_displacement"][part] for wheel in car.vehicle.wheels},
    )
