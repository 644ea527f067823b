"""Hydromount with an inertia track: by its closed form in a run, and in the matrices, runs and variants of the car."""

import math
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.engines.simulation.row_model import (
    Stepper,
    add_bushing,
    add_coordinate,
    add_free_body,
    element_law,
    empty_spec,
)
from tests.validation import foreign, validated
from vehicle.engines.linear.dynamic_stiffness import steady_motion
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows
from vehicle.errors import ConfigurationError
from vehicle.model.assembly import connections
from vehicle.model.assembly.connections import ElementLaw, FluidLaw
from vehicle.model.parameters.force_elements import Hydromount
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

RUBBER, DRAG, CHAMBER, MASS, FLOW = 2.0e5, 150.0, 4.0e5, 80.0, 1200.0
TRACK = {
    "hydromount.maxwell_stiffness": 0.0,
    "hydromount.chamber_stiffness": CHAMBER,
    "hydromount.track_mass": MASS,
    "hydromount.track_damping": FLOW,
}
GAP, DISC, LEAK, MEMBRANE, SEAT = 3e-4, 1.0, 60.0, 2e3, 2e6
DECOUPLED = {
    "hydromount.decoupler_gap": GAP, "hydromount.decoupler_mass": DISC, "hydromount.decoupler_damping": LEAK,
    "hydromount.decoupler_stiffness": MEMBRANE, "hydromount.decoupler_seat": SEAT,
}  # fmt: skip
CHANNELS = ["engine_acc_z", "hydromount_force_z"]
SOURCE = "closed form: Kr + i w cr + Kb Z / (Kb + Z), Z = -w^2 mt + i w ct"


def fluid_stiffness(omega, chamber=CHAMBER, mass=MASS, flow=FLOW):
    """Dynamic stiffness of the fluid, Kb Z / (Kb + Z)."""
    track = -(omega**2) * mass + 1j * omega * flow
    return chamber * track / (chamber + track)


def add_fluid(spec, name, moving, *, decoupler=False):
    """The fluid of a mount between a body and the world, as the generator writes it."""
    fluid = f"fluid/{name}"
    moving.add_site(name=f"{fluid}/moving")
    spec.worldbody.add_site(name=f"{fluid}/carrier")
    spec.add_equality(
        name=fluid, type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE,
        name1=f"{fluid}/moving", name2=f"{fluid}/carrier",
    )  # fmt: skip
    spec.add_numeric(name=f"law/{fluid}", data=element_law([0.0, 0.0, CHAMBER]))
    spec.add_numeric(name=f"inertia/{fluid}", data=[MASS, 0.0])
    add_coordinate(spec, fluid, MASS, 0.0, FLOW)
    if decoupler:
        spec.add_numeric(name=f"inertia/decoupler/{name}", data=[DISC, 0.0])
        seat = GAP * np.array([-2.0, -1.0, 1.0, 2.0, -SEAT, 0.0, 0.0, SEAT])
        spec.add_numeric(name=f"table/decoupler/{name}", data=seat)
        add_coordinate(spec, f"decoupler/{name}", DISC, MEMBRANE, LEAK)


def dynamic_stiffness(frequency, step=1e-4, mass=5.0):
    """K(jw) = F / X + m w^2 of a mount on the ground in the steady state under F = cos(w t) on its mass."""
    spec = empty_spec(step)
    body = add_free_body(spec, "engine", mass, [10.0] * 3)
    add_bushing(spec, "hydromount", body, spec.worldbody, element_law([RUBBER] * 3, [DRAG] * 3))
    add_fluid(spec, "hydromount", body)
    run, omega, steps = Stepper(spec), 2.0 * np.pi * frequency, round(1.0 / (frequency * step))
    # The rows average their forces over three steps, 1, 10, 1; the load must be averaged alike.
    average = (10.0 + 2.0 * np.cos(omega * step)) / 12.0

    def push(time):
        run.data.xfrc_applied[1, 2] = average * np.cos(omega * time)

    settle = steps * round(1.6 * frequency)
    x = run.step(settle + 2 * steps, run.position, push)[settle:, 2]
    amplitude = 2.0 * np.mean(x * np.exp(-1j * omega * step * (settle + np.arange(len(x)))))
    return 1.0 / amplitude + mass * omega**2


@pytest.mark.parametrize("frequency", [5.0, 10.0, 20.0])
def test_a_run_has_the_closed_form(frequency):
    omega = 2.0 * np.pi * frequency
    exact = RUBBER + 1j * omega * DRAG + fluid_stiffness(omega)
    validated(
        "Bushings, springs and stops", f"dynamic stiffness of a mount with inertia track in a run, {frequency:g} Hz",
        dynamic_stiffness(frequency), exact, rel=1e-5, unit="N/m", source=SOURCE,
    )  # fmt: skip


