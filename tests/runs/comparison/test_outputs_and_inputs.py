"""Responses to two plates that move apart: paired by output and input, whatever the order of channels and options."""

import itertools
import json

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.commands.compare import main as compare_command
from vehicle.commands.shaker import main as shaker
from vehicle.commands.tune import main as tune
from vehicle.errors import DataError
from vehicle.runs.car import Car
from vehicle.runs.comparison.compared_run import compare
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import write_signal
from vehicle.signals.formats import uff_writer
from vehicle.signals.formats.channel import Channel
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.measured import read_measured

NAMES = {
    "plate_fl_displacement": "Stempel VL [mm]",
    "plate_fr_displacement": "Stempel VR [mm]",
    "knuckle_fr_acc_z": "Radträger VR z [m/s2]",
    "knuckle_fl_acc_z": "Radträger VL z [m/s2]",
    "seat_rail_acc_z": "Sitzschiene z [m/s2]",
}
"""Channel of the model to its column, in the order of the record."""

ACCELERATIONS = tuple(name for name in NAMES if name.endswith("acc_z"))
NOISE = 0.02
"""RMS of the noise on the accelerations over theirs [-]."""


def mapped(names):
    return {name: NAMES[name].split(" [")[0] for name in names}


def options(names):
    return [word for name, column in mapped(names).items() for word in ("--map", f"{name}={column}")]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with the run of a car on two independent plates, and a record of it with noise."""
    folder = tmp_path_factory.mktemp("plates")
    signals = {
        wheel: random_road(rms=1e-3, seed=seed, duration=16.0, wheel=wheel).displacement[wheel]
        for wheel, seed in (("fr", 1), ("fl", 2))
    }
    time = np.arange(signals["fr"].size) / 1000.0
    write_signal(folder / "two.csv", Signal(time=time, displacement=signals))
    arguments = ["--input", str(folder / "two.csv"), "--engine", "reduced", "--output", str(folder / "run"), "--quiet"]
    assert shaker([*arguments, "--vehicle", "focus", "--any-level"]) == 0
    return folder


@pytest.fixture(scope="module")
def columns(folder):
    """Columns of the record: the run with noise on the accelerations, in the units of its names."""
    noise = np.random.default_rng(4)
    with np.load(folder / "run" / "time.npz") as file:
        held = {key.split(" ")[0]: file[key] for key in file.files}
    found = {"time": held["time"]}
    for name in NAMES:
        scatter = NOISE * held[name].std() * noise.standard_normal(held[name].size) if "acc" in name else 0.0
        found[name] = (1e3 if "plate" in name else 1.0) * (held[name] + scatter)
    return found


def record(path, columns, order):
    heads = ",".join(["time [s]", *(NAMES[name] for name in order)])
    table = np.column_stack([columns[name] for name in ("time", *order)])
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.12g", encoding="cp1252")
    return path


def errors(comparison):
    """Error of each band by output, input and lower edge."""
    return {
        (item.channel, item.plate, band.low): (band.error, band.magnitude_db, band.phase_deg)
        for item in comparison.responses
        for band in item.bands
    }


def test_the_order_of_columns_and_options_changes_nothing(folder, columns, tmp_path):
    orders = [*itertools.permutations(NAMES)][:: 120 // 2]
    first = None
    for number, (written, asked) in enumerate(zip(orders, orders[::-1], strict=True)):
        file = record(tmp_path / f"{number}.csv", columns, written)
        result = compare(folder / "run", file, mapped(asked))
        found = errors(result)
        first = first or found
        assert list(found) == list(first)
        np.testing.assert_allclose(list(found.values()), list(first.values()), rtol=1e-9, atol=1e-9)
        assert {item.plate for item in result.responses} == {"plate_fr", "plate_fl"}
        # The noise of 2 % on the accelerations is all that differs.
        assert result.signatures is not None and result.signatures.channels == 6
        assert np.nanmean(result.signatures.csac) > 0.99
        assert all(item.frac > 0.99 for item in result.responses)


def test_the_command_names_output_and_plate(folder, columns, tmp_path, capsys):
    file = record(tmp_path / "rec.csv", columns, list(NAMES))
    assert compare_command([str(folder / "run"), "--measured", str(file), *options(NAMES), "--output",
                            str(tmp_path / "found")]) == 0  # fmt: skip
    said = capsys.readouterr().out
    assert "seat_rail_acc_z/plate_fr" in said and "seat_rail_acc_z/plate_fl" in said
    content = json.loads((tmp_path / "found" / "compare.json").read_text())
    pairs = {(one["channel"], one["plate"]) for one in content["responses"]}
    assert pairs == {(name, plate) for name in ACCELERATIONS for plate in ("plate_fr", "plate_fl")}
    assert content["signatures"]["csac_mean"] > 0.99
    table = [line.split(",") for line in (tmp_path / "found" / "compare.csv").read_text().splitlines()[1:]]
    at = table[0].index("plate")
    assert {(row[1], row[at]) for row in table[1:] if row[0] == "frf"} == pairs
    pictures = {path.name for path in (tmp_path / "found").glob("compare_frf_*.png")}
    assert {f"compare_frf_knuckle_fr_plate_{wheel}.png" for wheel in ("fr", "fl")} <= pictures


def uff(path, columns_of, reference, name=""):
    """Write FRFs of the linear car to both plates as a universal file, with their references."""
    car, frequency = Car.load("focus"), np.arange(2.0, 48.0, 0.25)
    channels = []
    for plate in columns_of:
        rows = car.matrix_frf(ACCELERATIONS, frequency, wheel=plate[-2:])
        channels += [
            Channel(name=name.format(output=output, plate=plate) or f"R {plate[-1]}{node}", values=values,
                    unit="(m/s2)/(m)", axis=frequency, kind="frequency", function="frequency response",
                    place=f"p{node}", direction="+Z", reference=reference.format(plate=plate))
            for node, (output, values) in enumerate(zip(ACCELERATIONS, rows, strict=True), 1)
        ]  # fmt: skip
    uff_writer.write(path, channels, "made")
    return path


@pytest.mark.parametrize("plates", [("plate_fr", "plate_fl"), ("plate_fl", "plate_fr")])
def test_a_file_of_responses_is_paired_by_the_plates_that_it_names(folder, tmp_path, plates):
    file = uff(tmp_path / "named.uff", plates, "{plate}+Z", name="{output} / {plate}")
    result = compare(folder / "run", file)
    assert {(item.channel, item.plate) for item in result.responses} == {
        (name, plate) for name in ACCELERATIONS for plate in plates
    }
    exact = {
        (name, plate): row
        for plate in plates
        for name, row in zip(
            ACCELERATIONS, Car.load("focus").matrix_frf(ACCELERATIONS, np.arange(2.0, 48.0, 0.25), wheel=plate[-2:]),
            strict=True,
        )
    }  # fmt: skip
    for item in result.responses:
        inside = np.isin(np.arange(2.0, 48.0, 0.25), item.frequency)
        np.testing.assert_allclose(item.measured, exact[item.channel, item.plate][inside], rtol=1e-5)


def test_a_response_without_a_plate_is_refused_or_named_by_the_option(folder, tmp_path):
    file = uff(tmp_path / "nameless.uff", ["plate_fl"], "", name="R {output}")
    roles = {name: f"R {name}"[:40] for name in ACCELERATIONS}
    with pytest.raises(DataError, match=r"knuckle_fr_acc_z: .* 2 plates .*--map knuckle_fr_acc_z/plate_fr=NAME"):
        compare(folder / "run", file, roles)
    named = compare(folder / "run", file, {f"{name}/plate_fl": wanted for name, wanted in roles.items()})
    assert {item.plate for item in named.responses} == {"plate_fl"}
    assert any("the run also drives plate_fr" in text for text in named.notices)


def test_a_fit_pairs_responses_of_two_plates_in_any_order(folder, columns, tmp_path, capsys):
    car = Car.load("focus")
    true = car.vehicle.damper.viscous or 0.0
    found = []
    signal = ["--signal", str(folder / "two.csv")]
    for number, (order, more) in enumerate(((list(NAMES), []), (list(NAMES)[::-1], signal))):
        file = record(tmp_path / f"{number}.csv", columns, order)
        arguments = ["focus", "--set", f"damper.viscous={1.3 * true}", "--parameters",
                     f"damper.viscous={0.4 * true}:{3.0 * true}", "--frf", str(file), *options(order), *more,
                     "--engine", "reduced", "--spacing", "1", "--quiet"]  # fmt: skip
        assert tune([*arguments, "--output", str(tmp_path / f"fit{number}"), "--json"]) == 0
        found.append(json.loads(capsys.readouterr().out))
    one, other = ([entry["value"] for entry in each["parameters"]] for each in found)
    assert one == pytest.approx(other, rel=1e-3)
    (parameter,) = found[0]["parameters"]
    assert abs(parameter["value"] - true) < 3.0 * parameter["standard_error"] < 0.1 * true
    named = {(row["channel"], row["plate"]) for row in found[0]["agreement"]}
    assert named == {(name, plate) for name in ACCELERATIONS for plate in ("plate_fr", "plate_fl")}


def test_measured_plates_that_move_as_one_are_one_input(folder, columns, tmp_path):
    """A record in roll: the response to the first plate while the other does the opposite."""
    rolled = columns | {"plate_fl_displacement": -columns["plate_fr_displacement"]}
    file = record(tmp_path / "roll.csv", rolled, list(NAMES))
    measured = read_measured(file, tuple(NAMES), Choice(channels=mapped(NAMES)))
    assert measured.frf is not None
    (motion,) = {name.motion for name in measured.frf.names}
    assert dict(motion) == pytest.approx({"plate_fr": 1.0, "plate_fl": -1.0}) and motion[0][0] == "plate_fr"
