"""Steering of rack, column and wheel: mode in closed form, both engines, resonance over speed, friction of the rack."""

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle import Car, order_points, road
from vehicle.commands.summary_text import summary_text
from vehicle.signals.analysis.weighting import weighting
from vehicle.signals.records.run_summary import read_summary

CHANNELS = ["steering_wheel_rim_acc_y", "steering_wheel_rim_acc_x", "knuckle_fr_acc_x", "seat_rail_acc_z"]
GUIDES = ("rack_guide_right", "rack_guide_left")
FREE = {f"steering.bushings.{name}.friction_force": [0, 0, 0] for name in GUIDES}


def unbalanced(grams: float, *, friction: bool = True) -> Car:
    imbalance = {"front.right.imbalance.mass": grams / 1000.0, "front.right.imbalance.radius": 0.2}
    return Car.load("sedan_steering", imbalance if friction else {**imbalance, **FREE})


def test_the_mode_of_rack_and_steering_wheel_in_closed_form():
    """Rack on its own guides, off the steering rods; wheel on the column.

    m y'' + k (y - i phi) = 0,   J phi'' - i k (y - i phi) + K phi = 0,

    k = K_c/i^2 of the column at the radius i of the pinion, K of the hands: w^2 = k (1/m + 1/(J/i^2)) for K = 0.
    """
    rigid = {"steering.bushings.column_top.stiffness": [1e10] * 3, "front.ports.rack": "body"}
    rigid |= {"steering.bushings.column_bottom.stiffness": [0, 1e10, 1e10]}
    car = Car.load("sedan_steering", {**FREE, **rigid})
    model, system = car.model.model, car.matrices.system
    rows = np.concatenate(
        [model.jnt_dofadr[body.jntadr[0]] + np.arange(6) for body in (model.body("rack"), model.body("steering_wheel"))]
    )
    squares = scipy.linalg.eigvals(system.stiffness[np.ix_(rows, rows)], system.mass[np.ix_(rows, rows)]).real
    points = car.vehicle.table["steering"]["hardpoints"]
    along = np.subtract(points["column_top"], points["column_bottom"])
    radius = np.linalg.norm(np.cross(np.subtract(points["pinion"], points["column_bottom"]), along))
    radius /= np.linalg.norm(along)
    k, hands, mass = 1.2e6, 2.0, 2.5
    # Inertia about the column: n' I n with the disc of the vehicle file.
    n = along / np.linalg.norm(along)
    inertia = n @ np.array([[0.0801, 0.0, -0.069455], [0.0, 0.2004, 0.0], [-0.069455, 0.0, 0.1603]]) @ n
    expected = scipy.linalg.eigvalsh(
        np.array([[k, -radius * k], [-radius * k, radius**2 * k + hands]]), np.diag([mass, inertia])
    )
    found = [squares[np.argmin(np.abs(squares - value))] for value in expected]
    validated(
        "Applied forces",
        "steering of `sedan_steering` off its rods: mode of rack against wheel, and of both on the hands",
        np.sqrt(found) / (2.0 * np.pi),
        np.sqrt(expected) / (2.0 * np.pi),
        source="closed form: two masses on the column and the hands",
        rel=2e-4,  # bearings of 1e10 N/m are in series with the column
        unit="Hz",
    )
    assert inertia == pytest.approx(0.04, rel=1e-3)
    assert radius == pytest.approx(0.0075, rel=1e-3)
    assert expected[1] == pytest.approx(k * (1.0 / mass + radius**2 / inertia), rel=1e-3)


def switched(time, length, inertia, damping, stiffness):
    """Acceleration of J x'' + c x' + K x = (1 - cos(2 pi t/T))/2 from rest at t = 0, 0 before; closed form."""
    line, poles = 2j * np.pi / length, np.roots([inertia, damping, stiffness])
    gain = 0.5 / (inertia * line**2 + damping * line + stiffness)
    start = -np.array([0.5 / stiffness - gain.real, -(gain * line).real])
    free = np.linalg.solve(np.vstack([np.ones(2), poles]), start.astype(complex))
    after = np.maximum(time, 0.0)
    acceleration = (free * poles**2) @ np.exp(np.multiply.outer(poles, after)) - gain * line**2 * np.exp(line * after)
    return np.where(time < 0.0, 0.0, acceleration.real)


