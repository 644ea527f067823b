"""Presliding friction in both engines: loops, creep, order in the step, the limit of a stiff curve."""

import dataclasses

import numpy as np
import pytest

from tests.engines.reduced.test_reduced_quarter_car import CAR, ROAD, damper, matrices
from tests.engines.simulation.row_model import Stepper, add_damper, add_mass, empty_spec
from tests.validation import validated
from vehicle.engines.linear.damper_elements import SliderElements
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.model.laws.jenkins import Jenkins
from vehicle.model.laws.presliding import presliding_elements
from vehicle.signals.excitation.signal import Signal, uniform_time

LIMIT, STIFFNESS, MASS, SPRING, VISCOUS = 125.0, 5e5, 40.0, 4e4, 200.0
LAW = damper(friction_law="presliding", presliding_stiffness=STIFFNESS, coulomb_friction=LIMIT)
STEPS = np.array([1e-3, 5e-4, 2.5e-4])


def strut(step, elements):
    """A mass on a slide joint with a spring to the ground and a damper with presliding friction."""
    spec = empty_spec(step)
    body = add_mass(spec.worldbody, "mass", MASS)
    add_damper(spec, body, [VISCOUS, 1e5, LIMIT, LIMIT, 1.0, 1.0], stiffness=SPRING, sliders=elements)
    return Stepper(spec)


def push(time):
    """A force on the mass [N] that slides and sticks."""
    return (
        150.0 * np.sin(2.0 * np.pi * 3.1 * time) + 60.0 * np.sin(2.0 * np.pi * 11.0 * time + 1.0) - 60.0 * np.sin(1.0)
    )


def stepped(step, elements, duration=0.6, force=push):
    run = strut(step, elements)

    def before(time):
        run.data.xfrc_applied[1, 0] = force(time)

    def read():
        return [run.data.qpos[0], run.rows.state.slider[0].sum()]

    return run.step(round(duration / step) + 1, read, before)


def fine(elements, samples, interval, force=push):
    """Positions by a central scheme with 100 steps in an interval, whose forces of the elements are explicit."""
    stiffness, share = np.transpose(elements)
    x = v = t = 0.0
    h, inner, sliders, found = interval / 100, 100, np.zeros(len(stiffness)), [0.0]
    for _ in range(samples - 1):
        for _ in range(inner):
            # Velocity Verlet with the middle velocity in the damper.
            a = (force(t) - SPRING * x - VISCOUS * v - sliders.sum()) / MASS
            v += h * a
            x, t = x + h * v, t + h
            sliders = np.clip(sliders + stiffness * h * v, -share * LIMIT, share * LIMIT)
        found.append(x)
    return np.array(found)


def test_a_run_in_mujoco_follows_the_elements_along_its_path():
    elements = presliding_elements(LAW)
    # The elements are advanced in the step after the position was read.
    path, friction = stepped(1e-3, elements).T
    x, friction = path[:-1], friction[1:]
    law = Jenkins(stiffness=elements[:, 0], limit=LIMIT * elements[:, 1])
    validated(
        "Dampers and friction", "presliding friction of a run in MuJoCo along its path", friction, law.path(x),
        abs=1e-9, unit="N", source="second derivation: elements along the recorded positions",
    )  # fmt: skip
    assert np.max(friction) > 0.99 * LIMIT and np.any(np.abs(friction[50:]) < 0.3 * LIMIT)


def test_order_in_mujoco():
    elements = presliding_elements(LAW)
    reference = fine(elements, 601, 1e-3)
    errors = []
    for step in STEPS:
        x = stepped(step, elements)[:: round(1e-3 / step), 0]
        errors.append(np.sqrt(np.mean((x - reference) ** 2)) / np.std(reference))
    validated(
        "Integration in MuJoCo", "order of convergence of a mass with presliding friction",
        np.polyfit(np.log(STEPS), np.log(errors), 1)[0], 2.0, within=(1.8, 2.2),
        source="second derivation: explicit steps of 10 us",
    )  # fmt: skip
    validated(
        "Integration in MuJoCo", "mass with presliding friction, RMS error of the position at 0.25 ms", errors[-1], 0.0,
        abs=2e-3, source="second derivation: explicit steps of 10 us",
    )  # fmt: skip


@pytest.mark.parametrize("stiffness", [1e7, 1e10])
def test_stable_at_any_stiffness_and_step(stiffness):
    elements = presliding_elements(dataclasses.replace(LAW, presliding_stiffness=stiffness))
    # w h is 16 and 500 in stick: it neither grows nor moves by more than the force could.
    x = stepped(0.01 if stiffness > 1e8 else 0.03, elements, duration=6.0)[:, 0]
    assert np.max(np.abs(x)) < 3.0 * 210.0 / SPRING


def test_no_creep_under_a_held_load_in_mujoco():
    elements = presliding_elements(LAW)

    def held(time):
        return 70.0 * min(time / 0.2, 1.0) + 25.0 * np.sin(2.0 * np.pi * 12.5 * time)

    x = stepped(1e-3, elements, duration=6.0, force=held)[:, 0]
    period = [np.mean(x[first : first + 80]) for first in (4000, 5600)]
    validated(
        "Dampers and friction", "creep of a strut with presliding friction under 70 N and a vibration, in MuJoCo",
        60.0 * (period[1] - period[0]) / 1.6, 0.0, abs=1e-12, unit="m/min",
        source="closed form: a held load does not creep",
    )  # fmt: skip


def quarter_cars(law, tyre_damping=0.0):
    """The two quarter cars with Jenkins elements on their dampers."""
    plain = matrices(tyre_damping)
    stiffness, share = presliding_elements(law).T
    sliders = SliderElements(
        rows=plain.system.slide_rows, dampers=np.arange(2), stiffness=np.tile(stiffness, (2, 1)),
        limit=np.tile(share, (2, 1)), steepness=np.zeros(2),
    )  # fmt: skip
    return dataclasses.replace(plain, sliders=sliders)


