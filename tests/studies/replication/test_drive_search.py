"""Replication of a known plate signal from the response of the car, and the linearisation it uses."""

from dataclasses import replace

import numpy as np
import pytest

from scenarios.inputs.make_inputs import LEVELS, SEED
from scenarios.signals.random_road import random_road
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.response import frequency_response
from vehicle.engines.reduced.equivalent_damping import equivalent_damping, linearised_response
from vehicle.errors import VehicleError
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.replication.drive_settings import DriveSettings
from vehicle.studies.replication.driven_car import DrivenCar
from vehicle.studies.replication.inverse import Lines
from vehicle.studies.replication.iteration import replicate
from vehicle.studies.replication.target import Target

CHANNEL, BAND = "knuckle_fr_acc_z", (1.0, 50.0)
CHANNELS = (CHANNEL, "seat_rail_acc_x")


def target_of(car: Car, signal: Signal, path) -> Target:
    run = car.run(signal, engine="reduced", channels=(CHANNEL,))
    lines = Lines(run.time.size, run.recording.timestep, BAND)
    return Target(
        channels=(CHANNEL,), time=run.time, values=run[CHANNEL][None], lines=lines, band=BAND, source=path,
        sha256="", notices=(),
    )  # fmt: skip


@pytest.mark.parametrize(("name", "iterations", "tolerance"), [("low", 5, 0.01), ("high", 7, 0.05)])
def test_a_known_plate_is_replicated_from_one_knuckle_channel(car, tmp_path, name, iterations, tolerance):
    """Replicate a level with stuck dampers and a level with slipping dampers."""
    # From 6 Hz on: below, a plate moves the knuckle too little to replicate its displacement within a percent.
    signal = random_road(rms=LEVELS[name], seed=SEED, wheel="fr", lower_band_edge=6.0, roll_off_order=2)
    target = target_of(car, signal, tmp_path)
    plant = DrivenCar(car, ("fr",), target, "reduced")
    replication = replicate(plant, target.values, target.lines, DriveSettings(iterations=iterations))
    exact = signal.displacement["fr"]
    error = np.std(target.lines.in_band(replication.drive[0] - exact)) / np.std(target.lines.in_band(exact))
    assert error < tolerance and replication.error < tolerance


def test_coulomb_friction_under_a_sine_is_the_textbook_dashpot():
    """Compare with c = D + 4 Fd / (pi V), Den Hartog, Mechanical Vibrations, for a velocity of amplitude V."""
    law = Car.load(overrides=["damper.coulomb_friction=100", "damper.viscous=2000"]).vehicle.damper
    phase = 2.0 * np.pi * (np.arange(20000) + 0.5) / 20000
    velocity = 0.25 * np.sin(phase)
    force = 2000.0 * velocity + 100.0 * np.sign(velocity) - 300.0
    assert equivalent_damping(law, velocity, force) == pytest.approx(2000.0 + 400.0 / (np.pi * 0.25), rel=1e-6)


def test_linearised_dampers_lie_between_the_stuck_and_the_sliding_car(car):
    """Compare the linearised FRFs with those of the matrices for stuck, sliding and intermediate damping.

    The stuck car of the matrices has no slip; the friction law at rest has 8e6 N s/m.
    """
    lines, wheels, system = np.array([1.5, 12.0, 30.0]), car.vehicle.wheels, car.matrices.system
    still = np.full(2, equivalent_damping(car.vehicle.damper, np.zeros(4), np.zeros(4)))
    middle = np.array([4e3, 2e4])
    rows = system.slide_rows
    more = replace(system, damping=system.damping + rows.T @ np.diag(middle - car.matrices.viscous) @ rows)
    for number, wheel in enumerate(wheels):
        driven = [float(name == wheel) for name in wheels]
        between = frequency_response(first_order(more), lines, CHANNELS, "acceleration", driven=driven)
        for damping, expected, tolerance in (
            (still, car.matrix_frf(CHANNELS, lines, wheel=wheel), 6e-3),
            (middle, between, 1e-8),
            (car.matrices.viscous, car.matrix_frf(CHANNELS, lines, damper="sliding", wheel=wheel), 1e-8),
        ):
            response = linearised_response(car.poles, damping, CHANNELS, wheels, lines)[:, number]
            assert response == pytest.approx(expected, rel=tolerance)


@pytest.mark.parametrize("history", ["harmonics", "file"])
def test_a_car_that_a_force_shakes_gets_no_drive(tmp_path, history):
    """Its plates would be made to repeat the motion by the force; a force without a history shakes nothing."""
    place = {"force.a.on": "engine", "force.a.force": [0, 0, 1]}
    time = np.arange(201) / 100.0
    heads = "time [s],push [N]"
    np.savetxt(tmp_path / "a.csv", np.column_stack([time, np.sin(time)]), delimiter=",", header=heads, comments="")
    shaken: dict[str, object] = {"force.a.file": str(tmp_path / "a.csv")}
    if history == "harmonics":
        shaken = {"force.a.harmonics": [[1, 10, 0]], "force.a.frequency": 5.0}
    still = np.zeros((1, 201))
    lines = Lines(201, 0.01, BAND)
    target = Target(
        channels=(CHANNEL,), time=time, values=still, lines=lines, band=BAND, source=tmp_path, sha256="", notices=(),
    )  # fmt: skip
    DrivenCar(Car.load("focus", place), ("fr",), target, "reduced")
    with pytest.raises(VehicleError, match=r"force\.a: .*--set apply_forces=false"):
        DrivenCar(Car.load("focus", {**place, **shaken}), ("fr",), target, "reduced")
    DrivenCar(Car.load("focus", {**place, **shaken, "apply_forces": False}), ("fr",), target, "reduced")
