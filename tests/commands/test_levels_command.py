"""`vehicle levels`: its files, its cut, its printed numbers, and bad options."""

import json

import numpy as np
import pytest

from vehicle import Car
from vehicle.__main__ import main
from vehicle.commands.levels import cut_frequency, numbers
from vehicle.errors import ConfigurationError

OPTIONS = [
    "--plates",
    "fl",
    "--frequency",
    "2:8:14",
    "--level",
    "0.02:5:6",
    "--channels",
    "seat rail z,knuckle_fl_acc_z",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("levels") / "levels"
    assert main(["levels", "focus", *OPTIONS, "--at", "3.7 Hz", "--output", str(path), "--quiet"]) == 0
    return path


def test_the_files_have_the_numbers_of_python(folder):
    states = Car.load("focus").levels(
        plates="fl", frequency=np.geomspace(2, 8, 14), level=1e-3 * np.geomspace(0.02, 5, 6),
        channels=["seat_rail_acc_z", "knuckle_fl_acc_z"],
    )  # fmt: skip
    text = (folder / "chart.csv").read_text(encoding="utf-8").splitlines()
    heads = text[1].split(",")
    table = np.genfromtxt(text[2:], delimiter=",").reshape(14, 6, -1)
    column = dict(zip(heads, np.moveaxis(table, -1, 0), strict=True))
    np.testing.assert_allclose(column["level [mm]"], np.tile(1e3 * states.level, (14, 1)), rtol=1e-6)
    np.testing.assert_allclose(column["knuckle_fl_acc_z FRF [(m/s2)/m]"], abs(states.frf[1]), rtol=1e-6)
    np.testing.assert_allclose(column["seat_rail_acc_z RMS [m/s2]"], states.rms[0], rtol=1e-6)
    energy = states.energy[states.dampers.index("damper_fl")]
    np.testing.assert_allclose(column["damper_fl energy per cycle [J]"], energy, rtol=1e-6)
    slips = np.genfromtxt((folder / "slip.csv").read_text(encoding="utf-8").splitlines()[2:], delimiter=",")
    np.testing.assert_allclose(slips[:, 1:], 1e3 * states.unsticking.T, rtol=1e-6)


def test_the_summary_names_first_slip_peak_and_mode(folder):
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert summary["points"] == 84 and summary["without_result"] == 0 and all(summary["only_one_state_proven"])
    assert set(summary["first_slip"]) == {"damper_fr", "damper_fl"}
    first, last = summary["peak"][0], summary["peak"][-1]
    assert 3.5 < first["frequency_hz"] < 3.9 and first["damping_ratio"] < 0.1 < last["damping_ratio"]
    assert {*summary["files"]} == {path.name for path in folder.iterdir() if not path.name.startswith(".")}
    assert {"levels.svg", "levels_knuckle_fl_acc_z.svg", "damping.svg", "cut_3.7Hz.csv"} <= {*summary["files"]}


def test_the_pictures_name_what_they_show(folder):
    drawn = (folder / "levels.svg").read_text(encoding="utf-8")
    for text in ("plate of the left front wheel", "left damper begins to slip", "peaks of the FRF", "frequency [Hz]"):
        assert text in drawn


def test_a_single_point_and_no_pictures(tmp_path, capsys):
    words = ["levels", "focus", "--frequency", "5", "--level", "1", "--no-figures", "--output", str(tmp_path / "one")]
    assert main(words) == 0
    assert "results: 1 of 1 points" in capsys.readouterr().out
    assert not list((tmp_path / "one").glob("*.svg"))


def test_numbers():
    np.testing.assert_allclose(numbers("--level", "0.1:10:3", "mm"), [0.1, 1.0, 10.0])
    np.testing.assert_allclose(numbers("--level", "1,3", "mm"), [1.0, 3.0])
    assert cut_frequency(" 3.7 Hz ") == 3.7
    for text in ("1:30", "30:1:9", "1:30:1", "0:30:4", "a", "1:3:2.5"):
        with pytest.raises(ConfigurationError, match="must be LOW:HIGH:N"):
            numbers("--level", text, "mm")
    for text in ("fast", "0 Hz", "3.7 kHz"):
        with pytest.raises(ConfigurationError, match="must be a frequency above 0"):
            cut_frequency(text)
