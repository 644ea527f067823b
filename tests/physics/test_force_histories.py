"""Histories of applied forces: files and run-ups against an own fine integration of the linear car, both engines."""

import mujoco
import numpy as np
import pytest
import scipy
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

from tests.validation import validated
from vehicle import Car, Run, load_run, road
from vehicle.commands.shaker import main as shaker
from vehicle.errors import VehicleError
from vehicle.runs.output.run_forces import force_values
from vehicle.signals.analysis.order_cut import order_cut
from vehicle.signals.analysis.run_up_peak import run_up_peak
from vehicle.signals.excitation.force_lines import SweptLine

FREE = {"front.damper.coulomb_friction": 0.0}
ON_RAIL = {"force.a.on": "body", "force.a.at": "seat_rail", "force.a.force": [0.3, 0, 1]}
CHANNELS = ("seat_rail_acc_z", "knuckle_fr_acc_z", "engine_acc_z")
FINE = 20000.0
"""Rate of the own integration [Hz]: a force of 60 Hz that is linear between its samples is (w h)^2/12 = 3e-5 low."""

ENGINE: dict[str, object] = {"cylinders": 4, "bore": 0.0765, "stroke": 0.0869, "rod": 0.137, "reciprocating_mass": 0.45}
ENGINE |= {"spacing": 0.086, "firing": [1, 3, 4, 2], "torque": 30, "highest_order": 4}
ORDERS = {f"engine.orders.{key}": value for key, value in ENGINE.items()}


def integrated(car: Car, history: np.ndarray) -> np.ndarray:
    """Accelerations of the linear car by a force at the seat rail, linear between samples at `FINE`, at 1 kHz.

    The joints are eliminated by a basis of the null space of their rows, and each eigenvector of x' = A x + b F is
    integrated exactly over each interval.
    """
    system, (force,), model = car.matrices.system, car.vehicle.composition.forces, car.model.model
    data = mujoco.MjData(model)
    mujoco.mj_fwdPosition(model, data)
    linear = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, linear, None, np.array(force.at), model.body("body").id)
    gap = np.linalg.norm(car.model.superelement.positions - np.array(force.at), axis=1)
    node = car.model.superelement.nodes[int(np.argmin(gap))]
    linear[:, car.matrices.modal] += car.model.superelement.shape_at(node)
    basis = scipy.linalg.null_space(system.constraints)
    mass, damping, stiffness = (basis.T @ part @ basis for part in (system.mass, system.damping, system.stiffness))
    rows, n, b = system.branch_rows @ basis, basis.shape[1], len(system.branch_rows)
    effect = np.linalg.solve(mass, basis.T @ (np.array(force.force) @ linear))
    state = np.block(
        [
            [np.zeros((n, n)), np.eye(n), np.zeros((n, b))],
            [*np.split(-np.linalg.solve(mass, np.hstack([stiffness, damping])), 2, axis=1),
             -np.linalg.solve(mass, (system.effects @ basis).T)],
            [np.zeros((b, n)), system.branch_stiffness[:, None] * rows, -np.diag(1.0 / system.branch_time)],
        ]
    )  # fmt: skip
    poles, vectors = np.linalg.eig(state)
    inputs = np.linalg.solve(vectors, np.concatenate([np.zeros(n), effect, np.zeros(b)]).astype(complex))
    outputs = np.array([system.outputs[name][: system.size] for name in CHANNELS]) @ basis
    result = np.outer(outputs @ effect, history[::20]).astype(complex)
    step = 1.0 / FINE
    for pole, vector, weight in zip(poles, vectors.T, inputs, strict=True):
        x = pole * step
        # phi_1 and phi_2 of the exponential integrator; their series where x is small.
        one, two = (
            (np.expm1(x) / x, (np.expm1(x) - x) / x**2) if abs(x) > 1e-3 else (1 + x / 2 + x * x / 6, 0.5 + x / 6)
        )
        motion = lfilter([two * step, (one - two) * step], [1.0, -np.exp(x)], history.astype(complex))
        rate = vector[n : 2 * n] * pole * weight
        result += np.outer(outputs @ rate, motion[::20])
    accelerations: np.ndarray = result.real
    return accelerations


