"""Fits to road records: a measured profile with the speed, heights over time, FRFs in classes of the input level."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.tune import main
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.paths import value_of
from vehicle.runs.car import Car, Road
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.channel import uniform_axis
from vehicle.signals.formats.table import Record
from vehicle.signals.records.choice import Choice
from vehicle.studies.tuning.car_fit import tune
from vehicle.studies.tuning.level_target import LevelTarget, level_target
from vehicle.studies.tuning.measured_targets import measured_histories, measured_levels
from vehicle.studies.tuning.record_target import RecordTarget

HIDDEN = {
    "front.damper.coulomb_friction": 95.0,
    "front.damper.viscous": 2000.0,
    "front.bushings.tyre.stiffness.z": 220e3,
}
BOUNDS = (
    "front.damper.coulomb_friction=50:250",
    "front.damper.viscous=1000:5000",
    "front.bushings.tyre.stiffness.z=1.5e5:4e5",
)
CHANNELS = {"knuckle_fl_acc_z": ("Rad VL z", "g", 9.80665), "seat_rail_acc_z": ("Sitzschiene z", "m/s2", 1.0)}
MAP = [word for name, (label, *_) in CHANNELS.items() for word in ("--map", f"{name}={label}")]
NOISE, SPEED, LENGTH = 0.03, 72.0, 11.0
SUBJECT = "Sweeps, tuning and optimisation"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Profile of growing height, and the MDF4 record of a hidden car on it: 3 % noise, other names and clock."""
    asammdf = pytest.importorskip("asammdf")
    folder, random = tmp_path_factory.mktemp("road"), np.random.default_rng(3)
    distance = np.arange(0.0, 240.0, 0.05)
    # A random walk has the spectrum n^-2 of ISO 8608; waves above 20 m are left out by its moving mean.
    walk = np.cumsum(1.2e-3 * random.standard_normal((2, distance.size)), axis=1)
    walk -= np.array([np.convolve(track, np.full(401, 1.0 / 401.0), mode="same") for track in walk])
    tracks = walk * np.linspace(0.1, 1.5, distance.size) * np.clip((230.0 - distance) / 5.0, 0.0, 1.0)
    table = np.column_stack([distance, *tracks])
    head = "distance [m],left [m],right [m]"
    np.savetxt(folder / "profile.csv", table, delimiter=",", header=head, comments="", fmt="%.7f")
    car = Car.load("focus_road", HIDDEN)
    run = car.run(Road(folder / "profile.csv", speed=SPEED, duration=LENGTH), engine="reduced")
    signals = []
    for name, (label, unit, factor) in CHANNELS.items():
        noise = NOISE * np.sqrt(np.mean(run[name] ** 2)) * random.standard_normal(run.time.size)
        signals.append(asammdf.Signal((run[name] + noise) / factor, run.time + 12.0, unit=unit, name=label))
    for side, wheel in (("left", "fl"), ("right", "fr")):
        heights = 1e3 * run[f"plate_{wheel}_displacement"]
        signals.append(asammdf.Signal(heights, run.time + 12.0, unit="mm", name=f"Road {side}"))
    speed = np.full(run.time.size, SPEED)
    signals.append(asammdf.Signal(speed, run.time + 12.0, unit="km/h", name="Speed"))
    with asammdf.MDF(version="4.10") as file:
        file.append(signals)
        file.save(folder / "drive.mf4")
    return folder


