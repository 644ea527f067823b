"""Air spring: thermodynamics of the gas, levelling to the static load, both engines, energy."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.model.laws.elastomer import Maxwell
from vehicle.model.parameters.air_spring import ATMOSPHERE, GAMMA, air_stiffness
from vehicle.runs.car import Car
from vehicle.runs.car.air_notice import air_travel, gas_error
from vehicle.runs.car.road import Road

AREA, VOLUME, SLOPE, TIME, MASS = 0.01, 0.002, 0.02, 0.5, 150.0
BELLOWS, DAMPING = 2e3, 50.0

BOX = """
mirrored = false
joint = [{ kind = "slide", name = "box", child = "box", at = "box", axis = [0, 0, 1] }]
connection = [{ name = "box_air", moving = "MOVING", carrier = "CARRIER", at = "box" }]
output = [{ name = "box", on = "box", at = "box" }, { name = "floor", on = "body", at = "box" }]

[hardpoints]
box = "box on the floor of the car"

[parts]
box = { points = ["box"] }
"""

CAR = f"""
base = "sedan"
name = "box_car"

[box]
template = "box"
hardpoints = {{ box = [2.5, 0.0, 1.2] }}
parts = {{ box = {{ mass = {MASS}, inertia = [5.0, 5.0, 5.0] }} }}

