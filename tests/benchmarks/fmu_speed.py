"""Speed of an FMU: processor time of communication steps of 1 ms. `python -m tests.benchmarks.fmu_speed [CAR]`."""

from __future__ import annotations

import ctypes
import math
import sys
import tempfile
import time
from pathlib import Path

from tests.handover.fmu.master import Fmu, Instance
from vehicle.handover.fmu.fmu_file import write_fmu
from vehicle.runs.car import Car

SECONDS, LENGTH = 4.0, 1e-3
"""Time of the run and communication step [s]."""

FEW = ("seat_rail_acc_z", "seat_rail_acc_x", "tyre_fl_force_z", "damper_fl_velocity", "damper_fl_force")
"""The five outputs of the target."""


class Idle:
    """Library whose functions do nothing, for the time of the master itself."""

    fmi2SetReal = fmi2DoStep = fmi2GetReal = ctypes.CDLL(None).labs


def step_seconds(fmu: Fmu, outputs: list[str]) -> float:
    """Return the processor time of a communication step: inputs, step and outputs, without that of the master.

    Args:
        fmu: the FMU.
        outputs: names of the outputs that are read.
    """
    inputs = [name for name in fmu.names("input") if name.startswith("plate_") and not name.endswith("_excess")]
    instance = Instance(fmu)
    component, steps = ctypes.c_void_p(instance.slave.component), round(SECONDS / LENGTH)
    read, written = (
        (ctypes.c_uint * len(names))(*[fmu.references[name] for name in names]) for names in (outputs, inputs)
    )
    values, results = (ctypes.c_double * len(inputs))(), (ctypes.c_double * len(outputs))()
    counts = ctypes.c_size_t(len(inputs)), ctypes.c_size_t(len(outputs))
    times = []
    for library in (instance.slave.dll, Idle):
        started = time.process_time()
        for step in range(steps):
            phase = 50.0 * LENGTH * (step + 1)
            for index in range(0, len(inputs), 2):
                values[index], values[index + 1] = 0.01 * math.sin(phase + index), 0.5 * math.cos(phase + index)
            status = library.fmi2SetReal(component, written, counts[0], values)
            status |= library.fmi2DoStep(component, ctypes.c_double(step * LENGTH), ctypes.c_double(LENGTH), 1)
            status |= library.fmi2GetReal(component, read, counts[1], results)
            # Messages of a car beyond its valid range are warnings; refused calls are not.
            assert status == 0 or library is Idle
        times.append(time.process_time() - started)
    return (times[0] - times[1]) / steps


def realtime_factors(car: Car, folder: Path) -> dict[int, float]:
    """Return how many times faster than real time an FMU is, by the number of its outputs that are read.

    Args:
        car: the car, which is written with the default step.
        folder: folder for the file.
    """
    path = folder / "speed.fmu"
    write_fmu(car, path)
    fmu = Fmu(path)
    return {len(outputs): LENGTH / step_seconds(fmu, outputs) for outputs in (list(FEW), fmu.names("output"))}


def main() -> None:
    """Print the factors of a car."""
    name = sys.argv[1] if len(sys.argv) > 1 else "focus_road"
    car = Car.load(name)
    with tempfile.TemporaryDirectory() as folder:
        for count, factor in realtime_factors(car, Path(folder)).items():
            print(f"{name}: {count} outputs, {1e3 * LENGTH:g} ms: {factor:.0f} times real time")


if __name__ == "__main__":
    main()