@pytest.fixture(scope="module")
def rubber():
    """The car of Bommer 2006 without the Maxwell branch of its mount, on rigid attachments."""
    return Car.load("focus", {"hydromount.maxwell_stiffness": 0.0, "body.attachment_flexibility": False})


@pytest.fixture(scope="module")
def tracked(rubber):
    return rubber.with_(TRACK)


def mount_row(car):
    """Extension of the mount along z over the velocity coordinates."""
    rows, data = Rows(car.model.model, car.static.preload), mujoco.MjData(car.model.model)
    with installed(rows):
        mujoco.mj_forward(car.model.model, data)
    jacobian = data.efc_J.reshape(-1, car.model.model.nv)
    return jacobian[rows.layout.bushings.rows[rows.names.index("bushing/hydromount"), 2]].copy()


def test_the_matrices_are_those_of_the_car_with_the_closed_form_in_place_of_the_fluid(rubber, tracked):
    frequency = np.array([2.0, 7.0, 11.0, 14.0, 25.0, 45.0])
    steady = steady_motion(tracked.matrices.system, frequency, [1.0, 0.0], stuck=True)
    system, row = rubber.matrices.system, mount_row(rubber)
    rail = {name: car.matrices.system.output("seat_rail_acc_z")[0] for name, car in (("with", tracked), ("no", rubber))}
    found, exact = rail["with"] @ steady.motion, []
    for s, f in zip(steady.s, frequency, strict=True):
        held = np.vstack([system.constraints, system.slide_rows])
        basis = np.linalg.svd(held)[2][np.linalg.matrix_rank(held) :].T
        dynamic = s**2 * system.mass + s * system.damping + system.stiffness
        dynamic = dynamic + fluid_stiffness(2.0 * np.pi * f) * np.outer(row, row)
        load = (s * system.input_damping + system.input_stiffness)[:, 0]
        motion = basis @ np.linalg.solve(basis.T @ dynamic @ basis, basis.T @ load)
        exact.append(rail["no"] @ motion)
    validated(
        "Linear system", "seat rail over plate, car with an inertia track in its hydromount, 2 to 45 Hz", found,
        np.array(exact), rel=1e-7, source="second derivation: matrices without track plus its closed form",
    )  # fmt: skip
    assert np.max(np.abs(np.array(exact) / (rail["no"] @ steady_motion(
        system, frequency, [1.0, 0.0], stuck=True).motion) - 1.0)) > 0.02  # fmt: skip


def test_both_engines_agree_and_the_energy_balances(tracked, high_piece):
    run = {engine: tracked.run(high_piece, engine=engine, channels=CHANNELS) for engine in ("mujoco", "reduced")}
    for channel, limit in zip(CHANNELS, (2e-2, 1e-2), strict=True):
        whole, reduced = (np.asarray(run[engine][channel]) for engine in ("mujoco", "reduced"))
        error = np.sqrt(np.mean((whole - reduced) ** 2)) / np.std(whole)
        validated(
            "Reduced engine", f"car with an inertia track, RMS error of {channel} against MuJoCo", error, 0.0,
            abs=limit, source="second derivation: MuJoCo at its default step",
        )  # fmt: skip
    validated(
        "Integration in MuJoCo", "energy balance of a run of the car with an inertia track",
        run["mujoco"].recording.statistics.energies.residual, 0.0, abs=1e-3,
        source="conservation: work of the plates, losses and stored energy",
    )  # fmt: skip


@pytest.mark.parametrize("flexible", [False, True])
def test_a_changed_track_changes_the_matrices_as_a_new_model_does(flexible):
    # On a flexible attachment the share of the rubber in the fluid, Kb/K0, changes too.
    fixed = {"body.attachment_flexibility": flexible, **TRACK, **DECOUPLED}
    change = {"hydromount.track_mass": 30.0, "hydromount.track_damping": 700.0, "hydromount.chamber_stiffness": 3e6}
    varied, built = Car.load("focus", fixed).with_(change), Car.load("focus", {**fixed, **change})
    assert varied._from_terms is not None
    for name in ("mass", "damping", "stiffness"):
        scale = np.max(np.abs(getattr(built.matrices.system, name)))
        np.testing.assert_allclose(
            getattr(varied.matrices.system, name), getattr(built.matrices.system, name), rtol=1e-6, atol=1e-9 * scale
        )
    preload = built.static.preload
    np.testing.assert_allclose(varied.static.preload, preload, rtol=1e-6, atol=1e-9 * np.max(np.abs(preload)))


