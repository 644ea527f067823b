"""Non-uniform tyres and varying brakes in both engines: closed forms, matrices solved line by line, batches."""

import mujoco
import numpy as np
import pytest

from tests.physics.test_applied_forces import energies_of
from tests.validation import validated
from vehicle import Car, Run, road
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.model.parameters.force_elements import Tyre
from vehicle.runs.output.run_forces import force_values
from vehicle.signals.analysis.order_lines import order_lines
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.records.run_summary import OrderSummary

SPEED = 100.0
FREE = {
    "front.damper.coulomb_friction": 0.0,
    "rear.damper.coulomb_friction": 0.0,
    "driving.speed": SPEED / 3.6,
    "solver.record_rate": 2000.0,
}
ORDERS = (1, 2, 3)
CHANNELS = ("seat_rail_acc_z", "seat_rail_acc_x", "knuckle_fr_acc_z", "knuckle_fr_acc_x", "knuckle_fr_acc_y")
TABLES: dict[str, dict[str, list[list[float]]]] = {
    "run-out": {"front.right.nonuniformity.runout": [[1, 3e-4, 30], [2, 1e-4, -60], [3, 1e-4, 0]]},
    "radial force variation": {"front.right.nonuniformity.rfv": [[1, 40, 30], [2, 20, -60], [3, 20, 0]]},
    "lateral force variation": {"front.right.nonuniformity.lfv": [[1, 40, 30], [2, 20, -60], [3, 20, 0]]},
    "rolling radius": {"front.right.nonuniformity.rolling_runout": [[1, 3e-4, 30], [2, 1e-4, -60], [3, 1e-4, 0]]},
    "brake torque": {"front.right.brake_variation.torque": [[1, 20, 30], [2, 10, -60], [3, 10, 0]]},
}


def lines_of(time: np.ndarray, records: np.ndarray, speed: float, orders: tuple[int, ...] = ORDERS) -> np.ndarray:
    """Complex amplitudes of records from their last two seconds, by least squares; (channels, orders)."""
    last = time >= time[-1] - 2.0
    angle = speed * np.outer(time[last], orders)
    basis = np.hstack([np.cos(angle), np.sin(angle), np.ones((angle.shape[0], 1))])
    found = np.linalg.lstsq(basis, records[:, last].T, rcond=None)[0]
    return np.asarray((found[: len(orders)] - 1j * found[len(orders) : -1]).T)


def records_of(run: Run) -> np.ndarray:
    return np.array([run[name] for name in CHANNELS])


def solved(car: Car, kind: str) -> np.ndarray:
    """Answer of the linear car, line by line, with the rows of the right front wheel from its points and its law."""
    system, model = car.matrices.system, car.model.model
    data, (history,) = mujoco.MjData(model), TABLES[kind].values()
    mujoco.mj_fwdPosition(model, data)
    wheel = next(wheel for wheel in car.vehicle.composition.wheels if wheel.name == "fr")
    tyre = next(tyre for tyre in car.vehicle.composition.connections if tyre.name == "tyre_fr")
    law, hub, spin = tyre.law, model.body(tyre.moving).id, np.zeros(model.nv)
    assert isinstance(law, Tyre) and law.carcass_longitudinal and law.slip_stiffness
    radius, spin[model.joint("spin_fr").dofadr[0]] = wheel.center[2] - wheel.patch[2], 1.0
    center, turned, patch = np.zeros((3, 3, model.nv))
    mujoco.mj_jac(model, data, center, turned, np.array(wheel.center), hub)
    mujoco.mj_jac(model, data, patch, None, np.array(wheel.patch), hub)
    slip, joints = center[0] - radius * (turned[1] + spin), system.constraints
    stiffness, damping, carcass = law.stiffness[2], law.damping[2], law.carcass_longitudinal
    relaxation = law.slip_stiffness / (SPEED / 3.6 * carcass)
    result = np.zeros((len(CHANNELS), len(ORDERS)), dtype=complex)
    for column, (order, amplitude, phase) in enumerate(history):
        s = 1j * order * SPEED / 3.6 / radius
        unit = amplitude * np.exp(1j * np.radians(phase))
        force = {
            "run-out": (stiffness + s * damping) * patch[2],
            "radial force variation": (1.0 + s * damping / stiffness) * patch[2],
            "lateral force variation": patch[1],
            "rolling radius": -slip * carcass / (s + 1.0 / relaxation) * SPEED / 3.6 / radius,
            "brake torque": spin,
        }[kind]
        drifts = 0.0 if system.branch_drifts is None else system.branch_drifts
        branch = (system.branch_stiffness / (s + 1.0 / system.branch_time))[:, None] * (s * system.branch_rows + drifts)
        whole = system.stiffness + s * system.damping + s * s * system.mass + system.effects.T @ branch
        matrix = np.block([[whole, joints.T], [joints, np.zeros((len(joints), len(joints)))]])
        motion = np.linalg.solve(matrix, np.append(unit * force, np.zeros(len(joints))))[: system.size]
        result[:, column] = [s * s * (system.outputs[name][: system.size] @ motion) for name in CHANNELS]
    return result