def test_hidden_values_are_found_in_a_road_record(folder, tmp_path, capsys):
    words = ["focus_road", "--record", str(folder / "drive.mf4"), "--road", str(folder / "profile.csv")]
    words += ["--speed", "72", *MAP, "--parameters", *BOUNDS, "--stretch", "14:17", "--engine", "reduced"]
    assert main([*words, "--output", str(tmp_path / "tune")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("front.damper.coulomb_friction ") and lines[3].startswith("--set front.damper.coulomb")
    content = json.loads((tmp_path / "tune" / "tune.json").read_text(encoding="utf-8"))
    assert content["converged"] and not content["left_open"]
    fitted = Car.load(tmp_path / "tune" / "vehicle.toml")
    for row, path in zip(content["parameters"], HIDDEN, strict=True):
        validated(
            SUBJECT, f"{path} fitted to a road record with 3 % noise", row["value"], HIDDEN[path],
            abs=3.0 * row["standard_error"], unit=row["unit"],
            source="closed form: hidden value of the car that made the record",
        )  # fmt: skip
        # With a larger standard error the check above would be too weak.
        assert row["standard_error"] < 0.01 * HIDDEN[path]
        assert value_of(fitted.vehicle, path) == pytest.approx(row["value"], rel=1e-9)
    assert not fitted.vehicle.driving.rolling  # the speed belongs to the road, not to the fitted car
    assert all(row["after"] < 0.3 * row["before"] for row in content["agreement"])


def test_heights_over_time_in_the_record_drive_the_same_road(folder):
    start = Car.load("focus_road")
    labels = {name: label for name, (label, *_) in CHANNELS.items()}
    record = folder / "drive.mf4"
    choice = {"left": "Road left", "right": "Road right"}
    over_time = Road(record, speed="channel:Speed", choice=Choice(channels=choice))
    hidden, errors = start.with_(HIDDEN), []
    for road in (Road(folder / "profile.csv", speed=SPEED, duration=LENGTH), over_time):
        target = measured_histories(start, record, road, labels, stretch=(14.0, 17.0)).target
        assert isinstance(target, RecordTarget)
        assert target.signal.duration == pytest.approx(5.05)  # the rest is not simulated
        errors.append(np.sqrt(np.mean(target.residuals(hidden) ** 2)))
    # A fifth of the power of the noise is below 100 of 500 Hz, and this part is quieter than the record, whose RMS
    # determines the noise: 1.3 to 2.5 %. Heights over time rise once more from rest.
    assert 0.013 < errors[0] < 0.025
    assert errors[1] < 2.0 * errors[0]
    assert isinstance(target, RecordTarget)
    standing = replace(target, road=None)  # tyres that do not roll
    assert np.sqrt(np.mean(standing.residuals(hidden) ** 2)) > 2.0 * errors[0]


def test_classes_of_level_find_the_same_values(folder):
    """Two classes in one fit; friction acts more on the lower."""
    start = Car.load("focus_road", {"front.bushings.tyre.stiffness.z": HIDDEN["front.bushings.tyre.stiffness.z"]})
    labels = {name: label for name, (label, *_) in CHANNELS.items()}
    road = Road(folder / "profile.csv", speed=SPEED, duration=LENGTH)
    entry = measured_levels(start, folder / "drive.mf4", road, labels, levels=2, window=1.0, spacing=1.0)
    target = entry.target
    assert isinstance(target, LevelTarget)
    assert len(target.rows) == 8 and target.data.channels[0].startswith("knuckle_fl_acc_z, plate_fl ")
    bounds = {"front.damper.coulomb_friction": (50.0, 250.0), "front.damper.viscous": (1e3, 5e3)}
    result = tune(start, bounds, [entry])
    assert result.converged and not result.unidentified
    for path in bounds:
        validated(
            SUBJECT, f"{path} fitted to FRFs in two classes of level, road record with 3 % noise", result.values[path],
            HIDDEN[path], abs=3.0 * result.standard_errors[path],
            source="closed form: hidden value of the car that made the record",
        )  # fmt: skip
        assert result.standard_errors[path] < 0.05 * HIDDEN[path]
    # Friction acts most at the low level. Classes of a road differ without friction too: their spectra differ.
    with_friction = np.abs(target.model_response(start.with_(HIDDEN))).reshape(2, 2, -1)
    without = np.abs(target.model_response(start.with_({"*.damper.coulomb_friction": 0.0}))).reshape(2, 2, -1)
    effect = np.mean(np.abs(np.log(with_friction / without)), axis=(0, 2))
    assert effect[0] > 1.2 * effect[1] > 0.05


def test_classes_of_a_linear_response():
    """y(t) = 2 x(t - 3 ms) + noise: the same H in each class, with the stated scatter, at levels in ascending order."""
    random, count = np.random.default_rng(4), 40_000
    level = np.where(np.arange(count) < count // 2, 1.0, 3.0)
    x = 1e-3 * level * random.standard_normal(count)
    record = Record(
        time=uniform_axis(count, 1e-3),
        channels={"knuckle_fl_acc_z": 2.0 * np.roll(x, 3) + 5e-4 * random.standard_normal(count)},
        units={"knuckle_fl_acc_z": "m/s2"},
    )
    signal = Signal(time=record.time, displacement={"fl": x})
    histories = RecordTarget(name="rig", signal=signal, record=record, window=(0.0, 40.0))
    target = level_target(
        histories, "plate_fl_displacement", x, x[None], levels=2, window=1.0, band=(5.0, 400.0), spacing=2.0
    )
    levels = [[float(text) for text in re.findall(r"[0-9.]+(?= to| mm)", name)] for name in target.data.channels]
    # The window in the middle contains both levels.
    np.testing.assert_allclose([levels[0][0], *levels[1]], [1.0, 3.0, 3.0], rtol=0.1)
    exact = 2.0 * np.exp(-2j * np.pi * target.data.frequency * 3e-3)
    ratio = (target.data.response - exact) / target.data.random_error
    validated(
        "Statistics and intervals", "scatter of FRFs in classes of level over the stated error",
        np.sqrt(np.mean(ratio.real**2 + ratio.imag**2) / 2.0), 1.0, abs=0.1,
        source="closed form: known noise, 396 lines of two classes",
    )  # fmt: skip
    assert np.mean(target.data.random_error[0]) > 2.0 * np.mean(target.data.random_error[1])
    for classes, error, message in ((20, DataError, r"20 .*160, 80.5 s"), (1, ConfigurationError, "--levels 1: .*2")):
        with pytest.raises(error, match=message):
            level_target(histories, "x", x, x[None], levels=classes, window=1.0, band=(5.0, 45.0), spacing=1.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--speed 80", "--speed: "),
        ("--road C", "--road C: "),
        ("--road C --speed 80 --signal low.csv", "--road C and --signal low.csv"),
        ("--road nowhere --speed 80", "--road nowhere: "),
        ("--reference knuckle_fl_acc_z", "--levels N"),
        ("--road PROFILE --speed 72 --levels 2", "9.001 s contain 3 windows of 4 s; 2 classes need 16"),
        ("--road PROFILE --speed 72 --levels 2 --window 1 --reference plate_xx", "--reference plate_xx: "),
    ],
)
def test_refused_by_name(folder, tmp_path, capsys, arguments, message):
    words = [str(folder / "profile.csv") if word == "PROFILE" else word for word in arguments.split()]
    options = [*MAP, "--parameters", BOUNDS[0], "--engine", "reduced", "--output", str(tmp_path / "tune")]
    assert main(["focus_road", "--record", str(folder / "drive.mf4"), *words, *options]) in (2, 3)
    assert message in capsys.readouterr().err
    assert not (tmp_path / "tune").exists()
