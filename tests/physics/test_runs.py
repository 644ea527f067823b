"""Runs of the whole car: energy, determinism, step halving, symmetry, matrices against time."""

from __future__ import annotations

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.periodic import multisine
from tests.validation import validated
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.periodic_record import whole_record_responses
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal

PLACES = ("knuckle_fr", "seat_rail", "engine")


def rms(values):
    return float(np.sqrt(np.mean(np.asarray(values) ** 2)))


def test_energy_balance(high_run):
    energies = high_run.recording.statistics.energies
    assert energies.work_in > 5.0 and energies.dissipated > 5.0
    # Four seconds that end in motion, sampled at 1 kHz through stick and slip.
    validated(
        "Integration in MuJoCo", "energy that is missing after 4 s on the high input, of the work in",
        energies.residual, 0.0, abs=1e-3, source="conservation: work in = dissipated + stored",
    )  # fmt: skip
    assert energies.residual == pytest.approx(
        abs(energies.work_in - energies.dissipated - energies.stored) / energies.work_in
    )


def test_energy_balance_without_slip(car):
    energies = car.run(random_road(rms=5e-5, seed=2, wheel="fr", duration=4.0)).recording.statistics.energies
    validated(
        "Integration in MuJoCo",
        "energy that is missing after 4 s on a road that is too small for slip, of the work in", energies.residual, 0.0,
        abs=1e-3, source="conservation: work in = dissipated + stored",
    )  # fmt: skip


def test_the_same_run_twice_is_the_same_bit_for_bit(high_run, high_piece):
    again = Car.load().run(high_piece)
    for name, values in high_run.recording.channels.items():
        assert np.array_equal(values, again[name]), name
    assert np.array_equal(high_run.recording.poses, again.recording.poses)


def test_default_step_against_an_eighth_of_it(car):
    # The demand of the project: 0.5 % for every acceleration. The top of a slipping damper is a light part with short
    # impacts, which a step of 1 ms cannot place: it is held to that up to 80 Hz, the end of the weighting of comfort.
    high = read_signal(find_input("high.csv"), wheel="fr")
    piece = Signal(time=high.time[:6001], displacement={"fr": high.displacement["fr"][:6001]})
    high_run = car.run(piece)
    fine = Car.load(None, [f"solver.timestep={car.vehicle.solver.timestep / 8}"]).run(piece)
    ratios = {}
    for name in car.vehicle.acceleration_channels:
        sizes = []
        for run in (high_run, fine):
            spectrum = np.fft.rfft(run[name])
            highest = 80.0 if name.startswith("damper_top_fr") else 500.0
            sizes.append(rms(np.abs(spectrum[np.fft.rfftfreq(run[name].size, run.recording.timestep) <= highest])))
        ratios[name] = sizes[0] / sizes[1] - 1.0
    halved = "second derivation: the same run at an eighth of the step"
    validated(
        "Integration in MuJoCo", "RMS of all accelerations of the car at the default step over that at an eighth of it",
        1.0 + np.array(list(ratios.values())), 1.0, abs=5e-3, source=halved,
    )  # fmt: skip
    for wheel in ("fr", "fl"):
        validated(
            "Integration in MuJoCo", f"share of time in which damper {wheel} slips, default step",
            high_run.slip_share(wheel), fine.slip_share(wheel), abs=3e-3, source=halved,
        )  # fmt: skip
    assert high_run.slip_share("fr") > 0.05  # it does slip


@pytest.mark.parametrize("damper", ["stuck", "sliding"])
def test_frf_from_time_and_from_the_matrices(damper):
    """Periodic input without leakage, three periods for the transient; friction stuck, or off."""
    settings = [] if damper == "stuck" else ["damper.coulomb_friction=0"]
    car = Car.load(None, settings)
    signal = multisine(rms=1e-5, seed=1, period=4.0, periods=4)
    run = car.run(signal)
    channels = [f"{point}_acc_{axis}" for point in PLACES for axis in AXES]
    responses = np.array([run[name][:-1] for name in channels])
    plate = run["plate_fr_displacement"][None, :-1]
    (frf,) = whole_record_responses(run.recording.timestep, plate, responses)
    frequency, measured = frf.frequency, frf.response
    assert frequency.size == 197  # 1 to 50 Hz in steps of 0.25
    exact = car.matrix_frf(channels, frequency, damper=damper, wheel="fr")
    error = np.sum(np.abs(measured - exact) ** 2, axis=1)
    size = np.sum(np.abs(exact) ** 2, axis=1)
    # The demand of the project: 1 % RMS over 1 to 50 Hz.
    each = dict(zip(channels, np.sqrt(error / size), strict=True))
    for channel, gap in each.items():
        validated(
            "Integration in MuJoCo", f"FRF of {channel} from a run, 1 to 50 Hz, damper {damper}, error", gap, 0.0,
            abs=0.01, source="second derivation: FRF from M, C, K of the linear system",
        )  # fmt: skip
    # The other state of the damper is another car: the comparison can fail.
    other = car.matrix_frf(channels, frequency, damper="sliding" if damper == "stuck" else "stuck", wheel="fr")
    assert np.sqrt(np.sum(np.abs(measured[2] - other[2]) ** 2) / size[2]) > 0.2


