"""Processor time from Python without environment variables over that with OMP_NUM_THREADS=1.

`python -m tests.benchmarks.blas_threads [--threads 8]`: two processes compute each job alternately; minimum of five.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import ThreadpoolController

from vehicle import Car, road, sweep
from vehicle.threads import THREADS

REPEATS = 5

Job = Callable[[], Iterable[npt.ArrayLike]]


def jobs(duration: float = 10.0) -> dict[str, Job]:
    """Return name to job; a job returns arrays of results.

    Args:
        duration: length of the road [s].
    """
    car = Car.load("focus_road")
    source = road("C", 80, duration=duration)
    run = car.run("bump_7p5mm.csv", engine="reduced")
    channels = ["seat_rail_acc_z", "seat_rail_acc_x"]
    values = [1500.0 + 50.0 * number for number in range(8)]

    def build() -> Iterable[npt.ArrayLike]:
        system = Car.load("focus_road").matrices.system
        return system.mass, system.damping, system.stiffness

    def variants() -> Iterable[npt.ArrayLike]:
        varied = [car.with_({"front.damper.viscous": value}) for value in values]
        return [one.matrix_frf(channels, np.arange(1.0, 40.0), damper="sliding") for one in varied]

    def swept() -> Iterable[npt.ArrayLike]:
        table = sweep(car, {"front.damper.viscous": values}, [source], engine="reduced")
        return [table.column(name) for name in table.units]

    return {
        "matrices of a new car": build,
        "modes": lambda: [mode.shape for mode in car.modes()],
        "FRFs of 8 variants from matrices": variants,
        "reduced run on a road": lambda: car.run(source, engine="reduced").recording.channels.values(),
        "FRF of a run": lambda: [run.frf(channels).response],
        "sweep of 8 cars": swept,
    }


def serve(threads: int | None, duration: float) -> None:
    """Compute the jobs named on standard input, and print processor time [ms], wall time [ms] and digest of each."""
    if threads is not None:
        for library in ThreadpoolController().lib_controllers:
            library.set_num_threads(threads)
    named = jobs(duration)
    print(json.dumps(list(named)), flush=True)
    for line in sys.stdin:
        begin, started = time.process_time(), time.perf_counter()
        arrays = [np.ascontiguousarray(array) for array in named[line.strip()]()]
        times = 1e3 * (time.process_time() - begin), 1e3 * (time.perf_counter() - started)
        print(
            json.dumps([*times, hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()]), flush=True
        )


class Server:
    """Process that computes jobs.

    Args:
        one: set OMP_NUM_THREADS=1; by default no variable is set.
        threads: number of BLAS threads, as on a machine with this number of cores; that of the machine by default.
        duration: length of the road [s].
    """

    def __init__(self, *, one: bool = False, threads: int | None = None, duration: float = 10.0) -> None:
        environment = {name: value for name, value in os.environ.items() if name not in THREADS}
        command = [sys.executable, "-m", "tests.benchmarks.blas_threads", "--serve", f"--duration={duration}"]
        command += [] if threads is None else ["--threads", str(threads)]
        environment |= {"OMP_NUM_THREADS": "1"} if one else {}
        self.process = subprocess.Popen(
            command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.names: list[str] = self._line()

    def __call__(self, name: str) -> tuple[float, float, str]:
        """Return processor time [ms], wall time [ms] and digest of a job."""
        assert self.process.stdin is not None
        print(name, file=self.process.stdin, flush=True)
        processor, wall, digest = self._line()
        return processor, wall, digest

    def _line(self) -> Any:
        assert self.process.stdout is not None
        return json.loads(self.process.stdout.readline())

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark and print a line for each job."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.blas_threads", description=__doc__)
    parser.add_argument("--threads", type=int, help="number of BLAS threads; that of the machine by default")
    parser.add_argument("--serve", action="store_true", help="compute jobs named on standard input")
    parser.add_argument("--duration", type=float, default=10.0, help="length of the road [s]")
    options = parser.parse_args(arguments)
    if options.serve:
        serve(options.threads, options.duration)
        return 0
    one, free = Server(one=True), Server(threads=options.threads)
    for name in one.names:
        pairs = [(one(name), free(name)) for _ in range(REPEATS + 1)][1:]
        limited, unset = (min(pair[column][0] for pair in pairs) for column in (0, 1))
        same = "same bits" if len({result[2] for pair in pairs for result in pair}) == 1 else "OTHER BITS"
        print(f"{name:<34} {limited:8.1f} ms   unset {unset:8.1f} ms   ratio {unset / limited:6.2f}   {same}")
    one.close()
    free.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