def rise(time: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * (1.0 - np.cos(np.pi * np.minimum(time, 1.0))))


def histories(run: Run) -> np.ndarray:
    return np.array([run[name] for name in CHANNELS])


def pulse(time: np.ndarray) -> np.ndarray:
    """Pulse of 300 N and 0.12 s, and a decaying oscillation of 22 Hz: at rest at both ends."""
    one = np.where((time > 0.5) & (time < 0.62), np.sin(np.pi * (time - 0.5) / 0.12) ** 2, 0.0)
    after = np.maximum(time - 1.0, 0.0)
    return 300.0 * one + 80.0 * np.sin(2.0 * np.pi * 22.0 * after) * np.exp(-2.0 * after) * after


# MuJoCo has the second order of the motion too, see below: it gets a tenth of 600 N.
@pytest.mark.parametrize(("kind", "factor", "limit"), [("reduced", 2.0, 1e-4), ("mujoco", 0.2, 1e-3)])
def test_a_force_of_a_file_moves_the_linear_car(tmp_path, kind, factor, limit):
    # The file is in kN at 2 kHz and begins at 3 s; the car of the reduced engine is linear without friction.
    time = np.arange(16001) / 2000.0
    table = np.column_stack([time + 3.0, np.sin(time), pulse(time) / 1000.0])
    heads = "time [s],torque [Nm],push [kN]"
    np.savetxt(tmp_path / "push.csv", table, delimiter=",", header=heads, comments="", fmt="%.9f")
    car = Car.load("focus", {**FREE, **ON_RAIL, "force.a.file": str(tmp_path / "push.csv"), "force.a.factor": factor})
    run = car.run(road("level", 0, duration=4), engine=kind, channels=CHANNELS)
    assert "begins at 3 s and was shifted to 0" in " ".join(run.recording.statistics.notices)
    validated(
        "Applied forces",
        f"{kind} engine, force of a file on the seat rail: accelerations of seat rail, knuckle and engine",
        histories(run), integrated(car, factor * pulse(np.arange(0.0, 4.0 + 0.5 / FINE, 1.0 / FINE))),
        source="second derivation: exact integration of each eigenvector at 20 kHz", peak=limit,
    )  # fmt: skip


@pytest.mark.parametrize("growth", ["constant", "squared"])
def test_a_run_up_moves_the_linear_car(growth):
    # 600 to 1200 rpm in 4 s: order 2 from 20 to 40 Hz, then constant.
    law: dict[str, object] = {"force.a.angle": "crank", "force.a.harmonics": [[1, 15, 20], [2, 30, -50]]}
    law |= {"force.a.reference_frequency": 15.0} if growth == "squared" else {}
    run_up = {"crank.rpm": 600, "crank.end_rpm": 1200, "crank.run_up_time": 4}
    car = Car.load("focus", {**FREE, **ON_RAIL, **law, **run_up})
    run = car.run(road("level", 0, duration=5), engine="reduced", channels=CHANNELS)
    time = np.arange(0.0, 5.0 + 0.5 / FINE, 1.0 / FINE)
    turns = np.where(time < 4.0, 10.0 * time + 1.25 * time**2, 60.0 + 20.0 * (time - 4.0))
    speed = np.minimum(10.0 + 2.5 * time, 20.0)
    force = 15.0 * np.cos(2.0 * np.pi * turns + np.radians(20.0))
    force += 30.0 * np.cos(4.0 * np.pi * turns - np.radians(50.0))
    force *= rise(time) * ((speed / 15.0) ** 2 if growth == "squared" else 1.0)
    validated(
        "Applied forces",
        f"run-up from 600 to 1200 rpm, orders 1 and 2, {growth} amplitudes: seat rail, knuckle and engine",
        histories(run), integrated(car, force),
        source="second derivation: exact integration of each eigenvector at 20 kHz", peak=1e-4,
    )  # fmt: skip


