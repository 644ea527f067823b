import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.exposure import (
    crest_factor,
    estimated_vibration_dose_value,
    motion_sickness_dose_value,
    mtvv,
    vector_sum,
    vibration_dose_value,
    weighted_rms,
)
from vehicle.signals.analysis.weighting import weighted_record, weighting

STEP = 1e-3
SINE = np.sin(2 * np.pi * 8.0 * np.arange(60_000) * STEP)


def test_measures_of_a_sine_are_their_closed_forms():
    # whole periods, an even number of samples in each: exact but for rounding
    assert weighted_rms(3.0 * SINE) == pytest.approx(3.0 / np.sqrt(2.0), rel=1e-12)
    assert crest_factor(3.0 * SINE) == pytest.approx(np.sqrt(2.0), rel=1e-4)  # the top lies between samples
    assert vibration_dose_value(STEP, SINE) == pytest.approx((3 / 8 * 60) ** 0.25, rel=1e-12)
    assert motion_sickness_dose_value(STEP, SINE) == pytest.approx(np.sqrt(60 / 2), rel=1e-12)
    assert mtvv(STEP, SINE) == pytest.approx(np.sqrt(0.5), rel=1e-12)


def test_vdv_of_a_unit_sine_of_8_hz_over_60_s_weighted_with_wk():
    # VDV = |Wk(8 Hz)| (3/8 T)^(1/4) = 1.0364 * 2.1780 = 2.257
    steady = float(weighting("Wk").spectrum_factor(8.0)) * (3 / 8 * 60) ** 0.25
    assert steady == pytest.approx(2.257, abs=0.0005)
    # from the record: the filter starts from rest, which costs part of the first 0.1 s of 60 s
    assert vibration_dose_value(STEP, weighted_record(STEP, SINE, "Wk")) == pytest.approx(2.257, abs=0.0005)


def test_estimated_vdv_of_a_sine_is_known():
    # a sine has VDV / (a_w T^(1/4)) = (3/8)^(1/4) sqrt(2) = 1.107, the estimate says 1.4
    rms = weighted_rms(SINE)
    ratio = vibration_dose_value(STEP, SINE) / estimated_vibration_dose_value(rms, 60.0)
    assert ratio == pytest.approx(1.5**0.25 / 1.4, rel=1e-12)
    assert estimated_vibration_dose_value(2.0, 16.0) == pytest.approx(5.6)


def test_mtvv_of_a_short_burst():
    burst = np.zeros(10_000)
    burst[4000:4500] = 2.0
    # half a second of 2 m/s2 in a window of one second
    assert mtvv(STEP, burst) == pytest.approx(2.0 * np.sqrt(0.5), rel=1e-9)
    # exponential: 1 - exp(-0.5) of the square at the end of the burst
    assert mtvv(STEP, burst, average="exponential") == pytest.approx(2.0 * np.sqrt(1 - np.exp(-0.5)), rel=1e-9)
    # another integration time
    assert mtvv(STEP, burst, integration_s=0.25) == pytest.approx(2.0, rel=1e-9)


def test_mtvv_counts_silence_before_a_record_shorter_than_a_second():
    assert mtvv(STEP, np.ones(250)) == pytest.approx(0.5, rel=1e-12)
    assert mtvv(STEP, np.zeros(250)) == 0.0


def test_mtvv_is_the_largest_window_of_a_random_record():
    record = np.random.default_rng(0).standard_normal(4000)
    # second derivation: every window by itself
    windows = np.lib.stride_tricks.sliding_window_view(record, 1000)
    assert mtvv(STEP, record) == pytest.approx(np.sqrt((windows**2).mean(axis=1).max()), rel=1e-12)
    # for long stationary records linear and exponential averages are near each other, both above the RMS
    assert mtvv(STEP, record, average="exponential") == pytest.approx(mtvv(STEP, record), rel=0.1)


def test_all_measures_are_proportional_to_the_acceleration():
    record = np.random.default_rng(1).standard_normal(4000)
    for measure in (
        weighted_rms,
        lambda r: mtvv(STEP, r),
        lambda r: vibration_dose_value(STEP, r),
        lambda r: motion_sickness_dose_value(STEP, r),
    ):
        assert measure(2.0 * record) == pytest.approx(2.0 * measure(record), rel=1e-12)
    assert crest_factor(2.0 * record) == pytest.approx(crest_factor(record), rel=1e-12)


def test_the_dose_of_a_tiny_or_huge_record_neither_vanishes_nor_overflows():
    assert vibration_dose_value(STEP, 1e-100 * SINE) == pytest.approx(1e-100 * (22.5) ** 0.25, rel=1e-12)
    assert vibration_dose_value(STEP, 1e100 * SINE) == pytest.approx(1e100 * (22.5) ** 0.25, rel=1e-12)
    assert vibration_dose_value(STEP, np.zeros(100)) == 0.0


def test_a_record_of_zeros_has_no_crest_factor():
    assert crest_factor(np.zeros(100)) is None


def test_vector_sums():
    assert vector_sum([3.0, 4.0, 12.0], [1.0, 1.0, 1.0]) == pytest.approx(13.0)
    assert vector_sum([3.0, 4.0, 0.0], [1.4, 1.4, 1.0]) == pytest.approx(7.0)
    assert vector_sum([1.0, 1.0], [1.0, 1.0], power=4.0) == pytest.approx(2.0**0.25)
    with pytest.raises(ConfigurationError, match="vector sum: found 2 values and 3 factors"):
        vector_sum([1.0, 1.0], [1.0, 1.0, 1.0])


def test_bad_arguments_are_refused():
    with pytest.raises(DataError, match="found nan at sample 0"):
        weighted_rms([np.nan, 1.0])
    with pytest.raises(DataError, match=r"needed is one axis, shape \(n,\)"):
        weighted_rms(np.ones((2, 10)))
    with pytest.raises(ConfigurationError, match="running average: found 'fast', allowed are 'linear' and"):
        mtvv(STEP, SINE, average="fast")  # type: ignore[arg-type]
    with pytest.raises(ConfigurationError, match="integration_s: found 0 s"):
        mtvv(STEP, SINE, integration_s=0.0)
    with pytest.raises(ConfigurationError, match=r"eVDV: found RMS 1.0 and duration 0.0"):
        estimated_vibration_dose_value(1.0, 0.0)
