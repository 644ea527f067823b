"""Channels that are a sum hold the whole: the force of a damper with its stop, of a rolling tyre with the slope."""

from dataclasses import replace

import numpy as np
import pytest

from scenarios.signals.bump import bump_shape
from tests.engines.simulation.test_load_channels import at_poses, centres, moved_by
from tests.physics.rolling_car import rolling_car
from tests.physics.test_displacement_tables import bent, changed_car
from tests.validation import validated
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.signals.excitation.signal import Signal, uniform_time

SPEED = 15.0
ENGINES = ("mujoco", "reduced")


def tyre_channels(wheels):
    """Whole force along x of each tyre, and its two terms; (3, wheels)."""
    return [[f"tyre_{wheel}_{term}force_x" for wheel in wheels] for term in ("", "slip_", "slope_")]


@pytest.fixture(scope="module")
def stopped_runs():
    """A bump of 15 mm under a car with stops from 2 mm on, in both engines."""
    car = changed_car(bent)
    time = uniform_time(samples=601, timestep=1e-3)
    signal = Signal(time=time, displacement={"fr": bump_shape(time, amplitude=15e-3, start=0.05)})
    names = [f"damper_fr_{quantity}" for quantity in ("force", "stop_force", "velocity")]
    return {engine: car.run(signal, engine=engine, channels=names) for engine in ENGINES}


def test_the_force_of_a_stop_is_its_curve(stopped_runs):
    run = stopped_runs["mujoco"]
    damper = run.car.vehicle.composition.dampers[0]
    stroke = run.recording.poses[:, run.car.model.model.joint(damper.joint).qposadr[0]]
    at = np.rint(run.recording.pose_time / run.recording.timestep).astype(int)
    expected = np.interp(stroke, damper.law.stop.displacement, damper.law.stop.force)
    assert expected.min() < -300.0 and expected.max() > 300.0
    validated(
        "Bushings, springs and stops", "recorded force of a stop", run["damper_fr_stop_force"][at], expected, abs=1e-6,
        unit="N", source="closed form: table at the position of the damper",
    )  # fmt: skip


def test_the_force_of_a_damper_is_its_law_with_its_stop(stopped_runs):
    """D v + Fd sign v + stop, where the damper is fast; the sum does not depend on what else is recorded."""
    law = stopped_runs["mujoco"].car.vehicle.composition.dampers[0].law
    for engine, run in stopped_runs.items():
        velocity = run["damper_fr_velocity"]
        fast = np.abs(velocity) > 0.05
        assert np.count_nonzero(fast) > 50
        expected = law.viscous * velocity + law.coulomb_friction * np.sign(velocity) + run["damper_fr_stop_force"]
        validated(
            "Bushings, springs and stops", f"force of a damper that hits its stop, {engine} engine",
            run["damper_fr_force"][fast], expected[fast], abs=1.0, unit="N",
            source="closed form: D v + Fd sign v, and the recorded force of the stop",
        )  # fmt: skip
        alone = run.car.run(run.signal, engine=engine, channels=["damper_fr_force"])
        np.testing.assert_array_equal(alone["damper_fr_force"], run["damper_fr_force"])
    mujoco, reduced = (run["damper_fr_stop_force"] for run in stopped_runs.values())
    validated(
        "Reduced engine", "RMS of the force of a stop on a bump of 15 mm", float(np.std(reduced)),
        float(np.std(mujoco)), rel=1e-2, unit="N", source="second derivation: MuJoCo",
    )  # fmt: skip


