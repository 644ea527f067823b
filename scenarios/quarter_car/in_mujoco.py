"""Quarter car in MuJoCo with the element rows of the complete car, compared with the lumped model."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from scenarios.claims import OWN_CHECK, Claim
from scenarios.lumped.quarter_car_network import quarter_car
from scenarios.lumped.quarter_car_parameters import QuarterCar
from scenarios.lumped.quarter_car_spec import WHEEL, quarter_car_spec
from scenarios.quarter_car.runs import STEP, Runs, rms
from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.plate_arrays import PlateArrays
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.model.laws.coulomb import Coulomb
from vehicle.model.laws.friction import Clamped
from vehicle.signals.analysis.slip import slip_share
from vehicle.signals.excitation.signal import Signal

DEFAULT_STEP = 5e-4
"""Step of the complete car [s]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Motion:
    """Sampled motion at every step, by place: `body`, `wheel` and, with friction, `damper`."""

    time: Vector  # [s], shape (T,)
    displacement: Mapping[str, Vector]  # [m], shape (T,)
    acceleration: Mapping[str, Vector]  # [m/s2], shape (T,)
    sliding_velocity: Vector  # Velocity of the damper [m/s], shape (T,); zero where the damper slips or sticks for good


def in_mujoco(
    car: QuarterCar,
    signal: Signal,
    *,
    timestep: float = DEFAULT_STEP,
    damper: Literal["slip", "stick", "friction"] = "friction",
) -> Motion:
    """Simulate the quarter car on its plate from rest in MuJoCo.

    Args:
        car: parameters of the quarter car.
        signal: displacement of the front right plate.
        timestep: step [s].
        damper: damper model, see `quarter_car_spec`.

    Returns:
        Motion from 0 to the end of the signal, at every step.

    Raises:
        ConfigurationError: an unknown damper model or a bad step.
        SimulationError: another simulation of this process uses the callbacks.
    """
    model = quarter_car_spec(car, timestep=timestep, damper=damper).compile()
    prepare_model(model)
    data = mujoco.MjData(model)
    rows = Rows(model)
    times: Vector = timestep * np.arange(int(np.floor(signal.duration / timestep + 1e-6)) + 1, dtype=np.float64)
    plate = PlateArrays.of(signal, timestep, times.size - 1, (WHEEL,))
    position, velocity = np.zeros((times.size, model.nv)), np.zeros((times.size, model.nv))
    sensors = np.zeros((times.size, model.nsensordata))
    with installed(rows):
        for index in range(times.size):
            data.mocap_pos[0, 2] = plate.displacement[index, 0]
            rows.state.plate_velocity[0, 2] = plate.velocity[index, 0]
            rows.state.plate_acceleration[0, 2] = plate.acceleration[index, 0]
            position[index] = data.qpos
            mujoco.mj_step(model, data)
            sensors[index] = data.sensordata
            # After the step MuJoCo's velocity belongs to its middle.
            velocity[index] = data.qvel - 0.5 * timestep * data.qacc
    displacement = {"body": position[:, 0], "wheel": position[:, 1]}
    sliding = np.zeros(times.size)
    if damper == "friction":
        displacement["damper"] = position[:, 1] + position[:, 2]
        sliding = velocity[:, 2]
    acceleration = {name: sensors[:, model.sensor(f"{name}_acc").adr[0] + 2] for name in displacement}
    return Motion(time=times, displacement=displacement, acceleration=acceleration, sliding_velocity=sliding)


def friction_of_the_rows(car: QuarterCar) -> FirstOrder:
    """Return the friction model (2.6) with the law of a friction row: min(Fd, max(-Fd, c v)), c = (2/pi) Fd eps."""
    network = quarter_car(car, damper="friction")
    law = Clamped(law=Coulomb(friction_limit=car.friction.limit, smoothing=car.friction.steepness))
    return dataclasses.replace(network, slides=(dataclasses.replace(network.slides[0], friction=law),)).first_order()


MIDDLE = 0.005
"""RMS of the road [m] on which the damper slips part of the time."""


def in_mujoco_claims(runs: Runs) -> list[Claim]:
    """Return the rows that compare the element rows of the complete car in MuJoCo with the stiff solver."""
    motion = in_mujoco(runs.car, runs.road_signal(MIDDLE))
    every = round(STEP / DEFAULT_STEP)
    slipping = 100.0 / runs.car.friction.steepness
    share = 100.0 * slip_share(motion.sliding_velocity[::every], slipping)
    claims = []
    for law, history, names in (
        ("the law of the row", runs.road_of(friction_of_the_rows(runs.car), MIDDLE), ("body", "wheel", "damper")),
        ("the published atan law", runs.road(MIDDLE), ("body", "wheel")),
    ):
        gaps = {
            name: 100.0 * (rms(value[::every]) / rms(history.acceleration(name)) - 1.0)
            for name, value in motion.acceleration.items()
        }
        expected = 100.0 * slip_share(history.sliding_velocity(), slipping)
        ours = ", ".join(f"{name} {gap:+.2f} %" for name, gap in gaps.items())
        claims.append(
            OWN_CHECK.statement(
                f"road 5 mm, quarter car in MuJoCo against the stiff solver with {law}",
                "same physics",
                f"acceleration RMS {ours}; slip {share:.1f} against {expected:.1f} % of the time",
                all(abs(gaps[name]) < 1.0 for name in names) and abs(share - expected) < 0.5,
                f"not printed, our own check at {1e3 * DEFAULT_STEP:g} ms: RMS of {', '.join(names)} within 1 %, slip "
                "(100/eps) within 0.5 points"
                + ("" if "damper" in names else "; the two laws differ below 1/eps, which the damper mass feels"),
            ).at("section 2.3.2.4")
        )
    return claims
