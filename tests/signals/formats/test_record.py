"""Records of a run, as text and as arrays, come back alike."""

import json

import numpy as np
import pytest

from vehicle.arrays import Vector
from vehicle.commands.comfort import main
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats import csv_table, text
from vehicle.signals.formats.formats import TABLES, write_record
from vehicle.signals.formats.reader import read_columns
from vehicle.signals.formats.table import Record, Wanted, key_column

TIME: Vector = np.linspace(2.0, 5.999, 4000)
SINE: Vector = np.sin(2 * np.pi * 8.0 * TIME)
CHANNELS: dict[str, Vector] = {
    **{f"seat_rail_acc_{axis}": scale * SINE for axis, scale in zip("xyz", (0.1, 0.2, 1.0), strict=True)},
    "damper_fr_force": 100.0 * SINE,
}
UNITS = {**dict.fromkeys(CHANNELS, "m/s2"), "damper_fr_force": "N"}


@pytest.fixture(params=TABLES)
def run(request, tmp_path):
    path = tmp_path / f"time.{request.param}"
    write_record(path, request.param, Record(time=TIME, channels=CHANNELS, units=UNITS), "x to the rear")
    return path


def test_what_a_run_writes_comes_back(run):
    record = read_columns(run)
    assert (record.start, record.step) == pytest.approx((2.0, 1e-3))
    assert record.units == UNITS
    for name, values in CHANNELS.items():
        # Nine digits are written as text.
        np.testing.assert_allclose(record.channels[name], values, rtol=1e-8, atol=1e-12)


def test_comfort_reads_a_place_of_a_run(run, tmp_path, capsys):
    assert main(["--input", str(run), "--channel", "seat_rail", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    plain = tmp_path / "plain.csv"
    axes: dict[str, Vector] = dict(zip("xyz", list(CHANNELS.values())[:3], strict=True))
    write_record(plain, "csv", Record(time=TIME, channels=axes, units=dict.fromkeys("xyz", "m/s2")), "")
    assert main(["--input", str(plain), "--json"]) == 0
    expected = json.loads(capsys.readouterr().out)
    for axis in "xyz":
        assert found[axis]["weighted_rms"] == pytest.approx(expected[axis]["weighted_rms"], rel=1e-7)
    assert main(["--input", str(run)]) == 3
    said = capsys.readouterr().err
    assert ": column x is missing; " in said
    assert "--channel POINT, one of seat_rail" in said
    assert main(["--input", str(run), "--channel", "roof"]) == 3
    assert "column roof_acc_x is missing" in capsys.readouterr().err


def test_arrays_that_are_no_record_are_refused(tmp_path):
    path = tmp_path / "own.npz"
    with pytest.raises(ConfigurationError, match=r"own\.npz: .*does not exist"):
        read_columns(path)
    for arrays, message in (
        ({}, "cannot be read as npz"),
        ({"x": SINE}, "'time' is missing; found x;"),
        ({"time": TIME, "x": SINE[:-1]}, "array 'x' .* 3999 samples .* 4000"),
        ({"time": TIME[::-1], "x": SINE}, r"sample 2: time 5\.998 s .* of sample 1"),
    ):
        path.write_bytes(b"PK no archive")
        if arrays:
            np.savez(path, **arrays)  # type: ignore[arg-type]
        with pytest.raises(DataError, match=rf"own\.npz: .*{message}"):
            read_columns(path)


def test_the_shaker_reads_the_plates_of_a_run(run):
    plates = {"plate_fr_displacement": 1e-3 * (1.0 - np.cos(50.0 * (TIME - 2.0))), "plate_fl_displacement": 0.0 * TIME}
    record = Record(time=TIME, channels=CHANNELS | plates, units=UNITS | dict.fromkeys(plates, "m"))
    write_record(run, run.suffix[1:], record, "x to the rear")
    signal = read_signal(run)
    assert signal.wheels == ("fr",)  # the other plate stood still
    assert signal.notices == ("time begins at 2 s in the file and was shifted to 0",)
    np.testing.assert_allclose(signal.displacement["fr"], plates["plate_fr_displacement"], rtol=1e-8, atol=1e-15)


def test_arrays_beyond_the_memory_are_refused_before_they_are_unpacked(tmp_path, monkeypatch):
    np.savez_compressed(tmp_path / "own.npz", time=TIME, x=0.0 * TIME)  # zeros pack a thousand times smaller
    monkeypatch.setattr("vehicle.signals.formats.unpacked_size.MEMORY_LIMIT", 60_000)
    with pytest.raises(DataError, match=r"own\.npz: unpacked, its data need .* GiB but may need at most"):
        read_columns(tmp_path / "own.npz")


@pytest.mark.parametrize("ending", ["", "\n", "\n\n# the end"])
def test_a_long_table_is_read_in_pieces(tmp_path, monkeypatch, ending):
    """Whatever the length of a piece: the same numbers, the same lines, the same place of a fault."""
    rows = [f"{0.001 * n:.3f},{n % 7 - 3},{n * n:.6e}" for n in range(300)]
    rows[17] = "# a remark"
    rows[18] = ""
    path = tmp_path / "long.csv"
    path.write_text("# first\ntime [s],a [m],b [m]\n" + "\n".join(rows) + ending)
    wanted = Wanted(needed="time [s]", key=key_column("time [s]", "time [s]"))
    whole = csv_table.read(path, wanted)
    assert whole.values.shape == (298, 3) and whole.values[17, 2] == 19.0**2 and whole.lines[17] == 22
    damaged = tmp_path / "damaged.csv"
    damaged.write_text(path.read_text().replace("0.250,", "0.25o,"))
    for size in (1, 40, 1000):
        monkeypatch.setattr(text, "PIECE", size)
        found = csv_table.read(path, wanted)
        np.testing.assert_array_equal(found.values, whole.values)
        np.testing.assert_array_equal(found.lines, whole.lines)
        assert [line for _, lines in text.read_text(path).pieces() for line in lines] == text.read_text(path).lines
        with pytest.raises(DataError, match=r"damaged\.csv:253:1: .*0\.25o"):
            csv_table.read(damaged, wanted)
