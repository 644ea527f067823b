"""`python -m vehicle loads`: the files of a run with loads, and what is refused."""

import csv

import numpy as np
import pytest

from vehicle.commands.loads import main
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.recorded_channels import recorded_channels
from vehicle.signals.analysis.load_spectrum import load_spectrum


def rows_of(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


@pytest.fixture
def folder(tmp_path):
    """A run of 10 s with a sine of 300 N at 1 Hz about 4000 N."""
    time = np.arange(0.0, 10.0005, 1e-3)
    load, travel = 4000.0 + 300.0 * np.sin(2 * np.pi * time), 0.01 * np.cos(2 * np.pi * time)
    heads = "time [s],tyre_fr_force_z [N],suspension_travel_fr [m],seat_rail_acc_z [m/s2]"
    columns = np.column_stack([time, load, travel, load])
    np.savetxt(tmp_path / "time.csv", columns, delimiter=",", header=heads, comments="")
    return tmp_path


def test_files_of_a_sine(folder, capsys):
    pytest.importorskip("rainflow")
    assert main([str(folder), "--slope", "4", "--classes", "8"]) == 0
    assert "tyre_fr_force_z" in capsys.readouterr().out
    tyre, travel = rows_of(folder / "loads.csv")
    assert (tyre["channel"], tyre["unit"], travel["channel"]) == ("tyre_fr_force_z", "N", "suspension_travel_fr")
    assert float(tyre["maximum"]) == pytest.approx(4300.0) and float(tyre["minimum"]) == pytest.approx(3700.0)
    assert float(tyre["rms"]) == pytest.approx(np.hypot(4000.0, 300.0 / np.sqrt(2.0)), rel=1e-4)
    # One cycle a second is its own equivalent; the two ends of the record count by halves, of half the range.
    assert float(tyre["equivalent_amplitude"]) == pytest.approx(300.0, rel=2e-2)
    spectrum = [row for row in rows_of(folder / "load_spectra.csv") if row["channel"] == "tyre_fr_force_z"]
    assert len(spectrum) == 8 and float(spectrum[-1]["range_up_to"]) == pytest.approx(600.0)
    assert float(spectrum[-1]["cycles"]) == pytest.approx(9.5, abs=0.5)
    assert float(spectrum[0]["cycles_of_this_range_or_more"]) == pytest.approx(float(tyre["cycles"]))
    assert (folder / "loads.png").stat().st_size > 10_000
    # Once more beside the first ones, or with --force in their place.
    assert main([str(folder)]) == 0
    said = capsys.readouterr()
    assert "loads.csv exists; writing " in said.err and "loads-2.csv, load_spectra-2.csv" in said.out
    assert all((folder / name).exists() for name in ("loads-2.csv", "load_spectra-2.csv", "loads-2.png"))
    assert main([str(folder), "--output", str(folder)]) == 2 and "give --force" in capsys.readouterr().err
    assert main([str(folder), "--force", "--quiet"]) == 0
    assert float(rows_of(folder / "loads.csv")[0]["equivalent_amplitude"]) == pytest.approx(300.0, rel=2e-2)


def test_a_class_holds_its_upper_edge():
    pytest.importorskip("rainflow")
    found = load_spectrum("a", "N", np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]), slope=1, duration=1)
    edges, counts = found.classes(3)
    assert edges.tolist() == [0.0, 3.0, 6.0, 9.0] and counts.tolist() == [0.5, 2.0, 1.5]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--slope", "0"], "--slope 0: must be at least 1"),
        (["--classes", "0"], "--classes 0: must be 1 to 10000"),
        (["--channels", "tyre_fr"], "has no channel 'tyre_fr'; choose from tyre_fr_force_z"),
    ],
)
def test_bad_options(folder, capsys, arguments, said):
    assert main([str(folder), *arguments]) == 2
    assert said in capsys.readouterr().err


def test_bad_runs(folder, capsys, monkeypatch):
    (folder / "empty").mkdir()
    assert main([str(folder / "empty")]) == 2
    assert "contains no time.npz or time.csv" in capsys.readouterr().err
    (folder / "loads.csv").write_text("mine")
    assert main([str(folder), "--force"]) == 2
    assert "was not written by this program, or was changed since" in capsys.readouterr().err
    (folder / "loads.csv").unlink()
    monkeypatch.setitem(__import__("sys").modules, "rainflow", None)
    assert main([str(folder)]) == 5
    assert "the Python package rainflow is missing" in capsys.readouterr().err
    assert not (folder / "loads.csv").exists()


def test_channels_of_a_run(car):
    default, more = car.vehicle.channels, car.vehicle.load_channels
    assert recorded_channels("loads", car.vehicle) == recorded_channels("all", car.vehicle) == (*default, *more)
    assert recorded_channels("main_spring_fr_force, seat_rail_acc_z", car.vehicle) == (*default, "main_spring_fr_force")
    with pytest.raises(ConfigurationError, match=r"no channel 'main_spring_force'; .* did you mean main_spring_f"):
        recorded_channels("main_spring_force", car.vehicle)


def sine(folder, amplitude, duration):
    """A run with a sine of 1 Hz about 4000 N that begins and ends at its mean."""
    folder.mkdir()
    time = np.arange(0.0, duration + 0.0005, 1e-3)
    load = 4000.0 + amplitude * np.sin(2 * np.pi * time)
    np.savetxt(folder / "time.csv", np.column_stack([time, load]), delimiter=",", comments="",
               header="time [s],tyre_fr_force_z [N]")  # fmt: skip
    return str(folder)


def test_damage_of_a_schedule(tmp_path, capsys, monkeypatch):
    """Sines of 300 and 600 N: with slope 5 a cycle of the larger does the damage of 32 of the smaller."""
    pytest.importorskip("rainflow")
    monkeypatch.chdir(tmp_path)
    small, large = sine(tmp_path / "small", 300.0, 100.0), sine(tmp_path / "large", 600.0, 50.0)
    assert main([small, large, "--repeats", "32,2", "--slope", "5", "--reference-run", small]) == 0
    (row,) = rows_of(tmp_path / "schedule.csv")
    # 3200 cycles of the smaller and 100 of the larger do the same damage; the ends of a record count by halves.
    assert float(row["share of small [-]"]) == pytest.approx(0.5, abs=0.01)
    assert float(row["damage_ratio [-]"]) == pytest.approx(64.0, rel=0.02)
    equivalent = (2.0 * 3200.0 * 300.0**5 / 3300.0) ** 0.2
    assert float(row["equivalent_amplitude"]) == pytest.approx(equivalent, rel=0.01)
    assert "32 x small, 2 x large" in capsys.readouterr().out
    assert main([small, "--repeats", "3", "--output", "once", "--quiet"]) == 0
    assert float(rows_of(tmp_path / "once" / "schedule.csv")[0]["share of small [-]"]) == 1.0
    for words, message in (
        ([small, large, "--repeats", "3"], "--repeats: 1 numbers for 2 runs"),
        ([small, large, "--repeats", "3,0"], "give a number above 0 for each run"),
        ([small, large, "--repeats", "3,many"], "--repeats 3,many: must be numbers"),
    ):
        assert main([*words, "--output", "wrong"]) == 2
        assert message in capsys.readouterr().err
