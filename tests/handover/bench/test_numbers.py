"""Numbers of the bench: those of a run, FRFs of the linear car, excerpts and roads."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, read_signal, road
from vehicle.errors import ConfigurationError
from vehicle.handover.bench.drive import bench_drive, excerpt
from vehicle.handover.bench.numbers import numbers
from vehicle.runs.output.run_obstacle import obstacle_values
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal, uniform_time


@pytest.fixture(scope="module")
def high():
    return read_signal(find_input("high.csv"), wheel="fr")


@pytest.fixture(scope="module")
def drive(car, high):
    return bench_drive(car, high, seconds=8.0)


@pytest.fixture(scope="module")
def found(car, drive):
    return numbers(car, drive)


@pytest.fixture(scope="module")
def sliding(car, drive):
    return numbers(car.with_({"damper.coulomb_friction": 0.0}), drive)


def test_numbers_are_those_of_the_run(car, high, drive, found):
    run = car.run(excerpt(high, 0.0, 8.0)[0], engine="reduced")
    assert drive.skip == 0.0 and run.signal.duration == 8.0
    # Rounding alone: a run with fewer channels is summed in another order.
    comfort = run.comfort()
    assert found.table["comfort unweighted"][0] == pytest.approx(comfort.unweighted.overall, rel=1e-9)
    assert found.table["comfort weighted"][0] == pytest.approx(comfort.weighted.overall, rel=1e-9)
    assert found.table["slip fl"] == (100.0 * run.slip_share("fl"), "%")
    np.testing.assert_allclose(found.acceleration, run["seat_rail_acc_z"][run.evaluated], atol=1e-9)
    np.testing.assert_allclose(found.damper_force["fr"], run["damper_fr_force"][run.evaluated], atol=1e-6)
    np.testing.assert_allclose(found.spectra[0].density, run.psd("seat_rail_acc_z").channels[0].density, rtol=1e-6)
    assert found.table["slip fr"] == (100.0 * run.slip_share("fr"), "%")
    assert found.seconds > 0.0


def test_frf_of_the_car_without_friction_is_that_of_its_matrices(car, sliding):
    found = sliding
    inside = found.frf.frequency >= 2.0
    exact = car.matrix_frf(found.names, found.frf.frequency[inside], damper="sliding", wheel="fr")
    # The transient of the input before is left over, see `phase_averages.LEAD`.
    for name, computed, expected in zip(found.names, found.frf.response[:, inside], exact, strict=True):
        validated(
            "FRF estimation and spectra",
            f"{name.replace('_', ' ')} of the car without friction, periodic inputs of the bench: RMS error over |H|",
            np.linalg.norm(computed - expected) / np.linalg.norm(expected), 0.0, abs=2e-5,
            source="second derivation: FRF of the matrices",
        )  # fmt: skip


@pytest.mark.parametrize("rate", [500.0, 2000.0])
def test_the_rate_of_the_file_does_not_change_the_frf(car, high, sliding, rate):
    time = uniform_time(samples=round(9.0 * rate), timestep=1.0 / rate)
    z = np.interp(time, high.time, high.displacement["fr"])
    other = bench_drive(car, Signal(time=time, displacement={"fr": z}, source="other rate"), seconds=8.0)
    one, two = sliding.frf, numbers(car.with_({"damper.coulomb_friction": 0.0}), other).frf
    inside = (one.frequency >= 2.0) & (one.frequency <= 50.0)
    same = np.isclose(one.frequency[inside][:, None], two.frequency).any(axis=1)
    assert same.all()
    later = np.searchsorted(two.frequency, one.frequency[inside])
    error = np.linalg.norm(two.response[:, later] - one.response[:, inside], axis=1)
    # Twice the transient of `phase_averages.LEAD`.
    assert np.all(error < 4e-5 * np.linalg.norm(one.response[:, inside], axis=1))


def test_a_coarse_step_is_fine_enough_for_the_frf(car, drive, found, monkeypatch):
    coarse = found.frf
    monkeypatch.setattr("vehicle.handover.bench.numbers.FRF_STEP", 5e-5)
    fine, inside = numbers(car, drive).frf, coarse.frequency >= 2.0
    error = np.linalg.norm((coarse.response - fine.response)[:, inside], axis=1)
    # 6e-4, see FRF_STEP; the standard error is 4 to 8 %.
    assert np.all(error < 1e-3 * np.linalg.norm(fine.response[:, inside], axis=1))
    assert np.all(error > 1e-6 * np.linalg.norm(fine.response[:, inside], axis=1))


def test_friction_makes_an_error_band(found):
    band = np.median(found.frf.random_error / np.abs(found.frf.response), axis=1)
    assert np.all((band > 0.02) & (band < 0.3))


def test_excerpt_from_the_middle_rises_before_it(high):
    part, skip = excerpt(high, 20.0, 6.0)
    assert (skip, part.duration) == (2.0, 8.0)
    z = high.displacement["fr"][18000:26001]
    assert part.displacement["fr"][0] == 0.0
    np.testing.assert_allclose(part.displacement["fr"][2000:], (z - z.mean())[2000:], atol=1e-12)
    with pytest.raises(ConfigurationError, match=r"--from 58: .*60 s.* 5 s"):
        excerpt(high, 58.0, 6.0)


def test_a_road_rolls_and_delays_the_rear_axle():
    car = Car.load("focus_road")
    drive = bench_drive(car, road("C", 80), seconds=6.0)
    assert drive.overrides == (f"driving.speed={80 / 3.6!r}",)
    assert drive.record.duration == drive.skip + 6.0
    assert drive.label == f"road C, 80 km/h, {drive.skip:g} to {drive.skip + 6:g} s"
    front, rear = (drive.inputs.periods(drive.probe.displacement[name][None])[0, 0] for name in ("fr", "rr"))
    wheels = {wheel.name: wheel.center[0] for wheel in car.vehicle.composition.wheels}
    delay = (wheels["rr"] - wheels["fr"]) * 3.6 / 80
    lag = np.fft.irfft(np.fft.rfft(rear) * np.conj(np.fft.rfft(front)))
    assert np.argmax(lag) * 1e-3 == pytest.approx(delay, abs=1e-3)
    found = numbers(car.with_(drive.overrides), drive)
    assert {f"slip {wheel}" for wheel in ("fr", "fl", "rr", "rl")} <= set(found.table)
    assert found.table["comfort unweighted"][0] > 0.5
    for ride, options, message in (
        (replace(road("C", 80), speed="channel:V"), {}, "over time"),
        (road("C", 80), {"seconds": 100.0}, r"--seconds 100: .*5 to 60 s"),
        (road("C", 80, duration=12.0), {"seconds": 6.0}, r"--seconds 6: --duration 12 "),
        (road("C", 80, duration=500.0), {}, r"--duration 500: "),
    ):
        with pytest.raises(ConfigurationError, match=message):
            bench_drive(car, ride, **options)


def test_moved_wheels_take_the_road_where_they_are():
    car = Car.load("focus_road")
    drive = bench_drive(car, road("C", 80), seconds=5.0)
    longer = car.with_({"front.hardpoints.wheel_center.x": 0.81, "front.hardpoints.tyre_patch.x": 0.81})
    found = numbers(longer.with_(drive.overrides), drive)
    run = longer.run(road("C", 80, duration=drive.record.duration), engine="reduced")
    assert found.table["comfort weighted"][0] == pytest.approx(run.comfort().weighted.overall, rel=1e-9)
    assert found.table["slip rr"][0] == pytest.approx(100.0 * run.slip_share("rr"))
    moved = drive.under(longer)
    assert moved.probe.displacement["rr"][4000] != drive.probe.displacement["rr"][4000]
    assert drive.under(car.with_({"front.damper.viscous": 1500.0})) is drive


def test_an_obstacle_has_the_values_of_its_run():
    car = Car.load("focus_road")
    cleat = road("cleat:20x50", 30)
    drive = bench_drive(car, cleat)
    found = numbers(car.with_(drive.overrides), drive)
    run = car.run(replace(cleat, duration=drive.record.duration), engine="reduced")
    assert run.skip == drive.skip and drive.record.duration == drive.skip + 5.0
    table, values = found.table, obstacle_values(run)
    assert values is not None
    assert table["peak to peak seat rail z"][0] == pytest.approx(values.peak_to_peak["seat_rail"]["z"])
    assert table["VDV seat rail"][0] == pytest.approx(values.vdv["seat_rail"]["overall"])
    assert table["settling time seat rail z"][0] == pytest.approx(values.settling_s["seat_rail"], abs=2e-3)
    assert table["peak knuckle rr z"][0] == pytest.approx(values.knuckle_peak["rr"])
    longer = bench_drive(car, road("cobbles", 10))
    assert longer.road is not None
    times: Any = longer.road["obstacle_s"]
    assert longer.record.duration == pytest.approx(times[1] + 3.0, abs=0.11)
