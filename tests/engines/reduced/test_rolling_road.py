"""Both engines on roads with rolling tyres: what is odd in the road agrees, what is even are products of motions.

Of a road and the same road upside down, half the difference of two histories holds all that is linear and the
friction; half their sum holds what is of second order in the motion, as the present wheel load on a slope or a wheel
that moves along an arc. The reduced engine contains the load, and not the arcs.
"""

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from vehicle.engines.reduced.batch_simulation import COARSE_STEP, simulate_batch
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.simulation.recording import Recording
from vehicle.runs.car import Car
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad, Side, drive
from vehicle.signals.excitation.signal import Signal

Vector = npt.NDArray[np.float64]

SPEED, SKIP = 80.0 / 3.6, 1000


def road(car: Car, level: str, duration: float) -> Signal:
    """Return a road of a class for all wheels of a car, with tracks of 1.5 m.

    Args:
        car: whose wheels.
        level: class.
        duration: [s].
    """
    foremost = min(wheel.center[0] for wheel in car.vehicle.composition.wheels)
    wheels: dict[str, tuple[float, Side]] = {
        wheel.name: (wheel.center[0] - foremost, "right" if wheel.side > 0.0 else "left")
        for wheel in car.vehicle.composition.wheels
    }
    surface = IsoRoad(level=CLASSES[level], seed=1, track=1.5, patch=0.1)
    return drive(surface, speed=SPEED, wheels=wheels, duration=duration)


def run_reduced(car: Car, signal: Signal, *, present_load: bool = True, step: float | None = None) -> Recording:
    """A run with present or static wheel loads on slopes.

    Args:
        car: the car.
        signal: road.
        present_load, step: see `simulate_reduced`.
    """
    return simulate_reduced(
        car.poles, signal, dampers=[damper.law for damper in car.vehicle.composition.dampers],
        record_rate=car.vehicle.solver.record_rate, tyre_load=car.static.tyre_load, present_load=present_load,
        step=step,
    )  # fmt: skip


def rms(values: Vector) -> float:
    """Standard deviation after the rise of the road."""
    return float(np.std(values[SKIP:]))


@pytest.mark.parametrize(("name", "level", "arcs"), [("sedan", "B", 0.25), ("focus_road", "A", 0.12)])
def test_engines_differ_by_arcs_of_the_wheels_alone(name: str, level: str, arcs: float) -> None:
    car = Car.load(name, [f"driving.speed={SPEED}", "solver.timestep=0.0005"])
    signal = road(car, level, 2.5)
    down = replace(signal, displacement={wheel: -z for wheel, z in signal.displacement.items()})
    few = [run_reduced(car, plates) for plates in (signal, down)]
    static = [run_reduced(car, plates, present_load=False) for plates in (signal, down)]
    whole = [car.run(plates).recording for plates in (signal, down)]
    for channel in car.vehicle.acceleration_channels:
        odd, even = (
            [0.5 * (run[0][channel] + sign * run[1][channel]) for run in (few, whole, static)] for sign in (-1.0, 1.0)
        )
        # At 0.5 ms MuJoCo places the instants of slipping of the light damper tops less finely: 0.3 % at 0.25 ms.
        bound = 1.5e-2 if channel.startswith("damper_top") else 5e-3
        assert abs(rms(odd[0]) / rms(odd[1]) - 1.0) < bound, channel
        # Along x and y, where arcs are compared with small motions; along z they move only the instants of slipping.
        limit = 0.03 if channel.endswith("z") else arcs if channel.startswith("knuckle") else 0.5 * arcs
        assert rms(even[0] - even[1]) < limit * rms(whole[0][channel]), channel
        if channel in ("knuckle_fl_acc_x", "knuckle_fr_acc_x"):
            # Front wheels move nearly straight up, so most of what is even is the load on the slope.
            assert rms(even[0] - even[1]) < 0.6 * rms(even[1]), channel
            assert rms(even[2] - even[1]) > 0.9 * rms(even[1]), channel


def test_a_batch_of_rolling_cars_is_the_single_run_at_its_step() -> None:
    """Current loads on slopes, and small lateral motion beside large vertical motion, in single precision."""
    car = Car.load("sedan", [f"driving.speed={SPEED}"])
    signal = road(car, "B", 4.0)
    channels = [f"seat_rail_acc_{axis}" for axis in "xyz"]
    dampers = [damper.law for damper in car.vehicle.composition.dampers]
    batch = simulate_batch(
        2 * [car.poles],
        signal,
        dampers=2 * [dampers],
        record_rate=car.vehicle.solver.record_rate,
        tyre_load=2 * [car.static.tyre_load],
        channels=channels,
    ).recording(1)
    present, static = (run_reduced(car, signal, present_load=load, step=COARSE_STEP) for load in (True, False))
    for channel in channels:
        # Point by point; from differences of the states, round-off would be 2 % along y.
        assert rms(batch[channel] - present[channel]) < 3e-3 * rms(present[channel]), channel
        assert abs(rms(batch[channel]) / rms(present[channel]) - 1.0) < 2e-5, channel
    assert 1e-2 < rms(present[channels[0]] - static[channels[0]]) / rms(present[channels[0]]) < 0.1
