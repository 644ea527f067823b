"""`python -m vehicle spectra`: tables and pictures of one and two runs, a road, and what is refused."""

import csv

import numpy as np
import pytest

from vehicle.commands.spectra import main
from vehicle.runs.car import Car, Road
from vehicle.runs.output.saved_run import save_run
from vehicle.signals.analysis.seat_value import weighted_rms_of
from vehicle.signals.formats.units import STANDARD_GRAVITY as G
from vehicle.signals.records.record_spectra import record_spectra


def rows_of(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def sine_file(path, amplitude):
    time = np.arange(0.0, 20.0, 1e-3)
    z = amplitude * np.sin(2 * np.pi * 8.0 * time)
    np.savetxt(path, np.column_stack([time, z, z]), delimiter=",", comments="",
               header="time [s],seat_rail_acc_z [m/s2],tyre_fr_force_z [N]")  # fmt: skip
    return path


def test_two_files_of_sines_over_each_other(tmp_path, capsys):
    files = [sine_file(tmp_path / "one.csv", 1.0), sine_file(tmp_path / "two.csv", 2.0)]
    assert main([*map(str, files), "--output", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "8 Hz, 0.707 m/s2" in said and "8 Hz, 1.41 m/s2" in said and "seat_rail_acc_z Wk" in said
    bands = [row for row in rows_of(tmp_path / "out" / "third_octaves.csv") if row["midband [Hz]"] == "8"]
    assert [(row["run"], row["weighting"]) for row in bands] == [
        ("one.csv", ""), ("one.csv", "Wk"), ("two.csv", ""), ("two.csv", "Wk"),
    ]  # fmt: skip
    assert [float(row["RMS [m/s2]"]) for row in bands][::2] == pytest.approx(np.sqrt([0.5, 2.0]), rel=1e-5)
    assert (tmp_path / "out" / "spectra_seat_rail.png").stat().st_size > 20_000


def test_run_on_a_road(tmp_path, capsys):
    run = Car.load("sedan").run(Road("B", speed=80, duration=12, seed=2), engine="reduced")
    folder = save_run(run, tmp_path / "B")
    assert main([str(folder)]) == 0
    said = capsys.readouterr().out
    assert "road under fr: G(0.1 cycles/m)" in said and "class B of ISO 8608" in said
    assert (folder / "spectra_road.png").exists() and (folder / "spectra_knuckles.png").exists()
    last = [
        row
        for row in rows_of(folder / "spectra.csv")
        if (row["channel"], row["weighting"]) == ("seat_rail_acc_z", "Wk")
    ]
    # The record begins in motion, where the filter of the standard has been running; 10 s hold its settling, so the
    # spectrum, which has no beginning, agrees within a few per cent.
    weighted = weighted_rms_of(run.recording.timestep, [run[f"seat_rail_acc_{axis}"] for axis in "xyz"], skip=run.skip)
    assert float(last[-1]["cumulative RMS [m/s2]"]) == pytest.approx(weighted[2], rel=0.03)


def test_a_logger_in_g_with_names_of_its_own(tmp_path, capsys):
    """A record in g has the spectra of the same record in m/s2, under the names that it gets."""
    time = np.arange(0.0, 20.0, 2e-3)
    seat = np.sin(2 * np.pi * 8.0 * time) / G
    rows = [f"{t:.3f};{z:.6f};{3 * z:.6f}".replace(".", ",") for t, z in zip(time, seat, strict=True)]
    log = tmp_path / "log.txt"
    log.write_text("\n".join(["Logger 3000", "Zeit;Sitz z;Nabe z", "s;g;g", *rows]), encoding="utf-8")
    one = sine_file(tmp_path / "one.csv", 2.0)
    named = ["--channel", "seat_rail_acc_z=Sitz z"]
    assert main([str(one), str(log), *named, "--output", str(tmp_path / "two")]) == 0
    said = capsys.readouterr()
    assert "8 Hz, 0.707 m/s2" in said.out and "8 Hz, 1.41 m/s2" in said.out and "seat_rail_acc_z Wk" in said.out
    assert "seat_rail_acc_z: channel 1 'Sitz z' [g]" in said.err
    assert main([str(log), "--output", str(tmp_path / "all")]) == 0
    said = capsys.readouterr().out
    assert "Nabe z" in said and "8 Hz, 2.12 m/s2" in said


def test_jitter_of_the_first_stamps_moves_no_line(tmp_path):
    """The sampling rate is that of all samples: 1 kHz, with a first step 0.09 % too long."""
    time = np.append(0.0, 9e-7 + 1e-3 * np.arange(1, 8000))
    path = tmp_path / "jitter.csv"
    np.savetxt(path, np.column_stack([time, np.sin(2 * np.pi * 8.0 * time)]), delimiter=",", comments="", fmt="%.9g",
               header="time [s],seat_rail_acc_z [m/s2]")  # fmt: skip
    frequency = record_spectra(path).channels[0].frequency
    np.testing.assert_allclose(np.diff(frequency), 0.5, rtol=1e-6)


def test_a_table_of_a_run_in_g(tmp_path, capsys):
    time = np.arange(0.0, 20.0, 1e-3)
    path = tmp_path / "g.csv"
    np.savetxt(path, np.column_stack([time, np.sin(2 * np.pi * 8.0 * time) / G]), delimiter=",", comments="",
               header="time [s],seat_rail_acc_z [g]")  # fmt: skip
    assert main([str(path), "--output", str(tmp_path / "out")]) == 0
    assert "8 Hz, 0.707 m/s2" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--range", "5"], "--range 5: must be LOW:HIGH"),
        (["--range", "9:3"], "--range 9:3: must be LOW:HIGH [Hz]"),
        (["--channels", "seat_rail_acc_y"], "--channels 'seat_rail_acc_y' matches no channel"),
        (["--channels", "tyre_fr_force_z"], "tyre_fr_force_z is a force; spectra are of accelerations"),
    ],
)
def test_refused(tmp_path, capsys, arguments, said):
    assert main([str(sine_file(tmp_path / "one.csv", 1.0)), *arguments]) in (2, 3)
    assert said in capsys.readouterr().err
