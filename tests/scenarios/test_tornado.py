"""`python -m scenarios.tornado` as a user runs it, and what its bars mean."""

import dataclasses
import json

import pytest

from scenarios.tornado import PARAMETERS, Bar, bar_table, main, tornado_claims, variation
from tests.scenarios.kept_table import contradictions
from tests.scenarios.test_comfort_sensitivity import made
from vehicle.model.parameters.vehicle import load_vehicle


def test_a_short_study_ranks_the_parameters(tmp_path):
    folder = tmp_path / "tornado"
    assert main(["--output", str(folder), "--quick"]) == 0
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert (folder / "tornado.png").exists()
    labels = [bar["label"] for bar in content["bars"]]
    assert len(labels) == len(PARAMETERS) == 8
    # The whole input comes through the tyre, and a fifth of the main spring is 2 % of the stiffness with a stuck
    # damper: no length of record moves one from the top or the other from the last three.
    assert labels[0].startswith("tyre stiffness")
    assert any(label.startswith("main spring") for label in labels[-3:])
    assert [row["within"] for row in content["rows"]] == [True, True, True]
    assert contradictions("tornado", folder) == []


def test_ends_are_a_fifth_away_unless_said_otherwise():
    vehicle = load_vehicle()
    ends_by_label = {parameter.label: variation(vehicle, parameter).values for parameter in PARAMETERS}
    assert ends_by_label["Coulomb friction Fd [N]"] == pytest.approx((100.0, 150.0))
    assert ends_by_label["tyre stiffness, z [N/m]"] == pytest.approx((2.0e5, 3.0e5))
    low, high = ends_by_label["body stiffness, as factor on its frequencies [-]"]
    assert (low**2, high**2) == pytest.approx((0.8, 1.2))
    mount = next(parameter for parameter in PARAMETERS if "mount damping" in parameter.label)
    assert variation(vehicle, mount).values == (0.0, 500.0) and mount.reason


def bar(label, low, high):
    return Bar(
        label=label,
        nominal=1.0,
        low=0.8,
        high=1.2,
        reason="",
        at_low={road: made(0.8, low) for road in ("smooth", "rough")},
        at_high={road: made(1.2, high) for road in ("smooth", "rough")},
    )


def test_conclusions_disagree_where_the_bars_do():
    names = ("Coulomb friction", "suspension mount damping", "suspension mount stiffness")
    good = [bar(name, *pair) for name, pair in zip(names, ((0.9, 1.1), (1.1, 0.9), (1.1, 0.9)), strict=True)]
    assert all(claim.within for claim in tornado_claims(good))
    bad = [dataclasses.replace(good_bar, at_low=good_bar.at_high, at_high=good_bar.at_low) for good_bar in good]
    assert not any(claim.within for claim in tornado_claims(bad))
    assert "| Coulomb friction | 1 | 0.8, 1.2 | 90.00 ± 0.10, 110.00 ± 0.10 | 20.0 | 90.00, 110.00 |" in bar_table(good)


def test_a_swing_counts_the_nominal_car():
    both_up = bar("x", 1.02, 1.05)
    assert both_up.swing("smooth") == pytest.approx(0.05)