[box.bushings.box_air]
stiffness = [0.0, 0.0, {BELLOWS}]
damping = [0.0, 0.0, {DAMPING}]
rotational_stiffness = 0.0
air_area = {AREA}
air_volume = {VOLUME}
air_area_slope = {SLOPE}
air_exchange_time = {TIME}
"""


def written(folder, moving="body", carrier="box", car=CAR):
    """Write a sedan with a box that moves up and down on an air spring; return its file."""
    (folder / "box.toml").write_text(BOX.replace("MOVING", moving).replace("CARRIER", carrier), encoding="utf-8")
    (folder / "vehicle.toml").write_text(car, encoding="utf-8")
    return folder / "vehicle.toml"


@pytest.fixture(scope="module")
def car(tmp_path_factory):
    return Car.load(written(tmp_path_factory.mktemp("box")))


def gas_stiffness(load, frequency, amplitude=1e-6):
    """Return the complex stiffness of the gas itself [N/m]: nonlinear, m cv T' = -p V' - G (T - T0), p V = m R T."""
    pressure = ATMOSPHERE + load / AREA
    # With T0 = 1 and m R = p V: m cv = p V / (gamma - 1) and G = m cv / tau.
    capacity = pressure * VOLUME / (GAMMA - 1.0)
    steps, periods = 2000, 12 + round(8 * TIME * frequency)
    omega, h = 2.0 * np.pi * frequency, 1.0 / (frequency * steps)

    def rate(time, temperature):
        travel, speed = amplitude * np.sin(omega * time), amplitude * omega * np.cos(omega * time)
        # dV/ds = -A(s), A = A0 + slope s.
        area, volume = AREA + SLOPE * travel, VOLUME - AREA * travel - 0.5 * SLOPE * travel**2
        present = pressure * VOLUME * temperature / volume
        force = (present - ATMOSPHERE) * area
        return (present * area * speed - capacity / TIME * (temperature - 1.0)) / capacity, force

    temperature, forces = 1.0, []
    for n in range(steps * periods):
        t = n * h
        k1, force = rate(t, temperature)
        k2, _ = rate(t + 0.5 * h, temperature + 0.5 * h * k1)
        k3, _ = rate(t + 0.5 * h, temperature + 0.5 * h * k2)
        k4, _ = rate(t + h, temperature + h * k3)
        temperature += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if n >= steps * (periods - 1):
            forces.append((force - load) * np.exp(-1j * omega * t))
    return 2j * np.mean(forces) / amplitude


@pytest.mark.parametrize("frequency", [0.1, 0.3, 2.0])
def test_the_law_is_that_of_the_gas(frequency):
    load = 1500.0
    static, branch = air_stiffness(load, AREA, VOLUME, SLOPE)
    law = Maxwell(stiffness=static, branch_stiffness=branch, branch_damping=branch * TIME)
    validated(
        "Bushings, springs and stops", f"air spring at {frequency:g} Hz, complex stiffness",
        law.complex_stiffness(2.0 * np.pi * frequency), gas_stiffness(load, frequency), rel=1e-4, unit="N/m",
        source="second derivation: gas with heat exchange, integrated in time, amplitude of 1 um",
    )  # fmt: skip


@pytest.mark.parametrize("mass", [MASS, 250.0])
def test_transmission_to_a_levelled_box(car, mass):
    """a_box / a_floor = K / (K + m s2); a heavier box has a higher pressure, as a variant and as a built car."""
    frequency = np.linspace(0.2, 20.0, 60)
    s, load = 2j * np.pi * frequency, mass * car.vehicle.gravity
    pressure = ATMOSPHERE + load / AREA
    gas = pressure * AREA**2 / VOLUME * (1.0 + (GAMMA - 1.0) * TIME * s / (1.0 + TIME * s))
    stiffness = BELLOWS + DAMPING * s + gas + load / AREA * SLOPE
    box, floor = car.with_({"box.parts.box.mass": mass}).matrix_frf(("box_acc_z", "floor_acc_z"), frequency)
    validated(
        "Bushings, springs and stops", f"box of {mass:g} kg on a levelled air spring, transmission",
        box / floor, stiffness / (stiffness + mass * s**2), rel=1e-6, unit="-",
        source="closed form: K/(K + m s2) with p = pa + m g/A, isothermal to adiabatic",
    )  # fmt: skip


def test_both_engines_and_energy(car):
    road = Road("B", speed=60, duration=5, period="record")
    stepped, run = (car.run(road, engine=engine) for engine in ("mujoco", "reduced"))
    validated(
        "Bushings, springs and stops", "RMS of a box on an air spring, reduced engine over MuJoCo",
        np.std(run["box z"]) / np.std(stepped["box z"]), 1.0, abs=2e-3,
        source="second derivation: time integration in MuJoCo",
    )  # fmt: skip
    energies = stepped.recording.statistics.energies
    assert energies is not None
    validated(
        "Bushings, springs and stops", "work on a car with an air spring, less stored and dissipated energy",
        energies.residual, 0.0, abs=3e-4, source="conservation: energy balance",
    )  # fmt: skip


def test_wrong_air_springs_are_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="air spring bushing/box_air: carries -1472 N"):
        Car.load(written(tmp_path, moving="box", carrier="body")).static  # noqa: B018
    for old, new, message in (
        (f"air_volume = {VOLUME}\n", "", "air_volume: missing"),
        ("air_area_slope", "maxwell_stiffness = 1e3\nmaxwell_damping = 1e3\nair_area_slope", "the only branch along z"),
        (f"air_area = {AREA}", "air_area = 100.0", "must be at most 1"),
    ):
        with pytest.raises(ConfigurationError, match=message):
            Car.load(written(tmp_path, car=CAR.replace(old, new)))
    air = {"air_area": AREA, "air_volume": VOLUME, "air_exchange_time": TIME}
    with pytest.raises(ConfigurationError, match="the body is flexible at this point"):
        Car.load("focus_road", {f"engine.bushings.linear_mount.{key}": value for key, value in air.items()}).static  # noqa: B018


def test_beyond_the_linear_range_a_run_has_a_notice(car):
    """Error of the adiabatic gas, (V/(V - A x))^gamma by hand, and the travel of a sine from its force."""
    law = next(link.law for link in car.vehicle.composition.connections if link.name == "box_air")
    load, x = MASS * car.vehicle.gravity, 0.02
    absolute = ATMOSPHERE + load / AREA
    volumes = VOLUME - AREA * np.array([x, -x]) - 0.5 * SLOPE * x**2
    force = (absolute * (VOLUME / volumes) ** 1.4 - ATMOSPHERE) * (AREA + SLOPE * np.array([x, -x]))
    linear = (1.4 * absolute * AREA**2 / VOLUME + load / AREA * SLOPE) * np.array([x, -x])
    validated(
        "Bushings, springs and stops", "air spring at 20 mm: error of the change of its force by the linear law",
        [gas_error(law, load, end) for end in (x, -x)], (force - load) / linear - 1.0, rel=1e-9,
        source="closed form: p V^1.4 = const",
    )  # fmt: skip
    time = np.arange(8000) / 1e3
    wave = np.exp(2j * np.pi * 1.5 * time)
    static, branch = air_stiffness(load, AREA, VOLUME, SLOPE)
    gas = Maxwell(stiffness=BELLOWS + static, branch_stiffness=branch, branch_damping=branch * TIME)
    stiffness = gas.complex_stiffness(3.0 * np.pi) + 3j * np.pi * DAMPING
    travel = air_travel(law, load, (x * wave * stiffness).imag, 1e-3)
    # Settled after 10 tau; the damper is a backward difference, 1e-3 of the stiffness late by half a sample.
    assert travel[5000:] == pytest.approx(x * wave.imag[5000:], abs=2e-3 * x)
    smooth, rough = (car.run(Road(road, 60, duration=5, period="record"), "reduced") for road in ("A", "D"))
    assert not [text for text in smooth.recording.statistics.notices if "gas is adiabatic" in text]
    (text,) = [text for text in rough.recording.statistics.notices if "gas is adiabatic" in text]
    assert text.startswith("box.bushings.box_air moves from -")
    assert "box_air_force_z" not in rough.channels
