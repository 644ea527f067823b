import json

import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis import evaluation
from vehicle.signals.analysis.contact_vibration import ContactVibration
from vehicle.signals.analysis.evaluation import (
    APPLICATIONS,
    application,
    offset_effect,
    offset_line,
    without_offset,
)
from vehicle.signals.analysis.weighting import weighted_record, weighting

STEP = 1e-3
TIME = np.arange(60_000) * STEP


def evaluate(*arguments, **options):
    """The values as in a file."""
    values = evaluation.evaluate(*arguments, **options)
    assert ContactVibration.from_json(values.to_json()) == values
    return values.to_json()


def sine(frequency, amplitude=1.0):
    return amplitude * np.sin(2 * np.pi * frequency * TIME)


def test_the_seat_is_weighted_wd_wd_wk():
    found = evaluate(STEP, [sine(1.0, 0.5), sine(4.0, 0.7), sine(8.0)])
    assert [found[axis]["weighting"] for axis in "xyz"] == ["Wd", "Wd", "Wk"]
    expected = [0.5 * weighting("Wd").spectrum_factor(1.0), 0.7 * weighting("Wd").spectrum_factor(4.0)]
    expected = np.array([*expected, weighting("Wk").spectrum_factor(8.0)]) / np.sqrt(2)
    # the filters start from rest: of the RMS of 60 s the first second differs; maxima are taken after it
    assert [found[axis]["weighted_rms"] for axis in "xyz"] == pytest.approx(expected, rel=5e-3)
    assert found["z"]["vdv"] == pytest.approx(2.257, abs=0.0005)
    assert found["z"]["crest_factor"] == pytest.approx(np.sqrt(2), rel=1e-3)
    assert found["z"]["mtvv"] == pytest.approx(expected[2], rel=1e-3)
    assert found["z"]["estimated_vdv"] == pytest.approx(1.4 * found["z"]["weighted_rms"] * 60**0.25, rel=1e-12)
    # comfort with k = 1, health with k = 1.4, 1.4, 1
    assert found["vector_sum"]["weighted_rms"] == pytest.approx(np.linalg.norm(expected), rel=5e-3)
    assert found["vector_sum"]["health_weighted_rms"] == pytest.approx(
        np.linalg.norm(expected * [1.4, 1.4, 1.0]), rel=5e-3
    )
    assert found["vector_sum"]["vdv"] == pytest.approx(sum(found[axis]["vdv"] ** 4 for axis in "xyz") ** 0.25)
    assert (found["duration_s"], found["place"]) == (pytest.approx(60.0), "seat")
    assert len(found["reasons"]) == 4 and "z: MTVV" in found["reasons"][2] and "3.5 s" in found["reasons"][2]
    assert all(word in found["reasons"][3] for word in ("msdv", "60 s", "6.0 periods of 0.1 Hz", "240 s"))
    # of a record that starts at rest the switching-on is real: 1.5 instead of 1.414
    rest = evaluate(STEP, [sine(1.0, 0.5), sine(4.0, 0.7), sine(8.0)], from_rest=True)
    assert 1.02 < rest["z"]["crest_factor"] / found["z"]["crest_factor"] < 1.1
    assert rest["reasons"] == found["reasons"][3:]


def test_a_shock_within_the_settling_time_gives_no_impossible_ratio():
    """Maxima after 3.5 s over the RMS with the shock were a crest factor of 0.57; it is at least 1."""
    quiet = 1e-2 * np.random.default_rng(1).standard_normal(sine(8.0).size)
    shock = quiet.copy()
    shock[round(2.5 / STEP) :][: round(0.02 / STEP)] += 100.0
    found = evaluate(STEP, [shock] * 3)
    weighted = weighted_record(STEP, shock, "Wk")[round(3.5 / STEP) :]
    rms = np.sqrt(np.mean(weighted**2))
    assert found["z"]["weighted_rms"] > 5.0 * rms
    assert found["z"]["crest_factor"] == pytest.approx(np.max(np.abs(weighted)) / rms, rel=1e-9)
    assert found["z"]["mtvv_ratio"] == pytest.approx(found["z"]["mtvv"] / rms, rel=1e-9)
    assert sum(text.startswith("z: MTVV") for text in found["reasons"]) == 1


