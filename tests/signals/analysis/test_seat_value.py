"""SEAT value: of a known transmissibility in closed form, by the command, in the summary, in a sweep."""

import csv
import json

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.comfort import main as comfort
from vehicle.commands.shaker import main as shaker
from vehicle.commands.sweep import main as sweep
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Car
from vehicle.runs.output.run_comfort import NO_SEAT, comfort_notices, seat_values
from vehicle.signals.analysis.seat_value import seat_value, weighted_rms_of
from vehicle.signals.analysis.weighting import weighting
from vehicle.signals.excitation.signal import Signal, uniform_time

STEP = 1e-3
TIME = uniform_time(samples=40_000, timestep=STEP)
FIRST, SECOND = np.sin(2.0 * np.pi * 4.0 * TIME), np.sin(2.0 * np.pi * 10.0 * TIME)
SEAT, RAIL = 2.0 * FIRST + 0.5 * SECOND, FIRST + SECOND


def lines(name, *pairs):
    """Weighted RMS of sines (amplitude, frequency)."""
    return np.sqrt(sum(0.5 * (a * float(weighting(name).spectrum_factor(f))) ** 2 for a, f in pairs))


@pytest.mark.parametrize(("place", "name"), [("seat", "Wk"), ("seat_bs6841", "Wb")])
def test_two_sines_in_closed_form(place, name):
    """After the filters have settled, SEAT^2 = sum (T_i w_i a_i)^2 / sum (w_i a_i)^2."""
    found = seat_value(STEP, SEAT, RAIL, contact=place, skip=10.0)
    expected = lines(name, (2.0, 4.0), (0.5, 10.0)) / lines(name, (1.0, 4.0), (1.0, 10.0))
    assert found.weighting == name
    validated(
        "Comfort, ISO 2631", f"SEAT value of two sines, {name}", found.rms, expected, rel=1e-5,
        source="closed form: sqrt(sum (T w a)^2 / sum (w a)^2), ISO 10326-1",
    )  # fmt: skip
    assert seat_value(STEP, 3.0 * RAIL, RAIL).rms == pytest.approx(3.0, rel=1e-12)
    validated(
        "Comfort, ISO 2631", f"SEAT value by VDV of a seat that amplifies by 3, {name}",
        seat_value(STEP, 3.0 * RAIL, RAIL).vdv, 3.0, rel=1e-12, source="closed form: ratio of the dose values",
    )  # fmt: skip


def test_the_axes_of_the_seat_are_weighted_as_the_standard_has_them():
    x, y, z, overall = weighted_rms_of(STEP, np.array([SEAT, RAIL, SEAT]), skip=10.0)
    exact = [lines("Wd", (2.0, 4.0), (0.5, 10.0)), lines("Wd", (1.0, 4.0), (1.0, 10.0))]
    exact.append(lines("Wk", (2.0, 4.0), (0.5, 10.0)))
    validated(
        "Comfort, ISO 2631", "weighted RMS on the seat, axes x, y, z and overall", np.array([x, y, z, overall]),
        np.array([*exact, np.linalg.norm(exact)]), rel=1e-5, unit="m/s2",
        source="standard: ISO 2631-1:1997, 8.2: Wd, Wd, Wk",
    )  # fmt: skip


def test_a_point_of_contact_other_than_a_seat_is_rejected():
    with pytest.raises(ConfigurationError, match="seat or seat_bs6841, not 'feet'"):
        seat_value(STEP, SEAT, RAIL, contact="feet")
    with pytest.raises(DataError, match="acceleration of the seat rail is zero"):
        seat_value(STEP, SEAT, 0.0 * RAIL)


