"""A seat with its occupant on the complete car: apparent mass in closed form, channels, a file over another car."""

import dataclasses
from typing import Any

import numpy as np
import pytest
import scipy.signal

from scenarios.signals.bump import bump_shape
from tests.validation import validated
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.response import frequency_response
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.shipped import VEHICLES
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal, uniform_time

SEATED = VEHICLES / "focus_road_seated" / "vehicle.toml"
SITTING = 55.0
"""What the seat carries of a person of 75 kg [kg]."""

OWN = 2.0 * np.pi * 5.0
"""Natural frequency of the occupant [rad/s]."""

FORCE = "cushion_driver_force_z"


@pytest.fixture(scope="module")
def seated() -> Car:
    return Car.load(SEATED)


def apparent_mass(frequency: Any) -> Any:
    """M(w) of Fairley and Griffin 1989 for a sitting mass: 5 Hz, damping ratio 0.475, masses as 6.0 to 45.6."""
    w = 2.0 * np.pi * np.asarray(frequency)
    still, moving = SITTING * np.array([6.0, 45.6]) / 51.6
    spring = OWN**2 + 2j * 0.475 * OWN * w
    return still + moving * spring / (spring - w**2)


def test_the_matrices_have_the_apparent_mass(seated):
    """Force of the cushion over the acceleration above it; the file rounds masses, spring and damper to 1e-3."""
    rows = seated.load_rows.only([FORCE])
    still = np.zeros(4)
    outputs = {"force": np.append(rows.displacement[0], still), "drag": np.append(rows.velocity[0], still)}
    system = dataclasses.replace(seated.matrices.system, outputs={**seated.matrices.system.outputs, **outputs})
    form, frequency = first_order(system, stuck=True), np.array([0.05, 1.0, 3.0, 5.0, 8.0, 12.0, 25.0, 50.0])
    assert not np.any(rows.branch) and not np.any(rows.height)
    force = frequency_response(form, frequency, "force") + frequency_response(form, frequency, "drag", "velocity")
    found = force / frequency_response(form, frequency, "seat_acc_z", "acceleration")
    validated(
        "Linear system", "apparent mass of a sitting person, 0.05 to 50 Hz", found, apparent_mass(frequency), rel=1e-3,
        unit="kg", source="closed form: Fairley and Griffin 1989, one mass on a spring",
    )  # fmt: skip
    assert found[0] == pytest.approx(SITTING, rel=1e-3)


@pytest.mark.parametrize("engine", ["mujoco", "reduced"])
def test_a_run_has_the_apparent_mass(seated, engine):
    """Acceleration of the seat through M(s) as a filter gives the force under it, at every instant.

    Masses and springs of the file are rounded to 1e-3, which the sums see by 1e-4; the engines by less.
    """
    time = uniform_time(samples=1501, timestep=1e-3)
    plates = {wheel: bump_shape(time, amplitude=5e-3, start=0.1) for wheel in seated.vehicle.wheels}
    run = seated.run(Signal(time=time, displacement=plates), engine=engine, channels=[FORCE, "seat_acc_z"])
    assert run[FORCE][0] == pytest.approx(SITTING * 9.81, rel=1e-9)
    still, moving = SITTING * np.array([6.0, 45.6]) / 51.6
    below = np.array([1.0, 2.0 * 0.475 * OWN, OWN**2])
    above = still * below + moving * np.array([0.0, *below[1:]])
    expected = scipy.signal.lsim((above, below), run["seat_acc_z"], time)[1]
    error = run[FORCE] - SITTING * 9.81 - expected
    if engine == "mujoco":
        assert run.recording.statistics.energies.residual < 1e-3, "what the cushion and the person take counts"
    assert np.std(expected) > 10.0
    validated(
        "Integration in MuJoCo" if engine == "mujoco" else "Reduced engine",
        "force under a seat with its occupant, RMS error", np.sqrt(np.mean(error**2)) / np.std(expected), 0.0, abs=3e-4,
        source="second derivation: apparent mass as a filter, scipy lsim",
    )  # fmt: skip


def test_the_seat_is_the_cushion(seated):
    """With a seat the channel is that of what sits on it; without one the point of the body, as it was."""
    bare = load_vehicle(VEHICLES / "focus_road" / "vehicle.toml")
    assert seated.vehicle.seated and not bare.seated
    places = {output.name: output.on for output in seated.vehicle.composition.outputs}
    assert (places["seat"], places["seat_rail"]) == ("seat_driver", "body")
    assert set(seated.vehicle.channels) == set(bare.channels)
    ratio = np.divide(*np.abs(seated.matrix_frf(["seat_acc_z", "seat_rail_acc_z"], [0.05, 4.0, 15.0])))
    assert ratio[0] == pytest.approx(1.0, abs=1e-3) and ratio[1] > 1.5 and ratio[2] < 0.6


def test_nothing_on_the_seat_swings(seated):
    """The seat adds four coordinates, and no mode of it without damping."""
    bare = Car.load("focus_road")
    assert seated.model.model.nv == bare.model.model.nv + 4
    own = [mode for mode in seated.modes("sliding") if "driver" in mode.description]
    assert len(own) == 3 and min(mode.damping_ratio for mode in own) > 0.15


def test_a_second_seat_has_the_name_of_its_table():
    table = vehicle_table(SEATED)
    table["seat"]["passenger"] = {**table["seat"]["driver"], "hardpoints": {"rail": [2.05, 0.37, 0.7]}}
    names = [output.name for output in vehicle_of(table, SEATED.parent).composition.outputs]
    assert names.count("seat") == 1 and "seat_passenger" in names
    table["seat"]["driver"]["hardpoints"] = {"rail": "seat_rial"}
    with pytest.raises(ConfigurationError, match="found 'seat_rial', must be coordinates"):
        vehicle_of(table, SEATED.parent)


def test_a_file_over_another_car(tmp_path):
    """Key by key; a table with a template of its own takes the place of the other."""
    own = tmp_path / "own.toml"
    own.write_text('base = "focus_road"\nname = "own"\n[front.damper]\ncoulomb_friction = 10.0\n', encoding="utf-8")
    found, base = load_vehicle(own), load_vehicle(VEHICLES / "focus_road" / "vehicle.toml")
    assert (found.name, found.damper.coulomb_friction, found.damper.viscous) == ("own", 10.0, base.damper.viscous)
    assert "base" not in found.table
    other = tmp_path / "other.toml"
    blocks = "rear_support = [3.4, 0.5, 0.7]"
    other.write_text(f'base = "own.toml"\n[rear]\ntemplate = "blocks"\n[rear.hardpoints]\n{blocks}\n', encoding="utf-8")
    assert vehicle_table(other)["rear"] == {"template": "blocks", "hardpoints": {"rear_support": [3.4, 0.5, 0.7]}}
    for text, message in {
        'base = "fokus"': (
            "base: found 'fokus', must be a shipped car \\(focus, focus_measured_roll, focus_road, focus_road_seated"
        ),
        'base = "own.toml"': "base: .*own.toml uses itself as base, directly or through other files; name",
        "base = 3": "base: ",
    }.items():
        own.write_text(text, encoding="utf-8")
        with pytest.raises(ConfigurationError, match=message):
            load_vehicle(own)
