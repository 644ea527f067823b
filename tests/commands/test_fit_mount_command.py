"""`python -m vehicle fit-mount`: printed table, files, lines that a vehicle file takes."""

import csv
import json
import tomllib

import numpy as np
import pytest

from vehicle.commands.fit_mount import main
from vehicle.model.parameters.force_elements import Hydromount
from vehicle.model.parameters.toml_file import build


def table(path, track):
    """Points of a hydromount, or of rubber with a Maxwell branch, at two amplitudes without noise."""
    rows = ["frequency [Hz],amplitude [mm],stiffness [N/mm],loss_angle [deg]"]
    for amplitude in (0.1, 1.0):
        for f in np.arange(2.0, 30.5, 2.0):
            s = 2j * np.pi * f
            fluid = 1.0 / (1.0 / 3e5 + 1.0 / (60.0 * s**2 + 900.0 * s))
            k = 2e5 + 100.0 * s + fluid if track else 2e5 + 1.0 / (1.0 / 5e4 + 1.0 / (800.0 * s))
            rows.append(f"{f},{amplitude},{abs(k) / 1e3:.9g},{np.degrees(np.angle(k)):.9g}")
    path.write_text("\n".join(rows) + "\n")
    return path


def test_the_lines_are_those_of_a_vehicle_file(tmp_path, capsys):
    folder = tmp_path / "out"
    assert main([str(table(tmp_path / "points.csv", track=True)), "--output", str(folder)]) == 0
    said = capsys.readouterr().out
    assert "chosen: hydromount with inertia track, the best fit for its number of parameters" in said
    assert "points.csv: 30 points, amplitudes 0.1 and 1 mm peak, 2 to 30 Hz" in said
    law = build(Hydromount, tomllib.loads((folder / "mount.toml").read_text()), "mount")
    assert (law.chamber_stiffness, law.track_mass, law.track_damping) == (3e5, 60.0, 900.0)
    assert law.stiffness == (2e5,) * 3 and law.damping == (100.0,) * 3
    # The mount of the base may have a Maxwell branch: it would remain, 65 N/mm at 11 Hz in the Focus.
    base = {"maxwell_stiffness": 1e5, "maxwell_damping": 2e3}
    over = build(Hydromount, base | tomllib.loads((folder / "mount.toml").read_text()), "mount")
    assert over.maxwell is None and over.friction_force == (0.0,) * 3
    with (folder / "mount.csv").open() as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        assert float(row["fitted_stiffness [N/mm]"]) == pytest.approx(float(row["stiffness [N/mm]"]), rel=1e-4)
    assert len(rows) == 30 and (folder / "mount.png").stat().st_size > 20_000


def test_a_law_can_be_asked_for(tmp_path, capsys):
    points = str(table(tmp_path / "points.csv", track=False))
    assert main([points, "--law", "hydromount", "--output", str(tmp_path / "a")]) == 0
    said = capsys.readouterr().out
    assert "chosen: hydromount with inertia track\n" in said and "poor fit" not in said
    track = str(table(tmp_path / "track.csv", track=True))
    assert main([track, "--law", "rubber", "--output", str(tmp_path / "c")]) == 0
    assert "poor fit: the RMS error is above 10 % or 6 deg; check units" in capsys.readouterr().out
    assert main([points, "--output", str(tmp_path / "b"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    values = {each["path"]: each["value"] for each in found["parameters"]}
    assert found["chosen"] == "rubber" and values["MOUNT.maxwell_stiffness"] == pytest.approx(5e4, rel=1e-4)
    assert values["MOUNT.stiffness.z"] == pytest.approx(2e5, rel=1e-4)
    assert "MOUNT.maxwell_stiffness=50000.0" in found["set"] and set(found["bic"]) >= {"hydromount", "rubber"}
    text = (tmp_path / "b" / "mount.toml").read_text()
    assert "maxwell_stiffness = 50000.0  # [N/m] fitted to points.csv, standard error" in text
    assert "damping = [0.0, 0.0, 0.0]" in text


def test_a_file_without_units_is_refused(tmp_path, capsys):
    path = tmp_path / "points.csv"
    path.write_text(table(path, track=True).read_text().replace(" [mm]", ""))
    assert main([str(path), "--output", str(tmp_path / "out")]) == 3
    assert "amplitude [mm] or amplitude [um] or amplitude [m]" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
