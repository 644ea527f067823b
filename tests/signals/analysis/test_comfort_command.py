import json
import subprocess
import sys

import numpy as np
import pytest

from tests.patience import HANG
from vehicle.commands.comfort import main
from vehicle.signals.analysis.weighting import weighted_record, weighting


@pytest.fixture
def ride(tmp_path):
    """A file of 60 s at 500 Hz: z a unit sine of 8 Hz about the offset given, x and y smaller sines."""

    def written(offset=0.0):
        time = np.arange(30_000) * 2e-3
        sine = np.sin(2 * np.pi * 8.0 * time)
        return table(tmp_path / "ride.csv", time, 0.1 * sine, 0.2 * sine, sine + offset)

    return written


def table(path, *columns):
    head = "time [s],x [m/s2],y [m/s2],z [m/s2]"
    np.savetxt(path, np.column_stack(columns), fmt="%.8f", delimiter=",", header=head, comments="")
    return str(path)


def test_json_holds_the_measures_of_each_axis(ride, capsys):
    assert main(["--input", ride(), "--json"]) == 0
    out, err = capsys.readouterr()
    found, said = json.loads(out), err.splitlines()
    assert [line.split()[1:3] for line in said[:3]] == [[f"{axis}:", "MTVV"] for axis in "xyz"]
    assert len(said) == 4 and "(msdv)" in said[3] and "6.0 periods of 0.1 Hz" in said[3] and "240 s" in said[3]
    for axis, name in zip("xyz", ("Wd", "Wd", "Wk"), strict=True):
        assert found[axis]["weighting"] == name
        assert {"weighted_rms", "mtvv", "crest_factor", "vdv", "msdv"} <= set(found[axis])
        assert all(np.isfinite(found[axis][key]) for key in ("weighted_rms", "mtvv", "crest_factor", "vdv", "msdv"))
    assert found["z"]["vdv"] == pytest.approx(2.257, abs=0.0005)
    assert set(found["vector_sum"]) == {"weighted_rms", "vdv", "health_weighted_rms"}
    assert found["offset"]["treatment"] == "kept"


def test_channels_that_were_copied_and_a_clipped_sensor_are_named(ride, tmp_path, capsys):
    """The crest factor is the peak over the RMS of the same, settled part."""
    time = np.arange(12_000) * 1e-3
    rough = np.cumsum(np.random.default_rng(3).standard_normal((2, 12_000)), axis=1)
    rough = 0.1 * (rough - np.apply_along_axis(np.convolve, 1, rough, np.ones(400) / 400.0, "same"))
    path = table(tmp_path / "copied.csv", time, rough[0], np.clip(rough[1], -0.6, 0.6), rough[0])
    assert main(["--input", path, "--json"]) == 0
    out, err = capsys.readouterr()
    assert "x and z" in err and "--channel z=NAME" in err
    assert "y: clipped?" in err and "x: clipped" not in err and "constant" not in err
    found = json.loads(out)["z"]
    weighted = weighted_record(1e-3, np.round(rough[0], 8), "Wk")
    settled = weighted[round(weighting("Wk").settling_s / 1e-3) :]
    expected = np.abs(settled).max() / np.sqrt(np.mean(settled**2))
    assert found["crest_factor"] == pytest.approx(expected, rel=1e-6)


def test_the_table_shows_the_values_of_json(ride, capsys):
    assert main(["--input", ride(), "--mtvv", "exponential"]) == 0
    out, _ = capsys.readouterr()
    assert "weighting                 Wd          Wd          Wk" in out
    title, x, y, z, unit = out.splitlines()[6].split()
    assert (title, z, unit) == ("VDV", "2.257", "m/s^1.75")
    # steady state of the sines; the switching-on adds a thousandth
    dose = weighting("Wd").spectrum_factor(8.0) * (3 / 8 * 60) ** 0.25
    assert [float(x), float(y)] == pytest.approx([0.1 * dose, 0.2 * dose], rel=3e-3)


def test_the_running_average_follows_its_option(ride, capsys):
    path = ride()
    found = {}
    for average in ("linear", "exponential"):
        assert main(["--input", path, "--json", "--mtvv", average]) == 0
        found[average] = json.loads(capsys.readouterr().out)
        assert found[average]["running_average"] == average
    # of a steady sine the exponential average ripples at twice 8 Hz, 1 / (2 * 2 pi 16) = 0.5 % in RMS; the linear one
    # holds whole periods
    assert 1.002 < found["exponential"]["z"]["mtvv"] / (np.sqrt(0.5) * weighting("Wk").spectrum_factor(8.0)) < 1.02
    assert found["exponential"]["z"]["mtvv"] != found["linear"]["z"]["mtvv"]


def test_gravity_is_rejected_without_the_offset_option(ride, capsys):
    path = ride(offset=9.81)
    assert main(["--input", path, "--json"]) == 3
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"error: {path}: z: ") and "9.81 m/s2" in err and "--detrend" in err and err.count("\n") == 1
    assert main(["--input", path, "--json", "--offset", "remove"]) == 0
    removed = json.loads(capsys.readouterr().out)
    assert removed["z"]["vdv"] == pytest.approx(2.257, abs=0.0005)
    assert removed["offset"]["treatment"] == "removed"
    assert removed["offset"]["mean"] == pytest.approx({"x": 0, "y": 0, "z": 9.81}, abs=1e-9)
    assert main(["--input", path, "--json", "--offset", "keep"]) == 0
    assert json.loads(capsys.readouterr().out)["z"]["vdv"] > 3.0


def test_bad_data_exits_3_and_a_bad_path_2(tmp_path, capsys):
    path = tmp_path / "bad.csv"
    path.write_text("time [s],x [m/s2],y [m/s2],z [m/s2]\n0,0,0,0\n0.001,0,nan,0\n0.002,0,0,0\n")
    for words, status, said in (
        ([path], 3, f"error: {path}:3:3: column 'y [m/s2]' is 'nan'"),
        ([tmp_path / "nix.csv"], 2, f"error: {tmp_path / 'nix.csv'}: "),
        ([path, "--place", "sofa"], 2, "not 'sofa'"),
    ):
        assert main(["--input", *map(str, words)]) == status
        out, err = capsys.readouterr()
        assert out == "" and said in err and err.count("\n") == 1


def test_the_module_runs_as_a_command_and_a_closed_pipe_is_quiet(ride):
    command = [sys.executable, "-m", "vehicle.comfort", "--input", ride(), "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()  # nobody reads: what `| head -0` does
        assert "Error" not in process.stderr.read()
        assert process.wait(timeout=HANG) == 6
