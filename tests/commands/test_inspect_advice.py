"""`inspect` prints a command that runs as printed; several files give one table."""

import json
import shlex

import numpy as np
import pytest

from tests.advice import run_advice
from vehicle.commands.comfort import main as comfort
from vehicle.commands.inspect import main as inspect
from vehicle.signals.formats.channel import Channel
from vehicle.signals.records.channel_words import axis_of, suggested_channels, wheel_of


@pytest.mark.parametrize(
    ("name", "wheel"),
    [
        *(("Shaker FR", "fr"), ("Weg_VL", "fl"), ("HR", "rr"), ("plate hl", "rl"), ("LF disp", "fl"), ("RF", "fr")),
        *(("front right", "fr"), ("Rear_Left_Z", "rl"), ("Stempel hinten links", "rl"), ("vorne rechts", "fr")),
        *(("frontRight", "fr"), ("displacement_rr", "rr"), ("LR", "rl"), ("displacement", ""), ("front", "")),
        *(("FRF", ""), ("speed", ""), ("height", ""), ("vr1", "fr")),
    ],
)
def test_names_tell_the_wheel(name, wheel):
    assert wheel_of(name) == wheel


@pytest.mark.parametrize(
    ("name", "direction", "axis"),
    [("AccZ", "", "z"), ("Seat lateral", "", "y"), ("a_x", "", "x"), ("Dof 3", "+Z", "z"), ("oil", "", "")],
)
def test_names_tell_the_axis(name, direction, axis):
    assert axis_of(Channel(name=name, values=np.zeros(3), direction=direction)) == axis


def test_names_and_units_suggest_model_channels():
    names = {
        "Stempel VL": ("mm", "plate_fl_displacement"),
        "Federweg VL": ("mm", None),
        "Radträger VL z": ("g", "knuckle_fl_acc_z"),
        "Hub RR vertical": ("m/s2", "knuckle_rr_acc_z"),
        "Sitzschiene z": ("m/s²", "seat_rail_acc_z"),
        "seat Z": ("g", "seat_acc_z"),
        "Motor x": ("g", "engine_acc_x"),
        "Roof z": ("g", None),
        "Wheel FL z": ("mm/s", None),
    }
    channels = [Channel(name=name, values=np.zeros(3), unit=unit) for name, (unit, _) in names.items()]
    expected = {model: name for name, (_, model) in names.items() if model}
    assert suggested_channels(channels) == expected
    assert suggested_channels(channels, ["engine_acc_x"]) == {"engine_acc_x": "Motor x"}


def test_plate_and_accelerations_of_one_file_give_the_comparison(tmp_path, capsys):
    time = np.arange(4800) / 400.0
    columns = [("Shaker FL", "mm", sine(time, 1.0, 2.0)), ("Hub FL z", "g", sine(time, 0.1, 2.0))]
    written(tmp_path / "a.csv", time, columns)
    assert inspect([str(tmp_path / "a.csv")]) == 0
    line = capsys.readouterr().out.splitlines()[-1]
    assert line.startswith("  python -m vehicle compare RUN --measured ")
    assert line.endswith(" --map 'plate_fl_displacement=Shaker FL' --map 'knuckle_fl_acc_z=Hub FL z'")


def test_the_comparison_of_a_file_of_many_channels_is_short(tmp_path, capsys):
    """Of 61 channels 25 fit the car; the command has plates and vertical accelerations, and runs."""
    time = np.arange(3600) / 400.0
    points = [*(f"Hub {wheel}" for wheel in ("VL", "VR", "HL", "HR")), "Motor", "Fahrersitz", "Sitzschiene"]
    names = [f"Stempel {wheel}" for wheel in ("VL", "VR", "HL", "HR")] + [
        f"{point} {axis}" for point in points for axis in "xyz"
    ]
    columns = [(name, "mm" if "Stempel" in name else "g", sine(time, 0.1, 2.0 + k)) for k, name in enumerate(names)]
    columns += [(f"Spare {number}", "V", time) for number in range(61 - len(columns))]
    written(tmp_path / "a.csv", time, columns)
    assert inspect([str(tmp_path / "a.csv")]) == 0
    head, line = capsys.readouterr().out.splitlines()[-2:]
    assert head.endswith("`tune` accepts the same --map); 15 more channels fit, --json lists them:")
    mapped = [word.split("=") for word in shlex.split(line) if "=" in word]
    assert len(mapped) == 10 and sum(model.startswith("plate_") for model, _ in mapped) == 4
    assert {name.removesuffix(" z") for model, name in mapped if model.endswith("_z")} == {*points} - {"Motor"}
    assert run_advice(tmp_path / "a.csv", tmp_path) == ["shaker", "compare"]
    assert inspect([str(tmp_path / "a.csv"), "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["comparison_left_out"]) == 15


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("Radträger VL z", "Sitzschiene z", "Sitzschiene y"), "'y=Sitzschiene y' --channel 'z=Sitzschiene z'"),
        (("Hub FL z", "Roof x", "Floor z", "Floor y"), "'y=Floor y' --channel 'z=Floor z'"),
        (("Fahrersitz z", "Beifahrersitz z"), "--channel 'z=Fahrersitz z' --"),
        (("Hub FL z", "Motor z"), "no command: accelerations of wheels or engine"),
    ],
)
def test_comfort_is_that_of_one_point_on_which_someone_sits(names, words, tmp_path, capsys):
    time = np.arange(4800) / 400.0
    path = tmp_path / "log.csv"
    written(path, time, [(name, "g", sine(time, 0.1, 2.0 + number)) for number, name in enumerate(names)])
    assert inspect([str(path)]) == 0
    assert words in capsys.readouterr().out