def test_twice_the_input_is_twice_the_response_while_it_sticks(car):
    small, large = (car.run(random_road(rms=rms_, seed=5, wheel="fr", duration=2.0)) for rms_ in (5e-6, 1e-5))
    for name in ("knuckle_fr_acc_z", "seat_rail_acc_x", "engine_acc_y"):
        # Geometry of the suspension at 10 um: far below 1e-3.
        np.testing.assert_allclose(large[name], 2.0 * small[name], atol=1e-3 * np.max(np.abs(large[name])))


def mirror_symmetric():
    """Return the car with its engine mounts, products of inertia and outputs made symmetric; body rigid."""
    return load_vehicle(
        None,
        [
            *("body.flexible=false", "body.inertia.ixy=0", "body.inertia.iyz=0", "body.attachment_flexibility=false"),
            *("hardpoints.hydromount.y=0", "hardpoints.linear_mount=[0.7, 0.0, 1.02]", "hardpoints.seat_rail.y=0"),
        ],
    )


def test_a_symmetric_car_responds_left_as_right():
    car = Car(mirror_symmetric())
    road = random_road(rms=5.25e-4, seed=4, wheel="fr", duration=2.0)
    z = road.displacement["fr"]
    right = car.run(Signal(time=road.time, displacement={"fr": z}))
    left = car.run(Signal(time=road.time, displacement={"fl": z}))
    both = car.run(Signal(time=road.time, displacement={"fr": z, "fl": z}))
    sign = {"x": 1.0, "y": -1.0, "z": 1.0}
    # The rows are solved in another order on the other side: rounding, blown up by sticking and slipping.
    for axis in AXES:
        for point in ("knuckle", "damper_top", "suspension_mount"):
            a, b = right[f"{point}_fr_acc_{axis}"], left[f"{point}_fl_acc_{axis}"]
            np.testing.assert_allclose(a, sign[axis] * b, atol=1e-5 * np.max(np.abs(a)) + 1e-9)
        a, b = right[f"engine_acc_{axis}"], left[f"engine_acc_{axis}"]
        np.testing.assert_allclose(a, sign[axis] * b, atol=1e-5 * np.max(np.abs(a)) + 1e-9)
    np.testing.assert_allclose(right["damper_fr_force"], left["damper_fl_force"], atol=1e-3)
    # Both wheels together: no roll, no yaw, no sideways motion of anything in the middle plane.
    assert np.max(np.abs(both["engine_acc_y"])) < 1e-6 * np.max(np.abs(both["engine_acc_z"]))
    assert np.max(np.abs(both["seat_rail_acc_y"])) < 1e-6 * np.max(np.abs(both["seat_rail_acc_z"]))
    assert np.max(np.abs(right["seat_rail_acc_y"])) > 1e-2 * np.max(np.abs(right["seat_rail_acc_z"]))


def test_the_recorded_damper_force_is_its_law(high_run):
    velocity, force = high_run["damper_fr_velocity"], high_run["damper_fr_force"]
    damper = high_run.car.vehicle.damper
    fast = np.abs(velocity) > 0.02
    assert fast.sum() > 100
    exact = damper.viscous * velocity + np.sign(velocity) * damper.coulomb_friction
    validated(
        "Integration in MuJoCo", "recorded damper force above 20 mm/s", force[fast], exact[fast], rel=1e-3, abs=0.5,
        unit="N", source="closed form: D v + Fd sign v",
    )  # fmt: skip
    # Never more than the limit: neither while it sticks nor while it breaks away.
    assert np.max(np.abs(force) - damper.viscous * np.abs(velocity)) <= damper.coulomb_friction + 0.5
    assert np.mean(np.abs(velocity) < 1e-5) > 0.3  # it sticks for a good part