def test_motion_sickness_uses_wf():
    found = evaluate(STEP, [sine(8.0), sine(8.0), sine(0.2)])
    expected = weighting("Wf").spectrum_factor(0.2) * np.sqrt(60 / 2)
    # after the 17.5 s of settling 8.5 periods are left, whose mean square is that of the sine within 0.5 %
    assert found["z"]["msdv"] == pytest.approx(expected, rel=5e-3)
    assert found["z"]["msdv_weighting"] == "Wf"
    assert found["x"]["msdv"] < 0.02 * expected


def test_the_backrest_has_its_own_weightings_and_factors():
    found = evaluate(STEP, [sine(8.0), sine(2.0), sine(2.0)], contact="backrest")
    assert [found[axis]["weighting"] for axis in "xyz"] == ["Wc", "Wd", "Wd"]
    rms = [found[axis]["weighted_rms"] for axis in "xyz"]
    assert rms[0] == pytest.approx(weighting("Wc").spectrum_factor(8.0) / np.sqrt(2), rel=5e-3)
    assert found["vector_sum"]["weighted_rms"] == pytest.approx(np.linalg.norm(np.multiply(rms, [0.8, 0.5, 0.4])))
    assert found["vector_sum"]["health_weighted_rms"] is None and "backrest" in found["reasons"][-1]


def test_every_point_of_contact_evaluates_and_writes_json():
    xyz = np.random.default_rng(0).standard_normal((3, 4000))
    for place in APPLICATIONS:
        found = evaluate(STEP, xyz, contact=place, average="exponential")
        assert json.loads(json.dumps(found, allow_nan=False)) == found
        assert [found[axis]["weighting"] for axis in "xyz"] == list(APPLICATIONS[place].weightings)


def test_an_axis_of_zeros_has_none_and_a_reason():
    found = evaluate(STEP, [0.0 * TIME, sine(4.0), sine(8.0)])
    assert found["x"]["weighted_rms"] == 0.0
    assert found["x"]["crest_factor"] is found["x"]["vdv_ratio"] is None
    assert found["reasons"][0].startswith("x: ")


def test_bad_records_and_points_of_contact_are_rejected():
    for step, xyz, message in (
        (STEP, np.ones((2, 100)), "2 signals, .* x, y, z"),
        (STEP, np.zeros((3, 100)), "zero throughout"),
        (0.05, np.ones((3, 100)), "found 20 Hz, .* 25 Hz for Wd"),
        (SLOW_STEP, ride(3.0), r" 3 s, .* 3\.5 s .*--offset keep"),
    ):
        with pytest.raises(DataError, match=message):
            evaluate(step, xyz)
    with pytest.raises(ConfigurationError, match=r"seat, backrest.* not 'sofa'"):
        application("sofa")


def test_an_offset_acts_as_a_step():
    xyz = np.stack([sine(8.0, 0.1), sine(8.0) + 9.81, 0.0 * TIME])
    effect = offset_effect(STEP, xyz)
    assert effect[0] < 1e-5  # the line through a sine of 480 periods rises by 4 mm/s2
    assert effect[2] == 0.0
    # the energies of sine and step add: step response of Wd integrated numerically from its polynomials in s gives the
    # square of the change
    alone, clean, both = (
        evaluate(STEP, [sine(8.0), y, sine(8.0)], from_rest=True)["y"]
        for y in (np.full(TIME.size, 9.81), sine(8.0), xyz[1])
    )
    rms = np.hypot(alone["weighted_rms"], clean["weighted_rms"])
    assert both["weighted_rms"] == pytest.approx(rms, rel=0.03)
    assert rms / clean["weighted_rms"] > 2.0
    # the dose feels it even more
    assert effect[1] == pytest.approx(both["vdv"] / clean["vdv"] - 1.0, rel=1e-3)
    assert offset_effect(STEP, without_offset(xyz)) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_a_pure_offset_has_an_infinite_effect_and_is_removed_exactly():
    xyz = np.stack([sine(8.0), sine(8.0), np.full(TIME.size, 9.81)])
    assert offset_effect(STEP, xyz)[2] == np.inf
    assert not without_offset(xyz)[2].any()


