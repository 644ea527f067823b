"""Rubber friction in the reduced engine: loops, order, linear limits, held loads, batches, on a quarter car."""

import dataclasses
from typing import Any

import numpy as np
import pytest

from tests.engines.reduced.test_reduced_quarter_car import ROAD, damper, matrices
from tests.validation import validated
from vehicle.engines.linear.displacement_laws import BUSHING, DisplacementLaw
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.reduced.step_factors import car_factors
from vehicle.errors import SimulationError
from vehicle.model.laws.amplitude import friction_elements
from vehicle.signals.excitation.signal import Signal

FORCE, STROKE, TYRE_DAMPING = 150.0, 1.5e-4, 300.0
MOUNT = np.array([1.0, -1.0, -1.0])
"""Displacement of the mount over body, wheel, and damper over wheel."""
SHORT = Signal(time=ROAD.time[:1201], displacement={"fr": ROAD.displacement["fr"][:1201]})
RUN: dict[str, Any] = {"record_rate": 1000.0, "tyre_load": dict.fromkeys(("fr", "fl"), 4000.0)}
CHANNELS = ["tyre_fr_force_z", "damper_fr_velocity", "suspension_mount_fr_acc_z"]


def law(wheel, elements):
    """Rubber friction of a mount as a law over displacement."""
    stroke = elements.limit / elements.stiffness
    return DisplacementLaw(
        name=f"mount {wheel} along z", element=(BUSHING, wheel, 2),
        row=np.concatenate([np.zeros(3 * wheel), MOUNT, np.zeros(3 - 3 * wheel)]), plate=-1,
        breakpoints=np.concatenate([-stroke, stroke]),
        changes=np.concatenate([elements.stiffness, -elements.stiffness]), friction=True,
    )  # fmt: skip


def quarter_cars(factor=1.0, stroke=STROKE, held=0.0):
    """Both quarter cars with friction in their mounts; springs `held` [N/m] of the body and along the dampers."""
    plain, elements = matrices(TYRE_DAMPING), friction_elements(factor * FORCE, stroke)
    laws = tuple(law(wheel, elements) for wheel in (0, 1))
    stiffness = plain.system.stiffness + held * np.diag([1.0, 0, 1, 1, 0, 1])
    stiffness = stiffness + sum(elements.stiffness.sum() * np.outer(each.row, each.row) for each in laws)
    return dataclasses.replace(plain, system=dataclasses.replace(plain.system, stiffness=stiffness), laws=laws)


def mount_rows(car):
    """Displacement of the first mount, and the force t of its friction, as loads."""
    count, plates = car.system.size, len(car.system.inputs)
    row, tangent = car.laws[0].row, car.laws[0].elements[0].sum()
    none = np.zeros((2, count))
    return LoadRows(
        names=("suspension_travel_mount", "mount_force_z"), static=np.zeros(2),
        displacement=np.array([row, tangent * row]), velocity=none, acceleration=none, branch=np.zeros((2, 0)),
        height=np.zeros((2, plates)), height_rate=np.zeros((2, plates)), friction=np.zeros((2, 2)),
        law=np.array([[0.0, 0.0], [1.0, 0.0]]), slope=np.zeros((2, 0)), applied=np.zeros((2, 0)),
    )  # fmt: skip


def reduced(car, signal=SHORT, step=2e-4, channels=tuple(CHANNELS), **changes):
    dampers = [damper(coulomb_friction=0.0)] * 2
    loads = mount_rows(car) if "mount_force_z" in channels else None
    settings = {**RUN, **changes}
    return simulate_reduced(
        pole_model(car), signal, dampers=dampers, step=step, channels=channels, loads=loads, **settings
    )


def midpoint(car, step):
    """Displacements and velocities of the first quarter car at the samples by the midpoint rule."""
    spline, (stiffness, stroke) = SHORT.spline("fr", 0.0, 1.2), car.laws[0].elements
    inverse, damping = np.linalg.inv(car.system.mass[:3, :3]), car.system.damping[:3, :3].copy()
    elastic = car.system.stiffness[:3, :3] - stiffness.sum() * np.outer(MOUNT, MOUNT)
    plate_k, plate_c = car.system.input_stiffness[:3, 0], car.system.input_damping[:3, 0]
    count = round(1.2 / step)
    z = np.asarray(spline(0.5 * step * np.arange(2 * count + 1)))
    rate = np.asarray(spline(0.5 * step * np.arange(2 * count + 1), 1))
    u, v, force, every = np.zeros(3), np.zeros(3), np.zeros(len(stiffness)), round(1e-3 / step)
    samples = [np.zeros(6)]
    for n in range(count):
        start = plate_k * z[2 * n] + plate_c * rate[2 * n] - elastic @ u - damping @ v - MOUNT * force.sum()
        u_half, v_half = u + 0.5 * step * v, v + 0.5 * step * (inverse @ start)
        middle = np.clip(force + stiffness * (MOUNT @ (u_half - u)), -stiffness * stroke, stiffness * stroke)
        pull = plate_k * z[2 * n + 1] + plate_c * rate[2 * n + 1]
        pull = pull - elastic @ u_half - damping @ v_half - MOUNT * middle.sum()
        force = np.clip(force + step * stiffness * (MOUNT @ v_half), -stiffness * stroke, stiffness * stroke)
        u, v = u + step * v_half, v + step * (inverse @ pull)
        if (n + 1) % every == 0:
            samples.append(np.concatenate([u, v]))
    return np.array(samples).T