def test_a_run_reports_its_seat_value(tmp_path, monkeypatch, capsys):
    """The summary, the page and the command on the file agree; a car without a seat has none, and says so."""
    monkeypatch.chdir(tmp_path)
    road = ["--road", "A", "--speed", "60", "--duration", "4", "--engine", "reduced"]
    assert shaker([*road, "--vehicle", "focus_road_seated", "--output", "seated"]) == 0
    value = json.loads((tmp_path / "seated" / "summary.json").read_text())["seat_value"]
    assert f"SEAT value {value['rms']:.3f} (z, Wk" in capsys.readouterr().out and 0.4 < value["rms"] < 1.0
    asked = ["--channel", "seat", "--rail", "seat_rail", "--offset", "keep", "--skip", "2", "--json"]
    assert comfort(["--input", "seated/time.npz", *asked]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["seat_value"] == pytest.approx(value) and NO_SEAT not in err
    still = Signal(time=TIME[:500], displacement=dict.fromkeys(("fr", "fl", "rr", "rl"), 0.0 * TIME[:500]))
    bare = Car.load("focus_road").run(still, engine="reduced")
    assert comfort_notices(bare)[-1] == NO_SEAT and seat_values(bare) is None
    summary = json.loads((tmp_path / "seated" / "summary.json").read_text())
    (tmp_path / "seated" / "summary.json").write_text(json.dumps({**summary, "notices": comfort_notices(bare)}))
    assert comfort(["--input", "seated/time.npz", *asked]) == 0
    assert f"notice: {NO_SEAT}" in capsys.readouterr().err
    for wrong, message in (
        (["--rail", "x=1"], "--rail x=1: "),
        (["--rail", "seat_rail", "--place", "feet"], "--place feet: "),
    ):
        assert comfort(["--input", "seated/time.npz", "--channel", "seat", "--offset", "keep", *wrong]) == 2
        assert message in capsys.readouterr().err


def test_a_measured_file_names_the_channel_of_its_rail(tmp_path, capsys):
    table = np.column_stack([TIME, 0.1 * SEAT, 0.2 * SEAT, SEAT, RAIL])
    path, head = tmp_path / "ride.csv", "time [s],a [m/s2],b [m/s2],cushion [m/s2],floor [m/s2]"
    np.savetxt(path, table, delimiter=",", header=head, comments="", fmt="%.9g")
    names = [word for pick in ("x=a", "y=b", "z=cushion") for word in ("--channel", pick)]
    assert comfort(["--input", str(path), *names, "--rail", "z=floor", "--skip", "10"]) == 0
    expected = seat_value(STEP, SEAT, RAIL, skip=10.0)
    assert f"SEAT value (z, Wk)       {expected.rms:.4g}, of VDV {expected.vdv:.4g}" in capsys.readouterr().out


def test_a_rail_at_another_rate_needs_resampling(tmp_path, capsys):
    """Tones of 5 Hz, 1 m/s2 on the seat at 200 Hz and 2 m/s2 on the rail at 100 Hz, in one LVM file over 30 s."""
    head = [
        "LabVIEW Measurement", "Separator\tTab\nDecimal_Separator\t.\nMulti_Headings\tYes\nX_Columns\tMulti",
        "***End_of_Header***", "Channels\t2", "Samples\t6000\t\t3000", "Date\t2026/01/02\t\t2026/01/02",
        "Time\t10:00:00.0\t\t10:00:00.0", "Y_Unit_Label\tm/s2\t\tm/s2", "X_Dimension\tTime\t\tTime",
        "X0\t0\t\t0", "Delta_X\t0.005\t\t0.01", "***End_of_Header***", "X_Value\tseat\tX_Value\trail\tComment",
    ]  # fmt: skip
    seat, rail = (
        [f"{t:.6f}\t{size * np.sin(10.0 * np.pi * t):.6f}" for t in np.arange(30.0, step=step)]
        for size, step in ((1.0, 0.005), (2.0, 0.01))
    )
    rows = [f"{above}\t{below}" for above, below in zip(seat, rail + ["\t"] * 3000, strict=True)]
    path = tmp_path / "two_rates.lvm"
    path.write_text("\n".join([*head, *rows, ""]))
    command = ["--input", str(path), "--channel", "z=seat", "--rail", "z=rail"]
    assert comfort(command) == 3
    said = capsys.readouterr().err
    assert "200 Hz from 0 to 29.995 s" in said and "100 Hz from 0 to 29.99 s" in said and "--resample" in said
    assert comfort([*command, "--resample", "100", "--to", "29"]) == 0
    assert "SEAT value (z, Wk)       0.5, of VDV 0.5" in capsys.readouterr().out


def test_a_sweep_of_a_car_with_a_seat(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = "seat.driver.bushings.cushion.stiffness.z"
    arguments = ["--road", "A", "--speed", "60", "--duration", "4", "--vehicle", "focus_road_seated", "--quiet"]
    assert sweep([*arguments, "--vary", f"{path}=4e4,16e4", "--engine", "reduced", "--output", "out"]) == 0
    with (tmp_path / "out" / "table.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    values = {key: [float(row[key]) for row in rows] for key in rows[0] if key.startswith("seat_")}
    value = next(values[key] for key in values if key.startswith("seat_value"))
    assert value[0] < value[1] < 1.0  # a softer cushion isolates better
    assert sum(key.startswith("seat_weighted") for key in values) == 5  # three axes, their sum and its error
