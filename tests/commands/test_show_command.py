"""The command that shows a car: text, JSON, files, parameters, refusals."""

import csv
import json

import pytest

from vehicle.commands.show import main


def test_text_and_json(capsys):
    assert main(["sedan", "--set", "body.mass=1000"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("sedan, tyres standing; body.mass=1000\n")
    assert "wheelbase     2757 mm" in text and "\nwheel rate [N/mm] " in text and "heave " in text
    assert main(["sedan", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["mass_kg"] == pytest.approx(1652.924) and found["axles"][1]["geometry"]["caster_deg"] is None
    assert found["axles"][0]["brake_support_percent"] == pytest.approx(27.74, abs=0.01)


def test_steady_acceleration(capsys):
    assert main(["sedan", "--acceleration", "-3", "--lateral", "2", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["steady"]
    assert (found["acceleration"], found["lateral"]) == (-3.0, 2.0)
    assert sum(wheel["along_n"] for wheel in found["wheels"]) == pytest.approx(-3.0 * 1652.924, rel=1e-6)
    assert sum(wheel["across_n"] for wheel in found["wheels"]) == pytest.approx(2.0 * 1652.924, rel=1e-6)
    assert found["pitch_deg"] > 0.0 and found["roll_deg"] > 0.0
    # All of the brakes would carry 27.74 %.
    assert found["supports"][0]["percent"] == pytest.approx(0.7 * 27.74, abs=0.01)
    assert main(["sedan", "--acceleration", "-3"]) == 0
    assert "m/s2 to the left; pitch 0.30 deg (nose down +)" in capsys.readouterr().out
    assert main(["sedan", "--acceleration", "-3", "--set", "driving.acceleration=-2"]) == 2
    assert "both set driving.acceleration" in capsys.readouterr().err


def test_files(tmp_path, capsys):
    folder = tmp_path / "car"
    assert main(["focus", "--output", str(folder)]) == 0
    assert (folder / "car.png").stat().st_size > 30_000
    assert json.loads((folder / "car.json").read_text())["wheelbase_m"] is None
    with (folder / "parameters.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["path"]: row for row in csv.DictReader(file)}
    assert rows["body.mass"]["value"] == "813" and rows["body.mass"]["source"] == "section 3.1.2"
    assert main(["focus", "--output", str(folder)]) == 2
    assert "exists" in capsys.readouterr().err


def test_a_change_without_effect_is_said_beside_a_search_too(capsys):
    assert main(["focus", "--search", "smoothing", "--set", "damper.presliding_stiffness=5e5"]) == 0
    assert "note: damper.presliding_stiffness=5e5: has no effect; it acts only with " in capsys.readouterr().out


def test_search(capsys):
    assert main(["sedan", "--search", "rear damper coulomb"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 and lines[0].split() == ["parameter", "value", "unit", "range", "source"]
    assert lines[1].startswith("rear.damper.coulomb_friction     40")
    assert main(["sedan", "--search", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)) > 200
