"""`python -m vehicle body participation`: tables, files and refusals."""

import json

import numpy as np
import pytest

from vehicle.commands.body import main


def test_tables_and_files_say_the_same(tmp_path, capsys):
    folder = tmp_path / "out"
    command = ["participation", "--at", "26", "--damper", "sliding", "--output", str(folder)]
    assert main([*command, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    parts = found["contributions"]
    assert sum(one["share"] for one in parts) == pytest.approx(1.0, abs=1e-9)
    assert len(parts) == 15 and parts[7]["name"] == "mode 2 (torsion)" and parts[7]["share"] > 0.5
    assert sum(found["attachments"][1]["share"].values()) == pytest.approx(1.0, abs=1e-9)
    assert sorted(path.name for path in folder.iterdir() if path.name[0] != ".") == [
        "attachments.csv",
        "participation.csv",
        "participation.png",
    ]
    lines = (folder / "participation.csv").read_text().splitlines()
    assert "# mode_2: mode 2 (torsion), 25.48 Hz" in lines
    heads = next(line for line in lines if not line.startswith("#")).split(",")
    assert heads[:3] == ["frequency [Hz]", "total_magnitude [m/s2/m]", "total_phase [deg]"]
    values = np.genfromtxt(folder / "participation.csv", delimiter=",", comments="#", skip_header=len(lines) - 600)
    shares = [index for index, head in enumerate(heads) if head.endswith("_share [%]")]
    assert values.shape == (600, len(heads)) and len(shares) == 15
    assert values[:, shares].sum(axis=1) == pytest.approx(np.full(600, 100.0), abs=1e-3)
    at = [np.interp(26.0, values[:, 0], values[:, index]) for index in (1, heads.index("mode_2_share [%]"))]
    assert at == pytest.approx([found["magnitude"], 100.0 * parts[7]["share"]], rel=0.01)
    assert main(command) == 2  # exists
    assert "give --force to replace it" in capsys.readouterr().err
    assert main([*command[:5]]) == 0
    printed = capsys.readouterr().out
    assert "+81.4 %      590.1   -36 deg  mode 2 (torsion), 25.48 Hz" in printed
    assert "mode 2 (torsion), 25.48 Hz: " in printed and "\n  +74.4 %  suspension_mou" in printed
