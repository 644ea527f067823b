"""Share of the difference of both engines on rolling tyres that is the second order of the equations of motion.

python -m tests.benchmarks.second_order [--cars kinematic_reference,focus_road] [--roads C] [--duration 8] [--speed 80]

Even is the part of the difference that keeps its sign with the road, over the RMS of MuJoCo. What remains of it: arc,
after the arc of the own wheel on the kinematics rig, c s^2/2; fit, after the best linear combination of the products of
two suspension travels, of their velocities, and of a travel and the second derivative of a travel; left, after the
second order. Then the difference of the RMS without and with the second order.
"""

import argparse
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tests.engines.reduced.second_order import Motion, linear_motion, second_order
from vehicle.engines.reduced.equivalent_damping import equivalent_damping
from vehicle.engines.simulation.recording import Recording
from vehicle.runs.car import Car, Road
from vehicle.runs.car.axle import axle_names, axle_statics, car_at_rest
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.signal import Signal

Vector = npt.NDArray[np.float64]

PAUSE = 6.0
"""Time after the record in which plates and dampers return to rest [s], so that the motion is periodic."""

STEP = "solver.timestep=0.0005"

RISE = 0.01
"""Wheel travel for the curvature of an arc [m]."""


def main() -> None:
    """Print the table for each car and road."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cars", default="kinematic_reference,focus_road")
    parser.add_argument("--roads", default="C", help="classes or obstacles, as cleat:20x50")
    parser.add_argument("--duration", type=float, default=8.0)
    parser.add_argument("--speed", type=float, default=80.0)
    options = parser.parse_args()
    for name in options.cars.split(","):
        for road in options.roads.split(","):
            duration = options.duration if road in CLASSES else None
            drive = Road(road, options.speed, duration=duration).under(Car.load(name).vehicle)
            compare(Car.load(name, [*drive.overrides, STEP]), drive.signal(), drive.skip, f"{name}, {road}")


def compare(car: Car, signal: Signal, skip: float, title: str) -> None:
    """Print the table of a car on a road.

    Args:
        car: the car, with the step of MuJoCo.
        signal: the road.
        skip: beginning of the record that is left out [s].
        title: first line.
    """
    down = replace(
        signal,
        displacement={wheel: -z for wheel, z in signal.displacement.items()},
        slope_velocity={wheel: -rate for wheel, rate in signal.slope_velocity.items()},
    )
    reduced = [car.run(plates, engine="reduced").recording for plates in (signal, down)]
    whole = [car.run(plates).recording for plates in (signal, down)]
    motion, products = second_order_of(car, signal, reduced[0])
    interval = 1.0 / car.vehicle.solver.record_rate
    evaluated = slice(round(skip / interval), None)
    memoryless = travel_products(car, motion)[: reduced[0].time.size][evaluated]
    bows = arcs(car, motion)
    still = np.zeros(motion.height.shape[1])
    heads = ("even", "arc", "fit", "left", "RMS", "RMS 2")
    print(f"\n{title}: % of the RMS in MuJoCo\n{'channel':<26}" + "".join(f"{head:>9}" for head in heads))
    for channel in car.vehicle.acceleration_channels:
        if not channel.startswith(("knuckle", "seat")):
            continue
        mujoco, linear = ([run[channel][evaluated] for run in runs] for runs in (whole, reduced))
        scale = 100.0 / float(np.std(mujoco[0]))
        even, odd = 0.5 * (mujoco[0] + mujoco[1]), 0.5 * (linear[0] - linear[1])
        second = products[channel][: reduced[0].time.size][evaluated]
        difference = even - 0.5 * (linear[0] + linear[1])
        values = (
            scale * np.std(difference),
            scale * np.std(difference - bows.get(channel, still)[: reduced[0].time.size][evaluated]),
            scale * np.std(difference - memoryless @ np.linalg.lstsq(memoryless, difference)[0]),
            scale * np.std(even - second),
            scale * np.std(linear[0]) - 100.0,
            scale * np.std(odd + second) - 100.0,
        )
        print(f"{channel:<26}" + "".join(f"{value:9.2f}" for value in values), flush=True)


def arcs(car: Car, motion: Motion) -> dict[str, Vector]:
    """Return the accelerations c (s s'' + s'^2) of the knuckles along the arcs of their wheels.

    Args:
        car: the car.
        motion: its linear motion.
    """
    travel, velocity, acceleration = travels(car, motion)
    result, wheels = dict[str, Vector](), car.vehicle.wheels
    for axle in axle_names(car):
        statics = axle_statics(car_at_rest(car), axle, ideal=False)
        curvature = np.zeros(2)
        # The own wheel contributes the mean of equal and opposite travel.
        for way in (1.0, -1.0):
            below, middle, above = (statics.solve([z, way * z])[0] for z in (-RISE, 0.0, RISE))
            for axis, name in enumerate(("longitudinal_m", "lateral_m")):
                bow = getattr(below, name) - 2.0 * getattr(middle, name) + getattr(above, name)
                curvature[axis] += 0.5 * bow / RISE**2
        for wheel in (wheel for wheel in car.vehicle.composition.wheels if wheel.axle == axle):
            k = wheels.index(wheel.name)
            square = travel[k] * acceleration[k] + velocity[k] ** 2
            result[f"knuckle_{wheel.name}_acc_x"] = curvature[0] * square
            result[f"knuckle_{wheel.name}_acc_y"] = wheel.side * curvature[1] * square
    return result


def travels(car: Car, motion: Motion) -> tuple[Vector, Vector, Vector]:
    """Return the suspension travels s, s' and s'' of a motion of a car; (wheels, samples) each."""
    rows = car.load_rows.only([f"suspension_travel_{wheel}" for wheel in car.vehicle.wheels]).displacement
    return rows @ motion.displacement, rows @ motion.velocity, rows @ motion.acceleration


def travel_products(car: Car, motion: Motion) -> Vector:
    """Return all products s_i s_j'' and s_i' s_j' of the suspension travels; (samples, products).

    Args:
        car: the car.
        motion: its linear motion.
    """
    travel, velocity, acceleration = travels(car, motion)
    pairs = [(i, j) for i in range(len(travel)) for j in range(len(travel))]
    products = [travel[i] * acceleration[j] for i, j in pairs]
    return np.array(products + [velocity[i] * velocity[j] for i, j in pairs if i <= j]).T


def second_order_of(car: Car, signal: Signal, run: Recording) -> tuple[Motion, dict[str, Vector]]:
    """Return the linear motion and the second order of all accelerations, over a run and the pause after it.

    Args:
        car: the car.
        signal: the road.
        run: the run with the reduced engine.
    """
    interval, wheels = 1.0 / car.vehicle.solver.record_rate, list(car.matrices.system.inputs)
    plates = signal.plate_motion(run.time, wheels)
    dampers = car.vehicle.composition.dampers
    friction = np.array(
        [
            run[f"{damper.name}_force"] - constant * run[f"{damper.name}_velocity"]
            for damper, constant in zip(dampers, car.matrices.viscous, strict=True)
        ]
    )
    friction -= friction[:, :1]
    slope = np.array(
        [
            signal.slope_spline(wheel, 0.0, signal.duration)(run.time) if signal.slope_velocity else rate
            for wheel, rate in ((wheel, plates.velocity[wheel]) for wheel in wheels)
        ]
    )
    height = padded(np.array([plates.displacement[wheel] for wheel in wheels]), interval)
    motion = linear_motion(
        car.matrices, height - height.mean(axis=1, keepdims=True), interval, friction=padded(friction, interval),
        slope=padded(slope, interval),
    )  # fmt: skip
    damping = [
        equivalent_damping(damper.law, run[f"{damper.name}_velocity"], run[f"{damper.name}_force"])
        for damper in dampers
    ]
    excess = np.array(damping) - car.matrices.viscous
    return motion, second_order(car, motion, interval, damping=excess)


def padded(values: Vector, interval: float) -> Vector:
    """Return histories that fall to their first values by a half cosine of 1 s, and rest for the pause.

    Args:
        values: (k, n).
        interval: sampling interval [s].
    """
    fall, steps = np.zeros(round(PAUSE / interval)), np.arange(round(1.0 / interval))
    fall[: steps.size] = 0.5 * (1.0 + np.cos(np.pi * steps / steps.size))
    rest = values[:, :1]
    return np.hstack([values, rest + (values[:, -1:] - rest) * fall])


if __name__ == "__main__":
    main()
