"""Springs, bushings and stops as tables of force over displacement."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from tests.engines.simulation.row_model import Stepper, add_damper, add_mass, empty_spec
from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError
from vehicle.model.laws.curve import Curve
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal_file import read_signal

# A bump stop: nothing up to 20 mm, then two rates; and a rebound stop.
GIVES, FORCES = [-0.06, -0.04, -0.02, 0.03, 0.04], [-9000.0, -1000.0, 0.0, 0.0, 2000.0]
MASS, SPEED = 40.0, 1.2


def stop_force(x):
    """Interpolate the table, and extrapolate its outer segments."""
    if x < GIVES[0]:
        return FORCES[0] + 4e5 * (x - GIVES[0])
    if x > GIVES[-1]:
        return FORCES[-1] + 2e5 * (x - GIVES[-1])
    return float(np.interp(x, GIVES, FORCES))


def dropped(step, speed=SPEED, duration=0.12):
    """Positions of a mass that flies into the stop, every 4 ms."""
    spec = empty_spec(step)
    body = add_mass(spec.worldbody, "mass", MASS)
    add_damper(spec, body, [0.0, 1e5, 1e-9, 1e-9, 0.03, 3.5])
    spec.add_numeric(name="table/damper_fr", data=[*GIVES, *FORCES])
    run = Stepper(spec)
    run.data.qvel[0] = -speed
    return run.step(round(duration / step) + 1, run.position)[:: round(4e-3 / step), 0]


def test_a_mass_is_thrown_back_by_a_bump_stop():
    fine = dropped(1e-4)
    # Turning point: where the area under the table is the kinetic energy.
    deepest = min(fine)
    depth = np.linspace(-0.1, 0.0, 2001)
    work = [quad(stop_force, 0.0, x, points=[p for p in GIVES if x < p < 0.0] or None)[0] for x in depth]
    expected = np.interp(-0.5 * MASS * SPEED**2, -np.array(work), depth)
    # sampled every 4 ms
    validated(
        "Bushings, springs and stops", "turning point of a mass that hits a bump stop", deepest, expected, rel=5e-3,
        unit="m", source="conservation: kinetic energy is the area under the table",
    )  # fmt: skip
    # And the whole flight against quadrature in time, with second order.
    steps, speeds = np.array([4e-3, 2e-3, 1e-3, 5e-4]), SPEED * np.linspace(0.9, 1.1, 7)
    flights = [
        solve_ivp(
            lambda _, y: [y[1], -stop_force(y[0]) / MASS],
            (0.0, 0.12),
            [0.0, -speed],
            t_eval=np.linspace(0.0, 0.12, 31),
            rtol=1e-10,
            atol=1e-13,
            max_step=2e-4,
        ).y[0]
        for speed in speeds
    ]
    # The position of a breakpoint inside a step is random, so use several flights.
    errors = [
        np.mean([np.max(np.abs(dropped(step, speed) - flight)) for speed, flight in zip(speeds, flights, strict=True)])
        for step in steps
    ]
    order, rk45 = np.polyfit(np.log(steps), np.log(errors), 1)[0], foreign("scipy", "RK45, tolerance 1e-10")
    validated(
        "Bushings, springs and stops", "order of convergence at the corners of a bump stop", order, 2.0,
        within=(1.6, 2.5), source=rk45,
    )  # fmt: skip
    validated(
        "Bushings, springs and stops", "mean error of seven flights into a bump stop, step 0.5 ms", errors[-1], 0.0,
        abs=1e-3 * 0.06, unit="m", source=rk45,
    )  # fmt: skip


def test_the_energy_of_a_curve_is_its_area():
    curve = Curve.through(GIVES, FORCES)
    for x in (-0.09, -0.05, -0.03, 0.0, 0.01, 0.035, 0.05):
        corners = [p for p in GIVES if min(x, 0.0) < p < max(x, 0.0)]
        validated(
            "Bushings, springs and stops", f"energy of a bump stop at {1e3 * x:g} mm", curve.energy(x),
            quad(stop_force, 0.0, x, points=corners or None)[0], abs=1e-9, unit="J", source=foreign("scipy", "quad"),
        )  # fmt: skip
    for force in (-9500.0, -3000.0, -10.0, 0.0, 500.0, 3000.0):
        validated(
            "Bushings, springs and stops", f"position at which a bump stop has {force:g} N, put into the table",
            stop_force(curve.position(force)), force, abs=1e-9, unit="N",
            source="closed form: linear interpolation of the table",
        )  # fmt: skip


FRONT = read_table(FOCUS_FILE)["front"]
SPRING, TYRE = FRONT["main_spring"]["stiffness"], FRONT["bushings"]["tyre"]["stiffness"][2]


def changed_car(change):
    """The car with a change of its front axle."""
    table = read_table(FOCUS_FILE)
    change(table["front"])
    return Car(vehicle_of(table, FOCUS_FILE.parent), folder=FOCUS_FILE.parent)


def bent(front):
    """A progressive spring, a tyre that does not pull, and stops."""
    front["main_spring"]["table"] = {
        "displacement": [-0.3, -0.1, 0.1],
        "force": [-0.1 * SPRING - 0.2 * 1.5 * SPRING, -0.1 * SPRING, 0.1 * SPRING],
    }
    front["bushings"]["tyre"]["table_z"] = {"displacement": [-0.1, 0.0, 0.1], "force": [-0.1 * TYRE, 0.0, 0.0]}
    # The point at 0 is on the line through its neighbours, so it is not an end of the segment.
    stop = {"displacement": [-0.05, -0.002, 0.0, 0.002, 0.05], "force": [-9600.0, 0.0, 0.0, 0.0, 9600.0]}
    front["damper"]["stop"] = stop


@pytest.fixture(scope="module")
def bump_piece():
    """The shipped bump of 7.5 mm."""
    return read_signal(find_input("bump_7p5mm.csv"), wheel="fr")


@pytest.fixture(scope="module")
def bent_car():
    return changed_car(bent)


def test_the_car_stands_on_its_tables(bent_car, car):
    static, model = bent_car.model.static, bent_car.model.model
    assert static.residual < 1e-9
    # The static position does not depend on stiffness, except for the remaining share of the ground during settling.
    assert list(static.tyre_load.values()) == pytest.approx(list(car.model.static.tyre_load.values()), rel=1e-3)
    bend = {law.name: law for law in bent_car.matrices.laws}
    load = static.tyre_load["fr"]
    # The tyre is at -load / K of the table, so that it leaves the ground after as much.
    validated(
        "Bushings, springs and stops", "way up to which a tyre of a table keeps contact",
        bend["bushing/tyre_fr along z"].high, load / TYRE, rel=1e-9, unit="m",
        source="closed form: static load over stiffness",
    )  # fmt: skip
    assert (bend["stop of damper 1"].low, bend["stop of damper 1"].high) == (-0.002, 0.002)
    assert model.nu == car.model.model.nu


def test_energy_balances_and_both_engines_follow_the_tables(bent_car, bump_piece):
    loads = ["main_spring_fr_force", "suspension_mount_fr_force_z"]
    channels = [*bent_car.vehicle.channels, *loads]
    run, reduced = (
        bent_car.run(bump_piece, channels=channels),
        bent_car.run(bump_piece, engine="auto", channels=channels),
    )
    assert run.recording.statistics.energies.residual < 2e-3
    assert reduced.recording.statistics.engine == "reduced" and reduced.recording.statistics.warnings == ()
    names = [name for name in channels if np.std(run[name]) > 0.0 and not name.startswith("main_spring")]
    validated(
        "Reduced engine", "RMS of all channels over that of MuJoCo, bump with stops and tables",
        np.array([np.std(reduced[name]) / np.std(run[name]) for name in names]), 1.0, abs=5e-3,
        source="second derivation: MuJoCo",
    )  # fmt: skip
    # The friction that is left in the suspension decides where it ends.
    assert np.std(reduced[loads[0]]) == pytest.approx(np.std(run[loads[0]]), rel=1e-2)
    straight = Car.load().run(bump_piece, engine="reduced")
    change = straight["damper_fr_velocity"] - run["damper_fr_velocity"]
    assert np.std(change) > 0.1 * np.std(run["damper_fr_velocity"])
    small = type(bump_piece)(
        time=bump_piece.time, displacement={name: 0.1 * z for name, z in bump_piece.displacement.items()}
    )
    exact, fast = bent_car.run(small), bent_car.run(small, engine="auto")
    assert fast.recording.statistics.engine == "reduced"
    difference = np.sqrt(np.mean((exact["tyre_fr_force_z"] - fast["tyre_fr_force_z"]) ** 2))
    assert difference < 5e-3 * np.std(exact["tyre_fr_force_z"])


def test_invalid_tables_are_rejected_by_name():
    def falling(front):
        front["main_spring"]["table"] = {"displacement": [-0.2, 0.1], "force": [1.0, -1.0]}

    def weak(front):
        front["bushings"]["tyre"]["table_z"] = {"displacement": [-0.1, -0.09, 0.0], "force": [-100.0, -100.0, 0.0]}

    with pytest.raises(ConfigurationError, match=r"^front\.main_spring\.table\.force: found -1\.0 N after 1\.0 N"):
        changed_car(falling)
    with pytest.raises(ConfigurationError, match=r"bushing/tyre_fr: reaches -100 N but must carry -3"):
        _ = changed_car(weak).model