def test_a_pulse_of_a_file_moves_one_mass_as_in_closed_form(tmp_path):
    """A sin^2 pulse, as of an engine that is switched off, on the one mass that turns: the wheel on light hands.

    sin(pi t/T)^2 within T is the history of `switched`, less the same T later.
    """
    time, begin, length = np.arange(0.0, 4.0, 0.0005), 0.7, 0.25
    inside = (time > begin) & (time < begin + length)
    pulse = np.where(inside, np.sin(np.pi * (time - begin) / length) ** 2, 0.0)
    np.savetxt(tmp_path / "p.csv", np.column_stack([time, pulse]), delimiter=",", header="time [s],T [Nm]", comments="")
    table = Car.load("sedan_steering").vehicle.table["steering"]
    axis = np.subtract(table["hardpoints"]["column_top"], table["hardpoints"]["column_bottom"])
    force = {"force.off.on": "steering_wheel", "force.off.moment": axis.tolist(), "force.off.against": "body"}
    firm = {f"steering.bushings.{name}.stiffness.y": 1e8 for name in ("pinion", "column_bottom", "column_top")}
    rest = {"force.off.file": str(tmp_path / "p.csv"), "front.ports.rack": "body"}
    car = Car.load("sedan_steering", {**FREE, **force, **firm, **rest})
    run = car.run(road("level", 0, duration=3.5), engine="reduced", channels=CHANNELS[:1])
    # The rack turns with the wheel, y = i phi, and its guides damp it; about the column the rim is 0.19 m away.
    inertia, damping, stiffness = 0.04 + 2.5 * 0.0075**2, 3000.0 * 0.0075**2, 2.0
    late = run.time - begin
    parts = [switched(at, length, inertia, damping, stiffness) for at in (late, late - length)]
    validated(
        "Applied forces",
        "pulse of a file on the steering wheel off its rods: acceleration of the rim, one mass on its spring",
        run[CHANNELS[0]],
        -0.19 * (parts[0] - parts[1]),
        source="closed form: a damped mass under a pulse sin^2",
        peak=5e-3,  # the body below moves too
    )


@pytest.mark.parametrize("grams", [10.0, 80.0])
def test_both_engines_agree_on_nibble(grams):
    car, smooth = unbalanced(grams), road("level", 90, duration=5)
    precise, reduced = (
        car.run(smooth, engine=kind, channels=CHANNELS).orders(CHANNELS, orders=[1]).amplitude
        for kind in ("mujoco", "reduced")
    )
    validated(
        "Applied forces",
        f"nibble of `sedan_steering` by {grams:g} g at 90 km/h: order 1 of rim, knuckle and seat in both engines",
        reduced, precise, source="second derivation: MuJoCo", rel=5e-3, peak=1e-4,
    )  # fmt: skip


def test_nibble_has_its_resonance_where_the_wheels_meet_the_steering():
    car = unbalanced(20.0, friction=False)
    points = order_points(car, "steering wheel rim y", speed=[70, 90, 120], orders=[1], duration=4.0)
    sizes = np.abs(points.amplitude[0])
    top = int(np.argmax(sizes / points.turns**2))
    steer = [
        mode.frequency for mode in car.with_({"driving.speed": 25.0}).modes("stuck") if "steer" in mode.description
    ]
    # A mode of 11 % turns an imbalance into a peak over a range of that width.
    assert points.turns[top] == pytest.approx(min(steer), rel=0.1)
    assert sizes[top] > 2.5 * max(sizes[0], sizes[-1])


def test_the_friction_of_the_rack_holds_nibble_of_a_small_imbalance():
    per_gram = [
        abs(order_points(unbalanced(grams), CHANNELS[0], speed=[90], orders=[1], duration=4.0).amplitude[0, 0]) / grams
        for grams in (5.0, 80.0)
    ]
    (free,) = np.abs(
        order_points(unbalanced(5.0, friction=False), CHANNELS[0], speed=[90], orders=[1], duration=4.0).amplitude[0]
    )
    assert per_gram[0] < 0.25 * free / 5.0
    assert per_gram[1] > 2.0 * per_gram[0]


def test_comfort_at_the_rim_is_weighted_as_on_a_steering_wheel(tmp_path):
    run = unbalanced(40.0, friction=False).run(road("level", 90, duration=6), engine="reduced")
    value, factor = run.comfort("steering_wheel_rim"), weighting("Ws").spectrum_factor(run.orders().frequency)
    (size,) = np.abs(run.orders("steering_wheel_rim_acc_y", orders=[1]).amplitude[0])
    # A single line; the imbalance makes no other order of this size.
    assert value.weighted.y == pytest.approx(factor[0] * size / np.sqrt(2.0), rel=0.02)
    assert value.standard == "Giacomin et al. 2004"
    run.save(tmp_path / "run")
    whole = read_summary(tmp_path / "run")
    summary = whole["steering_wheel_rim"]
    assert summary["weighted_rms"]["y"] == value.weighted.y
    assert (summary["weighting"], summary["rms"]["y"]) == ("Ws", value.unweighted.y)
    assert f"steering wheel rim {value.weighted.overall:.4f} m/s2 weighted RMS (Ws, Giacomin" in summary_text(whole)
