"""`python -m scenarios.wheel_shake` as a user runs it: friction makes the shake of a wheel, a road takes it."""

import json

import pytest

from scenarios.wheel_shake import NO_FRICTION, friction_claims, main


def test_sticking_dampers_shake_more_and_a_road_frees_them(tmp_path):
    folder = tmp_path / "study"
    assert main(["--output", str(folder), "--quick", "--engine", "reduced"]) == 0
    rows = json.loads((folder / "results.json").read_text(encoding="utf-8"))["shake"]
    shake = {(row["road"], row["speed_kmh"], row["grams"]): row["shake_per_kg_m"] for row in rows}
    assert all(claim.within for claim in friction_claims(shake))
    # Dampers without friction: a linear car but for the degressive curve of its dampers, on every road.
    free = shake[NO_FRICTION, 140.0, 20.0]
    assert shake[NO_FRICTION, 140.0, 80.0] == pytest.approx(free, rel=0.05)
    assert shake["smooth", 140.0, 20.0] > 1.8 * free
    assert free < shake["class B", 140.0, 20.0] < shake["class A", 140.0, 20.0] < shake["smooth", 140.0, 20.0]
    assert (folder / "wheel_shake.png").stat().st_size > 20_000
    claims = friction_claims({**shake, ("class A", 140.0, 20.0): shake["smooth", 140.0, 20.0]})
    assert [claim.within for claim in claims] == [True, False]
