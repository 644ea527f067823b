"""Tyres that roll: poles against derivations on paper, the limit of standing, energy, and both engines."""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import numpy.typing as npt
import pytest

from tests.physics.rolling_car import (
    AXLES,
    BODY,
    COG,
    CORNERING,
    INERTIA,
    MASSES,
    RADIUS,
    SPINS,
    TRACK,
    TYRE,
    pitch_plane,
    rolling_car,
    single_track,
)
from tests.validation import validated
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.stepping import simulate
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.signals.excitation.iso_road import IsoRoad, drive
from vehicle.signals.excitation.signal import Signal, uniform_time

Complex = npt.NDArray[np.complex128]

WHOLE = BODY + 4 * sum(MASSES.values())


def poles_of(car: Car) -> Complex:
    """Return the poles of a car."""
    return np.asarray(np.linalg.eigvals(first_order(car.matrices.system).state), dtype=complex)


def farthest(wanted: Complex, computed: Complex) -> float:
    """Return the largest relative distance of a pole from the nearest one found."""
    away = np.abs(wanted[:, None] - computed) / np.abs(wanted)[:, None]
    return float(np.max(np.min(away, axis=1)))


def hold_of(car: Car) -> npt.NDArray[np.float64]:
    """Stiffness and damping of the hold along x: m (2 pi f)^2 and 2 zeta m 2 pi f."""
    omega = 2.0 * np.pi * car.vehicle.driving.hold_frequency
    return WHOLE * np.array([omega**2, 2.0 * car.vehicle.driving.hold_damping * omega])


def yaw_inertia(axis: float) -> float:
    """Return the yaw inertia of the whole car about a vertical line at x [m]."""
    inertia = INERTIA[2] + BODY * (COG[0] - axis) ** 2
    for position in AXLES.values():
        wheel = sum(MASSES.values())
        wheel_inertia = 0.55 * SPINS["tyre"] + 0.6 * (SPINS["knuckle"] + SPINS["brake_disc"] + SPINS["caliper"])
        inertia += 2 * (wheel * ((position - axis) ** 2 + TRACK**2 / 4) + wheel_inertia)
    return float(inertia)


@pytest.mark.parametrize("speed", [3.0, 20.0, 50.0])
def test_rolling_corners_have_the_poles_of_the_paper(tmp_path: Path, speed: float) -> None:
    car = rolling_car(tmp_path, speed)
    wanted = np.linalg.eigvals(pitch_plane(speed, hold_of(car)))
    # Places of wheels that turn are no states of the car: they are zero poles on paper.
    assert np.count_nonzero(np.abs(wanted) < 1e-6) == len(AXLES)
    validated(
        "Tyres", f"largest relative distance of the poles of a car on rolling tyres at {speed:g} m/s",
        farthest(wanted[np.abs(wanted) > 1e-6], poles_of(car)), 0.0, abs=1e-6,
        source="second derivation: equations of the pitch plane with slip, on paper",
    )  # fmt: skip


def test_side_force_relaxes_over_its_length(tmp_path: Path) -> None:
    """A car that is held at a heading psi: F_y = -C psi (1 - exp(-V t k / C)), in the rows of a run."""
    car = rolling_car(tmp_path, 20.0, overrides=["solver.timestep=1e-4"])
    model, psi = car.model.model, 1e-3
    rows, data = Rows(model, car.static.preload), mujoco.MjData(model)
    start, way = data.qpos.copy(), np.zeros(model.nv)
    for name in ("body", *(f"knuckle_{wheel}" for wheel in car.vehicle.wheels)):
        joint = model.joint(name)
        position = car.model.origins[name]
        x, y = position[0] - COG[0], position[1]
        way[joint.dofadr[0] : joint.dofadr[0] + 6] = -y * psi, x * psi, 0.0, 0.0, 0.0, psi
    mujoco.mj_integratePos(model, start, way, 1.0)
    tyre = rows.layout.rolling.tyres[0]
    with installed(rows):
        for step in range(101):
            data.qpos[:], data.qvel[:], data.time = start, 0.0, 1e-4 * step
            mujoco.mj_forward(model, data)
    time, cornering = 1e-2, CORNERING["front"]
    relaxed = 1.0 - np.exp(-20.0 * time * TYRE["carcass_lateral"] / cornering)
    validated(
        "Tyres", "side force 10 ms after a change of heading", rows.state.branch_past[tyre, 1],
        cornering * psi * relaxed, rel=1e-4, unit="N", source="closed form: C psi (1 - exp(-V t k / C))",
    )  # fmt: skip
    system = car.matrices.system
    assert system.branch_drifts is not None
    number = next(index for index, row in enumerate(system.branch_drifts) if np.any(row))
    force = system.branch_stiffness[number] * system.branch_time[number] * (system.branch_drifts[number] @ way)
    validated(
        "Tyres", "steady side force of the linear system at a slip angle", force, cornering * psi, rel=1e-9, unit="N",
        source="closed form: C psi",
    )  # fmt: skip


