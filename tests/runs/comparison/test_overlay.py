"""A made measurement of another car, 3 % noise, as a universal file: beside a run, and as the target of a fit."""

import json
import re
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from vehicle.commands.compare import main as compare
from vehicle.commands.input_options import input_of
from vehicle.commands.options import read
from vehicle.commands.shaker import main as shaker
from vehicle.commands.shaker import parser as shaker_options
from vehicle.commands.tune import main as tune
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import overrides_of
from vehicle.runs.car import Car
from vehicle.runs.comparison.compared_run import comparison_of
from vehicle.runs.comparison.simulated import of_folder
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.input_settings import DriveInput
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats import uff_writer
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.csv_table import write_table
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.measured import read_measured
from vehicle.signals.records.measured_settings import MeasuredSettings
from vehicle.signals.records.record_settings import RecordSettings

MOUNT, ENGINE = "bushings.suspension_mount.stiffness.z", "bushings.linear_mount.stiffness.z"
HIDDEN = {MOUNT: 5.5e5, ENGINE: 4.5e5}
NOISE, AVERAGES = 0.03, 8.0
PLACES = {"knuckle_fr_acc_z": "1", "seat_rail_acc_z": "2", "engine_acc_z": "3"}
"""Channel to the node that measured it."""
MAP = [word for name, node in PLACES.items() for word in ("--map", f"{name}=Dof {node} -Z")]
BANDS = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 50.0)


@pytest.fixture(scope="module")
def measured(tmp_path_factory, car):
    """FRFs in g per m, measured downwards, with coherence, of a car with other mounts."""
    frequency = np.arange(2.0, 48.0, 0.25)
    clean = Car.load(overrides=overrides_of(car.vehicle, HIDDEN)).matrix_frf(tuple(PLACES), frequency, wheel="fr")
    real, imaginary = np.random.default_rng(11).standard_normal((2, *clean.shape))
    noisy = clean * (1.0 + NOISE * (real + 1j * imaginary))
    channels = []
    for row, node in enumerate(PLACES.values()):
        about: dict[str, Any] = {"axis": frequency, "kind": "frequency", "place": f"p{node}", "direction": "-Z"}
        coherence = np.full(frequency.size, 1.0 / (1.0 + 2.0 * AVERAGES * NOISE**2))
        channels += [
            Channel(name=f"{name} {node}", values=values, unit=unit, function=function, reference="", **about)
            for name, values, unit, function in (
                ("Acc", -noisy[row] / 9.80665, "(g)/(m)", "frequency response"),
                ("Coh", coherence, "", "coherence"),
            )
        ]
    path = tmp_path_factory.mktemp("measured") / "measured.uff"
    uff_writer.write(path, channels, "made")
    return path


@pytest.fixture(scope="module")
def run(tmp_path_factory, measured):
    """A short run of the car of the vehicle file, with the measurement beside it."""
    folder = tmp_path_factory.mktemp("overlay")
    signal = read_signal(find_input("low.csv"), wheel="fr")
    table = [signal.time[:6001], signal.displacement["fr"][:6001]]
    write_table(folder / "short.csv", ["time [s]", "displacement [m]"], table, [])
    arguments = ["--input", str(folder / "short.csv"), "--wheel", "front_right", "--engine", "reduced", "--quiet"]
    assert shaker([*arguments, "--measured", str(measured), *MAP, "--output", str(folder / "run")]) == 0
    return folder / "run"


def exact_errors(car):
    """|ln(H / Hm)|^2 of both cars by their matrices, band by band: channel and lower edge to the root of its mean."""
    frequency = np.arange(2.0, 48.0, 0.25)
    other = Car.load(overrides=overrides_of(car.vehicle, HIDDEN))
    ratio = np.log(
        car.matrix_frf(tuple(PLACES), frequency, wheel="fr") / other.matrix_frf(tuple(PLACES), frequency, wheel="fr")
    )
    found: dict[tuple[str, float], float] = {}
    for low, high in pairwise(BANDS):
        inside = (frequency >= low) & (frequency < high)
        if inside.any():
            sizes = np.sqrt(np.mean(np.abs(ratio[:, inside]) ** 2, axis=1))
            found |= {(name, low): size for name, size in zip(PLACES, sizes, strict=True)}
    return found


def test_the_table_of_a_run_names_the_worst_channel_and_band(run, car):
    files = {path.name for path in run.iterdir()}
    assert {"compare.csv", "compare.json", "compare_signatures.png"} <= files
    assert {f"compare_frf_{place}.png" for place in ("knuckle_fr", "seat_rail", "engine")} <= files
    content = json.loads((run / "compare.json").read_text())
    rows, exact = content["table"], exact_errors(car)
    worst = max(exact, key=lambda key: exact[key])
    assert (rows[0]["channel"], rows[0]["low_hz"]) == worst
    assert [row["error"] for row in rows] == sorted((row["error"] for row in rows), reverse=True)
    # Noise of 3 % in both parts and the estimate from 6 s add to what the mounts make.
    assert rows[0]["error"] == pytest.approx(exact[worst], rel=0.15)
    for one in content["responses"]:
        assert 0.5 < one["frac"] <= one["scaled_frac"] <= 1.0
    summary = json.loads((run / "summary.json").read_text())
    assert summary["measured"]["file"] == "measured.uff" and summary["measured"]["table"] == rows
    assert {summary["files"][kind] for kind in ("compare", "compare_table")} == {"compare.json", "compare.csv"}
    first = (run / "compare.csv").read_text().splitlines()[2].split(",")
    assert first[:4] == ["frf", worst[0], f"{worst[1]:g}", f"{rows[0]['high_hz']:g}"]
    said = " ".join(content["notices"])
    assert "sign inverted" in said and "along -Z" in said and "(g)/(m) converted to m/s2 per m" in said