@pytest.mark.parametrize("kind", TABLES)
def test_a_linear_car_answers_a_wheel_as_its_matrices_say(kind):
    car = Car.load("focus_road", {**TABLES[kind], **FREE})
    run = car.run(road("level", SPEED, duration=12), engine="reduced", channels=CHANNELS)
    validated(
        "Applied forces",
        f"Reduced engine, {kind} of one wheel, orders 1 to 3 at 100 km/h: acceleration of seat rail and knuckle",
        lines_of(run.time, records_of(run), car.vehicle.composition.speeds["wheel_fr"]),
        solved(car, kind),
        source="second derivation: matrices with the joints as constraints, line by line",
        # The plates are a spline through samples at 1 kHz.
        peak=1e-4 if kind in ("run-out", "radial force variation") else 1e-6,
    )


@pytest.mark.parametrize("kind", ["run-out", "brake torque"])
def test_mujoco_answers_a_wheel_as_the_matrices_say(kind):
    car = Car.load("focus_road", {**TABLES[kind], **FREE})
    run = car.run(road("level", SPEED, duration=6), channels=CHANNELS)
    validated(
        "Applied forces", f"MuJoCo, {kind} of one wheel, order 1 at 100 km/h: acceleration of seat rail and knuckle",
        lines_of(run.time, records_of(run), car.vehicle.composition.speeds["wheel_fr"])[:, :1],
        solved(car, kind)[:, :1], source="second derivation: matrices with the joints as constraints, line by line",
        peak=1e-3,
    )  # fmt: skip
    assert energies_of(run).residual < 1e-3


def test_a_run_out_is_no_slope_on_a_road_either():
    """On a wave of 3.1 Hz, whose slope acts, a run-out adds what it adds on a level road, along x too."""
    time = np.arange(12001) / 1e3
    wave = 2e-3 * (1.0 - np.cos(2.0 * np.pi * 3.1 * time))
    car, bare = (Car.load("focus_road", {**changes, **FREE}) for changes in (TABLES["run-out"], {}))
    waves = Signal(time=time, displacement=dict.fromkeys(car.vehicle.wheels, wave))
    level = road("level", SPEED, duration=12)
    found, without, smooth = (
        one.run(on, engine="reduced", channels=CHANNELS) for one, on in ((car, waves), (bare, waves), (car, level))
    )
    turns = car.vehicle.composition.speeds["wheel_fr"] / (2.0 * np.pi)
    added, expected = (
        order_lines(smooth.time, records, turns, [1], begin=4.0).amplitude[:, 0]
        for records in (records_of(found) - records_of(without), records_of(smooth))
    )
    # The present load on the slope has products of both, at other frequencies.
    assert np.max(np.abs(added / expected - 1.0)) < 1e-3


