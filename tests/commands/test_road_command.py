"""Roads as files: class and speed, measured profiles, what the shaker reads of them."""

import numpy as np
import pytest

from vehicle.commands.road import main
from vehicle.digits import number
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.analysis.roughness_index import roughness_index
from vehicle.signals.excitation.iso_road import IsoRoad, Side
from vehicle.signals.excitation.signal_file import read_signal

SIDES: tuple[Side, ...] = ("left", "right")


def test_a_class_and_a_speed_make_a_signal_that_is_read_back(tmp_path, capsys):
    file = tmp_path / "road.csv"
    arguments = ["--class", "c", "--speed", "80", "--duration", "10", "--output", str(file)]
    assert main(arguments) == 0
    said = capsys.readouterr().out
    assert "G(0.1 cycles/m) = 0.000256 m3" in said and "80 km/h" in said and "10 s" in said
    signal = read_signal(file, accept_implausible=True)
    assert signal.wheels == ("fr", "fl") and signal.duration == pytest.approx(10.0)
    first = file.read_bytes()
    assert main(arguments) == 2 and "exists; give --force" in capsys.readouterr().err
    assert main([*arguments, "--force"]) == 0
    assert file.read_bytes() == first
    assert main([*arguments, "--force", "--seed", "2"]) == 0
    assert file.read_bytes() != first


def test_a_measured_profile_is_met_at_the_speed(tmp_path):
    """A sine of 4 m under the right wheels, half as high under the left: 5 Hz at 20 m/s."""
    distance = np.arange(0.0, 100.0, 0.05)
    right = 0.01 * np.sin(2.0 * np.pi * distance / 4.0) + 0.3
    rows = np.column_stack([distance, 500.0 * (right - 0.3), right])
    profile = tmp_path / "profile.csv"
    np.savetxt(profile, rows, delimiter=",", header="distance [m],left [mm],right [m]", comments="", fmt="%.9g")
    file = tmp_path / "road.csv"
    assert main(["--profile", str(profile), "--speed", "72", "--patch", "0", "--output", str(file), "--quiet"]) == 0
    signal = read_signal(file, accept_implausible=True)
    assert signal.duration == pytest.approx(4.997, abs=2e-3)
    late = signal.time > 1.0
    wave = 0.01 * np.sin(2.0 * np.pi * 5.0 * signal.time[late])
    # Seven digits in the file, a spline through 80 points a wave.
    np.testing.assert_allclose(signal.displacement["fr"][late], wave, atol=1e-8)
    np.testing.assert_allclose(signal.displacement["fl"][late], 0.5 * wave, atol=1e-8)