def test_the_force_follows_the_elements_along_its_path():
    run = reduced(quarter_cars(), channels=("suspension_travel_mount", "mount_force_z"), record_rate=5000.0)
    elements, force = friction_elements(FORCE, STROKE), run["mount_force_z"]
    validated(
        "Reduced engine", "rubber friction of a quarter car along its path", force,
        elements.path(run["suspension_travel_mount"]), abs=1e-9, unit="N",
        source="second derivation: elements along the recorded displacements",
    )  # fmt: skip
    assert np.max(np.abs(force)) > 0.5 * FORCE and np.count_nonzero(np.diff(np.sign(np.diff(force)))) > 20


def test_order_in_the_step():
    car = quarter_cars()
    exact = midpoint(car, 1e-5)
    steps, errors = np.array([1e-3, 5e-4, 2.5e-4]), []
    for step in steps:
        velocity = reduced(car, step=step)["damper_fr_velocity"]
        errors.append(np.std(velocity - exact[5]) / np.std(exact[5]))
    source = "second derivation: midpoint rule with steps of 10 us"
    validated(
        "Reduced engine", "order of convergence of a quarter car with rubber friction",
        np.polyfit(np.log(steps), np.log(errors), 1)[0], 2.0, within=(1.9, 2.4), source=source,
    )  # fmt: skip
    validated(
        "Reduced engine", "quarter car with rubber friction, RMS error of the damper velocity, step 0.25 ms",
        errors[-1], 0.0, abs=1e-3, source=source,
    )  # fmt: skip


def test_a_held_load_does_not_creep():
    time = np.arange(0.0, 30.0005, 1e-3)
    z = 8e-3 * np.clip(time / 0.3, 0.0, 1.0) ** 2 * (3.0 - 2.0 * np.clip(time / 0.3, 0.0, 1.0))
    z += 5e-4 * np.sin(2.0 * np.pi * 12.5 * time) * np.clip(time - 0.3, 0.0, 1.0)
    run = reduced(
        quarter_cars(held=1e5),
        Signal(time=time, displacement={"fr": z}),
        channels=("suspension_travel_mount", "mount_force_z"),
    )
    mean = [np.mean(run["suspension_travel_mount"][first : first + 80]) for first in (20000, 28000)]
    assert (
        abs(np.mean(run["mount_force_z"][20000:])) > 0.2 * FORCE and np.ptp(run["mount_force_z"][20000:]) > 0.1 * FORCE
    )
    validated(
        "Reduced engine", "creep of a mount with rubber friction under a held load and a vibration",
        60.0 * (mean[1] - mean[0]) / 8.0, 0.0, abs=1e-12, unit="m/min",
        source="closed form: a held load does not creep",
    )  # fmt: skip


def test_a_batch_follows_the_single_run():
    cars = [quarter_cars(), quarter_cars(0.5), quarter_cars(2.0, 2.0 * STROKE), matrices(TYRE_DAMPING)]
    run: dict[str, Any] = {"record_rate": 1000.0, "step": 5e-4, "channels": CHANNELS}

    def batch(group):
        return simulate_batch(
            [pole_model(car) for car in group], SHORT, dampers=[[damper(coulomb_friction=0.0)] * 2] * len(group),
            tyre_load=[RUN["tyre_load"]] * len(group), **run,
        )  # fmt: skip

    together, alone = batch(cars), batch(cars[1:2])
    for index, car in enumerate(cars):
        single = reduced(car, step=5e-4)
        for name in CHANNELS:
            error = np.std(together.channels[name][index] - single[name]) / np.std(single[name])
            assert error < 2e-3, (index, name, error)
    for name in CHANNELS:
        np.testing.assert_array_equal(together.channels[name][1], alone.channels[name][0])
    assert np.std(together.channels[CHANNELS[1]][0] - together.channels[CHANNELS[1]][3]) > 0.0


def test_the_iteration_over_forces_is_bounded():
    (factors,) = car_factors([pole_model(quarter_cars())], 2e-4, [0], exact=True)
    car = quarter_cars()
    runs = [reduced(car)[CHANNELS[1]]]
    assert 2 <= factors.iterations <= 6
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(factors), "iterations", property(lambda self: 40))
        runs.append(reduced(car)[CHANNELS[1]])
    assert np.max(np.abs(runs[0] - runs[1])) < 1e-8 * np.max(np.abs(runs[1]))


def test_a_car_without_its_tangent_is_rejected():
    elements = friction_elements(1e3 * FORCE, 1e-2 * STROKE)
    car = dataclasses.replace(matrices(TYRE_DAMPING), laws=(law(0, elements), law(1, elements)))
    with pytest.raises(SimulationError, match=r"mount 0 along z: .*--engine mujoco"):
        reduced(car, step=1e-3)
