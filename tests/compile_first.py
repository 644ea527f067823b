"""Compile the functions of both engines before test processes start: `python -m tests.compile_first`.

numba keeps the compiled functions on disk, but two processes that start together on a fresh clone both compile them.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor

from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.runs.car import Car
from vehicle.signals.excitation.random_road import random_road

CARS = ("focus", "focus_road")
"""Cars with two and with four dampers: each number of dampers has compiled functions of its own."""


def compile_mujoco() -> None:
    """Compile the callbacks and the stepping loop of the MuJoCo engine."""
    Car.load(CARS[0]).run(random_road(rms=1e-4, seed=1, wheel="fl", duration=1.0))


def compile_reduced() -> None:
    """Compile the time stepping of the reduced engine, for single runs and for a batch."""
    road = random_road(rms=1e-4, seed=1, wheel="fl", duration=1.0)
    for name in CARS:
        Car.load(name).run(road, engine="reduced")
    car = Car.load(CARS[0])
    simulate_batch(
        [car.poles] * 2,
        road,
        dampers=[[damper.law for damper in car.vehicle.composition.dampers]] * 2,
        record_rate=car.vehicle.solver.record_rate,
        tyre_load=[car.model.static.tyre_load] * 2,
        channels=["seat_rail_acc_z"],
    )


if __name__ == "__main__":
    with ProcessPoolExecutor(2) as pool:
        for task in [pool.submit(compile_mujoco), pool.submit(compile_reduced)]:
            task.result()
