"""A known plate signal is found again from the response of the car alone; the linearisation behind it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from scenarios.inputs.make_inputs import LEVELS, SEED
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.response import frequency_response
from vehicle.engines.reduced.equivalent import equivalent_damping, linearised_response
from vehicle.runs.car import Car
from vehicle.signals.excitation.random_road import random_road
from vehicle.signals.excitation.signal import Signal
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


@pytest.mark.parametrize(("name", "iterations", "asked"), [("low", 5, 0.01), ("high", 7, 0.05)])
def test_a_known_plate_is_found_from_the_knuckle_alone(car, tmp_path, name, iterations, asked):
    """Where the dampers stick, and where they slip."""
    # From 6 Hz on: below, a plate moves the knuckle too little for its displacement to be found within a percent.
    signal = random_road(rms=LEVELS[name], seed=SEED, wheel="fr", lower_band_edge=6.0, roll_off_order=2)
    target = target_of(car, signal, tmp_path)
    plant = DrivenCar(car, ("fr",), target, "reduced")
    found = replicate(
        plant, target.values, target.lines, iterations=iterations, gain=0.8, tolerance=1e-3, possible=plant.possible,
        settled=plant.settled,
    )  # fmt: skip
    known = signal.displacement["fr"]
    error = np.std(target.lines.in_band(found.drive[0] - known)) / np.std(target.lines.in_band(known))
    assert error < asked and found.error < asked


def test_coulomb_friction_under_a_sine_is_the_textbook_dashpot():
    """c = D + 4 Fd / (pi V): Den Hartog, Mechanical Vibrations, for a velocity of the amplitude V."""
    law = Car.load(overrides=["damper.coulomb_friction=100", "damper.viscous=2000"]).vehicle.damper
    phase = 2.0 * np.pi * (np.arange(20000) + 0.5) / 20000
    velocity = 0.25 * np.sin(phase)
    force = 2000.0 * velocity + 100.0 * np.sign(velocity) - 300.0
    assert equivalent_damping(law, velocity, force) == pytest.approx(2000.0 + 400.0 / (np.pi * 0.25), rel=1e-6)


def test_linearised_dampers_lie_between_the_stuck_and_the_sliding_car(car):
    """As stiff as friction at rest they are stuck; with their viscous part alone they slide; between, by the matrices.

    The stuck car of the matrices has no slip at all, the law at rest 8e6 N s/m.
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
            (still, car.matrix_frf(CHANNELS, lines, wheel=wheel), 5e-3),
            (middle, between, 1e-8),
            (car.matrices.viscous, car.matrix_frf(CHANNELS, lines, damper="sliding", wheel=wheel), 1e-8),
        ):
            found = linearised_response(car.poles, damping, CHANNELS, wheels, lines)[:, number]
            assert found == pytest.approx(expected, rel=tolerance)
