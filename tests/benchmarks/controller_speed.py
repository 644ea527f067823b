"""Time of a call of a controller FMU by the core. `python -m tests.benchmarks.controller_speed`."""

from __future__ import annotations

import ctypes
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy.typing as npt

from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from tests.model.laws.controller_files import controller_fmu
from vehicle.core.library import core
from vehicle.model.laws.control_laws import in_steps, pack
from vehicle.model.laws.controller_fmu import Controller, read_controller
from vehicle.signals.formats.file_digest import digest

CALLS, SERIES = 2_000, 100


def time_per_call(folder: Path, version: str) -> float:
    """Return the processor time of a call by the core: inputs, communication step, output [s].

    It is that of the demand of a damper with the controller, less that of a damper with a law of its own.

    Args:
        folder: folder for the FMU.
        version: of FMI, "2" or "3".
    """
    control = replace(half_car_rider_parameters().semi_active, law="skyhook")
    path = controller_fmu(folder / "skyhook.fmu", version)
    controller = Controller(read_controller(path, digest(path)), "damper", control, 1e-3, [])
    own = in_steps(pack(control), 1e-3)
    outside = own.copy()
    outside["controller"] = float(controller.address)
    times = [(_time(outside), _time(own)) for _ in range(SERIES)]
    duration = min(first for first, _ in times) - min(second for _, second in times)
    controller.check()
    controller.close()
    return duration


def _time(setting: npt.NDArray[Any]) -> float:
    """Return the processor time of a demand in a series of calls [s]."""
    demanded, address = core().core_demanded, setting.ctypes.data
    demanded.argtypes, demanded.restype = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double], ctypes.c_double
    started = time.process_time()
    for _ in range(CALLS):
        demanded(address, 0.3, 0.1)
    return (time.process_time() - started) / CALLS


def main() -> None:
    """Print the times of both versions."""
    with tempfile.TemporaryDirectory() as folder:
        for version in ("2", "3"):
            print(f"FMI {version}.0: {1e6 * time_per_call(Path(folder), version):.3f} us a call")


if __name__ == "__main__":
    main()
