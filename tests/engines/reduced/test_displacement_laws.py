"""Bump stops, tables and tyres that lift off in the reduced engine: against a stiff solver, in batches, and MuJoCo."""

import dataclasses
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from scenarios.signals.random_road import random_road
from tests.engines.reduced.test_reduced_quarter_car import CAR, ROAD, damper, matrices
from tests.validation import foreign, validated
from vehicle.engines.linear.displacement_laws import BUSHING, STOP, DisplacementLaw
from vehicle.engines.reduced.batch_simulation import _single_precision_factors, simulate_batch
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.model.laws.curve import Curve
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road, lifting_tyres
from vehicle.signals.excitation.signal import Signal

ROAD_OF_STOPS = Signal(time=ROAD.time[:1201], displacement={"fr": ROAD.displacement["fr"][:1201]})
TYRE_DAMPING, LOAD = 300.0, 250.0
# A bump stop of two rates and a softer rebound stop; displacement of the damper.
STOPS = {"displacement": [-0.02, -0.003, -0.0015, 0.002, 0.02], "force": [-6900.0, -100.0, 0.0, 0.0, 1800.0]}


def stop(wheel):
    """The stop of a damper as a law over displacement."""
    curve = Curve.through(STOPS["displacement"], STOPS["force"])
    return DisplacementLaw(
        name=f"stop of damper {wheel + 1}", element=(STOP, wheel, 0), row=np.eye(6)[2 + 3 * wheel], plate=-1,
        breakpoints=curve.knots, changes=np.diff(curve.slopes),
    )  # fmt: skip


def tyre(wheel):
    """A tyre that cannot pull as a law over displacement."""
    stiffness = CAR.wheel.tyre_stiffness
    return DisplacementLaw(
        name="tyre", element=(BUSHING, wheel, 2), row=np.eye(6)[1 + 3 * wheel], plate=wheel,
        breakpoints=np.array([LOAD / stiffness]), changes=np.array([-stiffness]), rate_time=TYRE_DAMPING / stiffness,
        one_sided=True,
    )  # fmt: skip


CASES = {"a bump stop": (stop,), "a tyre that lifts off": (tyre,), "both": (stop, tyre)}


def quarter_cars(case):
    """Both quarter cars with laws over displacement."""
    plain = matrices(TYRE_DAMPING)
    laws = tuple(make(wheel) for make in CASES[case] for wheel in (0, 1))
    return dataclasses.replace(plain, laws=laws, one_sided=frozenset({"fr", "fl"} if tyre in CASES[case] else ()))


RUN: dict[str, Any] = {
    "record_rate": 1000.0,
    "channels": ["tyre_fr_force_z", "damper_fr_velocity", "suspension_mount_fr_acc_z"],
}


def reduced(case, step):
    return simulate_reduced(
        pole_model(quarter_cars(case)), ROAD_OF_STOPS, dampers=[damper(coulomb_friction=0.0)] * 2,
        tyre_load=dict.fromkeys(("fr", "fl"), LOAD), step=step, **RUN,
    )  # fmt: skip