SLOW_STEP = 1 / 250


def ride(duration, frequency=4.0):
    """Three sines of unit amplitude at 250 Hz that were going on before the record."""
    time = np.arange(round(duration / SLOW_STEP)) * SLOW_STEP
    return np.stack([np.cos(2 * np.pi * frequency * time + phase) for phase in (0.3, 1.0, 2.0)])


@pytest.mark.parametrize("duration", [60.0, 600.0])
@pytest.mark.parametrize("bias", [9.81, np.linspace(-1.0, 1.0)], ids=["gravity", "drift"])
def test_maxima_and_sickness_dose_are_independent_of_mean_and_drift(duration, bias):
    clean = ride(duration, 0.2) + ride(duration)
    bias = np.interp(np.linspace(0, 1, clean.shape[1]), np.linspace(0, 1, np.size(bias)), np.atleast_1d(bias))
    with_bias = evaluate(SLOW_STEP, clean + bias)
    without = evaluate(SLOW_STEP, clean)
    for axis in "xyz":
        # 1 % of the step of gravity is left when the filters count as settled, and falls by 20 within 3 s
        for key in ("mtvv", "crest_factor", "mtvv_ratio", "msdv"):
            assert with_bias[axis][key] == pytest.approx(without[axis][key], rel=0.015)
    # from the first sample on the peak is that of the step
    whole = evaluate(SLOW_STEP, clean + bias, from_rest=True)["z"]
    peak = without["z"]["crest_factor"] * without["z"]["weighted_rms"]
    assert whole["crest_factor"] * whole["weighted_rms"] > 1.2 * peak


def test_the_offset_of_a_long_record_shows_in_its_dose():
    xyz = 0.7 * ride(600.0) + np.array([[0.0], [0.0], [9.81]])
    effect = offset_effect(SLOW_STEP, xyz)
    assert effect[:2].max() < 1e-4
    assert effect[2] > 0.05
    line = offset_line(xyz + np.linspace(-1.0, 1.0, xyz.shape[1]))
    assert line[2, [0, -1]] == pytest.approx([8.81, 10.81], abs=1e-3)
    assert offset_line(without_offset(xyz)) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("duration", "limit"), [(20.0, "43.2 s"), (50.0, "240 s")])
def test_a_record_must_hold_the_lowest_frequency_of_its_weighting(duration, limit):
    found = evaluate(SLOW_STEP, ride(duration))
    assert (found["z"]["msdv"] is None) == (duration == 20.0)
    for words in ("msdv", f"{duration:g} s", f"{duration / 10:.1f} periods of 0.1 Hz", limit):
        assert words in found["reasons"][-1]


def test_a_record_is_an_event_a_ride_or_long_enough_for_sickness():
    short = evaluate(SLOW_STEP, ride(5.0))["reasons"]
    assert any(text.startswith("z: 5 s") and "2.5 periods of 0.5 Hz" in text for text in short)
    assert not any("msdv" in reason for reason in evaluate(SLOW_STEP, ride(240.0))["reasons"])
    assert evaluate(SLOW_STEP, ride(3.0), from_rest=True)["z"]["weighted_rms"] > 0.0


def test_the_skipped_time_is_not_evaluated():
    xyz = ride(60.0)
    xyz[:, :1000] *= 10.0
    found = evaluate(SLOW_STEP, xyz, skip=10.0)
    assert found["duration_s"] == pytest.approx(50.0)
    # 4 s of the large part have gone; 6 s later its decay is below 1e-4
    assert found["z"]["weighted_rms"] == pytest.approx(weighting("Wk").spectrum_factor(4.0) / np.sqrt(2), rel=1e-3)
    for skip in (-5.0, np.nan, np.inf, 60.0):
        with pytest.raises(ConfigurationError, match=rf"^skip: found {skip:g} s, .* 60 s$"):
            evaluate(SLOW_STEP, xyz, skip=skip)