@pytest.mark.parametrize(("speed", "trail"), [(20.0, 0.0), (30.0, 0.0), (40.0, 0.03)])
def test_rigid_car_is_the_single_track_car(tmp_path: Path, speed: float, trail: float) -> None:
    """Tyres without relaxation, wheels without gyroscopic moments: the textbook matrices in y, psi, v, r."""
    cornering = {"front": 1.2e3, "rear": 2e3}
    stiff = {"carcass_lateral": 1e7, "carcass_longitudinal": 1e7, "trail": trail}
    car = rolling_car(
        tmp_path, speed, mount=3 * (1e9,), turning=1e6, damping=1e5, inertia=1e-3 / SPINS["tyre"], tyre=stiff,
        cornering=cornering, vertical=1e9, overrides=["driving.hold_frequency=0.02"],
    )  # fmt: skip
    cog = (BODY * COG[0] + sum(2 * sum(MASSES.values()) * position for position in AXLES.values())) / WHOLE
    omega, zeta = 2.0 * np.pi * 0.02, 0.7
    # The inertia of the wheels is nearly zero.
    wheel_inertia = 4 * (0.55 * SPINS["tyre"] + 0.6 * (SPINS["knuckle"] + SPINS["brake_disc"] + SPINS["caliper"]))
    turned, design_inertia = yaw_inertia(cog) - wheel_inertia * 0.999, yaw_inertia(COG[0]) - wheel_inertia * 0.999
    hold = np.array(
        [WHOLE * omega**2, 2 * zeta * WHOLE * omega, design_inertia * omega**2, 2 * zeta * design_inertia * omega]
    )
    axles = [(AXLES[axle], 2 * cornering[axle]) for axle in AXLES]
    wanted = np.linalg.eigvals(single_track(speed, WHOLE, turned, cog, hold, axles, trail)).astype(complex)
    validated(
        "Tyres", f"largest relative distance of the poles of a rigid car at {speed:g} m/s, trail {1e3 * trail:g} mm",
        farthest(wanted, poles_of(car)), 0.0, abs=1e-4, source="second derivation: single-track car in y, psi, v, r",
    )  # fmt: skip


def test_gyroscopic_moment_of_a_wheel(tmp_path: Path) -> None:
    """-omega x H: a hub that yaws by r feels r |H| against x, H along -y for a car that drives along -x."""
    car, speed = rolling_car(tmp_path, 25.0), 25.0
    dof = int(car.model.model.joint("knuckle_fr").dofadr[0])
    moment = (SPINS["tyre"] + SPINS["brake_disc"]) * speed / RADIUS
    damping = car.matrices.system.damping - rolling_car(tmp_path, 1e-9).matrices.system.damping
    validated(
        "Tyres", "gyroscopic moment of a wheel by yaw and by roll velocity",
        np.array([damping[dof + 3, dof + 5], damping[dof + 5, dof + 3]]), np.array([moment, -moment]), rel=1e-6,
        unit="N m s/rad", source="closed form: spin inertia times V / R",
    )  # fmt: skip


def test_locked_wheel_at_no_speed_is_the_standing_tyre() -> None:
    """Spin held to the hub and V = 0: the sedan on springs k_x, k_y; with weight a round tyre rolls under its load."""
    carcass = [3.58e5, 1.03e5]
    common = ["gravity=0", *(f"{axle}.bushings.tyre.trail=0" for axle in AXLES)]
    standing = [
        f"{axle}.bushings.tyre.stiffness.{direction}={stiffness}"
        for axle in AXLES
        for direction, stiffness in zip("xy", carcass, strict=True)
    ]
    still = Car.load("sedan", [*common, *standing])
    car = Car.load("sedan", [*common, "driving.speed=1e-9"])
    system, rolling = car.matrices.system, Rows(car.model.model).layout.rolling
    course = rolling.course_rows(system.size)
    locked = replace(
        system,
        constraints=np.vstack([system.constraints, np.eye(system.size)[list(system.cyclic)]]),
        cyclic=(),
        stiffness=system.stiffness - course.T @ (rolling.hold[:3, None] * course),
        damping=system.damping - course.T @ (rolling.hold[3:6, None] * course),
    )
    eigenvalues = np.linalg.eigvals(first_order(locked).state)
    wanted = np.linalg.eigvals(first_order(still.matrices.system).state)
    assert np.count_nonzero(np.abs(eigenvalues) > 1e-3) == np.count_nonzero(np.abs(wanted) > 1e-3)
    validated(
        "Tyres", "largest relative distance of the poles of a sedan on locked wheels at no speed",
        farthest(wanted[np.abs(wanted) > 1e-3], eigenvalues.astype(complex)), 0.0, abs=1e-6,
        source="second derivation: standing tyres as springs of the carcass",
    )  # fmt: skip


def ramp(car: Car, speed: float) -> Signal:
    """Return a ramp of 30 mm over 1 m, cosine, met by the rear wheels later."""
    time = uniform_time(samples=801, timestep=1e-3)
    foremost, displacement = min(AXLES.values()), {}
    for wheel in car.vehicle.composition.wheels:
        late = np.clip((speed * time - (wheel.center[0] - foremost)) - 0.3, 0.0, 1.0)
        displacement[wheel.name] = 0.015 * (1.0 - np.cos(np.pi * late))
    return Signal(time=time, displacement=displacement, source="ramp")


