"""`python -m scenarios.damper_choice` as a user runs it."""

import json
import re
from dataclasses import fields

import numpy as np
import pytest

from scenarios.claims import Claim
from scenarios.damper_choice.damper_curves import compare_curves
from scenarios.damper_choice.other_vehicles import region_verdicts
from scenarios.damper_choice.printed_determinant import (
    PRINTED_TERMS,
    half_car_matrix,
    printed_determinant,
    wrong_terms,
)
from scenarios.damper_choice.runs import complete_car_quarter, trade_off
from scenarios.lumped.damper_choice import damper_choice_parameters
from scenarios.lumped.road_holding import quarter_car_model, tyre_load_ratio
from tests.scenarios.kept_table import contradictions
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.output.written_files import MARKER

P = damper_choice_parameters()


def test_every_file_is_there_and_no_temporary_one(results):
    names = {path.name for path in results.iterdir()} - {MARKER}
    assert names == {
        "results.md",
        "results.json",
        "figure_02_03_quarter_car.png",
        "figure_05_to_08_half_car.png",
        "figure_09_10_highway.png",
        "figure_09_10_city.png",
        "figure_11_12_13_iteration.png",
        "trade_off_fitted_quarter_car.png",
        "trade_off_complete_car.png",
        "damper_curves.png",
    }


def test_rows_show_what_the_source_prints(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    rows = {row["name"]: row for row in content["rows"]}
    assert len(rows) == len(content["rows"])
    assert all(set(row) == {field.name for field in fields(Claim)} for row in rows.values())
    for name in (
        "quarter car optimum damping, printed measure [N s/m]",
        "quarter car: steeper below the optimum than above, printed measure",
        "quarter car: steeper below the optimum than above, physical measure",
        "the pitch peak rises with damping while the heave peak falls",
        "optimum front above rear, printed measure",
        "optimum front above rear, physical measure",
        "iteration converges in three steps, printed measure",
        "R of both ends falls through the iteration",
        "one sprung peak for every damping, lower with more damping",
        *(f"quarter car sprung peak at {c} N s/m [Hz]" for c in (4000, 5000, 6000, 7000)),
    ):
        assert rows[name]["within"] is True, name
    assert rows["equation 10 without magnitude bars"]["within"] is False
    curves = [row for name, row in rows.items() if name.startswith("damper curve: ")]
    assert len(curves) == 2
    assert all(row["status"] == "not testable" and row["within"] is None for row in curves)


def test_one_printed_term_of_the_determinant_is_no_permutation():
    """With a24 read as a23 the terms are those of a determinant with a12 = a21 = 0, for any numbers."""
    assert wrong_terms() == ["a31 a42 a14 a24"] and len(PRINTED_TERMS) == 14
    rng = np.random.default_rng(1)
    matrix = rng.normal(size=(4, 4)) + 1j * rng.normal(size=(4, 4))
    matrix[0, 1] = matrix[1, 0] = 0.0
    misprint = matrix[2, 0] * matrix[3, 1] * matrix[0, 3] * (matrix[1, 2] - matrix[1, 3])
    assert printed_determinant(matrix) - misprint == pytest.approx(np.linalg.det(matrix))
    car = P.half_car
    # The matrix of the source at a line: front wheel, a22 = -mf w^2 + ktf + kf + jw (ctf + cf).
    rate, front = 2j * np.pi * 3.0, car.front
    expected = front.unsprung_mass * rate**2 + front.tyre_stiffness + front.suspension_stiffness
    expected += rate * (front.tyre_damping + front.suspension_damping)
    assert half_car_matrix(car, 3.0)[1, 1] == pytest.approx(expected)
    assert half_car_matrix(car, 3.0)[0, 1] == half_car_matrix(car, 3.0)[1, 0] == 0.0


def test_the_city_road_is_listed_and_not_judged(results):
    rows = {row["name"]: row for row in json.loads((results / "results.json").read_text(encoding="utf-8"))["rows"]}
    row = rows["quarter car optimum on the city road against the highway"]
    assert row["status"] == "not testable" and "printed measure: city" in row["ours"]
    assert rows["determinant D below equation 6"]["within"] is False


def test_a_flank_that_the_distance_turns_is_undecided(results):
    rows = {row["name"]: row for row in json.loads((results / "results.json").read_text(encoding="utf-8"))["rows"]}
    row = rows["half car front: steeper below the optimum than above, printed measure"]
    pairs = [[float(value) for value in pair] for pair in re.findall(r"([\d.]+) / ([\d.]+) \(", row["ours"])]
    assert len(pairs) == 3 and len({below > above for below, above in pairs}) == 2 and row["within"] is None


def test_the_order_of_the_wheel_curves():
    lines = np.arange(0.1, 12.0, 0.1)
    soft, firm = 1.0 + 0.0 * lines, 1.0 + 0.1 * np.sign(6.0 - lines)
    firm[lines < 2.0] = 1.0
    assert region_verdicts(lines, np.array([soft, firm]), 2.0) == (True, True)
    assert region_verdicts(lines, np.array([firm, soft]), 2.0) == (True, False)
    firm[lines < 2.0] = 1.2
    assert region_verdicts(lines, np.array([soft, firm]), 2.0) == (False, True)


def test_one_coefficient_gives_the_linear_tyre_load_and_rebound_pulls_the_body_down():
    comparison = compare_curves(P, duration=6.0)
    linear = tyre_load_ratio(quarter_car_model(P.quarter_car), P.highway, P.bands)[0]
    assert comparison.tyre_load[0].mean() == pytest.approx(linear, rel=0.1)  # four roads of 4 s: 5 % each
    # F = c v + d |v| with d = c / 3 has the mean d E|v|, which the spring must hold.
    car = P.quarter_car
    mean = car.wheel.suspension_damping / 3.0 * comparison.velocity * np.sqrt(2.0 / np.pi)
    assert (comparison.height[0] - comparison.height[2]).mean() == pytest.approx(
        mean / car.wheel.suspension_stiffness, rel=0.1
    )
    velocity, (constant, low, rebound) = comparison.curves
    np.testing.assert_allclose(constant, car.wheel.suspension_damping * velocity)
    np.testing.assert_allclose(low[::-1], -low, atol=1e-9)
    assert rebound[-1] == pytest.approx(-2.0 * rebound[0])


def test_trade_off_scales_with_the_class_and_has_its_optima_inside():
    trade = trade_off(P.quarter_car, np.geomspace(200.0, 10000.0, 41))
    for name in ("tyre_load", "acceleration", "travel"):
        a, d = (np.array([getattr(measure, name) for measure in trade.measures[road]]) for road in "AD")
        np.testing.assert_allclose(d, 8.0 * a, rtol=1e-12)  # density 64 times, amplitude 8 times
    assert 200.0 < trade.best("acceleration") < trade.best("tyre_load") < 10000.0
    assert np.all(np.diff([measure.travel for measure in trade.measures["A"]]) < 0.0)


def test_trade_off_grid_is_fine_enough(monkeypatch):
    before = trade_off(P.quarter_car, [500.0, 3000.0]).measures["A"]
    monkeypatch.setattr("scenarios.damper_choice.runs.EDGES", np.geomspace(0.1, 50.0, 1601))
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


def test_quick_contradicts_no_verdict_of_the_full_study(results):
    assert contradictions("damper_choice", results) == []
