"""Instances of an FMU: equal bits after a state was set back or stored, and beside other instances."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")

from tests.handover.fmu.master import STEP, Fmu, Instance, drive, plates_of, written
from tests.validation import validated
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

OUTPUTS = ["seat_rail_acc_z", "tyre_fl_force_z", "damper_fl_velocity", "damper_fl_force", "knuckle_fl_displacement_y"]


def moved(instance: Instance, first: int, count: int) -> np.ndarray:
    """Return the outputs of steps over a sine, so strong that the dampers slip."""
    rows = []
    for k in range(first + 1, first + count + 1):
        phase = 2.0 * np.pi * 8.0 * k * 1e-3
        instance.set({"plate_fl_displacement": 0.003 * np.sin(phase), "plate_fl_velocity": 0.15 * np.cos(phase)})
        instance.step(1e-3)
        rows.append(instance.get(OUTPUTS))
    return np.array(rows)


def state_of(instance: Instance):
    slave = instance.slave
    return slave.getFMUstate() if instance.fmu.second else slave.getFMUState()


def set_back(instance: Instance, state, time: float) -> None:
    (instance.slave.setFMUstate if instance.fmu.second else instance.slave.setFMUState)(state)
    instance.time = time


def test_a_state_set_back_gives_equal_bits(focus_fmu):
    instance = Instance(focus_fmu)
    moved(instance, 0, 300)
    state, time = state_of(instance), instance.time
    once = moved(instance, 300, 200)
    set_back(instance, state, time)
    again = moved(instance, 300, 200)
    assert np.array_equal(once, again) and np.ptp(once[:, 2]) > 1e-3
    assert instance.messages == []


def test_a_stored_state_goes_on_in_another_instance(focus_fmu):
    first, second = Instance(focus_fmu), Instance(focus_fmu)
    moved(first, 0, 300)
    if focus_fmu.second:
        stored = first.slave.serializeFMUstate(state_of(first))
        state = second.slave.deSerializeFMUstate(stored)
    else:
        stored = first.slave.serializeFMUState(state_of(first))
        state = second.slave.deserializeFMUState(stored)
    assert len(stored) < 10_000
    set_back(second, state, first.time)
    assert np.array_equal(moved(first, 300, 100), moved(second, 300, 100))


def test_two_instances_do_not_know_of_each_other(focus_fmu):
    alone = moved(Instance(focus_fmu), 0, 200)
    first, second = Instance(focus_fmu), Instance(focus_fmu)
    first.set({"damper_fl_coulomb_friction": 0.0})
    pairs = [(moved(first, k, 1)[0], moved(second, k, 1)[0]) for k in range(200)]
    assert np.array_equal(np.array([b for _, b in pairs]), alone)
    assert not np.array_equal(np.array([a for a, _ in pairs]), alone)


def test_reset_begins_anew(focus_fmu):
    instance = Instance(focus_fmu)
    once = moved(instance, 0, 100)
    instance.slave.reset()
    instance.begin()
    instance.end_initialization()
    instance.time = 0.0
    assert np.array_equal(moved(instance, 0, 100), once)


def test_a_car_at_rest_stays_at_rest_on_raised_plates(focus_fmu, car):
    instance = Instance(focus_fmu, started=False)
    instance.begin()
    raised = {f"plate_{wheel}_displacement": 0.1 for wheel in ("fr", "fl")}
    instance.set(raised)
    instance.end_initialization()
    instance.step(0.1)
    loads = instance.get(["tyre_fr_force_z", "tyre_fl_force_z", "seat_rail_displacement_z"])
    wanted = [car.static.tyre_load["fr"], car.static.tyre_load["fl"]]
    resting = Instance(focus_fmu).get(["tyre_fr_force_z", "tyre_fl_force_z"])
    assert resting == pytest.approx(wanted, rel=1e-12)
    # The rear of the car stands on blocks: the front rises by the plates, the seats by less.
    assert 0.02 < loads[2] < 0.08 and loads[:2] == pytest.approx(wanted, rel=0.05)
    instance.step(0.1)
    assert instance.get(["tyre_fr_force_z", "tyre_fl_force_z"]) == pytest.approx(loads[:2], rel=1e-12)


SKYHOOK = (
    "front.damper.control={law='skyhook', minimum_damping=500, maximum_damping=4000, skyhook_damping=2500, "
    "groundhook_damping=1500, skyhook_share=0.5, control_period=1e-3}"
)


def skyhook(body: float, wheel: float) -> float:
    """Return the damping beyond the softest setting that skyhook demands: F = c_sky vb within the limits."""
    relative = body - wheel
    force = 2500.0 * body * np.sign(relative)
    speed = abs(relative)
    return float(np.clip(force / speed, 500.0, 4000.0)) - 500.0 if speed else 0.0


def test_skyhook_outside_equals_the_own_law(tmp_path: Path, high_piece: Signal):
    """The controller reads the sensors every millisecond and sets the coefficient command until the next reading."""
    fmu: Fmu = written(Car.load("focus", [SKYHOOK]), tmp_path)
    plates, outputs = plates_of(high_piece, 1.5), [*OUTPUTS, "damper_fr_velocity"]
    own = drive(Instance(fmu, started=False), high_piece, plates, outputs, 1)
    outside = Instance(fmu)
    for wheel in ("fr", "fl"):
        outside.set({f"damper_{wheel}_control": 0.0})
    names = [f"damper_{wheel}_{end}_velocity" for wheel in ("fr", "fl") for end in ("wheel", "body")]
    rows = [outside.get(outputs)]
    for k, ((z, velocity, _),) in enumerate(plates[1:]):
        if k % 5 == 0:
            fr_wheel, fr_body, fl_wheel, fl_body = outside.get(names)
            outside.set({"damper_fr_coefficient_command": skyhook(fr_body, fr_wheel)})
            outside.set({"damper_fl_coefficient_command": skyhook(fl_body, fl_wheel)})
        outside.set({"plate_fr_displacement": z, "plate_fr_velocity": velocity})
        outside.step(STEP)
        rows.append(outside.get(outputs))
    found = np.array(rows).T
    peaks = np.max(np.abs(own - own[:, :1]), axis=1)
    validated(
        "Exported FMUs", "skyhook controller outside, by coefficient command: deviation from the own law over the peak",
        np.max(np.abs(found - own), axis=1) / peaks, 0.0, abs=1e-10,
        source="second derivation: the control law inside the FMU",
    )  # fmt: skip
    soft = Instance(fmu, started=False)
    soft.set({"damper_fr_control": 0.0})
    assert np.max(np.abs(drive(soft, high_piece, plates, outputs, 1) - own)) > 1.0
