"""`python -m scenarios.damper_choice` as a user runs it."""

import json
from dataclasses import fields

import numpy as np
import pytest

from scenarios.claim import Claim
from scenarios.complete_car_quarter import complete_car_quarter
from scenarios.damper_choice import main
from scenarios.damper_choice_tradeoff import trade_off
from vehicle.parameters.damper_choice import FITTED, damper_choice_parameters
from vehicle.parameters.vehicle import load_vehicle
from vehicle.written_files import MARKER

P = damper_choice_parameters()


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "damper_choice"
    assert main(["--output", str(folder), "--quick"]) == 0
    return folder


def test_every_file_is_there_and_no_temporary_one(results):
    names = {path.name for path in results.iterdir()}
    assert names == {
        MARKER,
        "results.md",
        "results.json",
        "figure_02_03_quarter_car.png",
        "figure_05_to_08_half_car.png",
        "figure_09_10_highway.png",
        "figure_09_10_city.png",
        "figure_11_12_13_iteration.png",
        "trade_off_fitted_quarter_car.png",
        "trade_off_complete_car.png",
    }


def test_rows_show_what_the_source_prints(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    rows = {row["name"]: row for row in content["rows"]}
    assert len(rows) == len(content["rows"])
    assert all(set(row) == {field.name for field in fields(Claim)} for row in rows.values())
    for name in (
        "figure 9: quarter car optimum damping, printed measure [N s/m]",
        "figure 9: steeper below the optimum than above, printed measure",
        "figure 9: steeper below the optimum than above, physical measure",
        "figures 7 and 8: the pitch peak rises with damping while the heave peak falls",
        "optimum front above rear, printed measure",
        "optimum front above rear, physical measure",
        "iteration converges in three steps, printed measure",
        "R of both ends falls through the iteration",
        "figure 3: one sprung peak for every damping, lower with more damping",
        *(f"figure 3: quarter car sprung peak at {c} N s/m [Hz]" for c in (4000, 5000, 6000, 7000)),
    ):
        assert rows[name]["within"] is True, name
    assert rows["equation 10 without magnitude bars"]["within"] is False


def test_both_roads_and_both_measures_are_reported(results):
    optima = json.loads((results / "results.json").read_text(encoding="utf-8"))["optima"]
    assert set(optima) == {"highway", "city"}
    assert all(set(row) == {"printed", "physical"} for row in optima.values())
    for row in optima.values():
        for one in row.values():
            assert sum(one["joint"]["values"]) <= sum(one["iteration"][-1]["fluctuation"]) + 1e-6


def test_existing_results_are_not_overwritten_without_force(results, capsys):
    assert main(["--output", str(results), "--quick"]) == 2
    assert "holds files already; give another folder, or --force to overwrite" in capsys.readouterr().err


def test_bad_parameter_is_refused_by_name(tmp_path, capsys):
    path = tmp_path / "car.toml"
    path.write_text(FITTED.read_text(encoding="utf-8").replace("decay = 0.19 ", "decay = 0.0 "), encoding="utf-8")
    assert main(["--parameters", str(path), "--output", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err == "error: highway.decay: found 0.0 s, must be greater than 0.0\n"


def test_trade_off_scales_with_the_class_and_has_its_optima_inside():
    found = trade_off(P.quarter_car, np.geomspace(200.0, 10000.0, 41))
    for name in ("tyre_load", "acceleration", "travel"):
        a, d = (np.array([getattr(one, name) for one in found.measures[road]]) for road in "AD")
        np.testing.assert_allclose(d, 8.0 * a, rtol=1e-12)  # density 64 times, amplitude 8 times
    assert 200.0 < found.best("acceleration") < found.best("tyre_load") < 10000.0
    assert np.all(np.diff([one.travel for one in found.measures["A"]]) < 0.0)


def test_trade_off_grid_is_fine_enough(monkeypatch):
    before = trade_off(P.quarter_car, [500.0, 3000.0]).measures["A"]
    monkeypatch.setattr("scenarios.damper_choice_tradeoff.EDGES", np.geomspace(0.1, 50.0, 1601))
    after = trade_off(P.quarter_car, [500.0, 3000.0]).measures["A"]
    for old, new in zip(before, after, strict=True):
        for name in ("tyre_load", "acceleration", "travel"):
            assert getattr(new, name) == pytest.approx(getattr(old, name), rel=1e-3)  # as the constant says


def test_complete_car_quarter_carries_its_share():
    vehicle = load_vehicle()
    car = complete_car_quarter(vehicle)
    # moments about the rear supports, front tyres and supports carrying body and engine
    base = 3.465 - 0.85
    expected = (813.0 * (3.465 - 2.157) + 220.0 * (3.465 - 0.72)) / base / 2.0
    assert car.sprung_mass == pytest.approx(expected, rel=1e-9)
    assert car.wheel.tyre_stiffness == 2.5e5
    # strut from (0.852, 0.64, 0.72) to (0.877, 0.548, 1.23)
    cosine = 0.51 / np.sqrt(0.025**2 + 0.092**2 + 0.51**2)
    assert car.wheel.suspension_stiffness == pytest.approx(2.5e4 * cosine**2, rel=1e-9)
    assert car.wheel.suspension_damping == pytest.approx(2250.0 * cosine**2, rel=1e-9)
    assert 30.0 < car.wheel.unsprung_mass < 60.0
