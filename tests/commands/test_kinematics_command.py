"""The rig for axles as a command: table, JSON, files, refusals."""

import json

import numpy as np
import pytest

from vehicle.commands.kinematics import main


def test_rows_and_rates(capsys):
    # The design position is that of the standing car: patches that roll freely move it by 0.0014 degrees.
    assert main(["--travel", "-20:20:10", "--tyre", "standing", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    travel = [row["wheel_travel_m"] for row in found["rows"]]
    assert travel == pytest.approx([-0.02, -0.01, 0.0, 0.01, 0.02], abs=1e-9)
    middle = found["rows"][2]
    assert max(abs(middle[name]) for name in ("camber_deg", "toe_deg", "lateral_m")) < 1e-6
    slope = (found["rows"][3]["load_n"] - found["rows"][1]["load_n"]) / 0.02
    assert found["rates"]["wheel_rate_n_per_m"] == pytest.approx(slope, rel=2e-3)
    # The bar of the source is stiff: twisted over its arms of 0.22 m it adds 2 k / r^2 or so to the spring.
    assert main(["--travel=-1:1:1", "--tyre", "standing", "--opposite"]) == 0
    *_, rate, _ = capsys.readouterr().out.splitlines()
    assert rate.endswith(" N/mm, opposite travel: anti-roll bar or beam included")
    opposite = 1e3 * float(rate.split()[2])
    assert opposite > 4.0 * found["rates"]["wheel_rate_n_per_m"]


def test_ideal_joints_have_no_load(capsys):
    assert main(["--ideal", "--travel=0:10:10", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [row["load_n"] for row in found["rows"]] == [None, None]
    assert found["rates"]["wheel_rate_n_per_m"] is None
    assert main(["--ideal", "--travel=0:10:10"]) == 0
    assert "ideal joints" in capsys.readouterr().out


def test_files(tmp_path, capsys):
    folder = tmp_path / "axle"
    arguments = ["--travel=-10:10:10", "--contact-force", "x=100", "--moment", "z=100", "--output", str(folder)]
    assert main(arguments) == 0
    lines = (folder / "kinematics.csv").read_text(encoding="utf-8").splitlines()
    assert lines[2].startswith("wheel_travel [m],camber [deg],toe [deg],lateral [m]")
    table = np.loadtxt(lines[3:], delimiter=",")
    assert table.shape == (3, 20) and abs(table[1, 2]) > 0.01  # toe under load at no travel
    assert (folder / "kinematics.png").stat().st_size > 10_000
    assert "load [N]" in capsys.readouterr().out
    assert main(arguments) == 2
    assert main([*arguments, "--force"]) == 0


def test_too_much_travel_is_no_position(capsys):
    assert main(["--ideal", "--travel=0:600:100"]) == 4
    assert "axle: " in capsys.readouterr().err


def test_gas_and_a_stop_are_part_of_the_load(capsys):
    stop = "damper.stop={displacement=[-0.05, -0.02, 0.05], force=[-3000, 0, 0]}"
    loads = []
    for extra in ([], ["--set", "damper.gas_force=250", "--set", stop]):
        # Standing: a gas force moves the horizontal forces of the trim, which patches that roll freely let go of.
        assert main(["--travel=0:60:60", "--tyre", "standing", "--json", *extra]) == 0
        loads.append([row["load_n"] for row in json.loads(capsys.readouterr().out)["rows"]])
    assert loads[1][0] == pytest.approx(loads[0][0], rel=1e-4) and loads[1][1] > loads[0][1] + 1000.0