@pytest.mark.parametrize("engine", ENGINES)
def test_tyres_on_a_slope_push_back_by_its_share_of_the_weight(engine):
    """At rest on its course spring: the sum of F_x is m g tan(beta), and the slip of a free wheel nothing."""
    car = Car.load("focus_road", [f"driving.speed={SPEED}"])
    time, slope = uniform_time(samples=8001, timestep=1e-3), 1e-3
    risen = 0.5 * (1.0 - np.cos(np.pi * np.clip(time / 0.5, 0.0, 1.0)))
    signal = Signal(
        time=time,
        displacement={wheel: np.zeros(time.size) for wheel in car.vehicle.wheels},
        slope_velocity=dict.fromkeys(car.vehicle.wheels, SPEED * slope * risen),
    )
    whole, slip, _ = tyre_channels(car.vehicle.wheels)
    run = car.run(signal, engine=engine, channels=[*whole, *slip])
    weight = 9.81 * sum(one[0, 0] for one in car.matrices.body_masses.values())
    validated(
        "Tyres", f"sum of the forces along x of four tyres on a slope of 0.1 %, {engine} engine",
        sum(run[name][-1] for name in whole), slope * weight, rel=2e-3, unit="N",
        source="closed form: m g tan(beta)",
    )  # fmt: skip
    assert abs(sum(run[name][-1] for name in slip)) < 2e-3 * slope * weight


def test_the_forces_along_x_of_the_tyres_move_the_car(tmp_path):
    """Newton over a slope that comes and goes at 5 Hz; the hold of the course, of 0.01 Hz, carries next to nothing."""
    overrides = ["hardpoints.seat_rail=[2.1, 0.0, 0.9]", "driving.hold_frequency=0.01"]
    step = 5e-4
    overrides += [f"solver.timestep={step}", f"solver.record_rate={1.0 / step}"]
    car = rolling_car(tmp_path, SPEED, gravity=9.81, overrides=overrides)
    time = uniform_time(samples=1001, timestep=1e-3)
    slope = 0.02 * np.sin(2.0 * np.pi * 5.0 * time) * np.clip(time / 0.2, 0.0, 1.0)
    signal = Signal(
        time=time,
        displacement={wheel: np.zeros(time.size) for wheel in car.vehicle.wheels},
        slope_velocity=dict.fromkeys(car.vehicle.wheels, SPEED * slope),
    )
    whole = tyre_channels(car.vehicle.wheels)[0]
    run = car.run(signal, channels=whole)
    mass, centre = centres(run, list(car.matrices.body_masses))
    force = np.zeros((len(run.time), 3))
    force[:, 0] = sum(run[name] for name in whole)
    found, expected = moved_by(force, mass, step)[at_poses(run), 0], centre[:, 0] - centre[0, 0]
    assert np.ptp(expected) > 3e-4
    validated(
        "Tyres", "motion of the centre of gravity along x on a slope of 2 % at 5 Hz, from the forces of the tyres",
        found, expected, peak=1e-2, unit="m", source="conservation: Newton, summed twice over time",
    )  # fmt: skip


def test_engines_agree_on_the_forces_along_x_of_a_cleat():
    drive = Road("cleat:1x50@15", speed=30.0, duration=2.5).under(Car.load("focus_road").vehicle)
    car, signal = Car.load("focus_road", [*drive.overrides, "solver.timestep=2.5e-4"]), drive.signal()
    names = tyre_channels(["fr", "rl"])
    flat = [name for term in names for name in term]
    reduced, whole = (car.run(signal, engine=engine, channels=flat) for engine in ("reduced", "mujoco"))
    start = round(1.2 * car.vehicle.solver.record_rate)
    for term, channels in zip(("total force", "force of the slip", "force on the slope"), names, strict=True):
        found, expected = (np.std([run[name][start:] for name in channels], axis=1) for run in (reduced, whole))
        assert np.all(expected > 1.0)
        validated(
            "Reduced engine", f"RMS of the {term} along x of two tyres on a cleat of 1 x 50 mm", found, expected,
            rel=1e-2, unit="N", source="second derivation: MuJoCo at 0.25 ms",
        )  # fmt: skip
    for run in (reduced, whole):
        for total, slip, slope in zip(*names, strict=True):
            np.testing.assert_allclose(run[total], run[slip] + run[slope], atol=1e-9)
    level = car.run(replace(signal, slope_velocity={}), engine="reduced", channels=flat)
    assert np.std(level["tyre_fr_slope_force_x"]) != pytest.approx(np.std(reduced["tyre_fr_slope_force_x"]), rel=1e-2)