def written(path, time, columns):
    heads = ",".join(["time [s]", *(f"{name} [{unit}]" for name, unit, _ in columns)])
    table = np.column_stack([time, *(values for *_, values in columns)])
    np.savetxt(path, table, fmt="%.8g", delimiter=",", header=heads, comments="")


def jittered(seconds=12.0, rate=400.0):
    rng = np.random.default_rng(2)
    return np.arange(int(seconds * rate)) / rate + rng.uniform(0.0, 0.01, int(seconds * rate)) / rate


def sine(time, amplitude, frequency):
    return amplitude * np.sin(2 * np.pi * frequency * time) * np.clip(time, 0.0, 1.0)


def case(folder, kind):
    """A file of a kind, with what its command must hold."""
    path = folder / f"{kind} 1.csv"
    time = np.arange(4800) / 400.0
    late = time - 0.2
    if kind == "plates":
        noise = np.random.default_rng(1).standard_normal((2, time.size)).cumsum(axis=1)
        noise = 0.3 * (noise - noise.mean(axis=1, keepdims=True)) / noise.std(axis=1, keepdims=True)
        written(path, time, [("Oil", "V", time), ("Stempel VR", "mm", noise[0]), ("Stempel VL", "mm", noise[1])])
        return path, ["shaker", "fr=Stempel VR", "fl=Stempel VL"]
    if kind == "jitter":
        time = jittered()
        written(path, time, [("Sitz Z", "g", 1.0 + sine(time, 0.1, 3.0)), ("Hub Z", "g", sine(time, 0.1, 8.0))])
        return path, ["comfort", "z=Sitz Z", "--resample 400", "--offset remove"]
    if kind == "gap":
        time = np.where(time > 9.0, time + 0.7, time)
        written(path, time, [("acc_vertical", "m/s2", sine(time, 1.0, 3.0))])
        return path, ["comfort", "z=acc_vertical", "--from 0 --to 9"]
    if kind == "road":
        written(path, time, [("left", "mm", sine(time, 3.0, 2.0)), ("right", "mm", sine(time, 3.0, 1.0)),
                             ("Speed", "km/h", 40.0 + time)])  # fmt: skip
        return path, ["--road", "--speed channel:Speed", "focus_road"]
    if kind == "profile":
        place = np.arange(0.0, 80.0, 0.1)  # 3.6 s: the evaluation begins after 2 s
        heights = 0.005 * np.sin(place)
        table = np.column_stack([place, heights, heights])
        np.savetxt(path, table, fmt="%.8g", delimiter=",", header="distance [m],left [m],right [m]", comments="")
        return path, ["--road", "--speed 80"]
    assert kind == "plain"
    written(path, time, [("displacement", "m", sine(late, 1e-3, 2.0))])
    return path, ["shaker --input"]


@pytest.mark.parametrize("kind", ["plates", "jitter", "gap", "road", "profile", "plain"])
def test_the_command_runs_as_printed(tmp_path, capsys, monkeypatch, kind):
    path, needed = case(tmp_path, kind)
    monkeypatch.chdir(tmp_path)
    assert inspect([path.name]) == 0
    *_, heading, line = capsys.readouterr().out.splitlines()
    assert kind != "plain" or "plate of wheel fl" in heading  # the shaker wheel of the car of the command
    words = shlex.split(line := line.strip())
    assert words[:3] == ["python", "-m", "vehicle"]
    assert all(text in shlex.join(words).replace("'", "") for text in needed), line
    assert run_advice(tmp_path / path.name, tmp_path)


def test_levels_are_in_the_unit_of_the_file(tmp_path, capsys):
    time = np.arange(800) / 400.0
    written(tmp_path / "a.csv", time, [("Weg", "mm", 2.0 * np.sin(2 * np.pi * 5.0 * time))])
    assert inspect([str(tmp_path / "a.csv")]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if " Weg " in line).split()
    assert row[2] == "mm" and float(row[5]) == pytest.approx(np.sqrt(2.0), rel=1e-3) and float(row[7]) == 2.0
    assert inspect([str(tmp_path / "a.csv"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["channels"][0]
    assert found["rms"] == pytest.approx(1e-3 * np.sqrt(2.0), rel=1e-3) and found["si_unit"] == "m"


def test_several_files_give_one_table(tmp_path, capsys):
    time = np.arange(6000) / 500.0
    for number in (1, 2):
        written(tmp_path / f"ride{number}.csv", time, [("z", "m/s2", number * sine(time, 1.0, 5.0))])
    assert inspect([str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert text.count("acceleration") == 2 and text.count("python -m vehicle comfort --input") == 2
    assert inspect([str(tmp_path), "--json"]) == 0
    assert [one["format"] for one in json.loads(capsys.readouterr().out)] == ["csv", "csv"]
    both = ["--input", str(tmp_path / "ride1.csv"), str(tmp_path / "ride2.csv"), "--offset", "keep"]
    assert comfort([*both, "--json"]) == 0
    first, second = json.loads(capsys.readouterr().out)
    assert second["z"]["weighted_rms"] == pytest.approx(2.0 * first["z"]["weighted_rms"])
    assert comfort(["--input", str(tmp_path), "--offset", "keep"]) == 0
    assert capsys.readouterr().out.count("ride") == 2
    (tmp_path / "text.csv").write_text("no numbers\n")
    assert comfort(["--input", str(tmp_path), "--offset", "keep"]) == 3
    out, err = capsys.readouterr()
    assert "text.csv" in out and "1 of 3 files has no result" in err
    assert inspect([str(tmp_path)]) == 0  # a folder may hold anything
    assert inspect([str(tmp_path / "ride1.csv"), str(tmp_path / "text.csv")]) == 3