def test_the_command_compares_the_files_of_a_run(run, measured, tmp_path, capsys):
    arguments = [str(run), "--measured", str(measured), *MAP[:2], "--no-figures", "--output", str(tmp_path / "found")]
    assert compare([*arguments, "--bands", "5,20,40"]) == 0
    said = capsys.readouterr().out
    assert re.search(r"largest error of a response: knuckle_fr_acc_z, \d+ to \d+ Hz: [+-]\d", said)
    content = json.loads((tmp_path / "found" / "compare.json").read_text())
    assert sorted((row["low_hz"], row["high_hz"]) for row in content["table"]) == [(5.0, 20.0), (20.0, 40.0)]
    assert content["signatures"] is None  # of one response alone
    # Turned once more, the phase is off by 180 degrees.
    again = [*arguments[:-1], str(tmp_path / "turned"), "--turn", "knuckle_fr_acc_z", "--json"]
    assert compare(again) == 0
    assert json.loads(capsys.readouterr().out)["table"][0]["phase_deg"] > 150.0


def test_a_run_beside_itself_agrees(run, tmp_path, capsys):
    names = ("knuckle_fr_acc_z", "damper_fr_velocity", "plate_fr_displacement")
    pairs = [word for name in names for word in ("--map", f"{name}={name}")]
    words = [str(run), "--measured", str(run / "time.npz"), *pairs, "--output", str(tmp_path / "x"), "--no-figures"]
    assert compare([*words, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert [one["channel"] for one in content["records"]] == list(names)
    for one in content["records"]:
        assert one["rms_ratio"] == pytest.approx(1.0) and one["correlation"] == pytest.approx(1.0)
        assert one["iso18571"]["overall"] == pytest.approx(1.0) and one["lag_s"] == 0.0
    # Response and plate as time histories: the responses are estimated as those of the run are.
    (response,) = content["responses"]
    assert response["frac"] == pytest.approx(1.0, abs=1e-6)
    assert any("local rational" in text for text in content["notices"])


def test_several_measurements_give_one_table(run, tmp_path, capsys):
    folder = tmp_path / "measured"
    folder.mkdir()
    (folder / "one.npz").write_bytes((run / "time.npz").read_bytes())
    (folder / "two.csv").write_text("nothing\n")
    words = [str(run), "--measured", str(folder), "--map", "seat_rail_acc_z=seat_rail_acc_z"]
    assert compare([*words, "--output", str(tmp_path / "out"), "--json"]) == 3
    out, err = capsys.readouterr()
    first, second = json.loads(out)
    assert first["records"][0]["rms_ratio"] == pytest.approx(1.0) and "no table of numbers" in second["error"]
    assert "1 of 2 files has no result" in err and (tmp_path / "out" / "one" / "compare.json").is_file()


def test_a_record_that_began_later_names_its_delay(run, tmp_path):
    """The run itself without its first 50 ms, at times from 0 on, and without its plate."""
    truth = of_folder(run).record
    path = tmp_path / "late.csv"
    names = ("knuckle_fr_acc_z", "seat_rail_acc_z")
    columns = [truth.time[50:] - truth.time[50], *(truth.channels[name][50:] for name in names)]
    write_table(path, ["time [s]", *(f"{name} [m/s2]" for name in names)], columns)
    measured = read_measured(path, tuple(truth.channels))
    notices = comparison_of(measured, of_folder(run)).notices
    assert notices[0].startswith("FRFs need") and "--map plate_fl_disp" in notices[0]
    assert "50 ms early in all channels" in notices[1] and notices[1].endswith("set --delay 0.05")
    again = comparison_of(measured, of_folder(run), delay=0.05)
    assert again.notices == notices[:1] and again.records[0].correlation == pytest.approx(1.0)


def test_gravity_in_a_record_is_named_with_its_remedy(run, tmp_path):
    """An offset of 1 g: the RMS ratio contains it, --detrend subtracts it."""
    truth = of_folder(run).record
    path = tmp_path / "offset.csv"
    values = truth.channels["seat_rail_acc_z"]
    write_table(path, ["time [s]", "seat_rail_acc_z [m/s2]"], [truth.time, values + 9.80665])
    comparison = comparison_of(read_measured(path, tuple(truth.channels)), of_folder(run))
    (said,) = [text for text in comparison.notices if "gravity" in text]
    assert said.startswith("seat_rail_acc_z: gravity is included in the mean (9.8") and "--detrend" in said
    assert comparison.records[0].rms_ratio < 0.1
    level = read_measured(path, tuple(truth.channels), choice=Choice(detrend=True))
    again = comparison_of(level, of_folder(run))
    assert again.records[0].rms_ratio == pytest.approx(1.0, abs=0.01)
    assert not [text for text in again.notices if "gravity" in text]


def test_a_unit_is_of_the_input_or_of_what_was_measured(tmp_path):
    """`--unit` of the shaker: of the plate that --channel names, else of a channel of the measurement."""
    time = np.arange(0.0, 2.0, 1e-3)
    wave = np.sin(50.0 * time)
    write_table(tmp_path / "hub.csv", ["time [s]", "knuckle_fr_acc_z"], [time, wave], [])
    words = ["--input", "x.csv", "--channel", "fr=1", "--unit", "fr=mm", "--measured", str(tmp_path / "hub.csv")]
    known = ("knuckle_fr_acc_z", "seat_rail_acc_z")
    for unit, factor in (("g", 9.80665), ("m/s2", 1.0)):
        options = shaker_options().parse_args([*words, "--unit", f"knuckle_fr_acc_z={unit}"])
        record, asked = read(options, RecordSettings), read(options, MeasuredSettings)
        choice = record.choice("fr", others=True)
        assert choice is not None and dict(choice.units) == {"fr": "mm"}
        found = asked.read(known, asked.choice(RecordSettings(units=record.units), choice.units))
        assert found.record is not None
        assert found.record.channels["knuckle_fr_acc_z"] == pytest.approx(factor * wave)
    road = ["--road", "C", "--unit", "knuckle_fr_acc_z=g", "--measured", str(tmp_path / "hub.csv")]
    assert isinstance(input_of(shaker_options().parse_args(road)), DriveInput)
    with pytest.raises(ConfigurationError, match="--unit: belongs to --input"):
        shaker_options().parse_args(road[:4])
    options = shaker_options().parse_args([*words, "--unit", "knuckle_fr=g"])
    with pytest.raises(ConfigurationError, match=r"--unit knuckle_fr=.*: knuckle_fr"):
        asked.read(known, asked.choice(read(options, RecordSettings), {"fr"}))


def test_a_fit_finds_the_mounts_from_the_same_file(measured, tmp_path):
    """Within three standard errors, and to a percent."""
    arguments = ["focus", "--frf", str(measured), "--stuck", *MAP, "--spacing", "1", "--engine", "reduced", "--quiet"]
    arguments += ["--set", "shaker_wheel='fr'"]  # the wheel of the measurement
    arguments += ["--set", f"{MOUNT}=6.5e5", "--set", f"{ENGINE}=5.5e5"]
    arguments += ["--parameters", f"{MOUNT}=4e5:9e5", f"{ENGINE}=3e5:8e5"]
    assert tune([*arguments, "--output", str(tmp_path / "fit"), "--author", "A. Engineer", "--project", "Ride"]) == 0
    assert "Ride, A. Engineer, 20" in (tmp_path / "fit" / "report.html").read_text(encoding="utf-8")
    fitted = json.loads((tmp_path / "fit" / "tune.json").read_text())["parameters"]
    assert [parameter["path"].removeprefix("front.") for parameter in fitted] == list(HIDDEN)
    for parameter, value in zip(fitted, HIDDEN.values(), strict=True):
        assert abs(parameter["value"] - value) < 3.0 * parameter["standard_error"] < 0.03 * value


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["--map", "knuckle_acc_z=1"], 2, "unknown channel of the model; .*did you mean knuckle_f[rl]_acc_z"),
        (["--map", "knuckle_fr_acc_z=nothing*"], 3, "--map knuckle_fr_acc_z= 'nothing\\*' matches no channel"),
        (["--map", "knuckle_fr_acc_z=Acc *"], 3, "matches 3 channels"),
        (["--map", "damper_fr_velocity=1"], 3, "--map damper_fr_velocity=.* frequency response"),
        ([], 3, "set --map CHANNEL=NAME"),
        ([*MAP[:2], "--unit", "knuckle_fr_acc_z=m/s2/N"], 3, "m/s2/N, a response to a force"),
        ([*MAP[:2], "--unit", "knuckle_fr_acc_z=Pa"], 3, "in Pa but must be a motion"),
        ([*MAP[:2], "--bands", "9,3"], 2, r"must be increasing frequencies \[Hz\]"),
        (["--map", "3"], 2, "must be CHANNEL=NAME"),
    ],
)
def test_what_cannot_be_compared_is_refused(run, measured, tmp_path, capsys, arguments, code, message):
    given = [str(run), "--measured", str(measured), "--output", str(tmp_path / "none"), *arguments]
    assert compare(given) == code
    said = capsys.readouterr().err
    assert re.search(message, said) and said.count("\n") == 1, said
    assert not (tmp_path / "none").exists()