def reduced(signal, law, step=None, tyre_damping=0.0):
    return simulate_reduced(
        pole_model(quarter_cars(law, tyre_damping)), signal, dampers=[law] * 2, record_rate=1000.0,
        tyre_load={"fr": 1e6, "fl": 1e6},
        channels=[*matrices().system.outputs, "damper_fr_velocity", "damper_fr_force"], step=step,
    )  # fmt: skip


QUARTER = damper(friction_law="presliding", presliding_stiffness=STIFFNESS)


def explicit_quarter_car(law, samples, inner=200):
    """Body and wheel displacement of the quarter car on `ROAD`, by explicit steps of 5 us; its damper has a mass."""
    stiffness, share = presliding_elements(law).T
    limit, h = share * law.coulomb_friction, 1e-3 / inner
    time = np.arange(samples * inner) * h
    road = np.interp(time, ROAD.time, ROAD.displacement["fr"])
    system = matrices().system
    inverse = np.linalg.inv(system.mass[:3, :3])
    k, c, push_rows = system.stiffness[:3, :3], system.damping[:3, :3], system.input_stiffness[:3, 0]
    x, v, sliders, found = np.zeros(3), np.zeros(3), np.zeros(len(limit)), []
    for n in range(samples * inner):
        if n % inner == 0:
            found.append(x.copy())
        force = push_rows * road[n] - k @ x - c @ v
        force[2] -= sliders.sum()
        v = v + h * (inverse @ force)
        x = x + h * v
        sliders = np.clip(sliders + stiffness * h * v[2], -limit, limit)
    return np.array(found)


def test_a_reduced_quarter_car_against_explicit_steps():
    run, x = reduced(ROAD, QUARTER), explicit_quarter_car(QUARTER, 2001)
    share = np.mean(np.abs(run["damper_fr_force"][:2000] - CAR.damper.damping * run["damper_fr_velocity"][:2000]))
    assert 0.2 * CAR.friction.limit < share < 0.95 * CAR.friction.limit  # it sticks and it slips
    for name, values in (("suspension_mount_fr_acc_z", x[:, 0]), ("knuckle_fr_acc_z", x[:, 1])):
        expected = (values[2:] - 2.0 * values[1:-1] + values[:-2]) / 1e-6
        # A plain second difference on both sides, which the recorded acceleration is not.
        smooth = np.convolve(run[name][: len(values)], [1.0, 10.0, 1.0], "valid") / 12.0
        validated(
            "Reduced engine", f"quarter car with presliding friction, RMS error of {name}",
            np.sqrt(np.mean((smooth - expected) ** 2)) / np.std(expected), 0.0, abs=1e-2,
            source="second derivation: explicit steps of 5 us",
        )  # fmt: skip


def test_order_of_the_reduced_engine():
    signal = Signal(time=ROAD.time[:1501], displacement={"fr": ROAD.displacement["fr"][:1501]})
    fine_run = reduced(signal, QUARTER, step=1e-3 / 64)["damper_fr_velocity"]
    steps, errors = np.array([1e-3, 5e-4, 2.5e-4]), []
    for step in steps:
        errors.append(np.sqrt(np.mean((reduced(signal, QUARTER, step=step)["damper_fr_velocity"] - fine_run) ** 2)))
    validated(
        "Reduced engine", "order of convergence of a quarter car with presliding friction",
        np.polyfit(np.log(steps), np.log(errors), 1)[0], 2.0, within=(1.7, 2.3),
        source="second derivation: the same engine at 1/64 ms",
    )  # fmt: skip


def test_no_creep_in_the_reduced_engine():
    time = uniform_time(samples=70001, timestep=1e-3)
    z = 2e-3 * np.minimum(time / 0.5, 1.0) + 1e-4 * np.sin(2.0 * np.pi * 12.5 * time)
    # The tyre is damped: the car would still swing on it for minutes.
    run = reduced(Signal(time=time, displacement={"fr": z}), QUARTER, tyre_damping=5000.0)
    # 12.5 Hz: whole periods of 80 samples. The mean velocity over a minute is the creep.
    creep = np.sum(run["damper_fr_velocity"][8000:68000]) * 1e-3
    validated(
        "Reduced engine", "creep of a stuck damper with presliding friction in a minute", creep, 0.0, abs=1e-12,
        unit="m",
        source="closed form: a held load does not creep",
    )  # fmt: skip
    assert np.std(run["damper_fr_velocity"][8000:68000]) > 1e-5


def test_single_and_double_precision():
    law = dataclasses.replace(QUARTER, presliding_stiffness=2e6)
    model = pole_model(quarter_cars(law))
    channels = ["suspension_mount_fr_acc_z", "knuckle_fr_acc_z", "damper_fr_force"]
    batch = simulate_batch(
        [model] * 3, ROAD, dampers=[[law] * 2] * 3, record_rate=1000.0, tyre_load=[{"fr": 1e6, "fl": 1e6}] * 3,
        channels=channels, step=5e-4,
    )  # fmt: skip
    single = simulate_reduced(
        model, ROAD, dampers=[law] * 2, record_rate=1000.0, tyre_load={"fr": 1e6, "fl": 1e6}, channels=channels,
        step=5e-4,
    )  # fmt: skip
    for name in channels:
        values = batch.channels[name]
        assert np.array_equal(values[0], values[2])
        assert np.std(values[0] - single[name]) < 1e-3 * np.std(single[name]), name
        assert not np.array_equal(values[0], single[name])  # eight at once, in single precision
