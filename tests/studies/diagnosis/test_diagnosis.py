"""A diagnosis of made records with few simulated drives: a worn damper is found, wrong inputs are refused."""

from dataclasses import replace

import numpy as np
import pytest

from vehicle import Car, road
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.output.folder import write_files
from vehicle.studies.diagnosis.car_diagnosis import CarDiagnosis
from vehicle.studies.diagnosis.diagnosis import MOST, Diagnostics, _main_channels
from vehicle.studies.diagnosis.diagnosis_files import contents
from vehicle.studies.diagnosis.drive_record import DriveRecord, usable_parts

EIGHT = tuple(f"{point}_{wheel}_acc_z" for point in ("knuckle", "damper_top") for wheel in ("fr", "fl", "rr", "rl"))
SPEED, SECONDS = 22.0, 20.0
WORN = {"rear.left.damper.viscous": 600}
"""40 % of the nominal 1500 N s/m."""


@pytest.fixture(scope="module")
def diagnostics():
    return Diagnostics.of(Car.load("sedan"), EIGHT, (SPEED, SPEED), SECONDS, highest=40.0, count=240)


@pytest.fixture(scope="module")
def record():
    drive = road("C", 3.6 * SPEED, duration=SECONDS + 4.0, period="record")
    run = Car.load("sedan", WORN).run(drive, "reduced", channels=EIGHT)
    samples = np.array([run[name] for name in EIGHT])[:, run.time >= 4.0]
    return DriveRecord(name="drive.csv", channels=EIGHT, samples=samples, rate=1.0 / (run.time[1] - run.time[0]),
                       highest=40.0, speeds=(SPEED, SPEED))  # fmt: skip


@pytest.fixture(scope="module")
def diagnosis(diagnostics, record):
    return diagnostics.diagnosis(record, usable_parts(record))


def test_the_worn_damper_is_found_and_the_others_are_not(diagnosis):
    assert diagnosis.worn("rl") > 0.9
    assert diagnosis.damper("rl").quantile(0.05) < 0.4 < diagnosis.damper("rl").quantile(0.95)
    assert all(diagnosis.worn(wheel) < 0.1 for wheel in ("fr", "fl", "rr"))
    assert diagnosis.answer.startswith("Rear left damper: 9")
    assert "The others are above" in diagnosis.answer


def test_the_class_of_the_road_is_read_off(diagnosis):
    assert diagnosis.road.letter == "C"
    # G of class C is 256e-6 m3, of the road with the waviness of the class.
    assert 0.5 * diagnosis.road.low < 256e-6 < 2.0 * diagnosis.road.high


def test_words_table_and_files_have_the_same_numbers(diagnosis, tmp_path):
    rows = diagnosis.rows
    assert [row["unknown"] for row in rows] == ["damper fr", "damper fl", "damper rr", "damper rl"]
    for row in rows:
        assert f"{row['low']:.2f} to {row['high']:.2f}" in str(diagnosis)
        assert f"{row['low']:.4f}" in diagnosis.csv
    more = replace(diagnosis, shown=("tyres", "mounts"))
    assert {row["unknown"].split()[0] for row in more.rows} == {"tyre", "mount"}
    files = contents(diagnosis)
    write_files(tmp_path, files)
    assert [*files] == ["diagnosis.json", "diagnosis.csv", "diagnosis.png"]
    assert all((tmp_path / name).stat().st_size > 0 for name in files)
    assert [*contents(diagnosis, figures=False)] == ["diagnosis.json", "diagnosis.csv"]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda samples: samples[[4, 5, 6, 7, 0, 1, 2, 3]], "cannot be a drive of sedan"),
        (lambda samples: samples * np.where(np.arange(8) < 4, -1.0, 1.0)[:, None], "cannot be a drive of sedan"),
        (lambda samples: 30.0 * samples, "times rougher than in any simulated drive"),
        (lambda samples: samples / 9.81, r"check the units \(--unit\)"),
        (lambda samples: samples / 100.0, "times smoother than in any simulated drive"),
    ],
    ids=["wheels and tops exchanged", "wheels upside down", "mm/s2 too large", "g taken for m/s2", "unit too small"],
)
def test_wrong_inputs_are_refused(diagnostics, record, change, reason):
    other = replace(record, samples=change(record.samples))
    with pytest.raises(DataError, match=reason):
        diagnostics.diagnosis(other, usable_parts(other))


def test_a_record_of_another_speed_is_refused_or_widened(diagnostics):
    run = Car.load("sedan").run(road("C", 50, duration=SECONDS + 4.0, period="record"), "reduced", channels=EIGHT)
    samples = np.array([run[name] for name in EIGHT])[:, run.time >= 4.0]
    record = DriveRecord(name="slow", channels=EIGHT, samples=samples, rate=1.0 / (run.time[1] - run.time[0]),
                         highest=40.0, speeds=(SPEED, SPEED))  # fmt: skip
    try:
        found: CarDiagnosis | None = diagnostics.diagnosis(record, usable_parts(record))
    except DataError:
        found = None
    assert found is None or found.widened > 1.2


def test_a_record_with_too_many_channels_keeps_the_main_ones(record):
    car = Car.load("sedan")
    names = car.vehicle.acceleration_channels
    whole = replace(record, channels=names, samples=np.zeros((len(names), 100)))
    kept = _main_channels(car, whole)
    assert len(kept.channels) == len(kept.samples) == 11 <= MOST
    assert "of 45 accelerations the 11 main ones are used" in kept.notices[-1]
    others = tuple(name for name in names if name.startswith(("engine", "roof", "body", "seat_acc", "suspension")))
    with pytest.raises(ConfigurationError, match=r"choose them with --map"):
        _main_channels(car, replace(record, channels=others, samples=np.zeros((len(others), 100))))


def test_wrong_groups_are_named(tmp_path):
    with pytest.raises(ConfigurationError, match=r"--parts wings|parts wings"):
        Car.load("sedan").diagnose(tmp_path / "none.csv", 80, parts=("wings",))
