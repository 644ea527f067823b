"""A diagnosis of made records with few simulated drives: a worn damper is found, wrong inputs are refused."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from vehicle import Car, road
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.output.folder import write_files
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.records.choice import Choice
from vehicle.studies.diagnosis.car_diagnosis import CarDiagnosis
from vehicle.studies.diagnosis.diagnosis import MOST, Diagnostics, _main_channels
from vehicle.studies.diagnosis.diagnosis_files import contents
from vehicle.studies.diagnosis.diagnosis_page import diagnosis_page
from vehicle.studies.diagnosis.drive_record import DriveRecord, read_drive, usable_parts
from vehicle.studies.diagnosis.driven_modes import damper_channels, driven_modes

EIGHT = tuple(f"{point}_{wheel}_acc_z" for point in ("knuckle", "damper_top") for wheel in ("fr", "fl", "rr", "rl"))
SPEED, SECONDS = 22.0, 20.0
WORN = {"rear.left.damper.viscous": 600}
"""40 % of the nominal 1500 N s/m."""


@pytest.fixture(scope="module")
def diagnostics():
    return Diagnostics.of(Car.load("sedan"), EIGHT, (SPEED, SPEED), SECONDS, highest=40.0, count=240)


DRIVE = road("C", 3.6 * SPEED, duration=SECONDS + 4.0, period="record")


def resampled_at(time, values, wanted, rate):
    """Values at other times after the low-pass of a recorder: a strut top that breaks away has spikes."""
    low = scipy.signal.butter(8, 0.4 * rate, fs=1.0 / (time[1] - time[0]), output="sos")
    return scipy.interpolate.CubicSpline(time, scipy.signal.sosfiltfilt(low, values))(np.clip(wanted, *time[[0, -1]]))


@pytest.fixture(scope="module")
def run():
    car = Car.load("sedan", WORN)
    return car.run(DRIVE, "reduced", channels=[*EIGHT, *damper_channels(car.poles)])


@pytest.fixture(scope="module")
def record(run):
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
    tables = ["diagnosis.json", "diagnosis.csv", "diagnosis_iri.csv"]
    assert [*files] == [*tables, "diagnosis.png"]
    assert all((tmp_path / name).stat().st_size > 0 for name in files)
    assert [*contents(diagnosis, figures=False)] == tables
    page = diagnosis_page(tmp_path, author="A. Engineer")
    assert diagnosis.answer in page and "data:image/png;base64," in page and "A. Engineer" in page
    for row in diagnosis.rows:
        assert f"{row['low']:.2f} to {row['high']:.2f}" in page
    assert (
        f'<td>rear left wheel hop</td><td class="number">{10 ** diagnosis.modes[-1].frequency.quantile(0.5):.1f}'
        in page
    )
    (tmp_path / "diagnosis.json").write_text("{}")
    with pytest.raises(DataError, match="is no complete diagnosis"):
        diagnosis_page(tmp_path)


def test_the_roughness_index_is_that_of_the_road(diagnosis):
    """The road of the record rated by its own heights; the car, its dampers and the level are unknown to the fit."""
    drive = DRIVE.under(Car.load("sedan").vehicle)
    assert isinstance(drive, RoadDrive)
    rated = [index.overall for index, _ in drive.roughness().values()]
    middle, low, high = diagnosis.roughness
    assert low < np.mean(rated) < high
    assert middle == pytest.approx(np.mean(rated), rel=0.15)
    # 20 s at 22 m/s after 4 s.
    assert [piece.start[0] for piece in diagnosis.road_pieces] == pytest.approx([0.0, 100.0, 200.0, 300.0], abs=0.3)


def test_the_modes_are_those_of_the_driven_car(diagnosis, run):
    """Poles of the worn car with the constants of its own run: the true factors are not known to the fit."""
    dampers = run.car.poles.matrices.damper_names
    motion = np.array([[run[f"{name}_{quantity}"] for name in dampers] for quantity in ("velocity", "force")])
    velocity, force = motion - motion.mean(axis=2, keepdims=True)
    constants = np.sum(force * velocity, axis=1) / np.sum(velocity**2, axis=1)
    true = driven_modes(run.car.poles, constants)
    pairs = [
        pair
        for mode in diagnosis.modes
        for pair in ((mode.frequency, np.log10(true[mode.motion].frequency)), (mode.damping, true[mode.motion].damping))
    ]
    inside = [posterior.quantile(0.05) < value < posterior.quantile(0.95) for posterior, value in pairs]
    # 14 intervals of 90 %: ten or less inside have a probability of 4 %.
    assert sum(inside) > 10
    hop = {mode.motion: mode for mode in diagnosis.modes}["hop rl"]
    assert hop.damping.quantile(0.95) < hop.nominal.damping
    assert true["hop rl"].damping < 0.7 * hop.nominal.damping


@pytest.mark.parametrize(("rate", "jitter"), [(100.0, 0.0), (400.0, 0.0), (200.0, 1.5e-3)])
def test_another_rate_or_irregular_times_give_the_same_statement(diagnostics, diagnosis, run, rate, jitter, tmp_path):
    time = np.arange(round(24.0 * rate)) / rate
    time += jitter * np.clip(np.random.default_rng(2).standard_normal(time.size), -1.3, 1.3)
    time = time[time >= 3.9]
    at = [resampled_at(run.time, run[name], time, rate) for name in EIGHT]
    file = tmp_path / "drive.csv"
    head = ",".join(["time [s]", *(f"{name} [m/s2]" for name in EIGHT)])
    np.savetxt(file, np.column_stack([time, *at]), delimiter=",", header=head, comments="", fmt="%.6f")
    again = read_drive(file, EIGHT, 3.6 * SPEED, Choice(resample=200.0 if jitter else None, first=4.0))
    found = diagnostics.diagnosis(again, usable_parts(again))
    for wheel in ("fr", "fl", "rr", "rl"):
        # An eighth of a usual interval, 0.3; the instants of the samples are others, so that windows differ.
        for share in (0.05, 0.5, 0.95):
            expected = diagnosis.damper(wheel).quantile(share)
            assert found.damper(wheel).quantile(share) == pytest.approx(expected, abs=0.04)
    assert found.answer.partition(":")[0] == diagnosis.answer.partition(":")[0]
    assert ("The others are above" in found.answer) == ("The others are above" in diagnosis.answer)
    assert found.roughness == pytest.approx(diagnosis.roughness, rel=0.03)


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
