"""`python -m scenarios.kinematics` as a user runs it, and what its closed forms are worth."""

import json
from dataclasses import replace

import numpy as np
import pytest

from scenarios.kinematics.__main__ import main
from scenarios.kinematics.axles import POINT, Moved, axles_of, bump_steer_gain, measured
from scenarios.kinematics.claims import claims
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car

TRAVELS = (-0.02, 0.0, 0.02)
MOVED = Moved(label="", shifts=(-0.01, 0.0, 0.01), curves=[], toe_slopes=(1.0, 3.0, 5.0), closed_form=np.nan)


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
    assert "| kinematic_reference, rear | twist_beam | 0 | 0 |" in text and "moved by +31 mm" in text
    for name in ("travel", "compliance", "point_moved"):
        assert (folder / f"{name}.png").stat().st_size > 15_000


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--shift", "0"], "--shift 0: allowed are 0.1 to 100 mm"),
        (["--vehicle", "focus", "--point", "front.hardpoints.pivot.z"], "--point front.hardpoints.pivot.z: no car has"),
    ],
)
def test_refusals(arguments, message, tmp_path, capsys):
    assert main(["--output", str(tmp_path / "none"), "--quick", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_the_point_that_steers_least(reference):
    """Check that toe is nearly constant over small travel with the tie rod at the computed neutral height."""
    assert (MOVED.gain, MOVED.neutral) == pytest.approx((200.0, -0.015))
    assert not np.isfinite(replace(MOVED, toe_slopes=(1.0, 1.0, 1.0)).neutral)
    change = f"front.hardpoints.tie_inner.z={0.655 + 0.031}"
    moved = measured(Car.load(vehicle_file("kinematic_reference"), [change]), "front", TRAVELS)
    assert abs(moved.slopes["toe_deg_per_m"] or np.nan) < 0.4
    assert np.isnan(bump_steer_gain(reference, "rear", POINT))
    assert bump_steer_gain(reference, "front", POINT) == pytest.approx(721.3, abs=0.1)


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
