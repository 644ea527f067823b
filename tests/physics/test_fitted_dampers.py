"""Cars with every law that `fit-damper` writes: the reduced engine against MuJoCo, and the energy of MuJoCo."""

import re
import tomllib

import numpy as np
import pytest

from tests.validation import validated
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.studies.dampers.damper_fit import DamperFit
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_setting import Setting
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.damper_text import vehicle_lines
from vehicle.studies.dampers.fitted_damper import FittedDamper
from vehicle.studies.dampers.over_condition import control_lines
from vehicle.studies.dampers.waveform import waveform_of

MOUNT = {"front": "suspension_mount", "rear": "damper_mount"}
CURVE = {"gas_force": 150.0, "damping_1": 5000.0, "damping_2": 1200.0, "velocity_1": 0.06}
SIDES = {"gas_force": 150.0, "rebound_damping_1": 6e3, "rebound_damping_2": 3e3, "rebound_damping_3": 900.0}
SIDES |= {"rebound_velocity_1": 0.05, "rebound_velocity_2": 0.04, "bump_damping_1": 4e3, "bump_damping_2": 2e3}
SIDES |= {"bump_damping_3": 700.0, "bump_velocity_1": 0.06, "bump_velocity_2": 0.05, "friction": 40.0}
STRIBECK = CURVE | {"friction": 50.0, "friction_at_rest": 30.0, "stribeck_velocity": 0.01}
SLIDERS = {f"slider_{n}_{i + 1}": v for i, pair in enumerate(((40.0, 1e-4), (30.0, 2e-3), (20.0, 5e-4), (15.0, 3e-5)))
           for n, v in zip(("limit", "stroke"), pair, strict=True)}  # fmt: skip
GAS = {
    "gas_force": 90.0,
    "damping_1": 900.0,
    "damping_2": 2200.0,
    "velocity_1": 0.1,
    "friction": 40.0,
    "gas_stiffness": 3e3,
}
SERIES = CURVE | {"friction": 60.0, "series_stiffness": 1.8e6}
FIRM = {"firm_damping_1": 9000.0, "firm_damping_2": 2500.0, "firm_velocity_1": 0.05, "firm_friction": 90.0}
LAWS = {
    "degressive": (DamperLaw(bends=1, friction="coulomb"), CURVE | {"friction": 60.0}),
    "bump and rebound": (DamperLaw(bends=2, own_sides=True, friction="coulomb"), SIDES),
    "Stribeck": (DamperLaw(bends=1, friction="stribeck"), STRIBECK),
    "presliding": (DamperLaw(bends=1, friction="presliding", elements=4), CURVE | SLIDERS),
    "progressive with gas stiffness": (DamperLaw(bends=1, friction="coulomb", gas_stiffness=True), GAS),
    "series stiffness": (DamperLaw(bends=1, friction="coulomb", series=True), SERIES),
    "gap": (DamperLaw(bends=1, friction="coulomb", series=True, gap=True),
            SERIES | {"gap": 4e-4, "outer_friction": 0.1}),
    "switched": (DamperLaw(bends=1, friction="coulomb", setting="lag", delayed=True),
                 CURVE | {"friction": 60.0} | FIRM | {"lag": 0.008, "delay": 0.004}),
}  # fmt: skip


def changes(axle, name):
    """The lines of a law as changes of a car, with those of the mount and of the control."""
    law, numbers = LAWS[name]
    parameters = np.array([numbers[each] for each in law.parameters])
    t = np.arange(400) / 100.0
    x, v = 0.02 * np.sin(2.0 * np.pi * t), 0.04 * np.pi * np.cos(2.0 * np.pi * t)
    setting = (
        Setting(name="current", time=t, values=np.round(t % 1.0), lowest=0.0, highest=1.0) if law.setting else None
    )
    test = DamperTest(name="made", time=t, displacement=x, velocity=v, force=1500.0 * v, waveform=waveform_of(t, x, v),
                      conditions={}, notices=(), setting=setting)  # fmt: skip
    spreads = np.diag(0.01 * parameters) ** 2
    fit = DamperFit(law=law, parameters=parameters, errors=0.01 * parameters, spreads=np.array([spreads, spreads]))
    fits = FittedDamper(conditions={}, tests=[test], fit=fit, compared=[fit]).settings()
    lines = tomllib.loads(vehicle_lines(fits[0]))
    values = {f"{axle}.damper.{key}": value for key, value in lines.items()}
    for entry in re.findall(r"^# \[AXLE.bushings.MOUNT\] (\w.*?)(?: where.*)?$", vehicle_lines(fits[0]), re.MULTILINE):
        key, _, value = entry.partition(" = ")
        values[f"{axle}.bushings.{MOUNT[axle]}.{key}"] = tomllib.loads(f"value = {value}")["value"]
    if law.setting:
        control = tomllib.loads(control_lines(fits)) | {"law": "skyhook_on_off", "control_period": 0.002}
        values |= {f"{axle}.damper.control.{key}": value for key, value in control.items()}
    return values


def test_the_table_of_the_mount_is_the_gap():
    table = changes("rear", "gap")["rear.bushings.damper_mount.table_z"]
    forces = np.interp([-3e-4, -1e-4, 0.0, 2e-4, 2.5e-4], table["displacement"], table["force"])
    assert forces == pytest.approx([-180.0, 0.0, 0.0, 0.0, 90.0], abs=0.01)  # five digits


@pytest.mark.parametrize(
    ("front", "rear"),
    [("degressive", "Stribeck"), ("presliding", "bump and rebound"), ("progressive with gas stiffness", "gap"),
     ("switched", "series stiffness")],
)  # fmt: skip
def test_engines_agree_on_the_lines_of_a_fit(front, rear):
    car = Car.load("focus_road", changes("front", front) | changes("rear", rear))
    signal = Road("B", 80.0, duration=4.0).under(car.vehicle).signal()
    stepped, reduced = (car.run(signal, engine=engine) for engine in ("mujoco", "reduced"))
    assert not stepped.recording.statistics.warnings and not reduced.recording.statistics.warnings
    energies = stepped.recording.statistics.energies
    assert energies is not None and energies.residual < 1e-3
    validated(
        "Dampers and friction", f"comfort over that of MuJoCo, lines of fit-damper: front {front}, rear {rear}",
        reduced.comfort().weighted.overall / stepped.comfort().weighted.overall, 1.0, abs=5e-3,
        source="second derivation: MuJoCo",
    )  # fmt: skip
