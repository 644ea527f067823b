"""`vehicle levels`: its files, its cut, its printed numbers, and bad options."""

import json

import numpy as np
import pytest

from vehicle import Car
from vehicle.__main__ import main
from vehicle.commands.levels import cut_frequency, levels_of, numbers
from vehicle.drawing.rendering.level_plot import plot_level_map
from vehicle.errors import ConfigurationError
from vehicle.runs.output.level_files import LevelReport

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
    assert {"levels.png", "levels_knuckle_fl_acc_z.png", "damping.png", "cut_3.7Hz.csv"} <= {*summary["files"]}


def test_the_pictures_name_what_they_show(folder, tmp_path):
    assert (folder / "levels.png").read_bytes().startswith(b"\x89PNG")
    frequency, level = np.geomspace(2, 8, 14), 1e-3 * np.geomspace(0.02, 5, 6)
    report = LevelReport(Car.load("focus").levels(plates="fl", frequency=frequency, level=level))
    plot_level_map(tmp_path / "levels.svg", report.picture(0), report.rows, report.states.driven.words, "")
    drawn = (tmp_path / "levels.svg").read_text(encoding="utf-8")
    for text in ("plate of the left front wheel", "left damper begins to slip", "peaks of the FRF", "frequency [Hz]"):
        assert text in drawn


def test_a_single_point_and_no_pictures(tmp_path, capsys):
    words = ["levels", "focus", "--frequency", "5", "--level", "1", "--no-figures", "--output", str(tmp_path / "one")]
    assert main(words) == 0
    assert "results: 1 of 1 points" in capsys.readouterr().out
    assert not list((tmp_path / "one").glob("*.png"))


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


def test_a_random_input_has_its_own_files(tmp_path, capsys):
    words = ["levels", "focus", "--random", "flat", "--realisations", "4", "--level", "0.4,4"]
    assert main([*words, "--plates", "fl", "--output", str(tmp_path / "random")]) == 0
    states = Car.load("focus").random_levels(level=[4e-4, 4e-3], plates="fl", realisations=4)
    text = (tmp_path / "random" / "random.csv").read_text(encoding="utf-8").splitlines()
    column = dict(zip(text[1].split(","), np.genfromtxt(text[2:], delimiter=",").T, strict=True))
    for name, expected in (
        ("FRF [(m/s2)/m]", abs(states.frf[0])),
        ("distortion [%]", 100.0 * states.distortion[0]),
        ("linearised FRF [(m/s2)/m]", abs(states.linearised[0])),
    ):
        np.testing.assert_allclose(column[f"seat_rail_acc_z {name}"], expected.T.ravel(), rtol=1e-6)
    assert (tmp_path / "random" / "random.png").exists()
    summary = json.loads((tmp_path / "random" / "summary.json").read_text(encoding="utf-8"))
    np.testing.assert_allclose(summary["rms"]["seat_rail_acc_z"], states.mean_rms[0][0])
    assert "0.4" in capsys.readouterr().out


def test_levels_have_units():
    values, unit = levels_of("0.1:10:3 m/s2", force=False)
    np.testing.assert_allclose(values, [0.1, 1.0, 10.0])
    assert unit == "m/s2" and levels_of("1,2", force=True)[1] is None
    values, unit = levels_of("1,2 mm", force=False)
    np.testing.assert_allclose(values, [1e-3, 2e-3])
    with pytest.raises(ConfigurationError, match="unit 'inch', must be mm"):
        levels_of("1,2 inch", force=False)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["--at", "3"], "--random: --at belongs to sinusoidal inputs"),
        (["--frequency", "2:8:9"], "--random: --frequency belongs to sinusoidal inputs"),
        (["--level", "1,2 m/s2"], "--random: --level in m/s2 belongs to sinusoidal inputs"),
        (["--applied-force", "pull"], "--random: --applied-force belongs to sinusoidal inputs"),
    ],
)
def test_a_random_input_refuses_what_belongs_to_sines(more, message, capsys):
    assert main(["levels", "focus", "--random", "flat", *more]) == 2
    assert message in capsys.readouterr().err


def test_realisations_belong_to_a_random_input(capsys):
    assert main(["levels", "focus", "--realisations", "5"]) == 2
    assert "add --random flat" in capsys.readouterr().err
