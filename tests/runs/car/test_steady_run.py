"""Periodic runs against runs in time after four periods, derivatives against differences, and what is refused."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, ConfigurationError, DataError, Signal, road

CHANNELS = ("seat_rail_acc_x", "seat_rail_acc_y", "seat_rail_acc_z", "knuckle_fl_acc_z", "tyre_fl_force_z",
            "tyre_fr_force_z", "damper_fl_force", "plate_fl_displacement")  # fmt: skip
PERIOD = 4.0


def multisine(wheels, rms, period=PERIOD, rate=1000):
    """Plates with random phases of lines from 0.5 to 40 Hz, whose displacement falls as 1/f."""
    random, count = np.random.default_rng(3), round(period * rate)
    frequency = np.arange(count // 2 + 1) / period
    size = np.where((frequency >= 0.5) & (frequency <= 40.0), 1.0 / np.maximum(frequency, 0.1), 0.0)
    displacement = {}
    for wheel in wheels:
        values = np.fft.irfft(size * np.exp(2j * np.pi * random.random(size.size)), count)
        displacement[wheel] = np.append(values, values[0]) * rms / np.std(values)
    return Signal(time=np.arange(count + 1) / rate, displacement=displacement, source="multisine")


def periods(signal, begin, count):
    """A signal with its last period count times more."""
    first = round(begin / signal.timestep)
    displacement = {w: np.concatenate([z, np.tile(z[first + 1 :], count)]) for w, z in signal.displacement.items()}
    time = np.arange(next(iter(displacement.values())).size) * signal.timestep
    return replace(signal, time=time, displacement=displacement, profile={}, repeats_after=None)


def last(run, period):
    samples = round(period * 1000)
    return np.array([run[name][-samples - 1 : -1] for name in CHANNELS])


@pytest.mark.parametrize(
    ("file", "letter"), [("focus_road", "A"), ("kinematic_reference", "B"), ("sedan", "C"), ("focus_road_seated", "C")]
)
def test_a_road_is_that_of_a_run_after_four_periods(file, letter):
    car, source = Car.load(file), road(letter, 80, duration=8.0)
    found = car.steady(source, channels=CHANNELS)
    assert found.engine_reason.startswith("periodic state")
    drive: Any = source.under(car.vehicle)
    long = periods(drive.signal(), drive.skip, 3)
    run = car.with_(drive.overrides).run(long, engine="reduced", channels=CHANNELS, stated_errors=False)
    samples = round(drive.span * 1000)
    own = np.array([found[name][found.evaluated][:samples] for name in CHANNELS])
    expected = last(run, drive.span)
    validated(
        "Reduced engine", f"RMS values of {file} in its periodic state on class {letter}", np.std(own, axis=1),
        np.std(expected, axis=1), rel=2e-4, source="second derivation: its run in time after four periods",
        unit="m/s2, N, m",
    )  # fmt: skip
    rail = slice(0, 3)
    np.testing.assert_allclose(np.std(own[rail], axis=1), np.std(expected[rail], axis=1), rtol=1e-4)
    # The waves, and the mean forces.
    assert np.all(np.std(own - expected, axis=1) < 0.01 * np.std(expected, axis=1))
    np.testing.assert_allclose(own[4:6].mean(axis=1), expected[4:6].mean(axis=1), rtol=1e-6)
    assert found.comfort().weighted.overall == pytest.approx(run_comfort(car, drive, run), rel=1e-4)
    # The record repeats, and the run-up has the same state.
    name = "seat_rail_acc_z"
    np.testing.assert_array_equal(found[name][-1], found[name][found.evaluated][0])
    np.testing.assert_array_equal(found[name][: round(drive.skip * 1000)], own[2, -round(drive.skip * 1000) :])


def run_comfort(car, drive, run):
    return replace(run, skip=run.signal.duration - drive.span).comfort().weighted.overall


LAWS = {
    "Stribeck friction": ["front.damper.friction_law=stribeck", "front.damper.coulomb_friction=125",
                          "front.damper.stribeck_friction=160"],
    "stops and tyres that lift off": [
        "front.damper.stop={displacement=[-0.03, -0.001, 0.001, 0.03], force=[-2800.0, 0.0, 0.0, 2800.0]}",
        "*.bushings.tyre.one_sided=true"],
}  # fmt: skip


@pytest.mark.parametrize("law", LAWS)
def test_plates_with_other_laws(law):
    car = Car.load("focus_road", LAWS[law])
    signal = multisine(car.vehicle.wheels, 4e-3 if "stops" in law else 1e-3)
    found = car.steady(signal, channels=CHANNELS)
    assert found.engine_reason.startswith("periodic state") and found.skip == 2.0 * PERIOD
    run = car.run(periods(signal, 0.0, 5), engine="reduced", channels=CHANNELS, stated_errors=False)
    np.testing.assert_allclose(np.std(last(found, PERIOD), axis=1), np.std(last(run, PERIOD), axis=1), rtol=3e-4)


@pytest.mark.parametrize("changes", [[], ["*.damper.friction_law=presliding", "*.damper.presliding_stiffness=5e5"]])
def test_a_run_in_time_takes_the_place_of_a_state_that_does_not_end(changes, monkeypatch):
    if not changes:
        monkeypatch.setattr("vehicle.engines.steady.driven_car.DrivenCar.state.__kwdefaults__",
                            {"limit": 5, "start": None})  # fmt: skip
    car = Car.load("focus_road", changes)
    signal = multisine(car.vehicle.wheels, 1e-3)
    found = car.steady(signal, channels=CHANNELS)
    assert found.engine_reason == "run in time" and found.time[-1] == 3.0 * PERIOD
    assert "RMS values of period 10 of a run in time, which differ" in " ".join(found.recording.statistics.notices)
    run = car.run(periods(signal, 0.0, 5), engine="reduced", channels=CHANNELS, stated_errors=False)
    np.testing.assert_allclose(last(found, PERIOD), last(run, PERIOD), atol=1e-3 * np.abs(last(run, PERIOD)).max())
    with pytest.raises(ConfigurationError, match="a run in time has no derivative"):
        found.gradient("body.mass")


def test_the_run_has_the_notices_of_a_run_in_time():
    car = Car.load("focus_road")
    found, run = (each(road("C", 80, duration=8.0)) for each in (car.steady, lambda r: car.run(r, engine="reduced")))
    assert found.channels == run.channels and found.recording.units == run.recording.units
    (turned,) = found.recording.statistics.warnings
    assert "rotates by" in turned and not found.recording.statistics.within_validity
    assert any("would lift off its plate" in text for text in found.recording.statistics.notices)


PATHS = ("front.damper.coulomb_friction", "front.damper.viscous", "front.bushings.tyre.stiffness.z", "body.mass",
         "front.main_spring.stiffness", "rear.damper.stribeck_friction")  # fmt: skip
FIGURES = ("weighted", "tyre_load_rms", "tyre_load", "rms:knuckle_fl_acc_z:5-30")


def test_derivatives_are_those_of_differences(monkeypatch):
    """Rolling tyres, Stribeck friction at the rear. With coarse samples, as kinks move by less than one of them."""
    monkeypatch.setattr("vehicle.runs.car.steady_run.RATE", 1000.0)
    monkeypatch.setattr("vehicle.runs.car.steady_run.TOLERANCE", 1e-10)
    monkeypatch.setattr("vehicle.runs.car.steady_run.FINER", 1e-10)
    monkeypatch.setattr("vehicle.engines.steady.driven_car.DrivenCar.state.__kwdefaults__",
                        {"limit": 1500, "start": None})  # fmt: skip
    car, source = Car.load("focus_road", STRIBECK), road("B", 80, duration=6.0)
    channels = [*CHANNELS, *(f"tyre_{wheel}_force_z" for wheel in ("rr", "rl"))]
    found = car.steady(source, channels=channels)
    values = np.array([found.figure(name) for name in FIGURES])
    for path in PATHS:
        number, step = found.car[path].value, 1e-5
        low, high = (
            np.array([run.figure(name) for name in FIGURES])
            for run in (car.with_({path: number * (1.0 + sign * step)}).steady(source, channels=channels)
                        for sign in (-1.0, 1.0))
        )  # fmt: skip
        own = np.array([found.gradient(path, name) for name in FIGURES]) * number / values
        validated(
            "Reduced engine", f"d ln figure/d ln {path} of a periodic state: {', '.join(FIGURES)}", own,
            (high - low) / (2.0 * step) / values, abs=1e-4 * np.max(np.abs(own)), unit="-",
            source="second derivation: central differences of two states",
        )  # fmt: skip


STRIBECK = ["rear.damper.friction_law=stribeck", "rear.damper.coulomb_friction=40", "rear.damper.stribeck_friction=60"]


def test_a_sensitivity_is_the_derivative_of_a_history():
    """The gradient of a figure is that of its history."""
    car = Car.load("focus_road")
    found = car.steady(multisine(car.vehicle.wheels, 2e-3), channels=CHANNELS)
    gradient = found.gradient(["body.mass", "front.damper.viscous"], "rms:seat_rail_acc_z")
    for path, value in gradient.items():
        history, change = found["seat_rail_acc_z"][found.evaluated], found.sensitivity(path)["seat_rail_acc_z"]
        expected = np.mean(history * change[found.evaluated]) / np.sqrt(np.mean(history**2))
        assert value == pytest.approx(expected, rel=1e-5)


def test_what_is_refused():
    car = Car.load("focus_road")
    time = np.arange(4001) / 1000
    open_ends = Signal(time=time, displacement={"fl": 1e-3 * time}, source="ramp")
    with pytest.raises(DataError, match="plate fl ends 4 mm above its start"):
        car.steady(open_ends)
    with pytest.raises(ConfigurationError, match="does not repeat; take a road class"):
        car.steady(road("cleat:20x50", 30))
    with pytest.raises(ConfigurationError, match="does not repeat; take a road class"):
        car.steady(road("C", 80, period="record"))
    odd = Signal(time=time * 1.00013, displacement={"fl": 1e-3 * np.sin(2.0 * np.pi * time)}, source="sine")
    with pytest.raises(ConfigurationError, match="no whole number of samples"):
        car.steady(odd)
    found = car.steady(multisine(car.vehicle.wheels, 2e-3), channels=CHANNELS)
    with pytest.raises(ConfigurationError, match="stick_share counts samples"):
        found.gradient("body.mass", "stick_share")
    with pytest.raises(ConfigurationError, match="must be a number other than 0"):
        found.gradient("front.damper.friction_law")