def test_the_track_names_its_mode_and_carries_no_weight(rubber, tracked):
    modes = tracked.modes(highest=30.0)
    shares = [mode.energy["fluid of hydromount"] for mode in modes]
    assert 0.3 < max(shares) < 1.0 and "fluid of hydromount" in modes[int(np.argmax(shares))].description
    assert tracked.static.tyre_load == pytest.approx(rubber.static.tyre_load, rel=1e-9)


def test_rubber_and_fluid_share_the_spring_of_the_attachment():
    car = Car.load("focus", {**TRACK, "hydromount.damping.z": 300.0})
    mount = next(each for each in car.vehicle.composition.connections if each.name == "hydromount")
    main, fluid = (
        law(mount, car.vehicle.body, car.trimmed_body) for law in (connections.element_law, connections.fluid_law)
    )
    assert isinstance(main, ElementLaw) and isinstance(fluid, FluidLaw) and isinstance(mount.law, Hydromount)
    omega, local = 2.0 * np.pi * np.linspace(2.0, 50.0, 97), 1.0 / car.trimmed_body.residual["hydromount"][2, 2]
    track, turn = -(omega**2) * fluid.mass + 1j * omega * fluid.damping, 1j * omega * main.branch_time[2]
    # Rows of rubber and chamber over the extension and the displacement of the fluid, which has no load.
    rubber = main.stiffness[2] + 1j * omega * main.damping[2] + main.branch_stiffness[2] * turn / (1.0 + turn)
    chamber = fluid.law.stiffness[2]
    cross, own = rubber * fluid.share - chamber, rubber * fluid.share**2 + chamber + track
    found = rubber + chamber - cross**2 / own
    exact = 1.0 / (1.0 / local + 1.0 / (mount.law.stiffness[2] + 300j * omega + fluid_stiffness(omega)))
    validated(
        "Bushings, springs and stops", "mount with an inertia track behind a flexible attachment, 2 to 50 Hz", found,
        exact, rel=1e-9, unit="N/m", source="closed form: 1 / (1 / K0 + 1 / K(iw))",
    )  # fmt: skip


def test_the_rows_move_with_the_fluid():
    # Behind a flexible attachment the rubber, with its damper and branch, has Kb/K0 of the motion of the fluid.
    car = Car.load("focus", {**TRACK, **DECOUPLED, "hydromount.damping.z": 300.0})
    model, rows, data = car.model.model, Rows(car.model.model, car.static.preload), mujoco.MjData(car.model.model)
    dofs = [model.joint(f"{kind}/hydromount").dofadr[0] for kind in ("fluid", "decoupler")]
    data.qpos[[model.joint(f"{kind}/hydromount").qposadr[0] for kind in ("fluid", "decoupler")]] = 2e-3, 5e-4
    data.qvel[dofs] = 0.3, -0.05
    with installed(rows):
        mujoco.mj_forward(model, data)
    share = CHAMBER * car.trimmed_body.residual["hydromount"][2, 2]
    for name, factor in (("bushing/hydromount", share), ("fluid/hydromount", -1.0)):
        index = rows.names.index(name)
        assert data.efc_J.reshape(-1, model.nv)[rows.layout.bushings.rows[index, 2], dofs] == pytest.approx(factor)
        assert rows.state.residual[index] == pytest.approx([0.0, 0.0, factor * 2.5e-3], abs=1e-9)
        assert rows.state.rate[index] == pytest.approx([0.0, 0.0, factor * 0.25], abs=1e-12)


def test_a_track_is_refused_where_the_attachment_couples_the_axes():
    mount: dict[str, Any] = {
        "moving": "engine", "carrier": "body", "at": "hydromount", "axes": ["engine_cog", "linear_mount"],
    }  # fmt: skip
    mount |= {"stiffness": [1e5] * 3, "damping": [0.0] * 3, "rotational_stiffness": 0.0}
    mount |= {"chamber_stiffness": 1e5, "track_mass": 20.0, "track_damping": 100.0}
    table = read_table(FOCUS_FILE) | {"connection": {"extra": mount}}
    with pytest.raises(ConfigurationError, match=r"connection\.extra\.chamber_stiffness: found an inertia track"):
        Car(vehicle_of(table, FOCUS_FILE.parent), folder=FOCUS_FILE.parent).model  # noqa: B018


def first_harmonic(x, omega, times):
    return 2.0 * np.mean(x * np.exp(-1j * omega * times))


