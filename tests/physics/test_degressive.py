"""The degressive damper as simulated: its law, alone and with friction, against a stiff solver, and in the car."""

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from scenarios.lumped.degressive import Degressive
from tests.engines.simulation.row_model import Stepper, add_damper, add_mass, empty_spec
from tests.validation import foreign, validated
from vehicle.runs.car import Car

LAW = Degressive(low_damping=15000.0, high_damping=1500.0, knee_velocity=0.02)  # appendix C.2 of Bommer 2006
VALVE = [13500.0, 0.0, 13500.0 * 0.02]
SMOOTHING, MASS, STIFFNESS = 1e5, 40.0, 4e4
OVERRIDES = ['damper.viscous_law="degressive"']


def strut(step, friction=(0.0, 0.0), *, mass=MASS, stiffness=0.0):
    """Return a mass on a degressive damper; `friction` are the sliding and the static limit [N]."""
    spec = empty_spec(step)
    body = add_mass(spec.worldbody, "mass", mass)
    law = [LAW.high_damping, SMOOTHING, max(friction[0], 1e-9), max(friction[1], 1e-9), 0.03, 3.5]
    add_damper(spec, body, law, stiffness=stiffness, pieces=[VALVE])
    return Stepper(spec)


def force_of(velocity, friction=(0.0, 0.0)):
    """Return the total damper force, with a linear friction law up to its limit like the rows."""
    limit = friction[0] + (friction[1] - friction[0]) * np.exp(-(np.abs(velocity / 0.03) ** 3.5))
    slope = 2.0 / np.pi * limit * SMOOTHING
    return float(LAW.force(velocity)) + float(np.clip(slope * velocity, -limit, limit))


@pytest.mark.parametrize("velocity", [1e-3, -0.01, 0.019, 0.021, -0.05, 0.3])
@pytest.mark.parametrize("friction", [(0.0, 0.0), (125.0, 125.0), (65.0, 125.0)], ids=["alone", "coulomb", "stribeck"])
def test_the_force_is_the_law_at_the_present_velocity(velocity, friction):
    # On a mass that nothing stops.
    run = strut(1e-3, friction, mass=1e7)
    run.data.qvel[0] = velocity
    run.step(1, run.position)
    e, data = run.rows.layout.dampers, run.data
    rows = np.concatenate([e.rows, e.frictions, e.valves[:, 0]])
    force = -(data.actuator_force[0] + np.sum(data.efc_force[rows]))
    # m v changes by 1e-7 in the step
    validated(
        "Dampers and friction",
        f"force of the degressive damper at {velocity:g} m/s, friction {friction[0]:g} and {friction[1]:g} N", force,
        force_of(velocity, friction), rel=1e-5, unit="N",
        source="closed form: Bommer 2006, appendix C.2, with Coulomb or Stribeck friction",
    )  # fmt: skip


def swing(step, friction, duration=0.3):
    """Return the positions of a mass released on its spring."""
    run = strut(step, friction, stiffness=STIFFNESS)
    run.data.qpos[0] = 0.01
    # MuJoCo holds the velocity of half a step before; the mass is at rest at time zero.
    run.data.qvel[0] = 0.5 * step * STIFFNESS * 0.01 / MASS
    return run.step(round(duration / step) + 1, run.position)[:, 0]


def exact(friction, duration=0.3):
    """Return the same motion by a stiff solver, every 4 ms."""
    times = np.linspace(0.0, duration, round(duration / 4e-3) + 1)
    solution = solve_ivp(
        lambda _, y: [y[1], -(STIFFNESS * y[0] + force_of(y[1], friction)) / MASS], (0.0, duration), [0.01, 0.0],
        method="Radau", t_eval=times, rtol=1e-9, atol=1e-13, max_step=1e-3,
    )  # fmt: skip
    return solution.y[0]


@pytest.mark.parametrize("friction", [(0.0, 0.0), (50.0, 50.0), (30.0, 60.0)], ids=["alone", "coulomb", "stribeck"])
def test_against_a_stiff_solver(friction):
    reference = exact(friction)
    fine = swing(1e-3, friction)[::4]
    # D h/m = 0.4 a step: centred, that is (D h/m)2/12 = 1 % of the motion of the first 3 ms, 5e-4 of the amplitude.
    # Stribeck friction, which follows the velocity of half a step before, adds 5e-4 at most.
    size = min(len(fine), len(reference))
    validated(
        "Dampers and friction",
        f"free decay on a degressive damper with friction {friction[0]:g} and {friction[1]:g} N", fine[:size],
        reference[:size], abs=1e-3 * 0.01, unit="m", source=foreign("scipy", "Radau, tolerance 1e-9"),
    )  # fmt: skip
    # A linear damper is another one.
    slack = strut(1e-3, friction, stiffness=STIFFNESS)
    slack.rows.layout.dampers.pieces[0, 2] = 1e-9
    slack.data.qpos[0] = 0.01
    assert np.max(np.abs(slack.step(301, slack.position)[::4, 0] - reference)) > 0.1 * 0.01


def test_the_centred_row_is_of_second_order():
    reference = exact((0.0, 0.0), 0.2)
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = [
        np.max(np.abs(swing(step, (0.0, 0.0), 0.2)[:: round(4e-3 / step)][: len(reference)] - reference))
        for step in steps
    ]
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    # A row with the velocity at the end of the step, like the friction row, would have order 1.
    validated(
        "Dampers and friction", "order of convergence of the degressive damper", order, 2.0, within=(1.7, 2.5),
        source=foreign("scipy", "Radau, tolerance 1e-9"),
    )  # fmt: skip


@pytest.fixture(scope="module")
def degressive_car():
    return Car.load(overrides=OVERRIDES)


def test_the_car_has_two_more_rows_only_where_the_law_asks(degressive_car, car):
    equal = Car.load(overrides=[*OVERRIDES, "damper.degressive_viscous=2250"])
    for candidate, rows in ((degressive_car, 68), (car, 66), (equal, 66)):
        data = mujoco.MjData(candidate.model.model)
        mujoco.mj_forward(candidate.model.model, data)
        assert data.nefc == rows


def test_the_damper_of_the_car_follows_its_law(degressive_car, high_piece):
    run = degressive_car.run(high_piece)
    damper = degressive_car.vehicle.damper
    law = Degressive(
        low_damping=damper.degressive_viscous, high_damping=damper.viscous, knee_velocity=damper.degressive_velocity
    )
    velocity, force = run["damper_fr_velocity"], run["damper_fr_force"]
    sliding = np.abs(velocity) > 1e-3
    assert np.sum(sliding) > 200
    expected = law.force(velocity[sliding]) + np.sign(velocity[sliding]) * damper.coulomb_friction
    # Samples in which the damper stops have a friction anywhere below its limit.
    away = np.abs(force[sliding] - expected) > 1e-3 * damper.coulomb_friction
    assert np.mean(away) < 0.1
    assert run.recording.statistics.energies.residual < 1e-3
