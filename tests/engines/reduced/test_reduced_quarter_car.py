"""The same physics twice: two quarter cars through the reduced engine, against a stiff solver of the lumped model."""

import dataclasses

import numpy as np
import pytest
import scipy

from scenarios.lumped.input_signals import Sampled
from scenarios.lumped.quarter_car_network import quarter_car
from scenarios.lumped.quarter_car_parameters import load_quarter_car
from scenarios.lumped.stiff_solution import stiff_solution
from scenarios.quarter_car.in_mujoco import friction_of_the_rows
from scenarios.signals.random_road import random_road
from tests.engines.linear.plain_matrices import plain_matrices
from tests.validation import own_function, validated
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.simulation.recorded_acceleration import acceleration
from vehicle.model.laws.friction import Clamped
from vehicle.model.laws.stribeck import Stribeck
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.analysis.slip import slip_share
from vehicle.signals.excitation.signal import Signal, uniform_time

CAR = load_quarter_car()
ROAD = random_road(rms=2e-3, seed=2006, wheel="fr", duration=8.0, lower_band_edge=0.5, upper_band_edge=50.0)


def matrices(tyre_damping=0.0):
    """Two independent quarter cars; coordinates body, wheel, damper over wheel, for the right and the left."""
    side = {"mass": np.diag([CAR.body.mass, CAR.wheel.mass, 0.0]), "stiffness": np.zeros((3, 3))}
    damper, spring, mount = np.array([0.0, 1.0, 1.0]), np.array([1.0, -1.0, 0.0]), np.array([1.0, -1.0, -1.0])
    side["mass"] += CAR.damper.mass * np.outer(damper, damper)
    side["stiffness"] += CAR.spring.stiffness * np.outer(spring, spring) + CAR.mount.stiffness * np.outer(mount, mount)
    side["stiffness"][1, 1] += CAR.wheel.tyre_stiffness
    both = {name: np.kron(np.eye(2), matrix) for name, matrix in side.items()}
    wheels = np.array([[0.0, 1, 0, 0, 0, 0], [0, 0, 0, 0, 1, 0]])
    outputs = {}
    for wheel, first in (("fr", 0), ("fl", 3)):
        row = np.zeros(6)
        row[first + 1] = 1.0
        outputs[f"knuckle_{wheel}_acc_z"] = row.copy()
        row[first + 2] = 1.0
        outputs[f"damper_top_{wheel}_acc_z"] = row
        outputs[f"suspension_mount_{wheel}_acc_z"] = np.eye(6)[first]
    return plain_matrices(
        mass=both["mass"], damping=tyre_damping * wheels.T @ wheels, stiffness=both["stiffness"],
        dampers=np.array([2, 5]), viscous=np.full(2, CAR.damper.damping),
        plate_stiffness=CAR.wheel.tyre_stiffness * wheels, plate_damping=tyre_damping * wheels,
        tyre_stiffness=np.full(2, CAR.wheel.tyre_stiffness), tyre_damping=np.full(2, tyre_damping), outputs=outputs,
        body_rows={"body": np.zeros((6, 6))}, body_masses={"body": np.eye(6)},
    )  # fmt: skip


def damper(**changes):
    law = dataclasses.replace(
        load_vehicle().damper,
        viscous=CAR.damper.damping,
        coulomb_friction=CAR.friction.limit,
        smoothing=CAR.friction.steepness,
    )
    return dataclasses.replace(law, **changes)


def reduced(signal, **changes):
    return simulate_reduced(
        pole_model(matrices()), signal, dampers=[damper(**changes)] * 2, record_rate=1000.0,
        tyre_load={"fr": 1e6, "fl": 1e6},
        channels=[*matrices().system.outputs, "damper_fr_velocity", "damper_fl_velocity", "damper_fr_force"],
    )  # fmt: skip


@pytest.fixture(scope="module")
def solved():
    return stiff_solution(friction_of_the_rows(CAR), ROAD.time, road=Sampled(ROAD.displacement["fr"], 1e-3))


def compare(reduced, expected, bounds, law):
    for name, bound in bounds.items():
        b = expected[name]
        a = reduced[name][: b.size]
        validated(
            "Reduced engine", f"quarter car with {law} friction, RMS error of {name}",
            np.sqrt(np.mean((a - b) ** 2)) / np.sqrt(np.mean(b**2)), 0.0, abs=bound,
            source=own_function("scipy", "lumped quarter car, Radau"),
        )  # fmt: skip