def test_both_engines_agree_on_a_run_up_of_an_engine_with_friction():
    run_up = {"crank.rpm": 700, "crank.end_rpm": 1500, "crank.run_up_time": 4}
    car = Car.load("focus_road", {**ORDERS, **run_up})
    smooth = road("level", 0, duration=4)
    precise, reduced = (car.run(smooth, engine=kind, channels=CHANNELS) for kind in ("mujoco", "reduced"))
    validated(
        "Applied forces",
        "run-up of a four-cylinder engine from 700 to 1500 rpm, with friction: both engines, difference over RMS",
        np.std(histories(reduced) - histories(precise), axis=1) / np.std(histories(precise), axis=1), 0.0,
        source="second derivation: MuJoCo", abs=5e-3,
    )  # fmt: skip
    energies = precise.recording.statistics.energies
    assert energies is not None and energies.residual < 5e-3
    # The torque of the gas does not grow with the speed, all else with its square: at 900 rpm the steady engine.
    steady = {f.name: f for f in Car.load("focus_road", {**ORDERS, "crank.rpm": 900}).vehicle.composition.forces}
    parts = {force.name: force for force in car.vehicle.composition.forces}
    share = (900.0 / 1500.0) ** 2
    order, speed = 2.0, parts["engine_torque"].speed
    inertia, gas = (parts[name].harmonics[order * speed] for name in ("engine_torque", "engine_torque_gas"))
    assert share * inertia + gas == pytest.approx(
        steady["engine_torque"].harmonics[order * steady["engine_torque"].speed], rel=1e-9
    )


def test_the_peak_of_a_mode_in_a_run_up():
    """Oscillator of 12 Hz and 3 % by exact integration of its equation; the amplitude of the notice."""
    frequency, damping, rates = 12.0, 0.03, (0.1, 0.5, 2.0, 5.0)
    step, natural = 1.0 / FINE, 2.0 * np.pi * frequency
    pole = natural * (-damping + 1j * np.sqrt(1.0 - damping**2))
    x = pole * step
    one, two = np.expm1(x) / x, (np.expm1(x) - x) / x**2
    found = []
    for rate in rates:
        time = np.arange(0.0, 12.0 / rate, step)[: round(100.0 * FINE)]
        force = np.cos(2.0 * np.pi * (frequency - 5.0 + 0.5 * rate * time) * time)
        motion = lfilter([two * step, (one - two) * step], [1.0, -np.exp(x)], force.astype(complex)).imag / pole.imag
        found.append(np.max(np.abs(motion)) * 2.0 * damping * natural**2)
    validated(
        "Applied forces",
        "peak of a mode of 12 Hz and 3 % in run-ups of 0.1, 0.5, 2 and 5 Hz/s over its steady peak",
        [run_up_peak(frequency, damping, rate)[0] for rate in rates],
        found,
        source="second derivation: exact integration of the oscillator at 20 kHz",
        abs=0.02,  # the envelope leaves out the second pole of the pair, a share of the damping ratio
    )


def test_the_peak_of_a_slow_mode_in_a_fast_run_up():
    """The equation of the envelope, integrated step by step: b = 500, where a quadrature of its solution is alone."""
    frequency, damping, b = 10.0, 0.02, 500.0
    bandwidth = 2.0 * np.pi * frequency * damping
    times = np.linspace(-0.1, 0.6, 1401)
    solved = solve_ivp(
        lambda u, a: (1j * b * u - 1.0) * a + 1.0, (-2.0, 0.6), [1.0 / (1.0 + 2j * b)], t_eval=times, rtol=1e-8,
        atol=1e-10,
    )  # fmt: skip
    top = np.argmax(np.abs(solved.y[0]))
    peak, late = run_up_peak(frequency, damping, b * bandwidth**2 / (2.0 * np.pi))
    # The function looks for the top on 801 times, 0.008 apart here; the top is sqrt(1/b) = 0.045 wide.
    assert peak == pytest.approx(abs(solved.y[0][top]), rel=4e-3)
    assert late == pytest.approx(b * bandwidth / (2.0 * np.pi) * times[top], rel=0.05)


