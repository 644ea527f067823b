"""Plates of a fit in the measurement file or in another one: every file that `inspect` reads, with its own names."""

import json

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.commands.shaker import main as shaker
from vehicle.commands.tune import main as tune
from vehicle.errors import DataError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice
from vehicle.studies.tuning.measured_targets import measured_histories

ACCELERATIONS = ("knuckle_fr_acc_z", "knuckle_fl_acc_z")
COLUMNS = {"fr": "Stößel VR", "fl": "Stößel VL"}
MAP = [word for wheel, name in COLUMNS.items() for word in ("--map", f"plate_{wheel}_displacement={name}")]
WESTERN = "the text is not UTF-8; it is read as Windows text (cp1252)"


@pytest.fixture(scope="module")
def run():
    signals = {
        wheel: random_road(rms=5e-4, seed=seed, duration=8.0, wheel=wheel).displacement[wheel]
        for wheel, seed in (("fr", 1), ("fl", 2))
    }
    signal = Signal(time=np.arange(signals["fr"].size) / 1000.0, displacement=signals, source="made")
    return Car.load("focus").run(signal, engine="reduced")


@pytest.fixture(scope="module")
def files(run, tmp_path_factory):
    """Accelerations in one file, plates in another with a head of three lines, in the text of a German Windows."""
    folder = tmp_path_factory.mktemp("files")
    histories = [run[name] for name in ACCELERATIONS]
    np.savetxt(folder / "acc.csv", np.column_stack([run.time, *histories]), delimiter=",", fmt="%.9g", comments="",
               header="time [s]," + ",".join(f"{name} [m/s2]" for name in ACCELERATIONS))  # fmt: skip
    plates = [1e3 * run[f"plate_{wheel}_displacement"] for wheel in COLUMNS]
    rows = [";".join(f"{value:.9g}" for value in row).replace(".", ",") for row in zip(run.time, *plates, strict=True)]
    head = ["Prüfstand 4", "Größe: Weg", f"Zeit;{';'.join(COLUMNS.values())}", "s;mm;mm"]
    (folder / "plates.txt").write_text("\n".join([*head, *rows]) + "\n", encoding="cp1252")
    return folder


def test_a_signal_file_is_read_as_inspect_reads_it(files, run, tmp_path, capsys):
    true = run.car.vehicle.damper.viscous
    arguments = ["focus", "--set", f"damper.viscous={1.2 * true}", "--parameters",
                 f"damper.viscous={0.4 * true}:{3.0 * true}", "--record", str(files / "acc.csv"), "--signal",
                 str(files / "plates.txt"), "--map", "knuckle_fr_acc_z=knuckle_fr_acc_z", "--map",
                 "knuckle_fl_acc_z=knuckle_fl_acc_z", "--engine", "reduced", "--quiet", "--json"]  # fmt: skip
    assert tune([*arguments, "--output", str(tmp_path / "unnamed")]) == 3
    said = capsys.readouterr().err
    assert f"--map '{MAP[1]}' --map '{MAP[3]}' (columns: 'Stößel VR', " in said
    assert tune([*arguments, *MAP, "--output", str(tmp_path / "named")]) == 0
    (parameter,) = json.loads(capsys.readouterr().out)["parameters"]
    # The files have nine digits; the filter of the fit does the rest.
    assert parameter["value"] == pytest.approx(true, rel=1e-3)


def test_the_channel_of_a_plate_is_that_of_both_files_that_have_it(files, run):
    channels = {f"plate_{wheel}_displacement": name for wheel, name in COLUMNS.items()}
    channels |= {name: name for name in ACCELERATIONS}
    found = measured_histories(
        run.car, files / "acc.csv", files / "plates.txt", channels, inverted=["plate_fl_displacement"]
    )
    assert found.signal is not None
    for wheel, sign in (("fr", 1.0), ("fl", -1.0)):
        np.testing.assert_allclose(
            found.signal.displacement[wheel], sign * run[f"plate_{wheel}_displacement"], atol=1e-11
        )  # fmt: skip


def test_every_option_reads_windows_text(run, tmp_path, capsys):
    """The same table for --input, --signal, --road and `inspect`, with an umlaut above its header."""
    table = np.column_stack([run.time, *(run[f"plate_{wheel}_displacement"] for wheel in COLUMNS)])
    rows = [",".join(f"{value:.9g}" for value in row) for row in table]
    file = tmp_path / "two.csv"
    text = "\n".join(["# Prüfstand", "time [s],displacement_fr [m],displacement_fl [m]", *rows]) + "\n"
    file.write_text(text, encoding="cp1252")
    assert WESTERN in read_record(file).notices
    signal = read_signal(file)
    assert WESTERN in signal.notices and signal.wheels == ("fr", "fl")
    assert shaker(["--input", str(file), "--vehicle", "focus", "--engine", "reduced", "--quiet", "--output",
                   str(tmp_path / "run")]) == 0  # fmt: skip
    road = tmp_path / "road.csv"
    profile = [f"{x:.2f},{1e-3 * np.sin(x):.6g},{1e-3 * np.sin(x):.6g}" for x in np.arange(0.0, 60.0, 0.05)]
    road.write_text("\n".join(["# Straße", "distance [m],left [m],right [m]", *profile]) + "\n", encoding="cp1252")
    driven = Road(road, speed=30.0, choice=Choice()).under(Car.load("focus").vehicle, []).signal()
    assert any(WESTERN in notice for notice in driven.notices)


def test_a_head_above_named_columns_is_no_obstacle(run, tmp_path):
    rows = [f"{t:.3f}\t{1e3 * z:.9g}" for t, z in zip(run.time, run["plate_fl_displacement"], strict=True)]
    file = tmp_path / "head.txt"
    file.write_text("\n".join(["Rig 4", "time [s]\tdisplacement_fl [mm]", *rows]) + "\n")
    np.testing.assert_allclose(read_signal(file).displacement["fl"], run["plate_fl_displacement"], atol=1e-11)
    file.write_text("\n".join(["Rig 4", "time [s]\tstroke_fl [mm]", *rows]) + "\n")
    with pytest.raises(DataError, match="'Rig 4'"):
        read_signal(file)


def test_plates_beyond_a_shaker_are_accepted_on_request(tmp_path):
    file, time = tmp_path / "rough.csv", np.arange(8000) / 1000.0
    plate = 0.2 * np.sin(2.0 * np.pi * time)
    np.savetxt(file, np.column_stack([time, plate, np.cos(time)]), delimiter=",", comments="",
               header="time [s],plate_fl_displacement [m],knuckle_fl_acc_z [m/s2]")  # fmt: skip
    car = Car.load("focus")
    with pytest.raises(DataError, match=r"plate fl is displaced by 0\.2 m"):
        measured_histories(car, file)
    target = measured_histories(car, file, choice=Choice(any_level=True))
    assert target.signal is not None
    assert any(text.startswith("accepted on request: ") for text in target.signal.notices)
