"""Values of a whole measured profile from a run over some of its pieces, against runs over the whole profile."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.benchmarks.profile_pieces import STEP, made_profile, of_whole
from tests.validation import validated
from vehicle import Car, over_profile, road
from vehicle.commands.shaker import main as shaker
from vehicle.commands.sweep import main as sweep
from vehicle.errors import ConfigurationError
from vehicle.runs.car import profile_value
from vehicle.runs.car.profile_value import FEWEST, ProfileValue


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("profiles")
    return {kind: made_profile(folder / f"{kind}.csv", kind, 2, 2000.0) for kind in ("rising", "bumps")}


def misses(value: ProfileValue, whole: dict[str, float]) -> dict[str, float]:
    """Return the error of each value over half of its stated interval."""
    return {name: abs(each - whole[name]) / value.half_intervals[name] for name, each in value.values.items()}


@pytest.mark.parametrize(("name", "kind"), [("sedan", "bumps"), ("focus_road", "rising")])
def test_intervals_cover_a_run_over_the_whole_profile(files: dict[str, Path], kind: str, name: str):
    car = Car.load(name)
    value, whole = over_profile(car, road(files[kind], 80, precision=1)), of_whole(car, files[kind])
    assert len(value.parts) < 0.8 * value.pieces and value.run.signal.duration < 0.9 * value.length
    validated(
        "Statistics and intervals", f"comfort of {name} over a profile ({kind}) from pieces, in half intervals",
        misses(value, whole)["weighted"], 0.0, abs=1.0, source="second derivation: a run over the whole profile",
    )  # fmt: skip
    # 95 % intervals of a dozen values that depend on each other.
    found = misses(value, whole)
    assert len(found) >= 12 and np.mean(np.array([*found.values()]) < 1.0) >= 0.75, found
    assert value.half_intervals["weighted"] < 0.02 * value.values["weighted"]


def test_a_car_without_friction_is_nearly_its_twin(files: dict[str, Path]):
    """Nothing is left but the filters at the edges of pieces and the present load of rolling tyres."""
    car = Car.load("focus_road", ["*.damper.coulomb_friction=0", "*.damper.stribeck_friction=0"])
    value, whole = over_profile(car, road(files["rising"], 80)), of_whole(car, files["rising"])
    assert len(value.parts) == FEWEST
    for name in ("weighted", "unweighted", "tyre_load_fr", "tyre_load_rl"):
        assert value.values[name] == pytest.approx(whole[name], rel=3e-3), name
        assert value.half_intervals[name] < 5e-3 * value.values[name], name


def test_more_pieces_for_a_higher_precision_and_all_of_them_without_an_error(files: dict[str, Path], sedan: Car):
    coarse, fine, exact = (over_profile(sedan, road(files["bumps"], 80, precision=p)) for p in (3.0, 0.4, 1e-3))
    assert FEWEST == len(coarse.parts) < len(fine.parts) <= len(exact.parts) == exact.pieces
    assert set(exact.half_intervals.values()) == {0.0} and "±" not in exact.text("weighted")
    whole = of_whole(sedan, files["bumps"])
    # All pieces are driven without a join: the whole profile from 2 s on.
    assert exact.values["weighted"] == pytest.approx(whole["weighted"], rel=1e-3)


def test_a_smooth_profile_up_a_hill(sedan: Car, tmp_path: Path):
    """The twin comes down from 74 m again, and no start of a slope rings in the filters: all pieces are the whole."""
    file, x = tmp_path / "hill.csv", STEP * np.arange(round(920.0 / STEP) + 1)
    rough = np.cumsum(2e-4 * np.random.default_rng(1).standard_normal(x.size))
    columns = np.column_stack([x, 0.08 * x + rough, 0.08 * x + rough])
    np.savetxt(file, columns, delimiter=",", header="distance [m],left [m],right [m]", comments="")
    value, whole = over_profile(sedan, road(file, 80, precision=1e-3)), of_whole(sedan, file)
    assert len(value.parts) == value.pieces == 10
    for name in ("weighted", "weighted_x", "unweighted", "unweighted_x"):
        # Run and twin end a sample earlier, where the twin goes on, than the whole.
        assert value.values[name] == pytest.approx(whole[name], rel=1e-4), name
    # Of the mean loads on the slope, the twin has the periodic part.
    assert value.values["tyre_load_fr"] == pytest.approx(whole["tyre_load_fr"], rel=2e-3)


def test_pieces_in_which_a_tyre_lifts_are_always_run(files: dict[str, Path], monkeypatch: pytest.MonkeyPatch):
    """A limit of 0 in place of 3 % of the time: all pieces in which a tyre of the whole run pulls by 500 N."""
    car = Car.load("focus_road")
    few = over_profile(car, road(files["rising"], 80, precision=90))
    monkeypatch.setattr(profile_value, "MOST_LIFTED", 0.0)
    more = over_profile(car, road(files["rising"], 80, precision=90))
    run = car.run(road(files["rising"], 80), "reduced", channels=[f"tyre_{w}_force_z" for w in few.run.signal.wheels])
    pulling = np.any([run[name] < -500.0 for name in run.channels if name.startswith("tyre_")], axis=0)
    times = run.time[pulling & (run.time >= run.skip)]
    assert times.size and FEWEST == len(few.parts) < len(more.parts)
    assert all(any(begin <= time <= end for begin, end in more.parts) for time in times.tolist())
    assert not all(any(begin <= time <= end for begin, end in few.parts) for time in times.tolist())


def test_both_engines(files: dict[str, Path], monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(profile_value, "FEWEST", 2)
    car = Car.load("focus_road")
    values = [over_profile(car, road(files["rising"], 80, precision=90), each) for each in ("reduced", "mujoco")]
    assert values[1].run.recording.statistics.engine == "mujoco" and values[0].parts == values[1].parts
    assert values[1].values["weighted"] == pytest.approx(values[0].values["weighted"], rel=5e-3)


def test_values_on_a_seat(files: dict[str, Path]):
    car = Car.load("focus_road_seated")
    value, whole = over_profile(car, road(files["rising"], 80, precision=9)), of_whole(car, files["rising"])
    for name in ("seat_weighted", "seat_value"):
        assert abs(value.values[name] - whole[name]) < max(value.half_intervals[name], 1e-3 * whole[name])
    assert value.half_intervals["seat_value"] / value.values["seat_value"] < 0.02


@pytest.mark.parametrize(
    ("source", "changes", "words"),
    [
        ("C", {}, "C is no measured profile"),
        ("cleat:20x50", {}, "is no measured profile"),
        ("rising", {"front.imbalance.mass": 0.02, "front.imbalance.radius": 0.2}, "forces that shake the car too"),
        ("cams", {}, "cams, which have no linear twin"),
        ("skip", {}, "below the lead-in of a piece, 2 s"),
    ],
)
def test_what_is_not_covered_is_refused(
    files: dict[str, Path], sedan: Car, source: str, changes: dict[str, float], words: str
):
    car, skip = sedan.with_(changes) if changes else sedan, 1.0 if source == "skip" else None
    if source == "cams":
        where = road(files["rising"], 80, contact="cams")
    else:
        where = road(files["rising"] if source in ("rising", "skip") else source, 80)
    with pytest.raises(ConfigurationError, match=words):
        over_profile(car, where, skip=skip)


def test_a_run_takes_no_precision_of_a_profile(files: dict[str, Path], sedan: Car):
    with pytest.raises(ConfigurationError, match="in the command shaker and in over_profile"):
        sedan.run(road(files["rising"], 80, precision=1), "reduced")
    with pytest.raises(ConfigurationError, match="duration exclude each other"):
        over_profile(sedan, replace(road(files["rising"], 80, precision=1), duration=20.0))


def test_the_command(files: dict[str, Path], sedan: Car, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    options = ["--vehicle", "sedan", "--road", str(files["rising"]), "--speed", "80", "--precision", "2"]
    output = ["--engine", "reduced", "--output", str(tmp_path / "values")]
    assert shaker([*options, *output]) == 0
    printed = capsys.readouterr().out
    value = over_profile(sedan, road(files["rising"], 80, precision=2))
    assert value.words in printed and value.text("weighted") in printed and value.text("tyre_load_rl") in printed
    data = json.loads((tmp_path / "values" / "profile.json").read_text())
    assert data["values"]["weighted"]["value"] == value.values["weighted"]
    assert data["values"]["weighted"]["half_interval"] == value.half_intervals["weighted"]
    assert data["parts_s"] == [list(part) for part in value.parts] and data["pieces"] == value.pieces
    for extra in (["--report"], ["--format", "mat"], ["--no-stated-errors"]):
        assert shaker([*options, "--output", str(tmp_path / "other"), *extra]) == 2
        assert f"{extra[0]}: belongs to a run of a whole road" in capsys.readouterr().err
    study = ["--vary", "body.mass=1200,1300", "--output", str(tmp_path / "sweep")]
    assert sweep([*options, *study]) == 2
    assert "leave it out to run the whole profile" in capsys.readouterr().err