def test_an_order_cut_separates_half_orders():
    time = np.arange(30001) / 1000.0
    turns, speed = 10.0 * time + 0.5 * time**2, 10.0 + time
    sizes = {2.0: 0.4, 2.5: 0.1}
    record = sum(size * speed**2 * np.cos(2.0 * np.pi * order * turns + order) for order, size in sizes.items())
    cut = order_cut(time, np.array([record]), 2.0 * np.pi * turns, 2.0 * np.pi * speed, [2.0, 2.5, 3.0])
    for row, (order, size) in enumerate(sizes.items()):
        # Over a window the square of the speed is not linear: its second derivative times the variance of the window.
        assert cut.amplitude[0, row] == pytest.approx(size * cut.turns**2 * np.exp(1j * order), rel=2e-3)
    assert np.max(np.abs(cut.amplitude[0, 2]) / (0.4 * cut.turns**2)) < 2e-3


def test_a_run_up_tells_what_its_speed_does_to_a_peak():
    run_up = {"crank.rpm": 700, "crank.end_rpm": 3000, "crank.run_up_time": 20}
    run = Car.load("focus_road", {**ORDERS, **run_up}).run(road("level", 0, duration=20), engine="reduced")
    (notice,) = (text for text in run.recording.statistics.notices if text.startswith("the run-up passes the mode at"))
    assert "in order 2 with 3.8 Hz/s" in notice and "python -m vehicle orders --rpm A:B:STEP" in notice
    (_, second), values = run.order_cut("seat rail z", orders=[1, 2]).amplitude[0], force_values(run)
    assert values["orders"] is None and np.max(np.abs(second)) == pytest.approx(
        next(line.peak["seat_rail_acc_z"] for line in values["run_up"] if line.order == 2)
    )
    with pytest.raises(VehicleError, match="the speed of crank changes in this run; use order_cut"):
        run.orders(orders=[2])