def solved(case):
    """Tyre force and damper velocity of the quarter car by an adaptive solver, with the laws written out."""
    system, spline, time = matrices(TYRE_DAMPING).system, ROAD_OF_STOPS.spline("fr", 0.0, 1.2), ROAD_OF_STOPS.time
    stiffness, lifts, stops = CAR.wheel.tyre_stiffness, tyre in CASES[case], stop in CASES[case]
    inverse, k, c = (
        np.asarray(matrix)[:3, :3].tolist()
        for matrix in (np.linalg.inv(system.mass[:3, :3]), system.stiffness, system.damping)
    )
    heights, slopes = spline(time).tolist(), spline(time, 1).tolist()
    x, f = STOPS["displacement"], STOPS["force"]
    rates = [(high - low) / (b - a) for a, b, low, high in zip(x, x[1:], f, f[1:], strict=False)]

    def road(t):
        """Height and its rate: a cubic between two samples, which are 1 ms apart."""
        n = min(int(1e3 * t), len(heights) - 2)
        s, (a, b), (p, q) = 1e3 * t - n, heights[n : n + 2], (1e-3 * slope for slope in slopes[n : n + 2])
        third, second = 2.0 * (a - b) + p + q, 3.0 * (b - a) - 2.0 * p - q
        return a + s * (p + s * (second + s * third)), 1e3 * (p + s * (2.0 * second + 3.0 * s * third))

    def tyre_force(t, y):
        height, rate = road(t)
        linear = LOAD + stiffness * (height - y[1]) + TYRE_DAMPING * (rate - y[4])
        return max(linear, 0.0) if lifts else linear

    def stop_force(d):
        n = sum(d > knot for knot in x[1:-1])
        return f[n] + rates[n] * (d - x[n])

    def law(t, state):
        y = state.tolist()  # plain numbers: the solver asks 100 000 times
        force = [
            -sum(a * b for a, b in zip(row, y[:3], strict=True)) - sum(a * b for a, b in zip(drag, y[3:], strict=True))
            for row, drag in zip(k, c, strict=True)
        ]
        force[1] += stiffness * y[1] + TYRE_DAMPING * y[4] + tyre_force(t, y) - LOAD
        force[2] -= stop_force(y[2]) if stops else 0.0
        return [*y[3:], *(sum(a * b for a, b in zip(row, force, strict=True)) for row in inverse)]

    y = solve_ivp(law, (0.0, 1.2), np.zeros(6), method="DOP853", t_eval=time, rtol=1e-9, atol=1e-11, max_step=5e-4).y
    return np.array([tyre_force(t, row) for t, row in zip(time, y.T, strict=True)]), y[5], y[2]


@pytest.mark.parametrize("case", CASES)
def test_a_quarter_car_against_an_adaptive_solver(case):
    force, velocity, position = solved(case)
    assert np.mean(force <= 0.0) > 0.02 or tyre not in CASES[case]
    assert np.mean((position < -0.0015) | (position > 0.002)) > 0.05 or stop not in CASES[case]
    steps, errors, source = np.array([1e-3, 5e-4, 2.5e-4]), [], foreign("scipy", "DOP853, tolerance 1e-9")
    for step in steps:
        run = reduced(case, step)
        errors.append(np.std(run["damper_fr_velocity"] - velocity) / np.std(velocity))
        assert run.statistics.warnings == () or tyre not in CASES[case]
    validated(
        "Reduced engine", f"order of convergence of a quarter car with {case}",
        np.polyfit(np.log(steps), np.log(errors), 1)[0], 2.0, within=(1.6, 2.4), source=source,
    )  # fmt: skip
    validated(
        "Reduced engine", f"quarter car with {case}, RMS error of the damper velocity, step 0.25 ms", errors[-1], 0.0,
        abs=2e-3, source=source,
    )  # fmt: skip
    validated(
        "Reduced engine", f"quarter car with {case}, RMS error of the tyre load, step 0.25 ms",
        np.std(run["tyre_fr_force_z"] - force) / np.std(force), 0.0, abs=2e-3, source=source,
    )  # fmt: skip
    if tyre in CASES[case]:
        assert min(run["tyre_fr_force_z"]) > -1e-6 and "tyre fr left its plate" in run.statistics.notices[0]


def test_a_batch_follows_the_single_run():
    # Cars of different stops, and one without: groups of equal laws.
    soft = quarter_cars("both")
    scaled = tuple(
        dataclasses.replace(law, changes=0.7 * law.changes) if "stop" in law.name else law for law in soft.laws
    )
    cars = [quarter_cars("both"), dataclasses.replace(soft, laws=scaled), matrices(TYRE_DAMPING)]
    run: dict[str, Any] = {
        "tyre_load": [dict.fromkeys(("fr", "fl"), LOAD)] * 3,
        "dampers": [[damper()] * 2] * 3,
        "step": 5e-4,
        **RUN,
    }
    batch = simulate_batch([pole_model(car) for car in cars], ROAD_OF_STOPS, **run)
    alone = simulate_batch(
        [pole_model(cars[1])], ROAD_OF_STOPS, **run | {"tyre_load": run["tyre_load"][:1], "dampers": run["dampers"][:1]}
    )
    for index, car in enumerate(cars):
        single = simulate_reduced(
            pole_model(car), ROAD_OF_STOPS, dampers=run["dampers"][0], tyre_load=run["tyre_load"][0], step=5e-4, **RUN
        )
        for name in RUN["channels"]:
            error = np.std(batch.channels[name][index] - single[name]) / np.std(single[name])
            assert error < 2e-3, (index, name, error)
            if index == 1:
                np.testing.assert_array_equal(batch.channels[name][1], alone.channels[name][0])
    assert np.std(batch.channels["damper_fr_velocity"][0] - batch.channels["damper_fr_velocity"][1]) > 0.0


