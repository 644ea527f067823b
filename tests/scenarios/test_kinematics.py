"""`python -m scenarios.kinematics` as a user runs it, and what its closed forms are worth."""

import json
from dataclasses import replace

import numpy as np
import pytest

from scenarios.kinematics import axles_of, bump_steer_gain, claims, main, measured
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car

TRAVELS = (-0.02, 0.0, 0.02)


@pytest.fixture(scope="module")
def reference():
    return Car.load(vehicle_file("kinematic_reference"))


def test_the_study(tmp_path, capsys):
    folder = tmp_path / "kinematics"
    arguments = ["--output", str(folder), "--quick", "--vehicle", "focus", "--vehicle", "kinematic_reference"]
    assert main(arguments) == 0
    assert "6 own check (6 agree)" in capsys.readouterr().out
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert list(content["axles"]) == ["focus, front", "kinematic_reference, front", "kinematic_reference, rear"]
    # According to its source the tie rod of this car was changed: it steers by 2 deg over 100 mm.
    assert content["axles"]["kinematic_reference, front"]["equal"]["toe_deg_per_m"] == pytest.approx(-21.7, abs=0.1)
    assert content["moved"]["kinematic_reference"]["neutral_m"] == pytest.approx(0.031, abs=1e-3)
    text = (folder / "results.md").read_text(encoding="utf-8")
    assert "| kinematic_reference, rear | twist_beam | 0 | 0 |" in text
    assert "| kinematic_reference | -2.17 | -1.47 | +31 |" in text
    assert (folder / "travel.png").stat().st_size > 15_000


def test_the_point_that_steers_least(reference):
    """Check that toe is nearly constant over small travel with the tie rod at the computed neutral height."""
    change = f"front.hardpoints.tie_inner.z={0.655 + 0.031}"
    moved = measured(Car.load(vehicle_file("kinematic_reference"), [change]), "front", TRAVELS)
    assert abs(moved.slopes["toe_deg_per_m"] or np.nan) < 0.4
    assert bump_steer_gain(reference) == pytest.approx(721.3, abs=0.1)


def test_the_spring_alone_makes_the_rate_where_bushings_are_stiff(reference):
    """k i^2 + F di/dz is the wheel rate of the axle when its bushings neither yield nor twist."""
    stiff = []
    for name in ("suspension_mount", "arm_rear", "arm_front"):
        stiff += [f"front.bushings.{name}.stiffness=[1e9, 1e9, 1e9]", f"front.bushings.{name}.rotational_stiffness=0"]
    axle = measured(Car.load(vehicle_file("kinematic_reference"), stiff), "front", TRAVELS)
    # The remainder is the static horizontal force of the tyres and the weight of the parts.
    assert axle.from_spring == pytest.approx(float(axle.slopes["wheel_rate_n_per_m"] or 0.0), rel=0.02)


def test_rows_disagree_where_the_numbers_do(reference):
    axles = axles_of([reference, reference], TRAVELS)
    assert [axle.label for axle in axles] == ["kinematic_reference, front", "kinematic_reference, rear"]
    assert all(claim.within for claim in claims(axles, []))
    turned = [replace(axle, equal=axles[0].equal, rolling={"wheel_rate_n_per_m": 0.0}) for axle in axles]
    assert not any(claim.within for claim in claims(turned, []))
