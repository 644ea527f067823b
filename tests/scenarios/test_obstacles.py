"""`python -m scenarios.obstacles` as a user runs it: values of a run, table, picture."""

import json

import pytest

from scenarios.obstacles import Passage, dose_claims, main, passage_table, passage_values
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.output.run_obstacle import obstacle_values


@pytest.fixture(scope="module")
def passage(rigid_car):
    return Passage(vehicle=rigid_car, overrides=(), engine="mujoco", obstacle="cleat:20x50", speed=30.0)


def test_a_short_study(rigid_car, tmp_path):
    folder = tmp_path / "obstacles"
    arguments = ["--output", str(folder), "--vehicle", str(rigid_car), "--speeds", "20,40", "--engine", "reduced"]
    assert main([*arguments, "--obstacle", "cleat:10x50", "--obstacle", "speed_bump"]) == 0
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    rows = {(row["obstacle"], row["speed_kmh"]): row for row in content["passages"]}
    assert set(rows) == {(text, speed) for text in ("cleat:10x50", "speed_bump") for speed in (20.0, 40.0)}
    for name in ("peak_to_peak_z", "peak_to_peak_x", "vdv"):
        for point in ("seat_rail", "seat"):
            assert rows["speed_bump", 40.0][f"{name} {point}"] > 1.5 * rows["speed_bump", 20.0][f"{name} {point}"] > 0.0
    assert rows["speed_bump", 40.0]["lowest_load"] < rows["speed_bump", 20.0]["lowest_load"] < 100.0
    assert (folder / "obstacles.png").stat().st_size > 20_000
    text = (folder / "results.md").read_text(encoding="utf-8")
    assert "| cleat:10x50 | 20 |" in text and "VDV seat rail" in text
    assert content["rows"] == []  # other obstacles than those of the study, and two speeds


def test_values_are_those_of_the_run(passage):
    run, values = passage.run(), passage_values(passage)
    found = obstacle_values(run)
    assert found is not None
    assert values["peak_to_peak_x seat"] == found["peak_to_peak"]["seat"]["x"]
    assert values["vdv seat_rail"] == found["vdv"]["seat_rail"]["overall"]
    assert values["knuckle_peak"] == max(found["knuckle_peak"].values())
    # Its tyres lift off on this cleat, which those of the vehicle file cannot: they would pull.
    assert all(connection.law.one_sided for connection in run.car.vehicle.composition.connections if connection.ground)
    assert -5.0 < values["lowest_load"] < 1.0


def test_the_checks_fail_where_they_do_not_hold():
    def rows(text, doses):
        passages = [
            Passage(vehicle=vehicle_file("sedan"), overrides=(), engine="reduced", obstacle=text, speed=10.0 * n)
            for n in range(1, 4)
        ]
        return dose_claims({each: {"vdv seat_rail": dose} for each, dose in zip(passages, doses, strict=True)})

    for text, doses, holds in (
        ("cleat:20x50", (1.0, 2.0, 1.5), True),
        ("cleat:20x50", (1.0, 1.5, 2.0), False),
        ("ramp:50x1000", (1.0, 1.5, 2.0), True),
        ("ramp:50x1000", (1.0, 2.0, 1.5), False),
    ):
        (claim,) = rows(text, doses)
        assert claim.within is holds
    assert not rows("cobbles", (1.0, 2.0, 3.0))


def test_a_passage_that_failed_is_a_gap(passage):
    text = passage_table({passage: {}}, ("seat_rail",))
    assert text.splitlines()[-1].startswith("| cleat:20x50 | 30 | - | - |")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--speeds", "20,x"], "--speeds 20,x: must be speeds above 0 to 400 km/h"),
        (["--speeds", "-5"], "--speeds -5: must be"),
        (["--obstacle", "kerb"], "'kerb' must be one of cleat"),
    ],
)
def test_refusals(arguments, message, tmp_path, capsys):
    assert main(["--output", str(tmp_path / "out"), "--quick", *arguments]) == 2
    assert message in capsys.readouterr().err