def test_a_law_at_a_breakpoint_and_its_slopes():
    curve = Curve.through([-0.1, 0.0, 0.1], [-200.0, 0.0, 100.0])
    law = dataclasses.replace(
        stop(0), breakpoints=np.array([0.0, -0.0]), changes=0.5 * np.diff(curve.slopes)[0] * np.ones(2)
    )
    for x in (-0.05, 0.0, 0.03):
        assert law.force(x) == pytest.approx(curve.force(x) - 1500.0 * x)
    assert law.slopes == (-500.0, 500.0) and (law.low, law.high) == (0.0, 0.0)


def test_a_car_over_a_cleat_that_lifts_its_tyres():
    fixed, road = Car.load("focus_road"), Road("cleat:15x50", speed=30)
    lifting = [f"{path}.one_sided=true" for path in lifting_tyres(fixed.vehicle)]
    car = fixed.with_([*lifting, "solver.timestep=0.00025"])
    stepped, run = car.run(road), car.run(road, engine="reduced")
    notices = [
        [text for text in each.recording.statistics.notices if "left its plate" in text] for each in (stepped, run)
    ]
    assert len(notices[0]) == 2 and notices[0] == notices[1]
    # Along y parts move by what is second order in the travel, with tyres on the road too.
    names = [name for name in run.recording.channels if name.endswith(("acc_z", "force_z"))]
    validated(
        "Reduced engine", "RMS of vertical channels over that of MuJoCo, cleat that lifts two tyres",
        np.array([np.std(run[name]) / np.std(stepped[name]) for name in names]), 1.0, abs=6e-3,
        source="second derivation: MuJoCo at 0.25 ms",
    )  # fmt: skip
    linear = fixed.with_(["*.bushings.tyre.one_sided=false"])
    pulling = linear.run(road, engine="reduced")["tyre_rl_force_z"]
    assert np.min(pulling) < -100.0 and np.std(pulling) > 1.02 * np.std(run["tyre_rl_force_z"])


def test_the_force_of_a_stop_in_a_batch():
    """A stop that is free at rest runs in single precision, one that is loaded at rest alone: both with its force."""
    free = "front.damper.stop={displacement=[-0.03, -0.002, 0.002, 0.03], force=[-2800.0, 0.0, 0.0, 2800.0]}"
    loaded = "front.damper.stop={displacement=[-0.03, -0.002, 0.001, 0.03], force=[-2800.0, 0.0, 300.0, 3200.0]}"
    cars = [Car.load("focus", [changes]) for changes in (free, loaded)]
    laws = [[damper.law for damper in car.vehicle.composition.dampers] for car in cars]
    names = ["damper_fr_force", "seat_rail_acc_z"]
    models = [car.poles for car in cars]
    signal = random_road(rms=5e-3, seed=3, wheel="fr", duration=2.0)
    run: dict[str, Any] = {"record_rate": 1000.0, "channels": names, "step": 5e-4}
    columns = [models[0].matrices.system.inputs.index(wheel) for wheel in signal.wheels]
    assert set(_single_precision_factors(models, laws, 5e-4, columns, names)) == {0}
    batch = simulate_batch(models, signal, dampers=laws, tyre_load=[car.static.tyre_load for car in cars], **run)
    for index, car in enumerate(cars):
        one = simulate_reduced(models[index], signal, dampers=laws[index], tyre_load=car.static.tyre_load, **run)
        without = simulate_reduced(
            models[index], signal, dampers=[dataclasses.replace(law, stop=None) for law in laws[index]],
            tyre_load=car.static.tyre_load, **run,
        )  # fmt: skip
        force = one["damper_fr_force"]
        assert np.std(batch.channels["damper_fr_force"][index] - force) < 1e-4 * np.std(force)
        assert np.std(without["damper_fr_force"] - force) > 0.1 * np.std(force)
