"""Delays between the channels of a target that no drive explains: closed form, and a car with a late sensor."""

from typing import Any

import numpy as np
import pytest

from tests.delayed_records import RATE, late, shaken, write_record
from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.studies.replication.channel_delays import delays_between
from vehicle.studies.replication.drive_search import replicate_drive
from vehicle.studies.replication.inverse import Lines

NAMES = ("knuckle_fl_acc_z", "seat_rail_acc_z", "engine_acc_z")


@pytest.mark.parametrize("true", [(0.0, 0.0, 0.0), (0.0, 0.4e-3, 0.0), (0.0, 12.3e-3, 0.0), (-3e-3, 5e-3, 0.0)])
def test_delays_of_a_linear_system_are_exact(true):
    drive = shaken(("fl",), 8.0).displacement["fl"]
    lines = Lines(drive.size, 1.0 / RATE, (2.0, 40.0))
    s = 2j * np.pi * lines.frequency
    frf = np.array(
        [s**2 * 900.0 / (s**2 + 2.0 * zeta * w * s + w**2) for zeta, w in ((0.1, 30), (0.2, 80), (0.3, 150))]
    )
    spectrum = np.zeros((3, lines.size // 2 + 1), dtype=complex)
    spectrum[:, lines.used] = frf * lines.spectrum(drive[None])
    response = np.fft.irfft(spectrum, lines.size)[:, : drive.size]
    target = np.array([late(values, delay) for values, delay in zip(response, true, strict=True)])
    delays, errors = delays_between(target, np.zeros_like(target), frf[:, None], lines)
    # The records are cut where the system still rings.
    assert delays == pytest.approx(np.array(true) - np.median(true), abs=2e-5) and np.all(errors < 2e-5)
    two, _ = delays_between(target[:2], np.zeros((2, drive.size)), frf[:2, None], lines)
    assert min(two) == 0.0 and two[1] - two[0] == pytest.approx(true[1] - true[0], abs=2e-5)
    alone, _ = delays_between(target[:1], np.zeros((1, drive.size)), frf[:1, None], lines)
    assert np.isnan(alone).all()  # another drive explains any delay


def test_a_late_sensor_is_named_and_taken_out(tmp_path):
    car = Car.load()
    run = car.run(shaken(("fl",), 8.0), engine="reduced", channels=[*NAMES, "plate_fl_displacement"])
    file = write_record(tmp_path / "target.csv", run, dict(zip(NAMES, (0.0, 12.3e-3, 0.0), strict=True)))
    options: dict[str, Any] = {"engine": "reduced", "iterations": 6, "band": (2.0, 45.0)}
    first = replicate_drive(car, file, NAMES, **options)
    delay = first.delays[1]
    texts = [text for each in first.delays for text in each.advice(1.0 / RATE)]
    assert any("--delay seat_rail_acc_z=1" in text for text in texts)
    # Friction of 125 N: the FRFs have the mean damping of a run with a drive that is far off (error 60 %).
    assert RATE * delay.delay == pytest.approx(12.3, abs=0.6)
    second = replicate_drive(car, file, NAMES, delay={"seat_rail_acc_z": delay.delay}, **options)
    validated(
        "Sweeps, tuning and optimisation", "delay of one of three channels of a target of `drive`, in samples",
        RATE * second.delays[1].delay, 12.3, abs=0.1, source="closed form: shift of the spectrum of a run",
    )  # fmt: skip
    assert second.error < 0.2 * first.error
    with pytest.raises(ConfigurationError, match="--delay seat_rail_acc_z="):
        replicate_drive(car, file, NAMES, delay={"record": 0.1}, **options)
