"""`python -m vehicle diagnose` before its drives: forms of the speed, the shipped record, the report of its folder."""

import numpy as np
import pytest

from vehicle.commands.diagnose import main, speed_of
from vehicle.commands.report import main as report
from vehicle.errors import ConfigurationError
from vehicle.signals.formats.reader import read_record

PHONE = [word for axis in "xyz" for word in ("--map", f"seat_rail_acc_{axis}=Acc {axis.upper()}")]


def test_the_speed_is_a_number_a_range_or_names_channels():
    assert speed_of("80") == 80.0 and speed_of("70:90") == (70.0, 90.0)
    assert speed_of("channel:v") == "channel:v" and speed_of("position:a,b") == "position:a,b"
    for text in ("position:", "channel:", "1:2:3"):
        with pytest.raises(ConfigurationError, match="LATITUDE,LONGITUDE"):
            speed_of(text)


def test_the_shipped_record_is_found_by_its_name_unless_a_file_has_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    record = read_record("third_car.csv")
    rates = {channel.name: channel.rate for channel in record.channels}
    assert [*rates] == ["Acc X", "Acc Y", "Acc Z", "GPS speed"] and rates["Acc X"] == pytest.approx(100.0)
    assert np.nanmean(record.channels[3].values) == pytest.approx(80.0, abs=0.2)
    (tmp_path / "third_car.csv").write_text("time [s],own [m]\n0,1\n1,2\n2,3\n", encoding="utf-8")
    assert [channel.name for channel in read_record("third_car.csv").channels] == ["own"]


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--speed", "80", "--forward", "y", *PHONE], "--forward y: must be one of x, -x, y, -y, z, -z, with --free"),
        (["--speed", "80", "--free", "seat_rail", "--forward", "z", *PHONE], "--forward z: this axis of seat_rail is"),
        (["--speed", "position:GPS speed,Acc X", *PHONE], "'GPS speed' is no angle but velocity"),
    ],
)
def test_wrong_options_are_refused_before_the_drives(options, reason, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["third_car.csv", "--vehicle", "sedan", *options]) in (2, 3)
    assert reason in capsys.readouterr().err


def test_a_diagnosis_is_reported_alone(tmp_path, capsys):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "diagnosis.json").write_text("{}", encoding="utf-8")
    assert report([str(tmp_path / "one"), str(tmp_path / "two")]) == 2
    assert "is a diagnosis, which has a report of its own; give its folder alone" in capsys.readouterr().err
    assert report([str(tmp_path / "one"), "--targets", "ride"]) == 2
    assert "without --targets" in capsys.readouterr().err
    assert report([str(tmp_path / "one")]) == 3
    assert "diagnosis.json: is no complete diagnosis" in capsys.readouterr().err
