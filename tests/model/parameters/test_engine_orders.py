"""Orders of an engine: crank drive by its kinetic energy and by series, gas by its work, cylinders by their firing."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, road
from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.engine_orders import EngineOrders
from vehicle.model.parameters.slider_crank import block_forces, crank_angles, gas_pressure, gas_torque, piston

FOUR: dict[str, Any] = {
    "cylinders": 4, "bore": 0.079, "stroke": 0.0814, "rod": 0.137, "reciprocating_mass": 0.45, "spacing": 0.087,
    "firing": [1, 3, 4, 2], "torque": 60.0,
}  # fmt: skip
SPEED = 3000 * math.pi / 30.0
R, LAMBDA = 0.5 * FOUR["stroke"], 0.5 * FOUR["stroke"] / FOUR["rod"]
UNIT = FOUR["reciprocating_mass"] * R * SPEED**2


def engine(**changes: Any) -> EngineOrders:
    numbers = {**FOUR, **changes}
    return EngineOrders(**{**numbers, "firing": tuple(map(float, numbers["firing"]))})


def test_torque_of_the_pistons_by_the_derivative_of_their_kinetic_energy() -> None:
    # At constant speed the crankshaft gets -d/dphi of the kinetic energy m w^2 x'(phi)^2 / 2; its spectrum is exact.
    without_gas = engine(torque=0.0, bore=0.0201)
    _, rate, _ = piston(without_gas, crank_angles())
    energy = 0.5 * FOUR["reciprocating_mass"] * (SPEED * rate) ** 2
    orders = np.arange(energy.size // 2 + 1) / 2.0
    slope = 1j * orders * np.fft.rfft(energy) * 2.0 / energy.size
    gas = np.fft.rfft(gas_torque(without_gas)) * 2.0 / energy.size
    block = block_forces(without_gas, SPEED, 8).torque
    found = [block[2.0], block[4.0], block[6.0], block[8.0]]
    # Four cylinders, all in phase in even orders; the block gets minus the torque on the crankshaft.
    expected = [4.0 * (slope[int(2 * order)] - gas[int(2 * order)]) for order in (2, 4, 6, 8)]
    validated(
        "Applied forces", "orders 2, 4, 6 and 8 of the torque of the pistons of a four-cylinder engine on its block",
        np.array(found), np.array(expected),
        source="second derivation: derivative of the kinetic energy of the pistons over the crank angle", peak=1e-9,
        unit="N m",
    )  # fmt: skip


def test_force_of_the_pistons_by_their_series() -> None:
    # Den Hartog, Mechanical Vibrations, chapter 5; the next terms are of the order lambda^7.
    second = LAMBDA + LAMBDA**3 / 4 + 15 * LAMBDA**5 / 128
    fourth, sixth = -(LAMBDA**3 / 4 + 3 * LAMBDA**5 / 16), 9 * LAMBDA**5 / 128
    found = block_forces(engine(), SPEED, 6)
    expected = {2.0: 4 * UNIT * second, 4.0: 4 * UNIT * fourth, 6.0: 4 * UNIT * sixth}
    for order, force in expected.items():
        assert found.force[order] == pytest.approx(force, abs=4 * UNIT * 40 * LAMBDA**7 / 128)
    assert max(abs(found.force[order]) for order in found.force if order not in expected) < 1e-9 * UNIT
    assert max(map(abs, found.moment.values())) < 1e-9 * UNIT
    balanced = block_forces(engine(balance_share=1.0), SPEED, 6)
    assert balanced.force[2.0] == 0.0
    assert balanced.force[4.0] == found.force[4.0]


def test_a_three_has_moments_of_order_one_and_two_and_no_force() -> None:
    three = block_forces(engine(cylinders=3, firing=[1, 3, 2]), SPEED, 6)
    arm = math.sqrt(3.0) * FOUR["spacing"] * UNIT
    assert abs(three.moment[1.0]) == pytest.approx(arm, rel=1e-9)
    assert abs(three.moment[2.0]) == pytest.approx(arm * (LAMBDA + LAMBDA**3 / 4 + 15 * LAMBDA**5 / 128), rel=1e-4)
    assert max(abs(three.force[order]) for order in three.force if order < 6.0) < 1e-9 * UNIT
    assert {order for order, torque in three.torque.items() if abs(torque) > 1e-6} == {1.5, 3.0, 4.5, 6.0}


@pytest.mark.parametrize("torque", [0.0, 30.0, 140.0])
def test_the_gas_gives_its_mean_torque(torque: float) -> None:
    assert 4.0 * float(np.mean(gas_torque(engine(torque=torque)))) == pytest.approx(torque, abs=1e-9)


def trace(tmp_path: Path, rows: Vector, head: str = "crank angle [deg],pressure [bar]") -> str:
    """Path of a file of the pressure."""
    file = tmp_path / "p.csv"
    np.savetxt(file, rows, delimiter=",", header=head, comments="", fmt="%.12g")
    return str(file)


@pytest.fixture(scope="module")
def modelled() -> Vector:
    """Crank angles [deg] and pressures [bar] of the modelled gas with the inlet at 0.6 bar; (1440, 2)."""
    return np.column_stack([np.degrees(crank_angles()), gas_pressure(engine(), 0.6e5) / 1e5])


@pytest.mark.parametrize(("step", "first", "limit"), [(1, 0, 1e-9), (2, 1, 1e-5), (6, 3, 5e-5)])
def test_a_trace_of_the_modelled_gas_gives_its_orders_back(
    tmp_path: Path, modelled: Vector, step: int, first: int, limit: float
) -> None:
    # A file in steps of 0.5, 1 and 3 degrees; one of 0 to 720 with both ends, in kPa, is the same.
    from_file = engine(torque=0.0, pressure=trace(tmp_path, modelled[first::step]))
    found = block_forces(from_file, SPEED, 8).torque
    mean = 4.0 * float(np.mean(gas_torque(from_file)))
    expected = block_forces(engine(torque=mean), SPEED, 8).torque
    validated(
        "Applied forces", f"orders 2, 4, 6 and 8 of an engine by a pressure trace in steps of {0.5 * step:g} degrees",
        np.array([found[order] for order in (2.0, 4.0, 6.0, 8.0)]),
        np.array([expected[order] for order in (2.0, 4.0, 6.0, 8.0)]),
        source="second derivation: closed model of the gas, from which the trace was made", peak=limit, unit="N m",
    )  # fmt: skip


def test_the_work_of_a_measured_cycle_is_that_of_its_pressure_and_volume(tmp_path: Path) -> None:
    """Mean torque x 4 pi = the area of the loop of pressure over volume, of any trace, here from 0 to 720 degrees."""
    crank = np.arange(0.0, 720.25, 0.5)
    bell = np.exp(-(((np.remainder(crank - 12.0 + 360.0, 720.0) - 360.0) / 40.0) ** 2))
    pressure = 100.0 * (1.0 + 30.0 * bell + 0.2 * np.sin(np.radians(1.5 * crank)))
    file = trace(tmp_path, np.column_stack([np.radians(crank), pressure]), "alpha [rad],p1 [kPa]")
    mean = 4.0 * float(np.mean(gas_torque(engine(torque=0.0, pressure=file))))
    phi = np.radians(crank)
    height = R * np.cos(phi) + np.sqrt(FOUR["rod"] ** 2 - (R * np.sin(phi)) ** 2)
    volume = -0.25 * math.pi * FOUR["bore"] ** 2 * height
    work = 4.0 * 1e3 * float(np.sum(0.5 * (pressure[1:] + pressure[:-1]) * np.diff(volume)))
    # Trapezia over half a degree are 1e-5 off.
    assert mean * 4.0 * math.pi == pytest.approx(work, rel=1e-4)
    assert work > 500.0


CYCLE_LATER = np.array([720.0, 0.0])

BAD_TRACES = {
    "half a cycle": (lambda rows: rows[:721], None, "angles from -360 to 0 deg in steps of up to 360 deg, must be"),
    "two cycles": (
        lambda rows: np.vstack([rows, rows + CYCLE_LATER]), None, "must be a cycle of 720 deg in steps of at most 3",
    ),
    "unsorted": (lambda rows: rows[::-1], None, ("crank angle 359 deg follows 359.5 deg; the angle must increase "
        "through a single cycle")),
    "Pa as bar": (lambda rows: rows * [1.0, 1e5], None, "bar but must be 2 to 400 bar; correct the unit of the column"),
    "bar as Pa": (lambda rows: rows, "a [deg],p [Pa]", "pressure is 0.0003208 bar but must be 2 to 400 bar"),
    "gauge": (lambda rows: rows - [0.0, 1.0], None, ("bar but must be above 0 bar")),
    "shifted": (lambda rows: rows + 0.5 * CYCLE_LATER, None, "377.5 deg but must be within 60 deg of 0"),
    "no unit": (lambda rows: rows, "a,p", ("0 columns have a unit of angle")),
    "gap": (lambda rows: np.delete(rows, slice(100, 120), axis=0), None, "in steps of up to 10.5 deg, must be"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD_TRACES)
def test_a_wrong_trace_is_refused(tmp_path: Path, modelled: Vector, case: str) -> None:
    change, head, said = BAD_TRACES[case]
    file = trace(tmp_path, change(modelled), *([head] if head else []))
    numbers = {f"engine.orders.{key}": value for key, value in {**FOUR, "torque": 0.0, "pressure": file}.items()}
    with pytest.raises(ConfigurationError) as raised:
        Car.load("sedan", {"crank.rpm": 750, **numbers})
    assert f"engine.orders.pressure: {file}: " in str(raised.value)
    assert said in str(raised.value)


def test_a_trace_gives_the_torque_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, modelled: Vector) -> None:
    trace(tmp_path, modelled)
    monkeypatch.chdir(tmp_path)
    numbers = {f"engine.orders.{key}": value for key, value in {**FOUR, "pressure": "p.csv"}.items()}
    with pytest.raises(ConfigurationError, match=r"engine.orders.torque: given twice, as 60 N m"):
        Car.load("sedan", {"crank.rpm": 750, **numbers})
    car = Car.load("sedan", {"crank.rpm": 750, **numbers, "engine.orders.torque": 0})
    forces = {force.name: force for force in car.vehicle.composition.forces}
    assert forces["engine_torque"].harmonics[2.0 * 750 * math.pi / 30.0] != 0.0
    with pytest.raises(ConfigurationError, match=r"engine.orders.pressure: .*none.csv: the file does not exist"):
        Car.load(
            "sedan", {"crank.rpm": 750, **numbers, "engine.orders.torque": 0, "engine.orders.pressure": "none.csv"}
        )


def test_half_the_counterweight_leaves_a_moment_of_constant_size_that_turns_backward() -> None:
    numbers = {**FOUR, "cylinders": 3, "firing": [1, 3, 2], "counterweight_share": 0.5}
    car = Car.load("sedan", {"crank.rpm": 3000, **{f"engine.orders.{key}": value for key, value in numbers.items()}})
    forces = {force.name: force for force in car.vehicle.composition.forces}
    across, along = forces["engine_moment_across"], forces["engine_moment_along"]
    assert (across.moment, along.moment) == ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    ahead, later = across.harmonics[SPEED], along.harmonics[SPEED]
    size = 0.5 * math.sqrt(3.0) * FOUR["spacing"] * UNIT
    angles = np.linspace(0.0, 2.0 * np.pi, 7)
    x, z = ((amplitude * np.exp(1j * angles)).real for amplitude in (ahead, later))
    assert np.hypot(x, z) == pytest.approx(np.full(7, size), rel=1e-9)
    # The crankshaft turns about +y: from z to x. The moment turns from x to z.
    assert np.diff(np.unwrap(np.arctan2(z, x))) == pytest.approx(np.full(6, np.pi / 3.0))


@pytest.mark.parametrize(("counterweight", "backward"), [(0.5, 1.0), (0.5, 0.6), (0.2, 1.0), (0.0, 0.0)])
def test_a_balance_shaft_of_a_three_takes_the_moment_that_turns_backward(counterweight: float, backward: float) -> None:
    """The moments of pistons, counterweights and shaft, mass by mass over a turn of the crankshaft."""
    numbers = {**FOUR, "cylinders": 3, "firing": [1, 3, 2], "counterweight_share": counterweight}
    numbers |= {"backward_balance_share": backward}
    car = Car.load("sedan", {"crank.rpm": 3000, **{f"engine.orders.{key}": value for key, value in numbers.items()}})
    forces = {force.name: force.harmonics.get(SPEED, 0.0j) for force in car.vehicle.composition.forces}
    phi = np.linspace(0.0, 2.0 * np.pi, 25)
    x, z = ((forces.get(f"engine_moment_{name}", 0.0j) * np.exp(1j * phi)).real for name in ("across", "along"))
    # The crankshaft turns about +y, its throws from z to x; cylinder 1 is at +y and cylinder 3 fires second.
    moment = np.zeros((25, 3))
    for cylinder, behind in ((1, 0.0), (3, 240.0), (2, 480.0)):
        angle = phi - np.radians(behind)
        none, sine, cosine = np.zeros(25), np.sin(angle), np.cos(angle)
        piston_force = np.column_stack([none, none, cosine])
        counterweights = -counterweight * np.column_stack([sine, none, cosine])
        shaft = -0.5 * backward * np.column_stack([-sine, none, cosine])
        place = np.array([0.0, FOUR["spacing"] * (2 - cylinder), 0.0])
        moment += np.cross(place, UNIT * (piston_force + counterweights + shaft))
    size = math.sqrt(3.0) * FOUR["spacing"] * UNIT
    assert np.column_stack([x, z]) == pytest.approx(moment[:, ::2], abs=1e-9 * size)
    largest = np.hypot(x, z).max()
    assert largest == pytest.approx(size * (abs(0.5 - counterweight) + 0.5 * (1.0 - backward)), abs=1e-9 * size)


@pytest.mark.parametrize("name", ["focus", "sedan"])
def test_both_engines_agree_on_idle(name: str) -> None:
    numbers = {f"engine.orders.{key}": value for key, value in {**FOUR, "torque": 20.0}.items()}
    car = Car.load(name, {"crank.rpm": 750, **numbers})
    source = road("level", 0, duration=6)
    channels = ["seat_rail_acc_z", "seat_rail_acc_x", "engine_acc_z"]
    precise, reduced = (
        car.run(source, engine=kind, channels=channels, skip=3.0).orders(channels, orders=[2, 4])
        for kind in ("mujoco", "reduced")
    )
    assert precise.frequency == pytest.approx([25.0, 50.0])
    validated(
        "Applied forces",
        f"idle of a four-cylinder engine at 750 rpm in {name}: orders 2 and 4 of seat rail and engine in both engines",
        reduced.amplitude, precise.amplitude, source="second derivation: MuJoCo", rel=5e-3, peak=1e-4,
    )  # fmt: skip


@pytest.mark.parametrize(("changes", "said"), [
    ({"firing": [1, 3, 4]}, "engine.orders.firing: found [1.0, 3.0, 4.0], must name each of the 4 cylinders"),
    ({"rod": 0.04}, "engine.orders.rod: found 0.04 m, must be above half the stroke"),
    ({"cylinder_axis": [0, 1, 0]}, "engine.orders.cylinder_axis: found [0.0, 1.0, 0.0], must be across"),
    ({"torque": 1500.0}, "engine.orders.torque: found 1500 N m, must be at most"),
])  # fmt: skip
def test_a_wrong_engine_is_refused(changes: dict[str, Any], said: str) -> None:
    numbers = {f"engine.orders.{key}": value for key, value in {**FOUR, **changes}.items()}
    with pytest.raises(ConfigurationError) as raised:
        Car.load("sedan", {"crank.rpm": 750, **numbers})
    assert said in str(raised.value)
