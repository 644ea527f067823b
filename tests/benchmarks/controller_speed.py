"""Time of a call of a controller FMU from the core. `python -m tests.benchmarks.controller_speed`."""

from __future__ import annotations

import ctypes
import tempfile
import time
from pathlib import Path

from tests.model.laws.controller_files import controller_fmu
from vehicle.core.library import core
from vehicle.model.laws.control_laws import in_steps, pack
from vehicle.model.laws.controller_fmu import Controller, read_controller
from vehicle.model.parameters.half_car_rider_parameters import half_car_rider_parameters
from vehicle.signals.records.reader import digest

CALLS = 100_000


def time_per_call(folder: Path, version: str) -> float:
    """Return the processor time of a call: inputs, communication step, output [s].

    Args:
        folder: folder for the FMU.
        version: of FMI, "2" or "3".
    """
    control = half_car_rider_parameters().semi_active
    path = controller_fmu(folder / "skyhook.fmu", version)
    controller = Controller(read_controller(path, digest(path)), "damper", control, 1e-3, [])
    law = in_steps(pack(control), 1e-3)
    law["controller"] = controller.address
    demanded = core().core_demanded
    demanded.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double]
    started = time.process_time()
    for n in range(CALLS):
        demanded(law.ctypes.data, 0.3 - 1e-6 * n, 0.1)
    duration = time.process_time() - started
    controller.check()
    controller.close()
    return duration / CALLS


def main() -> None:
    """Print the times of both versions."""
    with tempfile.TemporaryDirectory() as folder:
        for version in ("2", "3"):
            print(f"FMI {version}.0: {1e6 * time_per_call(Path(folder), version):.3f} us a call")


if __name__ == "__main__":
    main()