def test_the_file_holds_the_road_beside_what_the_tyre_takes(tmp_path, capsys):
    file = tmp_path / "cleat.csv"
    arguments = ["--obstacle", "cleat:20x50:right@15", "--speed", "36", "--output", str(file)]
    assert main(["--vehicle", "sedan", *arguments]) == 0
    assert (tmp_path / "cleat.png").is_file()
    table = np.genfromtxt(file, delimiter=",", names=True, deletechars="", skip_header=3)
    distance = 10.0 * table["time_[s]"]
    on = (distance > 15.0 + 2e-6) & (distance < 15.05 - 2e-6)
    assert on.sum() == 4
    np.testing.assert_allclose(table["road_fr_[m]"], np.where(on, 0.02, 0.0), atol=1e-9)
    assert not np.any(table["road_fl_[m]"]) and not np.any(table["slope_fl_[-]"])
    # The tyre is lifted before and behind the cleat: up the slope, then down it.
    felt = distance[table["displacement_fr_[m]"] > 1e-4]
    assert felt[0] < 14.9 and felt[-1] > 15.15
    slope = table["slope_fr_[-]"]
    assert np.sum(slope) == pytest.approx(0.0, abs=1e-3 * np.sum(np.abs(slope)))
    assert distance[np.argmax(slope)] < 15.0 and distance[np.argmin(slope)] > 15.05 and 0.1 < slope.max() < 0.4
    # It drives plates like any other file.
    np.testing.assert_allclose(
        read_signal(file, accept_implausible=True).displacement["fr"], table["displacement_fr_[m]"], atol=1e-9
    )
    assert main(["--vehicle", "sedan", *arguments, "--no-figures"]) == 2
    (tmp_path / "cleat.csv").unlink()
    assert main(["--vehicle", "sedan", *arguments]) == 2
    assert "cleat.png" in capsys.readouterr().err
    assert main(["--vehicle", "sedan", *arguments, "--no-figures"]) == 0


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["--speed", "80"], 2, "one of --class, --profile and --obstacle"),
        (["--road", "B", "--speed", "80"], 2, "use --class B, --profile FILE.csv or --obstacle cleat:20x50"),
        (["--class", "A"], 2, "the speed on the road is missing"),
        (["--class", "K", "--speed", "80"], 2, "road class 'K': must be one of A, B"),
        (["--class", "A", "--speed", "0"], 2, "--speed 0 km/h: must be above 0"),
        (["--class", "A", "--speed", "nan"], 2, "--speed nan km/h"),
        (["--class", "A", "--speed", "80", "--coherence", "2"], 2, "--coherence 2: must be 0 to 1"),
        (["--profile", "missing.csv", "--speed", "80"], 2, "missing.csv"),
        (
            ["--profile", "p.csv", "--speed", "80", "--duration", "9"],
            3,
            ("the road is 30 m long, but the car drives 200 m"),
        ),
        (["--profile", "q.csv", "--speed", "80"], 3, "q.csv:4: the distance must increase"),
        (["--profile", "r.csv", "--speed", "80"], 3, "r.csv:1: found 'distance [m]', 'left [m]', must be 'distance"),
    ],
)
def test_refusals(arguments, code, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    head = "distance [m],left [m],right [m]\n"
    (tmp_path / "p.csv").write_text(head + "".join(f"{x},{0.01 * (x % 2)},0\n" for x in range(31)), encoding="utf-8")
    (tmp_path / "q.csv").write_text(head + "0,0,0\n1,0,0\n0.5,0,0\n2,0,0\n3,0,0\n", encoding="utf-8")
    (tmp_path / "r.csv").write_text("distance [m],left [m]\n0,0\n1,0\n", encoding="utf-8")
    assert main(arguments) == code
    assert message in capsys.readouterr().err
    assert not (tmp_path / "road.csv").exists()


def test_the_index_of_a_short_drive_names_its_length(tmp_path, capsys):
    arguments = ["--class", "B", "--speed", "36", "--duration", "5", "--output", str(tmp_path / "a.csv")]
    assert main([*arguments, "--no-figures", "--iri"]) == 0
    assert " m/km over the 30 m of the road" in capsys.readouterr().out


def test_roughness_index_of_a_profile(tmp_path, capsys):
    """The file of a profile is rated at its own points, whatever the speed; the table holds every 100 m."""
    distance = np.arange(1001) * 0.25
    tracks = [IsoRoad(level=CLASSES["B"], seed=2, track=1.5).height(0.0, 0.25, 1001, side, 1.6) for side in SIDES]
    profile = tmp_path / "profile.csv"
    rows = np.column_stack([distance, *tracks])
    np.savetxt(profile, rows, delimiter=",", header="distance [m],left [m],right [m]", comments="", fmt="%.9g")
    for speed in ("60", "120"):
        file = tmp_path / f"at_{speed}.csv"
        arguments = ["--profile", str(profile), "--speed", speed, "--output", str(file), "--no-figures", "--iri"]
        assert main(arguments) == 0
        said = capsys.readouterr().out
        table = np.genfromtxt(tmp_path / f"at_{speed}_iri.csv", delimiter=",", names=True, skip_header=1)
        assert table["from_m"].tolist() == [0.0, 100.0, 200.0]
        for side, height in zip(SIDES, tracks, strict=True):
            # The drive ends up to one step of the plates, 1 ms, before the last point.
            expected = roughness_index(0.25, height - height[0])
            np.testing.assert_allclose(table[f"iri_{side}_mkm"], expected.segments, rtol=1e-5)
            assert f"IRI of the {side} track: {number(expected.overall)} m/km" in said
        assert "class B of ISO 8608" in said
