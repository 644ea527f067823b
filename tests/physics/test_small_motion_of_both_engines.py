"""Every channel of a car with laws over displacement is the same in both engines in small motion.

The difference of the engines is the finite motion of the parts, a relative error in proportion to the motion. Stops and
tables with breakpoints in proportion to the motion act as in large motion.
"""

import numpy as np

from tests.physics.test_mirrored_car import DECOUPLER, FILE, crooked, plates
from tests.validation import validated
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

SCALE = 0.01
"""Factor on the plates, which then move by 0.05 mm, and on breakpoints and friction."""

FREE_PLAY = {
    "displacement": [-2e-3, -1e-4 * SCALE, 3e-4 * SCALE, 2e-3],
    "force": [-900.0, -20.0 * SCALE, 30.0 * SCALE, 400.0],
}


def small_car(*, laws=True):
    table = crooked(rubber=False)
    front, rear = table["front"], table["rear"]
    del front["bushings"]["arm_front"]["table_y"], front["damper"]["stop"]
    for key in DECOUPLER:
        del table["engine"]["bushings"]["hydromount"][key]
    for damper in (front["damper"], front["right"]["damper"], rear["damper"]):
        damper["coulomb_friction"] *= SCALE
    if laws:
        stop = {"displacement": [-0.02, -0.0008, 0.001, 0.02], "force": [-4000.0, 0.0, 0.0, 5000.0]}
        front["damper"]["stop"] = {key: [SCALE * value for value in values] for key, values in stop.items()}
        table["connection"]["pendulum"] |= {"table_x": FREE_PLAY, "table_z": FREE_PLAY}
    table["solver"]["timestep"] = 2.5e-4
    return Car(vehicle_of(table, FILE.parent), folder=FILE.parent)


def test_all_channels_agree_in_small_motion():
    car, signal = small_car(), plates(1.0)
    signal = Signal(time=signal.time, displacement={w: SCALE * z for w, z in signal.displacement.items()})
    names = [*car.vehicle.channels, *car.vehicle.requested_channels]
    whole, reduced = (car.run(signal, engine=engine, channels=names) for engine in ("mujoco", "reduced"))
    shared = [name for name in names if not name.endswith("stop_force")]  # the plain car has no stop
    plain = small_car(laws=False).run(signal, engine="reduced", channels=shared)

    def error(other, name):
        exact = np.asarray(whole[name]) - whole[name][0]
        return np.sqrt(np.mean((np.asarray(other[name]) - other[name][0] - exact) ** 2) / np.mean(exact**2))

    names, shared = ([name for name in part if not name.startswith("plate_")] for part in (names, shared))
    errors = {name: error(reduced, name) for name in names}
    worst = max(errors, key=lambda name: errors[name])
    assert len(errors) > 120 and np.median([error(plain, name) for name in shared]) > 0.05
    assert all(abs(whole[name][0] - reduced[name][0]) < 1e-3 * max(abs(whole[name][0]), 1.0) for name in names), worst
    validated(
        "Reduced engine", "largest RMS error of all channels and loads, plates of 0.05 mm, stops and tables",
        errors[worst], 0.0, abs=1e-2, source="second derivation: MuJoCo at 0.25 ms",
    )  # fmt: skip
