"""Time of a call of a controller FMU from compiled code. `python -m tests.benchmarks.controller_speed`."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from tests.model.laws.controller_files import controller_fmu
from vehicle.compiler import numba_module
from vehicle.model.laws.controller_fmu import Controller, read_controller
from vehicle.model.laws.function_address import result_at
from vehicle.model.parameters.half_car_rider_parameters import half_car_rider_parameters
from vehicle.signals.records.reader import digest

CALLS = 1_000_000


def time_per_call(folder: Path, version: str) -> float:
    """Return the processor time of a call: inputs, communication step, output [s].

    Args:
        folder: folder for the FMU.
        version: of FMI, "2" or "3".
    """
    control = half_car_rider_parameters().semi_active
    path = controller_fmu(folder / "skyhook.fmu", version)
    controller = Controller(read_controller(path, digest(path)), "damper", control, 1e-3, [])
    numba = numba_module()

    @numba.njit  # type: ignore[untyped-decorator]
    def calls(address: float, count: int) -> float:
        total = 0.0
        for n in range(count):
            total += result_at(address, 0.3 - 1e-6 * n, 0.1)
        return total

    address = float(controller.memory.ctypes.data)
    calls(address, 1)
    started = time.process_time()
    calls(address, CALLS)
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