@pytest.mark.parametrize(("force", "said"), [(20.0, "within the gap"), (80.0, "at the gap"), (400.0, "beyond the gap")])
def test_a_decoupler_against_an_adaptive_solver(force, said):
    mass, frequency, step = 5.0, 11.0, 1e-4
    spec, omega, period = empty_spec(step), 2.0 * np.pi * frequency, round(1.0 / (frequency * step))
    omega = 2.0 * np.pi / (period * step)
    body = add_free_body(spec, "engine", mass, [10.0] * 3)
    add_bushing(spec, "hydromount", body, spec.worldbody, element_law([RUBBER] * 3, [DRAG] * 3))
    add_fluid(spec, "hydromount", body, decoupler=True)
    run = Stepper(spec)

    def push(time):
        run.data.xfrc_applied[1, 2] = force * np.cos(omega * time)

    settle, last = 16 * period, 4 * period
    moved = run.step(settle + last, run.position, push)[settle:]

    def slopes(time, state):
        z, x, y, *speeds = state.tolist()  # plain numbers: the solver asks 100 000 times
        pressed = CHAMBER * (z - x - y)
        seat = SEAT * (y - min(max(y, -GAP), GAP))
        return [
            *speeds,
            (force * math.cos(omega * time) - RUBBER * z - DRAG * speeds[0] - pressed) / mass,
            (pressed - FLOW * speeds[1]) / MASS,
            (pressed - LEAK * speeds[2] - MEMBRANE * y - seat) / DISC,
        ]

    times = step * (settle + np.arange(last))
    exact = solve_ivp(slopes, (0.0, times[-1]), np.zeros(6), "DOP853", times, rtol=1e-7, atol=1e-11, max_step=1e-3).y
    found, expected = (force / first_harmonic(z, omega, times) + mass * omega**2 for z in (moved[:, 2], exact[0]))
    assert (np.max(np.abs(exact[2])) > GAP) == (said != "within the gap")
    claim, source = f"mount with a decoupler, 11 Hz, {said}", foreign("scipy", "DOP853, tolerance 1e-7")
    subject = "Bushings, springs and stops"
    validated(
        subject, f"{claim}: dynamic stiffness", abs(found), abs(expected), rel=1e-3, unit="N/m", source=source
    )  # fmt: skip
    validated(
        subject, f"{claim}: loss angle", np.degrees(np.angle(found)), np.degrees(np.angle(expected)), abs=0.05,
        unit="deg", source=source,
    )  # fmt: skip


@pytest.mark.parametrize(("level", "said", "limit"), [(0.02, "within", 2e-3), (1.0, "beyond", 5e-3)])
def test_a_decoupler_in_both_engines(tracked, high_piece, level, said, limit):
    # A softer seat: on the stiff one the disc bounces at 225 Hz, and 1 % is the error of a step of 0.2 ms.
    changes = {"hydromount.decoupler_gap": 5e-5, "hydromount.decoupler_seat": 2e5, "solver.timestep": 1.25e-4}
    car = tracked.with_({**DECOUPLED, **changes})
    signal = Signal(time=high_piece.time, displacement={"fr": level * high_piece.displacement["fr"]})
    runs = [car.run(signal, engine=engine) for engine in ("mujoco", "reduced")]
    assert runs[0].recording.statistics.energies.residual < 1e-3 and not runs[1].recording.statistics.warnings
    whole, reduced = (np.asarray(run["engine_acc_z"]) for run in runs)
    validated(
        "Reduced engine", f"car with a decoupler {said} its gap, RMS error of engine_acc_z against MuJoCo",
        np.sqrt(np.mean((whole - reduced) ** 2)) / np.std(whole), 0.0, abs=limit,
        source="second derivation: MuJoCo with a step of 0.125 ms",
    )  # fmt: skip


def test_an_incomplete_track_is_refused():
    with pytest.raises(ConfigurationError, match=r"hydromount\.track_damping: missing; chamber_stiffness needs"):
        Car.load("focus", {"hydromount.chamber_stiffness": 4e5, "hydromount.track_mass": 50.0})
    with pytest.raises(ConfigurationError, match=r"hydromount\.chamber_stiffness: missing; decoupler_gap needs"):
        Car.load("focus", DECOUPLED)


def test_rubber_friction_along_the_fluid_is_refused():
    with pytest.raises(ConfigurationError, match=r"friction_force\.z: found 100 N with an inertia track"):
        Car.load(
            "focus", {"hydromount.friction_force": [0, 0, 100], "hydromount.friction_stroke": [0, 0, 1e-3], **TRACK}
        )
