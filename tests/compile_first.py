"""Compile the functions of the MuJoCo engine before test processes start: `python -m tests.compile_first`.

numba keeps the compiled functions on disk, but two processes that start together on a fresh clone both compile them.
The core is compiled here, too, where no shipped library fits its sources.
"""

from __future__ import annotations

from vehicle.core.library import core
from vehicle.runs.car import Car
from vehicle.signals.excitation.random_road import random_road

if __name__ == "__main__":
    core()
    Car.load().run(random_road(rms=1e-4, seed=1, wheel="fl", duration=1.0))