REFUSED: dict[str, tuple[dict[str, object], str]] = {
    "no such channel": ({"channel": "X"}, "force.a.channel 'X' matches no channel"),
    "unit of a moment": ({"channel": "torque"}, "channel 1 'torque' is a moment in [Nm]; force.a needs N, kN or lbf"),
    "no unit": ({"channel": "plain"}, "has no unit; set force.a.unit to N, kN or lbf"),
    "unknown unit": ({"channel": "plain", "unit": "kp"}, "has the unknown unit 'kp'; set force.a.unit to N, kN or lbf"),
    "shorter": ({"channel": "push"}, "the force lasts 2 s, less than the run, 3 s"),
    "does not end": ({"channel": "jump", "ends_at_zero": True}, "force.a.ends_at_zero: the last value of"),
    "gap": ({"channel": "gap", "ends_at_zero": True}, "gap"),
    "harmonics too": ({"harmonics": [[1, 1, 0]], "frequency": 5.0}, "found together with harmonics"),
    "no file": ({"file": "nowhere.csv"}, "nowhere.csv: the file does not exist"),
    "too fast": ({"channel": "fast", "ends_at_zero": True}, "solver.record_rate: found 1000 Hz, must be at least"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_bad_files_are_refused(tmp_path, name):
    changes, message = REFUSED[name]
    time = np.arange(2001) / 1000.0
    push, gap = pulse(time) * (time < 1.9), np.where(np.abs(time - 1.0) < 0.2, np.nan, 1.0)
    fast = np.sin(2.0 * np.pi * 300.0 * time) * np.sin(np.pi * time / 2.0) ** 2
    table = np.column_stack([time, time, push, push + 1.0, gap, push, fast])
    heads = "time [s],torque [Nm],push [N],jump [N],gap [N],plain,fast [N]"
    np.savetxt(tmp_path / "push.csv", table, delimiter=",", header=heads, comments="")
    places = {**ON_RAIL, "force.a.file": str(tmp_path / "push.csv")}
    with pytest.raises(VehicleError) as error:
        car = Car.load("focus", {**places, **{f"force.a.{key}": value for key, value in changes.items()}})
        car.run(road("level", 0, duration=3), engine="reduced")
    assert message in str(error.value)


def test_a_run_up_needs_both_numbers():
    with pytest.raises(VehicleError, match=r"crank.end_rpm: a run-up needs end_rpm and run_up_time; set both"):
        Car.load("focus", {"crank.rpm": 700, "crank.end_rpm": 3000})


def test_what_mujoco_differs_by_is_the_square_of_a_force():
    """The mean of the runs with F and -F has the even part alone, their difference the odd one, that of the method."""
    car, smooth = Car.load("focus", {**FREE, **ON_RAIL}), road("level", 0, duration=2.5)

    def run(kind: str, factor: float) -> np.ndarray:
        return histories(
            car.run(smooth, engine=kind, channels=CHANNELS, forces={"a": lambda time: factor * pulse(time)})
        )

    even, odd = [], []
    for factor in (2.0, 0.2):  # 600 N and 60 N
        pushed, pulled, linear = run("mujoco", factor), run("mujoco", -factor), run("reduced", factor)
        even.append(np.max(np.abs(pushed + pulled) / 2.0, axis=1) / np.max(np.abs(linear), axis=1))
        odd.append(np.max(np.abs((pushed - pulled) / 2.0 - linear), axis=1) / np.max(np.abs(linear), axis=1))
    assert np.all(even[0] > 1e-3)  # 0.2 to 0.7 % of the peak at 600 N
    validated(
        "Applied forces",
        "MuJoCo, force of 600 over 60 N on the seat rail: even parts of seat rail, knuckle and engine over the peak",
        even[0] / even[1], 10.0,
        source="closed form: a part of second order over one of first order grows with the force", rel=1e-2,
    )  # fmt: skip
    validated(
        "Applied forces", "MuJoCo, force of 600 N and 60 N on the seat rail: odd parts against the linear car",
        np.array(odd), 0.0, source="second derivation: reduced engine", abs=2e-4,
    )  # fmt: skip


def test_a_measured_speed_of_the_crankshaft_turns_its_forces(tmp_path):
    """Speed of a file that rises, waits and falls; its time begins at 5 s, and the last speed stays."""
    times, rpm = np.array([0.0, 1.0, 2.5, 4.0, 5.0]), np.array([700.0, 900.0, 900.0, 1400.0, 1100.0])
    table = np.column_stack([times + 5.0, np.zeros(5), rpm])
    np.savetxt(tmp_path / "speed.csv", table, delimiter=",", header="time [s],torque [Nm],n [1/min]", comments="")
    law: dict[str, object] = {"force.a.angle": "crank", "force.a.harmonics": [[1, 15, 20], [2, 30, -50]]}
    car = Car.load("focus", {**FREE, **ON_RAIL, **law, "crank.file": str(tmp_path / "speed.csv")})
    run = car.run(road("level", 0, duration=6), engine="reduced", channels=(*CHANNELS, "speed_crank"))
    time = np.arange(0.0, 6.0 + 0.5 / FINE, 1.0 / FINE)
    speed = np.interp(time, times, rpm / 60.0)
    turns = np.append(0.0, np.cumsum(0.5 * (speed[1:] + speed[:-1]) / FINE))
    force = 15.0 * np.cos(2.0 * np.pi * turns + np.radians(20.0))
    force += 30.0 * np.cos(4.0 * np.pi * turns - np.radians(50.0))
    validated(
        "Applied forces",
        "force over the angle of a measured speed of the crankshaft, 700 to 1400 rpm: seat rail, knuckle and engine",
        histories(run), integrated(car, force * rise(time)),
        source="second derivation: exact integration of each eigenvector at 20 kHz", peak=1e-4,
    )  # fmt: skip
    assert run["speed_crank"] == pytest.approx(60.0 * speed[::20], rel=1e-9)
    # Points on a line are the run-up of two numbers.
    points = np.column_stack([np.arange(9.0), 600.0 + 75.0 * np.arange(9.0)])
    np.savetxt(tmp_path / "line.csv", points, delimiter=",", header="time [s],n [rpm]", comments="")
    line = Car.load("focus", {"crank.file": str(tmp_path / "line.csv"), "crank.channel": "n"})
    plain = Car.load("focus", {"crank.rpm": 600, "crank.end_rpm": 1200, "crank.run_up_time": 8})
    run_ups = [each.vehicle.composition.crank_run_up for each in (line, plain)]
    turned = [SweptLine(*each).angle(time * 2.0)[0] for each in run_ups if each is not None]
    assert turned[0] == pytest.approx(turned[1], rel=1e-12)


def test_a_wrong_speed_of_the_crankshaft_is_refused(tmp_path):
    file = tmp_path / "speed.csv"
    points = np.column_stack([np.arange(8.0), np.full(8, 900.0), 1e5 * (np.arange(8.0) == 3.0)])
    np.savetxt(file, points, delimiter=",", header="time [s],n [rpm],m [rpm]", comments="")
    for changes, message in (
        ({"crank.file": str(file)}, "2 channels are in 1/min or rpm; set crank.channel to a number or name of: 1 'n'"),
        ({"crank.file": str(file), "crank.channel": "x"}, "0 channels match 'x'; set crank.channel"),
        (
            {"crank.file": str(file), "crank.channel": "m"},
            "the speed 'm' is 0 to 100000 1/min but must be 0 to 10000 1/min",
        ),
        ({"crank.file": str(file), "crank.rpm": 700}, "crank.rpm: set either rpm or file"),
        ({"crank.rpm": 700, "crank.channel": "n"}, ("crank.file: missing, but channel is set")),
        ({"crank.file": str(tmp_path / "no.csv")}, "no.csv: the file does not exist"),
    ):
        with pytest.raises(VehicleError) as error:
            Car.load("focus", changes)
        assert message in str(error.value)


def test_a_channel_of_the_input_is_the_speed_of_the_crankshaft(tmp_path, capsys):
    time = np.arange(751) / 500.0
    plate, rpm = 1e-3 * np.sin(20.0 * time) * np.minimum(time, 1.0), 700.0 + 100.0 * time
    file, heads = tmp_path / "rig.csv", "time [s],Shaker [m],n [1/min]"
    np.savetxt(file, np.column_stack([time, plate, rpm]), delimiter=",", header=heads, comments="", fmt="%.9g")
    force = ["force.a.on=engine", "force.a.force=[0,0,1]", "force.a.angle=crank", "force.a.harmonics=[[2,40,0]]"]
    words = ["--vehicle", "focus", "--input", str(file), "--engine", "reduced", "--no-figures", "--quiet"]
    words += [word for text in force for word in ("--set", text)]
    picks = ["--channel", "fl=Shaker", "--channel", "rpm=n"]
    out = tmp_path / "run"
    assert shaker([*words, *picks, "--channels", "speed_crank", "--output", str(out)]) == 0
    assert load_run(out)["speed_crank"] == pytest.approx(rpm[0] + 100.0 * np.arange(1501) / 1e3, rel=1e-6)
    for more, said in (
        (["--rpm", "750"], "the crankshaft speed is given twice; leave out --rpm and other channels"),
        (["--no-forces"], "--rpm has no effect with --no-forces"),
        (["--from", "0.1"], "the speed must be a channel of --input FILE, used from its start"),
    ):
        assert shaker([*words, *picks, *more]) == 2
        assert said in capsys.readouterr().err
