"""Targets of a fit from a file of the user: another clock, another rate, other units, the noise that was put in."""

import re
from typing import Any

import numpy as np
import pytest

from scenarios.signals.bump import bump
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Car
from vehicle.signals.formats import uff_writer
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.csv_table import write_table
from vehicle.studies.tuning.measured_targets import measured_histories
from vehicle.studies.tuning.record_target import RecordTarget

NOISE = 0.02
STRIBECK = ("damper.friction_law='stribeck'", "damper.stribeck_friction=160.0", "damper.coulomb_friction=60.0")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A car with Stribeck friction over a bump; measured from 0.2 s on, at the logger's 12.5 s, in g and mm/s."""
    folder = tmp_path_factory.mktemp("records")
    signal = bump(amplitude=6e-3, wheel="fr", duration=1.2, start=0.3, noise_rms=0.0)
    write_table(folder / "bump.csv", ["time [s]", "displacement_fr [m]"], [signal.time, signal.displacement["fr"]], [])
    run = Car.load(overrides=STRIBECK).run(signal, engine="reduced")
    noise = np.random.default_rng(4)
    channels = []
    for name, source, unit, factor in (
        ("knuckle_fr_acc_z", "Acc", "g", 9.80665),
        ("damper_fr_velocity", "Velocity", "mm/s", 1e-3),
    ):
        values = run[name][200:] / factor
        values = values + NOISE * np.sqrt(np.mean(values**2)) * noise.standard_normal(values.size)
        axis = uniform_axis(values.size, run.recording.timestep, 12.5)
        channels.append(Channel(name=source, values=values, unit=unit, axis=axis))
    uff_writer.write(folder / "bump.uff", channels, "made")
    return folder


CHANNELS = {"knuckle_fr_acc_z": "Acc", "damper_fr_velocity": "Velocity"}


def measured(folder, **options):
    entry = measured_histories(Car.load(), folder / "bump.uff", folder / "bump.csv", CHANNELS, **options)
    for text in entry.notices:
        assert text.startswith("bump.uff: ")
    return entry.target


def test_the_delay_that_was_forgotten_is_named(files):
    """By the car where the fit begins, which has another law of friction."""
    measurement = measured_histories(
        Car.load(), files / "bump.uff", files / "bump.csv", CHANNELS, inverted=["damper_fr_velocity"]
    )
    (late,) = (text for text in measurement.notices if "--delay" in text)
    advice = re.search(r"--delay (\S+)", late)
    # The clock is judged by the first group of channels, which the other friction law shifts by 5.1 ms.
    assert advice is not None and float(advice[1]) == pytest.approx(0.2, abs=6e-3)
    assert any(text.endswith("set --turn damper_fr_velocity") for text in measurement.notices)


def test_the_residuals_of_the_true_car_are_the_noise(files):
    target = measured(files, delay=0.2)
    assert target.rows == ("bump, knuckle_fr_acc_z", "bump, damper_fr_velocity")
    assert target.window == pytest.approx((0.2, 1.2))
    true, other = (target.residuals(Car.load(overrides=law)) for law in (STRIBECK, ()))
    # The low-pass at 100 Hz leaves a fifth of the power of white noise up to 500 Hz.
    expected = NOISE * np.sqrt(100.0 / 500.0)
    np.testing.assert_allclose(np.sqrt(np.mean(true**2, axis=1)), expected, rtol=0.4)
    assert np.sqrt(np.mean(other**2)) > 5.0 * expected


def test_the_part_that_counts(files):
    # The file begins at 12.5 s, and the record 0.2 s after the signal: --stretch has the times of --from.
    assert measured(files, delay=0.2, stretch=(12.55, 13.2)).window == pytest.approx((0.25, 0.9))
    late = measured(files)  # taken to begin with the signal: nothing fits
    assert np.sqrt(np.mean(late.residuals(Car.load(overrides=STRIBECK)) ** 2)) > 0.5
    assert measured(files, delay=0.2, fitted=["damper_fr_velocity"]).rows == ("bump, damper_fr_velocity",)
    for options, message in (
        ({"delay": 0.2, "stretch": (0.25, 0.9)}, r"--stretch 0.25:0.9 .*12.5 to 13.5 s"),
        ({"delay": 5.0}, "--delay S"),
        ({"delay": 0.2, "stretch": (12.55, 12.58)}, r"0.03 s .*0.04 s"),
        ({"fitted": ["seat_rail_acc_z"]}, r"--channels seat_rail_acc_z; .*knuckle_fr_acc_z, damper"),
    ):
        with pytest.raises(DataError, match=message):
            measured(files, **options)


def test_a_record_contains_its_plate(tmp_path):
    """The plate moves at the first sample: the car starts at rest, and the beginning is left out."""
    run = Car.load().run("high.csv", engine="reduced", channels=["plate_fl_displacement", "knuckle_fl_acc_z"])
    part = slice(3000, 9000)
    axis = uniform_axis(6000, run.recording.timestep, 12.5)
    channels = [
        Channel(name="Shaker", values=-1e3 * run["plate_fl_displacement"][part], unit="mm", axis=axis),
        Channel(name="Acc", values=run["knuckle_fl_acc_z"][part], unit="m/s2", axis=axis),
    ]
    file = tmp_path / "road.uff"
    uff_writer.write(file, channels, "made")
    names = {"plate_fl_displacement": "Shaker", "knuckle_fl_acc_z": "Acc"}
    entry = measured_histories(Car.load(), file, None, names, inverted=["plate_fl_displacement"])
    assert entry.signal is not None and entry.signal.wheels == ("fl",)
    assert entry.target.window == pytest.approx((2.0, 5.999))
    assert any("begins in motion: the first 2 s are left out" in text for text in entry.notices)
    # What is left of the start at rest: sticking is remembered longer than two seconds at single instants.
    assert isinstance(entry.target, RecordTarget)
    assert np.sqrt(np.mean(entry.target.residuals(Car.load()) ** 2)) < 0.02
    wrong: dict[str, dict[str, Any]] = {"--lowpass 0: ": {"lowpass": 0.0}, "contains the plate signal": {"delay": 0.1}}
    for message, options in wrong.items():
        with pytest.raises(ConfigurationError, match=message):
            measured_histories(Car.load(), file, None, names, **options)
    with pytest.raises(DataError, match=r"moving plate.* --signal FILE"):
        measured_histories(Car.load(), file, None, {"knuckle_fl_acc_z": "Acc"})