def test_a_batch_answers_wheels_as_single_cars_do():
    """Cars of one batch with different run-outs, and with equal ones, are those of single runs."""
    changes = [TABLES["run-out"], {"front.right.nonuniformity.runout": [[1.0, 1e-4, 0.0]]}, TABLES["rolling radius"]]
    rolling: dict[str, object] = {"driving.speed": SPEED / 3.6}
    cars = [Car.load("focus_road", {**rolling, **change}) for change in changes for _ in range(4)]
    smooth = road("level", SPEED, duration=6)
    singles = [car.run(smooth, engine="reduced", channels=CHANNELS) for car in cars[::4]]
    batch = simulate_batch(
        [car.poles for car in cars], singles[0].signal,
        dampers=[[damper.law for damper in car.vehicle.composition.dampers] for car in cars], record_rate=1000.0,
        tyre_load=[car.static.tyre_load for car in cars], channels=["seat_rail_acc_z", "knuckle_fr_acc_x"], step=2e-4,
    )  # fmt: skip
    for name, histories in batch.channels.items():
        for index, history in enumerate(histories):
            single = singles[index // 4][name]
            assert np.std(history - single) < 2e-4 * np.std(single)


def test_the_range_over_the_phases_contains_every_car_and_reaches_its_ends():
    rows = {"front.imbalance.mass": 0.02, "front.imbalance.radius": 0.19, "front.nonuniformity.rfv": [[1, 40, 90]]}
    smooth, name = road("level", 120, duration=6), "seat_rail_acc_z"
    limits = []
    for phase in (0.0, 60.0, 120.0, 240.0):
        left = {"front.left.imbalance.angle": phase, "front.left.nonuniformity.rfv": [[1, 40, 90 + phase]]}
        run = Car.load("focus_road", {**rows, **left}).run(smooth, engine="reduced")
        (line,) = force_values(run)["orders"]
        assert line.stuck_range[name][0] <= line.stuck[name] <= line.stuck_range[name][1]
        limits.append([*line.stuck_range[name], line.stuck[name]])
        assert OrderSummary.from_json(line.to_json()) == line, "its ranges are read as they were written"
    ranges = np.array(limits)
    # Both sides of a car are alike, so that the right and the left alone shake the middle alike, the rail nearly.
    assert np.ptp(ranges[:, :2], axis=0) == pytest.approx(0.0, abs=1e-6 * ranges[0, 1])
    assert np.max(ranges[:, 2]) > 0.85 * ranges[0, 1] and np.min(ranges[:, 2]) < 0.5 * ranges[0, 1]
    one = Car.load("focus_road", {f"front.right.{key[6:]}": value for key, value in rows.items()})
    (line,) = force_values(one.run(smooth, engine="reduced"))["orders"]
    assert line.stuck_range is None and OrderSummary.from_json(line.to_json()) == line


IMBALANCE = "front.right.imbalance"
SHAKEN: dict[str, tuple[str, float, dict[str, object]]] = {
    "sedan, imbalance of 160 g, 100 km/h": ("sedan", 100, {f"{IMBALANCE}.mass": 0.16, f"{IMBALANCE}.radius": 0.2}),
    "focus_road with skyhook dampers, imbalance of 40 g, 140 km/h": (
        "focus_road", 140,
        {f"{IMBALANCE}.mass": 0.04, f"{IMBALANCE}.radius": 0.2, "front.damper.control.law": "skyhook"},
    ),
    "focus_road_seated, brake variation of 20 N m, 100 km/h": (
        "focus_road_seated", 100, {"front.right.brake_variation.torque": [[1, 20, 0]]},
    ),
    "sedan, radial force variation of 80 N, 140 km/h": (
        "sedan", 140, {"front.right.nonuniformity.rfv": [[1, 80, 0]]},
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", SHAKEN)
def test_both_engines_agree_on_wheels_with_friction(case):
    """Amplitude within 0.5 % and phase within 0.3 degrees of order 1."""
    name, speed, changes = SHAKEN[case]
    car = Car.load(name, changes)
    channels = ["seat rail z", "seat rail x", "knuckle_fr_acc_z", "knuckle_fr_acc_x"]
    runs = [car.run(road("level", speed, duration=6), engine=engine) for engine in ("mujoco", "reduced")]
    precise, reduced = (run.orders(channels, angle="wheel_fr", orders=[1]).amplitude for run in runs)
    validated(
        "Applied forces", f"{case}: order 1 of seat rail and knuckle in both engines", reduced, precise,
        source="second derivation: MuJoCo", rel=5e-3,
    )  # fmt: skip
    assert energies_of(runs[0]).residual < 5e-3


def test_another_rolling_radius_turns_the_forces_of_the_wheel_at_another_speed():
    tyre = "front.bushings.tyre"
    rows = {"front.nonuniformity.rfv": [[1, 40, 0]], "driving.speed": 30.0, f"{tyre}.rolling_radius": 0.31}
    changes = {f"{tyre}.rolling_radius": 0.33, f"{tyre}.stiffness.z": 1.8e5}
    variant = Car.load("sedan", rows).with_(changes)
    loaded = Car.load("sedan", {**rows, **changes})
    assert variant.matrices.lines.frequencies == pytest.approx([30.0 / 0.33])
    assert variant.matrices.run_out == loaded.matrices.run_out
    assert max(loaded.matrices.run_out[0][2]) == pytest.approx(40.0 / 1.8e5)


def test_the_range_beside_a_run_up_of_the_engine_is_that_of_the_wheels():
    """Orders of a run-up have no constant frequency, and none among those of the wheels."""
    rows: dict[str, object] = {"front.nonuniformity.rfv": [[1, 40, 90]], "crank.rpm": 600, "crank.end_rpm": 900}
    rows |= {"force.a.on": "engine", "force.a.force": [0, 0, 1], "force.a.angle": "crank", "crank.run_up_time": 5}
    car = Car.load("focus_road", {**rows, "force.a.harmonics": [[1, 20, 0]]})
    (line,) = force_values(car.run(road("level", 120, duration=6), engine="reduced"))["orders"]
    low, high = line.stuck_range["seat_rail_acc_z"]
    assert high > 0.0 and low <= line.stuck["seat_rail_acc_z"] <= high * (1.0 + 1e-9)


def test_order_2_of_a_brake_has_a_part_from_order_1_squared():
    """Without friction: half the torque of order 1 makes a quarter of order 2; without that part both engines agree."""
    channels = ["seat rail z", "seat rail x", "knuckle_fr_acc_z", "knuckle_fr_acc_x"]

    def orders(engine: str, *torque: list[float]) -> np.ndarray:
        car = Car.load("sedan", {"front.right.brake_variation.torque": [*torque], **FREE})
        run = car.run(road("level", 100, duration=5), engine=engine)
        return np.asarray(run.orders(channels, angle="wheel_fr", orders=[2]).amplitude[:, 0])

    whole, half = orders("mujoco", [1, 20, 30]), orders("mujoco", [1, 10, 30])
    validated(
        "Applied forces",
        "sedan, brake variation of 20 over 10 N m in order 1, 100 km/h: order 2 of seat rail and knuckle in MuJoCo",
        np.abs(whole / half), 4.0, source="closed form: second order of the motion", rel=1e-2,
    )  # fmt: skip
    both, linear = (orders(engine, [1, 20, 30], [2, 10, -60]) for engine in ("mujoco", "reduced"))
    assert np.max(np.abs(both - linear) / np.abs(both)) > 0.1  # what it explains
    validated(
        "Applied forces", "sedan, brake variation in orders 1 and 2: order 2 in MuJoCo less that by order 1 alone",
        np.abs(both - whole - linear) / np.abs(both), 0.0, source="second derivation: reduced engine", abs=5e-3,
    )  # fmt: skip
