import subprocess
import sys

import numpy as np
import pytest

from scenarios.inputs.make_inputs import FOUR_POST, HEIGHTS, LEVELS
from scenarios.signals.bump import bump_shape
from scenarios.signals.four_post import MOTIONS, level_rms
from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.input_files import INPUT_FOLDER, find_input, shipped_inputs
from vehicle.signals.excitation.signal_file import read_signal

NAMES = [f"{name}.csv" for name in (*LEVELS, *HEIGHTS, *FOUR_POST)]


def test_the_script_makes_the_shipped_files_byte_for_byte(tmp_path):
    command = [sys.executable, "-m", "scenarios.inputs.make_inputs", "--output", str(tmp_path / "new")]
    done = subprocess.run(command, cwd=INPUT_FOLDER.parents[2], capture_output=True, text=True, check=True)
    assert "low.csv: RMS 1.060000e-04 m, 60 s" in done.stdout
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == sorted(NAMES) == shipped_inputs()
    for name in NAMES:
        assert (tmp_path / "new" / name).read_bytes() == (INPUT_FOLDER / name).read_bytes(), name


@pytest.mark.parametrize(("name", "rms"), [("low", 1.06e-4), ("mid", 3.17e-4), ("high", 5.25e-4)])
def test_random_inputs_read_without_notice_and_keep_their_rms(name, rms):
    signal = read_signal(find_input(f"{name}.csv"), wheel="fr")
    assert signal.notices == ()
    assert signal.wheels == ("fr",)
    assert signal.duration == 60.0
    assert signal.timestep == 1e-3
    # 7 digits per sample; as promised in the file
    validated(
        "Published cars", f"RMS of the shipped input {name}", signal.rms("fr"), rms, rel=1e-6, unit="m",
        source="publication: Bommer 2006, levels of the shaker",
    )  # fmt: skip
    assert signal.source == f"{name}.csv"
    assert signal.displacement["fr"][0] == 0.0


@pytest.mark.parametrize(("name", "height"), [("bump_1p5mm", 1.5e-3), ("bump_7p5mm", 7.5e-3)])
def test_bump_inputs_hold_the_bump_and_the_noise(name, height):
    signal = read_signal(find_input(f"{name}.csv"), wheel="fr")
    assert signal.notices == ()
    noise = signal.displacement["fr"] - bump_shape(signal.time, amplitude=height)
    outside = (signal.time <= 5.0) | (signal.time >= 5.0 + 1.0 / 3.0)
    assert np.std(noise[outside]) == pytest.approx(5e-5, rel=1e-6)  # 7 digits
    assert np.max(np.abs(noise)) < 2.5e-4  # 5 sigma: nothing else is in the file


@pytest.mark.parametrize("name", MOTIONS)
def test_four_post_inputs_are_one_noise_in_a_fixed_combination(name):
    signal = read_signal(find_input(f"{name}.csv"))
    assert signal.notices == () and signal.wheels == ("fr", "fl", "rr", "rl")
    assert (signal.duration, signal.timestep) == (60.0, 4e-3)
    for wheel, factor in MOTIONS[name].items():
        np.testing.assert_array_equal(signal.displacement[wheel], factor * signal.displacement["fr"])
        assert signal.rms(wheel) == pytest.approx(level_rms(), rel=1e-6)  # 7 digits
    # The four combinations are orthogonal: together they are all that four plates can do.
    table = np.array([list(factors.values()) for factors in MOTIONS.values()])
    np.testing.assert_array_equal(table @ table.T, 4.0 * np.eye(4))


def test_the_level_of_the_four_post_inputs_is_that_of_a_road_of_class_a():
    """The velocity PSD of ISO 8608 in space, (2 pi n)^2 Gd(n) = 6.3e-6 m for class A, times V, over the band."""
    velocity_psd = 6.3e-6 * 80.0 / 3.6
    displacement = velocity_psd / (2.0 * np.pi) ** 2 * (1.0 / 0.5 - 1.0 / 40.0)
    # the standard prints two digits
    validated(
        "Roads and excitation", "RMS of the four-post inputs, class A at 80 km/h", level_rms(), np.sqrt(displacement),
        rel=0.002, unit="m", source="standard: ISO 8608, velocity density 6.3e-6 m of class A",
    )  # fmt: skip


def test_the_plates_of_four_plates_are_unrelated():
    signal = read_signal(find_input("four_plates.csv"))
    assert signal.notices == ()
    related = np.corrcoef([signal.displacement[wheel] for wheel in signal.wheels])
    # Few lines near 0.5 Hz hold most of the displacement: some 10 degrees of freedom, 1 / sqrt(10).
    assert np.max(np.abs(related - np.eye(4))) < 0.4


@pytest.mark.parametrize("name", NAMES)
def test_files_are_small_and_say_what_they_are(name):
    path = INPUT_FOLDER / name
    assert path.stat().st_size < 1.8e6
    head = [line for line in path.read_text(encoding="utf-8").split("\n")[:8] if line.startswith("#")]
    text = " ".join(head)
    for word in ("seed", "Hz", "RMS", "z up", "python -m scenarios.inputs.make_inputs"):
        assert word in text


def test_a_path_as_given_comes_before_a_shipped_name(tmp_path, monkeypatch):
    own = tmp_path / "low.csv"
    own.write_text("x", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert find_input("low.csv").read_text(encoding="utf-8") == "x"
    assert find_input(own) == own
    assert find_input("mid.csv") == INPUT_FOLDER / "mid.csv"


def test_a_miss_lists_the_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ConfigurationError) as caught:
        find_input("lov.csv")
    assert str(caught.value) == (
        "input 'lov.csv' is neither a file nor a shipped input; did you mean low.csv? "
        "Give the path of a measurement file or one of: bump_1p5mm.csv, bump_7p5mm.csv, four_plates.csv, heave.csv, "
        "high.csv, low.csv, mid.csv, pitch.csv, roll.csv, warp.csv"
    )
    assert caught.value.exit_code == 2


@pytest.mark.parametrize("name", ["inputs/low.csv", "../inputs/low.csv"])
def test_a_path_is_no_shipped_name(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ConfigurationError, match="neither a file nor a shipped input"):
        find_input(name)


def test_a_folder_is_no_input(tmp_path):
    with pytest.raises(ConfigurationError, match="is not a file"):
        find_input(tmp_path)
