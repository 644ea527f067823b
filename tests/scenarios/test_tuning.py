"""`python -m scenarios.tuning` as a user runs it: on made data, and on own files."""

import json

import numpy as np
import pytest

from scenarios.tuning.__main__ import main
from scenarios.tuning.claims import demonstration_claims, fit_notes, frozen_note, own_claims
from scenarios.tuning.data import AUTHORS, HIDDEN, QUICK, parse_parameters
from tests.studies.tuning.two_masses import TRUE, MeasuredMasses
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.records.frf_file import write_frf
from vehicle.studies.tuning.full_steps import FullSteps
from vehicle.studies.tuning.least_squares import fit

MOUNT = "bushings.suspension_mount.stiffness.z"
CHANNELS = ("knuckle_fl_acc_z", "seat_rail_acc_z")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "tuning"
    assert main(["--output", str(folder), "--quick"]) == 0
    return folder


def test_hidden_values_are_found(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    assert len(content["rows"]) == len(QUICK) + 1
    assert all(row["within"] for row in content["rows"])
    rows = content["all"]
    for path in QUICK:
        assert rows["start"][path] != pytest.approx(HIDDEN[path], rel=0.15)
        # Three standard errors count for something only where they are small.
        assert abs(rows["values"][path] - HIDDEN[path]) < 0.01 * HIDDEN[path]
    assert content["not_judged"]
    files = {path.name for path in results.iterdir()}
    assert {"high_frf.csv", "frf_1_high.png", "records.png", "parameters.png", "correlation.png"} <= files


def test_the_hidden_car_is_no_secret_of_the_fit():
    # Starts are those of the authors, and no start or bound of the fit is a hidden value.
    assert {parameter.path for parameter in AUTHORS} == set(HIDDEN)
    assert all(HIDDEN[parameter.path] not in (parameter.low, parameter.start, parameter.high) for parameter in AUTHORS)


def test_options_of_own_files_are_checked(tmp_path, capsys):
    frequency = np.arange(4.0, 44.0, 0.5)
    hidden = Car.load(overrides=["bushings.suspension_mount.stiffness=[3e6, 3e6, 6.5e5]"])
    noise = np.random.default_rng(4).standard_normal((2, len(CHANNELS), frequency.size))
    measured = FrequencyResponse(
        frequency=frequency,
        response=hidden.matrix_frf(CHANNELS, frequency, wheel="fl") * np.exp(0.03 * (noise[0] + 1j * noise[1])),
        coherence=np.full((len(CHANNELS), frequency.size), 0.98),
        random_error=np.full((len(CHANNELS), frequency.size), np.nan),
        averages=np.full((len(CHANNELS), frequency.size), 8.0),
        segments=1,
        window="",
        estimator="",
        resolution_hz=0.5,
        reasons=(),
    )
    file = tmp_path / "own.csv"
    write_frf(file, measured, CHANNELS, "")
    options = ["--frf", str(file), "--level", "low", "--fit", f"{MOUNT}=3e5:2e6:9e5", "--spacing", "1", "--quick"]
    options += [word for name in CHANNELS for word in ("--channel", name)]
    capsys.readouterr()
    for extra, message in (
        (["--level", "high"], "1 --frf and 2 --level"),
        (["--band", "9:3"], "--band 9:3: needed is LOW:HIGH"),
        (["--fit", "damper.viscous"], "--fit damper.viscous: needed is PATH=LOWER:UPPER"),
        (["--record", str(file)], "1 --record and 0 --signal; each file of time histories needs its signal"),
        (
            ["--fit", "damper.stribeck_friction=50:300:120"],
            "without effect; it belongs to front.damper.friction_law = stri",
        ),
        (
            [
                *("--set", "damper.friction_law=stribeck", "--fit", "damper.stribeck_friction=50:300:120"),
                *("--fit", "damper.coulomb_friction=20:100:75"),
            ],
            "static friction must not be below sliding friction",
        ),
        (["--channel", "engine_acc_z"], "no channel engine_acc_z; the file has knuckle_fl_acc_z, seat_rail_acc_z"),
    ):
        assert main([*options, *extra, "--output", str(tmp_path / "refused")]) in (2, 3)
        assert message in capsys.readouterr().err
    assert main(["--level", "low", "--output", str(tmp_path / "alone")]) == 2
    assert "belongs to --frf" in capsys.readouterr().err


def test_parameters_of_the_command_line(car):
    first, two = parse_parameters(["damper.viscous=500:5000", f"{MOUNT}=1e5:1e6:5e5"], car.vehicle)
    assert (first.low, first.high, first.start) == (500.0, 5000.0, value_of(car.vehicle, "damper.viscous"))
    assert (two.path, two.start) == (MOUNT, 5e5)
    for text in ("damper.viscous=1", "damper.viscous=a:b", "damper.viscous=1:2:3:4"):
        with pytest.raises(ConfigurationError, match="needed is PATH=LOWER:UPPER"):
            parse_parameters([text], car.vehicle)


@pytest.fixture(scope="module")
def masses():
    """A fit of four parameters, of which one acts on nothing."""
    parameters = [Range(path=path, low=value / 9, high=9 * value, start=1.4 * value) for path, value in TRUE.items()]
    nothing = Range(path="colour", low=1.0, high=9.0, start=2.0)
    return fit([*parameters, nothing], [MeasuredMasses(seed=9)], dict)


def finished(result, *, settled=True):
    moved = dict.fromkeys(result.free, -0.5)
    return FullSteps(result=result, first=1.1, moved=moved, largest_steps=(0.5, 0.1), settled=settled)


def test_rows_say_what_was_missed(masses):
    rows = demonstration_claims(finished(masses), None, {**TRUE, "colour": 3.0})
    assert [row.within for row in rows] == [True] * 5
    assert rows[3].ours == "not identified by the data, held at 2"
    away = {**TRUE, "upper": TRUE["upper"] + 4.0 * masses.standard_errors["upper"]}
    assert [row.within for row in demonstration_claims(finished(masses, settled=False), None, away)] == [
        True,
        False,
        True,
        False,
    ]
    assert [row.within for row in own_claims(masses, finished(masses))] == [True, True]


def test_notes_name_everything(masses):
    text = "\n".join(fit_notes("A fit", masses, finished(masses)))
    assert "colour: the data do not identify this parameter (" in text and "held at 2" in text
    assert "| damping | 166.667 to 13500 | 2100 |" in text and "-0.50" in text
    assert "body, phase | 60" in text
    assert "damping 1" in frozen_note(masses, {**TRUE, "colour": 2.0})
