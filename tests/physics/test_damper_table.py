"""A damper as a table of force over velocity: bump and rebound different, with gas, in both engines."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.engines.simulation.row_model import Stepper, add_damper, add_mass, empty_spec
from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError
from vehicle.model.laws.curve import Curve
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car

VELOCITY = [-0.5, -0.1, -0.02, 0.0, 0.02, 0.1, 0.5]
FORCE = [-700.0, -300.0, -150.0, 0.0, 300.0, 600.0, 1400.0]
REST = -150.0  # a gas that pushes the damper apart
MASS, STIFFNESS = 40.0, 4e4


def table_force(velocity):
    """Interpolate the table, and extrapolate its outer segments."""
    if velocity < VELOCITY[0]:
        return FORCE[0] + 1000.0 * (velocity - VELOCITY[0])
    if velocity > VELOCITY[-1]:
        return FORCE[-1] + 2000.0 * (velocity - VELOCITY[-1])
    return float(np.interp(velocity, VELOCITY, FORCE))


def strut(step, mass=MASS, stiffness=STIFFNESS):
    """Return a mass on the damper and a spring that carries the gas force."""
    spec = empty_spec(step)
    body = add_mass(spec.worldbody, "mass", mass)
    curve = Curve.through(VELOCITY, FORCE)
    law = [curve.least_slope, 1e5, 1e-9, 1e-9, 0.03, 3.5]
    add_damper(spec, body, law, stiffness=stiffness, pieces=curve.clamped(), rest=REST)
    return Stepper(spec)


@pytest.mark.parametrize("velocity", [-2.0, -0.3, -0.05, -1e-3, 0.0, 0.013, 0.06, 0.4, 3.0])
def test_the_force_is_that_of_the_table_at_the_present_velocity(velocity):
    run = strut(1e-3, mass=1e9, stiffness=0.0)
    run.data.qvel[0] = velocity
    run.step(1, run.position)
    e, data = run.rows.layout.dampers, run.data
    force = -(data.actuator_force[0] + np.sum(data.efc_force[[*e.rows, *e.valves[:, 0]]]))
    validated(
        "Dampers and friction", f"force of a tabulated damper with gas at {velocity:g} m/s", force,
        table_force(velocity) + REST, rel=1e-6, abs=1e-4, unit="N",
        source="closed form: linear interpolation of the table",
    )  # fmt: skip


def swing(step, duration=0.2):
    """Positions of a mass that is released on its spring, every 4 ms."""
    run = strut(step)
    run.data.qpos[0] = 0.02
    # MuJoCo holds the velocity of half a step before; the mass is at rest at time zero.
    run.data.qvel[0] = 0.5 * step * (STIFFNESS * 0.02 + REST) / MASS
    return run.step(round(duration / step) + 1, run.position)[:: round(4e-3 / step), 0]


def test_against_a_stiff_solver_with_second_order():
    solution = solve_ivp(
        lambda _, y: [y[1], -(STIFFNESS * y[0] + table_force(y[1]) + REST) / MASS], (0.0, 0.2), [0.02, 0.0],
        method="Radau", t_eval=np.linspace(0.0, 0.2, 51), rtol=1e-10, atol=1e-13, max_step=1e-3,
    )  # fmt: skip
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = [np.max(np.abs(swing(step) - solution.y[0])) for step in steps]
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    radau = foreign("scipy", "Radau, tolerance 1e-10")
    validated(
        "Dampers and friction", "order of convergence of a tabulated damper", order, 2.0, within=(1.7, 2.5),
        source=radau,
    )  # fmt: skip
    validated(
        "Dampers and friction", "free decay on a tabulated damper, step 1 ms", errors[-1], 0.0, abs=2e-3 * 0.02,
        unit="m", source=radau,
    )  # fmt: skip


def test_the_clamped_lines_are_the_curve():
    curve = Curve.through(VELOCITY, FORCE)
    excess, middle, limit = curve.clamped().T
    speed = np.linspace(-3.0, 3.0, 401)
    lines = np.sum(np.clip(excess * (speed[:, None] - middle), -limit, limit), axis=1)
    expected = [table_force(v) for v in speed]
    np.testing.assert_allclose(curve.least_slope * speed + lines - curve.at_rest(), expected, atol=1e-8)
    validated(
        "Dampers and friction", "force of a table of force over velocity, -3 to 3 m/s", curve.force(speed),
        np.array(expected), abs=1e-9, unit="N", source="closed form: linear interpolation, outer lines extended",
    )  # fmt: skip


def table_car(folder=None, **law):
    """Return the `focus` car with a damper table."""
    table = read_table(FOCUS_FILE)
    table["front"]["damper"] |= {"viscous_law": "table", **law}
    return Car(vehicle_of(table, folder or FOCUS_FILE.parent), folder=FOCUS_FILE.parent)


@pytest.fixture(scope="module")
def tabled():
    return table_car(velocity=VELOCITY, force=FORCE, gas_force=150.0)


def test_the_car_stands_on_the_force_of_the_gas(tabled, car):
    # The springs carry so much less; the ground's small share of horizontal stiffness turns 1e-5 of it into loads.
    for name in ("tyre_load", "support_load"):
        mine, other = getattr(tabled.model.static, name), getattr(car.model.static, name)
        assert list(mine.values()) == pytest.approx(list(other.values()), rel=1e-4)
    assert tabled.model.static.residual < 1e-9


def test_both_engines_take_the_table(tabled, high_piece):
    # Twice as large, so that it passes a corner.
    large = replace(high_piece, displacement={"fr": 2.0 * high_piece.displacement["fr"]})
    exact = tabled.run(large)
    velocity, force = exact["damper_fr_velocity"], exact["damper_fr_force"]
    sliding = np.abs(velocity) > 2e-3
    expected = [table_force(v) - 150.0 + np.sign(v) * 125.0 for v in velocity[sliding]]
    assert np.mean(np.abs(force[sliding] - expected) > 1e-6) < 0.1  # but where it stops within the step
    assert np.max(velocity) > 0.02 and np.min(velocity) < -0.01  # bump, rebound, and beyond a corner
    assert exact.recording.statistics.energies.residual < 1e-3
    fast = tabled.run(large, engine="reduced")
    # Where 15000 N s/m hold, the velocity is small: both engines are 1 % off at their steps (7 and 10 of 1000 against
    # MuJoCo at a quarter of its step, 3 with a quarter of the reduced one), as with the degressive law.
    for name, allowed in {"seat_rail_acc_z": 5e-3, "damper_fr_force": 5e-3, "damper_fr_velocity": 2e-2}.items():
        difference = np.sqrt(np.mean((fast[name] - exact[name]) ** 2))
        assert difference < allowed * np.std(exact[name]), name


def test_a_file_of_a_test_gives_the_same_law(tmp_path, tabled):
    rows = "".join(f"{v},{f}\n" for v, f in zip(VELOCITY, FORCE, strict=True))
    (tmp_path / "test.csv").write_text("velocity [m/s],force [N]\n" + rows, encoding="utf-8")
    from_file = table_car(tmp_path, curve="test.csv", gas_force=150.0)
    assert from_file.vehicle == tabled.vehicle


BAD = [
    ({"velocity": VELOCITY, "force": FORCE[1:]}, "front.damper.force: found 6 forces for 7 values of velocity"),
    ({}, "front.damper.velocity: found 0 points, must be 2 to 40"),
    ({"velocity": [-11, 1], "force": [0, 1]}, "front.damper.velocity: found -11.0 m/s, must be at least -10.0"),
    ({"curve": "none.csv"}, "front.damper.curve: "),
    ({"curve": "a.csv", "force": FORCE}, "front.damper.curve: found 'a.csv', must be the name of a file, without"),
    ({"gas_force": -1.0, "velocity": VELOCITY, "force": FORCE}, "front.damper.gas_force: found -1.0 N, must be at"),
]


@pytest.mark.parametrize(("law", "message"), BAD)
def test_bad_tables_are_refused_by_name(law, message):
    with pytest.raises(ConfigurationError) as caught:
        table_car(**law)
    assert str(caught.value).startswith(message)
