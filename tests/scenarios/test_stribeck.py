"""`python -m scenarios.stribeck` as a user runs it, and how the extra peaks are found."""

import dataclasses
import json

import numpy as np
import pytest

from scenarios.signals.bump import bump
from scenarios.stribeck import force_error, law_force, peak_claims
from tests.scenarios.kept_table import contradictions
from vehicle.runs.car import Car
from vehicle.signals.analysis.slip import extra_peaks, most_prominent, slip_phases

TIME = np.arange(0.0, 1.0, 1e-3)


def test_the_extra_peak_is_there_with_stribeck_alone(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    assert {row["name"]: row["within"] for row in content["rows"]} == {
        "extra peak after stick ends, Stribeck": True,
        "extra peak after stick ends, Coulomb": True,
        "damper force over velocity against equations 3.1 and 3.2": True,
        "highest velocity of the damper over the 7.5 mm bump, both laws [m/s]": True,
        "lowest force of the damper over the 7.5 mm bump, both laws [N]": None,  # an axis with one readable label
    }
    assert all(len(counts) in (0, 2) for counts in content["extra_peaks_over_seeds"].values())
    largest = {
        law: max((peak["prominence"] for phase in phases for peak in phase["peaks"]), default=0.0)
        for law, phases in content["phases"].items()
    }
    # The falling branch of the Stribeck law (-2600 N s/m against D 2250) makes the strut swing on its mount.
    assert largest["Stribeck"] > 2.0 * largest["Coulomb"]
    assert {"relative_acceleration.png", "force_velocity.png"} <= {path.name for path in results.iterdir()}


def slip(burst):
    """A slip from 0.3 to 0.5 s: a break-away jump of 4 m/s2 that decays, and a burst of a height at 0.33 s."""
    inside = (TIME >= 0.3) & (TIME <= 0.5)
    velocity = np.where(inside, 0.02, 0.0)
    since = TIME - 0.3
    relative = np.where(inside, 4.0 * np.exp(-since / 0.01), 0.0)
    relative += burst * np.exp(-(((TIME - 0.33) / 0.003) ** 2))
    return slip_phases(TIME, velocity, relative, saturated=1e-3, begin=0.2, until=0.6)


def test_a_burst_after_break_away_is_an_extra_peak():
    phases = slip(3.0)
    assert len(phases) == 1
    assert phases[0].jump == pytest.approx(4.0)
    assert phases[0].start == pytest.approx(0.3)
    # The burst, and the valley after the jump.
    valley, burst = extra_peaks(phases)
    assert 0.315 < valley.time < burst.time
    assert burst.time == pytest.approx(0.33, abs=1e-3)
    assert burst.delay == pytest.approx(0.03, abs=1e-3)
    # The burst is added to the remainder of the jump, 4 exp(-3) = 0.2.
    assert burst.height == pytest.approx(3.2, abs=0.05)
    assert burst.prominence == pytest.approx(3.0, abs=0.3)
    assert most_prominent(phases) in (valley, burst)


def test_a_small_burst_and_the_jump_itself_are_none():
    assert extra_peaks(slip(1.5)) == []
    assert most_prominent(slip(0.0)) is None
    assert extra_peaks([]) == []


def test_slips_outside_the_stretch_and_short_ones_do_not_count():
    velocity = np.where((TIME >= 0.3) & (TIME < 0.31), 0.02, 0.0) + np.where(TIME > 0.8, 0.02, 0.0)
    assert slip_phases(TIME, velocity, np.sin(300.0 * TIME), saturated=1e-3, begin=0.2, until=0.6) == []


def test_law_of_equations_3_1_and_3_2():
    coulomb = Car.load().vehicle.damper
    stribeck = Car.load(overrides=["damper.friction_law=stribeck", "damper.coulomb_friction=65"]).vehicle.damper
    # 2250 N s/m at 0.1 m/s; the arctangent of eps v is short of its limit by 2/(pi eps v): 6e-5, and 2e-4 at 0.03 m/s.
    assert law_force(coulomb, 0.1) == pytest.approx(225.0 + 125.0, rel=1e-4)
    # exp(-(0.1/0.03)^3.5) is zero: only Fd is left; at 0.03 m/s a share 1/e of the difference is.
    assert law_force(stribeck, -0.1) == pytest.approx(-225.0 - 65.0, rel=1e-4)
    knee = dataclasses.replace(coulomb, viscous_law="degressive", degressive_viscous=15000.0, degressive_velocity=0.02)
    assert law_force(knee, 0.1) == pytest.approx(15000.0 * 0.02 + 2250.0 * 0.08 + 125.0, rel=1e-4)
    assert law_force(stribeck, 0.03) == pytest.approx(67.5 + 65.0 + 60.0 / np.e, rel=2e-4)


def test_force_error_sees_another_law(car):
    run = car.run(bump(amplitude=7.5e-3, wheel="fr", duration=1.2, start=0.3, noise_rms=0.0))
    assert force_error(run) < 0.012
    recording = run.recording
    channels = {**recording.channels, "damper_fr_force": 1.05 * recording["damper_fr_force"]}
    bent = dataclasses.replace(run, recording=dataclasses.replace(recording, channels=channels))
    assert force_error(bent) > 0.012
    phases = {"Stribeck": slip(0.0), "Coulomb": slip(3.0)}
    rows = peak_claims({"Stribeck": bent, "Coulomb": bent}, phases, {"Stribeck": [0, 0], "Coulomb": [1, 2]})
    assert [row.within for row in rows] == [False, False, False]
    # One seed of three as printed is no rare one.
    rows = peak_claims({"Stribeck": bent, "Coulomb": bent}, phases, {"Stribeck": [0, 2], "Coulomb": [1, 0]})
    assert [row.within for row in rows] == [True, True, False]
    assert str(rows[0].ours).startswith("present with 1 of 3 seeds of the noise; pictured run: 0,")


def test_quick_contradicts_no_verdict_of_the_full_study(results):
    assert contradictions("stribeck", results) == []
