"""Difference of both engines on roads with rolling tyres, and the causes of the difference.

python -m tests.benchmarks.rolling_engines [--roads A,B] [--duration 10] [--speed 80] [--channels 6]

Each line: point-by-point difference over the RMS of MuJoCo, and in brackets how much larger the RMS of the reduced
engine is. `static` is the reduced engine with static wheel loads on slopes z'/V, `present` with present ones, both
against MuJoCo at its own step; `fine` at a step of 0.25 ms; `odd` and `even` are the parts of `fine` that change sign
with the road and that do not: without and with products of two motions.
"""

import argparse
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.runs.car import Car, Road
from vehicle.signals.analysis.road_level import CLASSES

Histories = dict[str, npt.NDArray[np.float64]]

FINE = "solver.timestep=0.00025"


def main() -> None:
    """Print the channels with the largest differences for each car and class."""
    found = argparse.ArgumentParser(description=__doc__)
    found.add_argument("--roads", default="A,B", help="classes or obstacles, as cleat:20x50")
    found.add_argument("--duration", type=float, default=10.0)
    found.add_argument("--speed", type=float, default=80.0)
    found.add_argument("--channels", type=int, default=6)
    options = found.parse_args()
    for name in ("kinematic_reference", "focus_road"):
        for road in options.roads.split(","):
            duration = options.duration if road in CLASSES else None
            drive = Road(road, options.speed, duration=duration).under(Car.load(name).vehicle)
            car, fine = (Car.load(name, [*drive.overrides, *more]) for more in ([], [FINE]))
            signal = drive.signal()
            skip = round(drive.skip * car.vehicle.solver.record_rate)
            down = replace(
                signal,
                displacement={wheel: -z for wheel, z in signal.displacement.items()},
                slope_velocity={wheel: -rate for wheel, rate in signal.slope_velocity.items()},
            )

            def reduced(one: object, load: bool, car: Car = car, skip: int = skip) -> Histories:
                run = simulate_reduced(
                    car.poles,
                    one,  # type: ignore[arg-type]
                    dampers=[damper.law for damper in car.vehicle.composition.dampers],
                    record_rate=car.vehicle.solver.record_rate,
                    tyre_load=car.static.tyre_load,
                    present_load=load,
                )
                return {channel: run[channel][skip:] for channel in car.vehicle.acceleration_channels}

            few = [reduced(one, True) for one in (signal, down)]
            static = reduced(signal, False)
            own = {key: value[skip:] for key, value in car.run(signal).recording.channels.items()}
            whole = [
                {key: value[skip:] for key, value in fine.run(one).recording.channels.items()} for one in (signal, down)
            ]
            rows = []
            for channel in few[0]:
                parts = [
                    0.5 * (run[0][channel] + sign * run[1][channel]) for sign in (-1.0, 1.0) for run in (few, whole)
                ]
                pairs = [
                    (static[channel], own[channel]),
                    (few[0][channel], own[channel]),
                    (few[0][channel], whole[0][channel]),
                    (parts[0], parts[1]),
                ]
                size = float(np.std(whole[0][channel]))
                values = [
                    (float(np.std(one - other)) / size, float(np.std(one) / np.std(other)) - 1.0)
                    for one, other in pairs
                ]
                rows.append((abs(values[0][1]), channel, values, float(np.std(parts[2] - parts[3])) / size))
            print(f"\n{name} on {road}, step {own_step(car):g} s: difference % (RMS %)")
            print(f"{'channel':<28}" + "".join(f"{kind:>17}" for kind in ("static", "present", "fine", "odd", "even")))
            for _, channel, values, even in sorted(rows, reverse=True)[: options.channels]:
                print(
                    f"{channel:<28}"
                    + "".join(f"{100.0 * one:8.2f} ({100.0 * level:+6.2f})" for one, level in values)
                    + f"{100.0 * even:9.2f}",
                    flush=True,
                )


def own_step(car: Car) -> float:
    """Step of MuJoCo [s]."""
    return float(car.stepped().vehicle.solver.timestep or np.nan)


if __name__ == "__main__":
    main()