def test_static_forces_of_rolling_tyres_do_work() -> None:
    """A mean force is held at the contact points, where the pitch of a hub turns its wheel and a run-out moves a tread.

    Without this work 8.5 of 562 J were missing, at every step.
    """
    drag: dict[str, object] = {"force.drag.on": "body", "force.drag.at": "seat", "force.drag.force": [1, 0.5, 0]}
    drag |= {"force.drag.mean": 1000.0, "front.nonuniformity.rolling_runout": [[1, 2e-4, 0]]}
    run = Car.load("sedan", {**drag, "solver.timestep": 5e-4}).run(Road("B", 80.0, duration=3.0, seed=1))
    energies = run.recording.statistics.energies
    assert energies is not None
    validated(
        "Tyres", "energy that is missing of a car that rolls against a mean force, of the work put in",
        energies.residual, 0.0, abs=1e-4, source="conservation: work in = dissipated + stored",
    )  # fmt: skip


def test_energy_of_free_rolling_over_a_ramp(tmp_path: Path) -> None:
    speed = 15.0
    car = rolling_car(tmp_path, speed, gravity=9.81, tyre={"trail": 0.03}, overrides=["solver.timestep=0.0005"])
    run = simulate(car.model, ramp(car, speed))
    energies = run.statistics.energies
    assert energies is not None
    residual = energies.work_in - energies.dissipated - energies.stored
    validated(
        "Tyres", "energy that is missing after rolling over a ramp, of the dissipated one",
        residual / energies.dissipated, 0.0, abs=1e-4, source="conservation: work in = dissipated + stored",
    )  # fmt: skip
    # Up the ramp the wheels are pushed back, +x, by the load on the slope.
    assert np.max(run.channels["knuckle_fr_acc_x"]) > 1.0
    rolled = run.poses[:, car.model.model.joint("spin_fr").qposadr[0]]
    assert 1e-4 < np.max(np.abs(rolled)) < 0.2


def test_engines_agree_on_a_road() -> None:
    """On a road so smooth that products of motions are nothing, without friction: sample by sample."""
    speed, foremost = 20.0, 0.75
    smooth = ["solver.timestep=0.0005", *(f"{axle}.damper.coulomb_friction=0" for axle in AXLES)]
    car = Car.load("sedan", [f"driving.speed={speed}", *smooth])
    wheels = {
        wheel.name: (wheel.center[0] - foremost, "right" if wheel.side > 0.0 else "left")
        for wheel in car.vehicle.composition.wheels
    }
    road = IsoRoad(level=1e-8, seed=1, track=1.5, patch=0.1)
    signal = drive(road, speed=speed, wheels=wheels, duration=0.5)  # type: ignore[arg-type]
    whole, few = simulate(car.model, signal), car.run(signal, engine="reduced").recording
    for name in car.vehicle.acceleration_channels:
        if name.startswith(("knuckle", "seat", "engine")):
            assert np.std(few[name] - whole.channels[name]) < 0.01 * np.std(whole.channels[name]), name


def test_varied_speed_and_tyre_are_those_of_a_car_that_is_built() -> None:
    base = Car.load("sedan", ["driving.speed=20"])
    changes = ["driving.speed=30", "front.bushings.tyre.trail=0.01", "rear.bushings.tyre.cornering_stiffness=5e4"]
    short, built = base.with_(changes), Car.load("sedan", ["driving.speed=20", *changes])
    assert short._from_terms is not None
    for name in ("stiffness", "damping", "input_damping", "branch_rows", "branch_drifts", "branch_effects"):
        varied, other = (getattr(car.matrices.system, name) for car in (short, built))
        assert np.max(np.abs(varied - other)) < 1e-8 * max(np.max(np.abs(other)), 1.0), name


@pytest.mark.parametrize(("vehicle", "override", "message"), [
    ("focus", "driving.speed=20", "also stands on the ground without wheels"),
    ("sedan", "front.hardpoints.tyre_patch.x=0.76", "or the load would drive"),
    ("sedan", "front.parts.tyre.inertia.x=0.9", "must be round about the axle"),
    ("sedan", "front.parts.brake_disc.offset.z=0.01", "must be round about the axle"),
])  # fmt: skip
def test_cars_that_cannot_roll_are_refused(vehicle: str, override: str, message: str) -> None:
    from vehicle.errors import ConfigurationError

    with pytest.raises(ConfigurationError, match=message):
        Car.load(vehicle, ["driving.speed=20", override])


def test_pitch_of_a_hub_does_not_move_the_contact(tmp_path: Path) -> None:
    """The load stays below the wheel centre: no share F_z R of it in the stiffness of the hub's pitch."""
    for gravity in (0.0, 9.81):
        car = rolling_car(tmp_path, 20.0, gravity=gravity, overrides=["solver.timestep=0.0005"])
        pitch = int(car.model.model.joint("knuckle_fr").dofadr[0]) + 4
        assert car.matrices.system.stiffness[pitch, pitch] == pytest.approx(3e4, rel=1e-6)