def test_friction_against_the_stiff_solver(solved):
    run = reduced(ROAD)
    expected = {
        "suspension_mount_fr_acc_z": solved.acceleration("body"),
        "knuckle_fr_acc_z": solved.acceleration("wheel"),
        # It jumps between two samples, so that it is compared as it is recorded: from its positions.
        "damper_top_fr_acc_z": acceleration(solved.displacement("damper"), 1e-3),
        "damper_fr_velocity": solved.sliding_velocity(),
    }
    share = slip_share(expected["damper_fr_velocity"], 1e-3)
    assert 0.2 < share < 0.95  # it sticks and it slips
    # Point by point. The damper of 1 kg jumps at the instants of sticking and slipping, which the step rounds.
    compare(
        run.channels,
        expected,
        {
            "suspension_mount_fr_acc_z": 1e-3,
            "knuckle_fr_acc_z": 3e-3,
            "damper_fr_velocity": 3e-3,
            "damper_top_fr_acc_z": 5e-2,
        },
        "Coulomb",
    )
    size = expected["damper_top_fr_acc_z"].size
    ratio = np.std(run["damper_top_fr_acc_z"][:size]) / np.std(expected["damper_top_fr_acc_z"])
    assert ratio == pytest.approx(1.0, abs=5e-3)
    validated(
        "Reduced engine", "quarter car, share of time in which the damper slips",
        slip_share(run["damper_fr_velocity"], 1e-3), share, abs=2e-3,
        source=own_function("scipy", "lumped quarter car, Radau"),
    )  # fmt: skip
    # The left car stands still; equal poles of two equal cars mix them in the last digits.
    assert np.max(np.abs(run["knuckle_fl_acc_z"])) < 1e-9 * np.max(np.abs(run["knuckle_fr_acc_z"]))


def test_stribeck_against_the_stiff_solver():
    """A smooth Stribeck law, mild enough that both see the same steepness at rest."""
    changes = {
        "friction_law": "stribeck", "coulomb_friction": 40.0, "stribeck_friction": 75.0, "stribeck_velocity": 0.03,
        "stribeck_exponent": 3.5,
    }  # fmt: skip

    law = Clamped(
        law=Stribeck(
            friction_limit=40.0,
            static_limit=75.0,
            stribeck_velocity=0.03,
            stribeck_exponent=3.5,
            smoothing=CAR.friction.steepness,
        )
    )
    network = quarter_car(CAR, damper="friction")
    network = dataclasses.replace(network, slides=(dataclasses.replace(network.slides[0], friction=law),))
    solved = stiff_solution(network.first_order(), ROAD.time[:3001], road=Sampled(ROAD.displacement["fr"], 1e-3))
    run = reduced(ROAD, **changes)
    # The limit is that of the velocity at the beginning of a step: first order in 0.125 ms.
    compare(
        run.channels,
        {"knuckle_fr_acc_z": solved.acceleration("wheel"), "suspension_mount_fr_acc_z": solved.acceleration("body")},
        {"knuckle_fr_acc_z": 1e-2, "suspension_mount_fr_acc_z": 5e-3},
        "Stribeck",
    )


def test_a_plate_that_is_raised_and_moves_when_the_run_begins():
    # The car stands on the raised plate; M y'' + C y' + K y = k v t + c v from rest.
    height, speed, damping = 5e-3, 0.05, 400.0
    model = matrices(damping)
    system, n = model.system, 6
    inputs = np.hstack([system.input_stiffness[:, :1], system.input_damping[:, :1]])
    forced = np.linalg.solve(system.mass, np.hstack([-system.stiffness, -system.damping, inputs]))
    state = np.zeros((2 * n + 2, 2 * n + 2))
    state[:n, n : 2 * n], state[n : 2 * n], state[2 * n, 2 * n + 1] = np.eye(n), forced, 1.0
    time, step = uniform_time(samples=200, timestep=1e-3), scipy.linalg.expm(1e-3 * state)
    states = [np.append(np.zeros(2 * n + 1), speed)]
    for _ in time[1:]:
        states.append(step @ states[-1])
    wheel, rate, plate = np.array(states)[:, [1, n + 1, 2 * n]].T
    run = simulate_reduced(
        pole_model(model), Signal(time=time, displacement={"fr": height + speed * time}),
        dampers=[damper(coulomb_friction=0.0)] * 2, record_rate=1000.0, tyre_load={"fr": 1e6, "fl": 1e6},
        channels=["tyre_fr_force_z"],
    )  # fmt: skip
    expected = 1e6 + CAR.wheel.tyre_stiffness * (plate - wheel) + damping * (speed - rate)
    # Everything is linear: exact to the round-off of the load.
    validated(
        "Reduced engine", "wheel load after a start on a raised plate that moves", run["tyre_fr_force_z"], expected,
        abs=1e-6, unit="N", source="second derivation: matrix exponential of the physical coordinates",
    )  # fmt: skip
    assert np.ptp(expected) > 100.0


@pytest.mark.parametrize("rate", [125.0, 1000.0])
def test_a_short_lift_off_is_seen_at_any_recording_rate(rate):
    # A hole of 60 ms, which a sample interval of 128 ms misses.
    time = uniform_time(samples=401, timestep=1e-3)
    inside = (time > 0.15) & (time < 0.21)
    hole = np.where(inside, -5e-3 * (1.0 - np.cos(2.0 * np.pi * (time - 0.15) / 0.06)), 0.0)
    model, signal, load = pole_model(matrices()), Signal(time=time, displacement={"fr": hole}), {"fr": 1e3, "fl": 1e6}
    channels = ["tyre_fr_force_z"]
    run = simulate_reduced(model, signal, dampers=[damper()] * 2, record_rate=rate, tyre_load=load, channels=channels)
    batch = simulate_batch(
        [model], signal, dampers=[[damper()] * 2], record_rate=rate, tyre_load=[load], channels=channels
    )
    assert min(run["tyre_fr_force_z"]) < 0.0
    for statistics in (run.statistics, batch.statistics[0]):
        assert any("tyre fr would lift off" in warning for warning in statistics.warnings)
