"""Every command that `inspect` advises runs: files of users, of other programs, and with each fault of a record."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.advice import advised, run_advice
from tests.failing_inputs import DATABASES, MAKERS, made
from tests.signals.formats import logger_files
from tests.signals.formats.test_refused_without_need import crg
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.formats import hdf_format, matlab_format, mdf_format, rpc_format, uff_writer
from vehicle.signals.formats.channel import Channel

ROOT = Path(__file__).resolve().parents[2]
FOREIGN = sorted(path for path in (ROOT / "tests" / "data" / "uff").iterdir() if path.suffix)
TEXTS = sorted(name for name, value in vars(logger_files).items() if name.isupper() and isinstance(value, str))
TIME = np.arange(3000) / 100.0
SINE = np.sin(2 * np.pi * 2.0 * TIME) * np.clip(TIME, 0.0, 1.0)


@pytest.mark.parametrize("path", FOREIGN, ids=lambda path: path.name)
def test_files_of_other_programs(path, tmp_path):
    run_advice(path, tmp_path)


@pytest.mark.parametrize("name", MAKERS)
def test_files_that_once_gave_wrong_numbers(name, tmp_path):
    path = made(name, tmp_path)
    run_advice(path, tmp_path, *(["--dbc", str(tmp_path / "car.dbc")] if name in DATABASES else []))


@pytest.mark.parametrize("name", TEXTS)
def test_files_of_loggers(name, tmp_path):
    path = tmp_path / "logger.txt"
    path.write_text(getattr(logger_files, name), encoding="utf-8")
    run_advice(path, tmp_path)


@pytest.mark.parametrize("name", ["bump_1p5mm.csv", "low.csv"])
def test_shipped_inputs(name, tmp_path):
    assert run_advice(find_input(name), tmp_path) == ["shaker"]


RECORDS = {
    "seat": ("comfort", {"Seat Z": ("m/s2", 1.0)}),
    "plate": ("shaker", {"Shaker FL": ("m", 2e-3)}),
    "rig": ("shaker compare", {"Shaker FL": ("m", 2e-3), "Hub FL z": ("m/s2", 1.0)}),
}
"""Record to the advised commands, and to unit and level of each channel."""


def with_tdms(path, channels, _):
    nptdms = pytest.importorskip("nptdms")
    clock = {"wf_increment": 0.01, "wf_start_offset": 0.0}
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment(
            [nptdms.ChannelObject("g", one.name, one.values, {**clock, "unit_string": one.unit}) for one in channels]
        )


def with_parquet(path, channels, _):
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    parquet.write_table(
        arrow.table({"time [s]": TIME, **{f"{one.name} [{one.unit}]": one.values for one in channels}}), path
    )


def with_sheet(path, channels, _):
    book = pytest.importorskip("openpyxl").Workbook()
    book.active.append(["time [s]", *(f"{one.name} [{one.unit}]" for one in channels)])
    for row in np.column_stack([TIME, *(one.values for one in channels)]).tolist():
        book.active.append(row)
    book.save(path)


def with_text(path, channels, _):
    heads = ",".join(["time [s]", *(f"{one.name} [{one.unit}]" for one in channels)])
    np.savetxt(path, np.column_stack([TIME, *(one.values for one in channels)]), "%.6f", ",", header=heads, comments="")


WRITERS: dict[str, Callable[..., None]] = {
    "csv": with_text, "h5": hdf_format.write, "mat": matlab_format.write, "mf4": mdf_format.write,
    "parquet": with_parquet, "rsp": rpc_format.write, "tdms": with_tdms, "uff": uff_writer.write, "xlsx": with_sheet,
}  # fmt: skip
"""Suffix of a format to a function of path, channels and a description that writes it."""


@pytest.mark.parametrize("record", RECORDS)
@pytest.mark.parametrize("suffix", WRITERS)
def test_a_record_in_each_format(suffix, record, tmp_path):
    advice, channels = RECORDS[record]
    path = tmp_path / f"record.{suffix}"
    made = [Channel(name=name, values=level * SINE, unit=unit, axis=TIME) for name, (unit, level) in channels.items()]
    WRITERS[suffix](path, tuple(made), "a record")
    assert run_advice(path, tmp_path) == advice.split()


EMPTY = [""] * 1500
PAIRS = (TIME, SINE, [*TIME[::2], *EMPTY], [*SINE[::2], *EMPTY])
MARKED = (TIME, SINE, ["0", "1", *["run"] * 2998])
TABLES = {
    # heads, cells, advised commands
    "pairs of times": ("Time [s],Seat Z [m/s2],Time [s],Rail Z [m/s2]", PAIRS, ["comfort"]),
    "texts in another column": ("Time [s],Seat Z [m/s2],Marker [mm]", MARKED, ["comfort"]),
    "a title above the head": ("Rig 7\ntime [s],displacement_fl [m]", (TIME, 1e-3 * SINE), ["shaker"]),
}


@pytest.mark.parametrize("name", TABLES)
def test_tables_of_users(name, tmp_path):
    heads, cells, commands = TABLES[name]
    path = tmp_path / "table.csv"
    path.write_text("\n".join([heads, *(",".join(map(str, row)) for row in zip(*cells, strict=True)), ""]))
    assert run_advice(path, tmp_path) == commands


def test_a_road_in_crg(tmp_path):
    assert run_advice(crg(tmp_path / "road.crg", (0.0, 0.02)), tmp_path) == ["shaker"]


def swapped():
    time = TIME.copy()
    time[[1000, 1001]] = time[[1001, 1000]]
    return time


def with_empty(values, begin, end):
    values = values.copy()
    values[begin:end] = np.nan
    return values


CASES = {
    # stamps, accelerations, commands with a part of their words; no command where none can accept the file
    "times out of order": (swapped(), SINE, "--from 10.02 --to 29.99"),
    "a restarted clock": (np.concatenate([TIME[:1500], TIME[:1500]]), SINE, None),
    "a clock that restarts once and goes on": (np.concatenate([TIME[:500], TIME[:2500]]), SINE, "--from 5 --to 24.99"),
    "a pause": (np.where(TIME > 20.0, TIME + 3.0, TIME), SINE, "--from 0 --to 20"),
    "pauses with parts that are too short": (TIME + 3.0 * np.floor(TIME / 0.3), SINE, None),
    "a part shorter than the spline of --resample": (TIME + np.floor(TIME / 0.05) + 0.002 * (SINE > 0), SINE, None),
    "an empty channel": (TIME, np.full(TIME.size, np.nan), None),
    "empty cells": (TIME, with_empty(SINE, 1000, 1002), "--from 10.02 --to 29.99"),
    "empty cells and jitter": (TIME + 0.002 * (np.arange(TIME.size) % 7 == 3), with_empty(SINE, 9, 12), "--from 0.12"),
    "a level beyond comfort": (TIME, 500.0 * SINE, None),
    "a sensor that was off": (TIME, np.zeros(TIME.size), None),
    "gravity": (TIME, 9.81 + SINE, "--offset remove"),
    "a short record": (TIME[:500], SINE[:500], None),
    "batches": (0.2 * np.floor(TIME / 0.2), SINE, "--rate 100"),
}


@pytest.mark.parametrize("name", CASES)
def test_faults_of_an_acceleration(name, tmp_path):
    time, values, words = CASES[name]
    path = tmp_path / "seat.csv"
    cells = (f"{t:.6g},{'' if np.isnan(a) else f'{a:.6f}'}" for t, a in zip(time, values, strict=True))
    path.write_text("\n".join(["time [s],seat z [m/s2]", *cells]) + "\n")
    commands, text = advised(path)
    assert run_advice(path, tmp_path, commands=commands) == ([] if words is None else ["comfort"]), text
    assert (words or "no command: ") in (text if words is None else " ".join(commands[0])), text


@pytest.mark.parametrize(
    ("words", "names"),
    [
        (None, ("Altitude", "Distance")),
        (None, ("Damper Pos FL", "Federweg VR")),
        ("--channel 'fl=Shaker FL'", ("Shaker FL", "Distance")),
        ("--channel 'fl=Shaker FL'", ("Shaker FL", "Damper Pos FL")),
    ],
)
def test_a_displacement_that_is_no_plate(words, names, tmp_path):
    path = tmp_path / "lengths.csv"
    table = np.column_stack([TIME, SINE, 5.0 * SINE])
    heads = ",".join(["time [s]", *(f"{name} [mm]" for name in names)])
    np.savetxt(path, table, "%.5f", ",", header=heads, comments="")
    commands, text = advised(path)
    assert (words or "no command: a displacement, ") in text
    run_advice(path, tmp_path, commands=commands)


@pytest.mark.parametrize("jitter", [0.0, 0.2])
def test_the_comparison_takes_the_options_of_the_clock(jitter, tmp_path):
    path = tmp_path / "rig.csv"
    time = TIME + jitter / 100.0 * np.random.default_rng(1).uniform(size=TIME.size)
    table = np.column_stack([time, 2.0 * SINE, 0.1 * SINE, 0.1 * SINE])
    heads = "time [s],Shaker FL [mm],Hub FL z [g],Seat z [g]"  # the car of the command has no seat
    np.savetxt(path, table, "%.6f", ",", header=heads, comments="")
    assert run_advice(path, tmp_path) == ["shaker", "compare"]


def test_a_record_too_short_for_an_frf_is_refused_before_its_run(tmp_path, capsys, monkeypatch):
    from vehicle.commands.shaker import main

    monkeypatch.setattr("vehicle.runs.car.car.Car.run", lambda *_, **__: pytest.fail("the run has begun"))
    path = tmp_path / "short.csv"
    np.savetxt(
        path, np.column_stack([TIME[:100], SINE[:100]]), "%.5f", ",", header="time [s],displacement [mm]", comments=""
    )
    assert main(["--input", str(path), "--output", str(tmp_path / "out")]) == 3
    assert "s are too short for an FRF up to 40 Hz; record at least" in capsys.readouterr().err
