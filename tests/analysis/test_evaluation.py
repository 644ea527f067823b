import json

import numpy as np
import pytest

from vehicle.analysis.evaluation import APPLICATIONS, application, evaluate
from vehicle.analysis.offset import offset_effect, without_offset
from vehicle.analysis.weighting import weighting
from vehicle.errors import ConfigurationError, DataError

STEP = 1e-3
TIME = np.arange(60_000) * STEP


def sine(frequency, amplitude=1.0):
    return amplitude * np.sin(2 * np.pi * frequency * TIME)


def test_the_seat_is_weighted_wd_wd_wk():
    found = evaluate(STEP, [sine(1.0, 0.5), sine(4.0, 0.7), sine(8.0)])
    assert [found[axis]["weighting"] for axis in "xyz"] == ["Wd", "Wd", "Wk"]
    expected = [0.5 * weighting("Wd").spectrum_factor(1.0), 0.7 * weighting("Wd").spectrum_factor(4.0)]
    expected = np.array([*expected, weighting("Wk").spectrum_factor(8.0)]) / np.sqrt(2)
    # the filters start from rest: of 60 s the first second differs
    assert [found[axis]["weighted_rms"] for axis in "xyz"] == pytest.approx(expected, rel=5e-3)
    assert found["z"]["vdv"] == pytest.approx(2.257, abs=0.0005)
    assert found["z"]["crest_factor"] == pytest.approx(np.sqrt(2), rel=0.1)  # the switching-on overshoots
    assert found["z"]["mtvv"] == pytest.approx(expected[2], rel=0.01)
    assert found["z"]["estimated_vdv"] == pytest.approx(1.4 * found["z"]["weighted_rms"] * 60**0.25, rel=1e-12)
    # comfort with k = 1, health with k = 1.4, 1.4, 1
    assert found["vector_sum"]["weighted_rms"] == pytest.approx(np.linalg.norm(expected), rel=5e-3)
    assert found["vector_sum"]["health_weighted_rms"] == pytest.approx(
        np.linalg.norm(expected * [1.4, 1.4, 1.0]), rel=5e-3
    )
    assert found["vector_sum"]["vdv"] == pytest.approx(sum(found[axis]["vdv"] ** 4 for axis in "xyz") ** 0.25)
    assert (found["duration_s"], found["place"], found["reasons"]) == (pytest.approx(60.0), "seat", [])


def test_motion_sickness_uses_wf():
    found = evaluate(STEP, [sine(8.0), sine(8.0), sine(0.2)])
    expected = weighting("Wf").spectrum_factor(0.2) * np.sqrt(60 / 2)
    # the filter needs some 10 s of the 60 to come to its steady state
    assert found["z"]["msdv"] == pytest.approx(expected, rel=0.1)
    assert found["z"]["msdv_weighting"] == "Wf"
    assert found["x"]["msdv"] < 0.02 * expected


def test_the_backrest_has_its_own_weightings_and_factors():
    found = evaluate(STEP, [sine(8.0), sine(2.0), sine(2.0)], place="backrest")
    assert [found[axis]["weighting"] for axis in "xyz"] == ["Wc", "Wd", "Wd"]
    rms = [found[axis]["weighted_rms"] for axis in "xyz"]
    assert rms[0] == pytest.approx(weighting("Wc").spectrum_factor(8.0) / np.sqrt(2), rel=5e-3)
    assert found["vector_sum"]["weighted_rms"] == pytest.approx(np.linalg.norm(np.multiply(rms, [0.8, 0.5, 0.4])))
    assert found["vector_sum"]["health_weighted_rms"] is None
    assert found["reasons"] == ["vector_sum.health_weighted_rms: the standard gives no health factors for backrest"]


def test_every_place_evaluates_and_writes_json():
    xyz = np.random.default_rng(0).standard_normal((3, 4000))
    for place in APPLICATIONS:
        found = evaluate(STEP, xyz, place=place, average="exponential")
        assert json.loads(json.dumps(found, allow_nan=False)) == found
        assert [found[axis]["weighting"] for axis in "xyz"] == list(APPLICATIONS[place].weightings)


def test_an_axis_of_zeros_has_none_and_a_reason():
    found = evaluate(STEP, [0.0 * TIME, sine(4.0), sine(8.0)])
    assert found["x"]["weighted_rms"] == 0.0
    assert found["x"]["crest_factor"] is None
    assert found["x"]["vdv_ratio"] is None
    assert found["reasons"] == ["x: zero throughout, so crest factor and ratios are undefined"]


def test_doubling_the_acceleration_doubles_every_value_but_the_ratios():
    xyz = np.random.default_rng(1).standard_normal((3, 4000))
    once, twice = evaluate(STEP, xyz)["y"], evaluate(STEP, 2 * xyz)["y"]
    for key in ("weighted_rms", "mtvv", "vdv", "estimated_vdv", "msdv"):
        assert twice[key] == pytest.approx(2 * once[key], rel=1e-12)
    for key in ("crest_factor", "mtvv_ratio", "vdv_ratio"):
        assert twice[key] == pytest.approx(once[key], rel=1e-12)


def test_bad_records_and_places_are_refused():
    with pytest.raises(DataError, match="found 2 signals, needed are the three axes"):
        evaluate(STEP, np.ones((2, 100)))
    with pytest.raises(DataError, match="all three axes are zero throughout"):
        evaluate(STEP, np.zeros((3, 100)))
    with pytest.raises(DataError, match="sampling rate: found 100 Hz, weighting Wd needs at least 250 Hz"):
        evaluate(0.01, np.ones((3, 100)))
    with pytest.raises(ConfigurationError, match="point of contact: found 'sofa', allowed are seat, backrest"):
        application("sofa")


def test_an_offset_shows_as_the_step_it_is():
    xyz = np.stack([sine(8.0, 0.1), sine(8.0) + 9.81, 0.0 * TIME])
    effect = offset_effect(STEP, xyz)
    assert effect[0] < 1e-6
    assert effect[2] == 0.0
    # the energies of sine and step add: step response of Wd integrated numerically from its polynomials in s gives the
    # square of the change
    alone = evaluate(STEP, [sine(8.0), np.full(TIME.size, 9.81), sine(8.0)])["y"]["weighted_rms"]
    clean = evaluate(STEP, [sine(8.0), sine(8.0), sine(8.0)])["y"]["weighted_rms"]
    assert effect[1] == pytest.approx(np.hypot(alone, clean) / clean - 1, rel=0.05)
    assert effect[1] > 1.0
    assert offset_effect(STEP, without_offset(xyz)) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_a_pure_offset_has_an_infinite_effect_and_nothing_is_left_of_it():
    xyz = np.stack([sine(8.0), sine(8.0), np.full(TIME.size, 9.81)])
    assert offset_effect(STEP, xyz)[2] == np.inf
    assert not without_offset(xyz)[2].any()
