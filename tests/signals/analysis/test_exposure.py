import numpy as np
import pytest

from tests.validation import validated
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
    validated(
        "Comfort, ISO 2631", "weighted RMS of a sine", weighted_rms(3.0 * SINE), 3.0 / np.sqrt(2.0), rel=1e-12,
        unit="m/s2", source="closed form: a / sqrt(2)",
    )  # fmt: skip
    # the top lies between samples
    validated(
        "Comfort, ISO 2631", "crest factor of a sine", crest_factor(3.0 * SINE), np.sqrt(2.0), rel=1e-4,
        source="closed form: sqrt(2)",
    )  # fmt: skip
    validated(
        "Comfort, ISO 2631", "VDV of a sine over 60 s", vibration_dose_value(STEP, SINE), (3 / 8 * 60) ** 0.25,
        rel=1e-12, unit="m/s^1.75", source="closed form: a (3 T / 8)^(1/4)",
    )  # fmt: skip
    validated(
        "Comfort, ISO 2631", "motion sickness dose of a sine over 60 s", motion_sickness_dose_value(STEP, SINE),
        np.sqrt(60 / 2), rel=1e-12, unit="m/s^1.5", source="closed form: a sqrt(T / 2)",
    )  # fmt: skip
    validated(
        "Comfort, ISO 2631", "MTVV of a sine", mtvv(STEP, SINE), np.sqrt(0.5), rel=1e-12, unit="m/s2",
        source="closed form: a / sqrt(2)",
    )  # fmt: skip


def test_vdv_of_a_unit_sine_of_8_hz_over_60_s_weighted_with_wk():
    # VDV = |Wk(8 Hz)| (3/8 T)^(1/4) = 1.0364 * 2.1780 = 2.257
    steady = float(weighting("Wk").spectrum_factor(8.0)) * (3 / 8 * 60) ** 0.25
    assert steady == pytest.approx(2.257, abs=0.0005)
    # from the record: the filter starts from rest, which costs part of the first 0.1 s of 60 s
    validated(
        "Comfort, ISO 2631", "VDV of 60 s of a sine of 8 Hz weighted with Wk",
        vibration_dose_value(STEP, weighted_record(STEP, SINE, "Wk")), 2.257, abs=0.0005, unit="m/s^1.75",
        source="standard: ISO 2631-1:1997, 6.3.2: Wk(8 Hz) (3 T / 8)^(1/4)",
    )  # fmt: skip


def test_estimated_vdv_of_a_sine_is_known():
    # a sine has VDV / (a_w T^(1/4)) = (3/8)^(1/4) sqrt(2) = 1.107, the estimate says 1.4
    rms = weighted_rms(SINE)
    ratio = vibration_dose_value(STEP, SINE) / estimated_vibration_dose_value(rms, 60.0)
    assert ratio == pytest.approx(1.5**0.25 / 1.4, rel=1e-12)
    validated(
        "Comfort, ISO 2631", "estimated VDV of 2 m/s2 over 16 s", estimated_vibration_dose_value(2.0, 16.0), 5.6,
        rel=1e-6, unit="m/s^1.75", source="standard: ISO 2631-1:1997, annex B: 1.4 a T^(1/4)",
    )  # fmt: skip


def test_mtvv_of_a_short_burst():
    burst = np.zeros(10_000)
    burst[4000:4500] = 2.0
    # half a second of 2 m/s2 in a window of one second
    validated(
        "Comfort, ISO 2631", "MTVV of a burst of 0.5 s, linear average", mtvv(STEP, burst), 2.0 * np.sqrt(0.5),
        rel=1e-9, unit="m/s2", source="standard: ISO 2631-1:1997, 6.3.1, linear average",
    )  # fmt: skip
    # exponential: 1 - exp(-0.5) of the square at the end of the burst
    validated(
        "Comfort, ISO 2631", "MTVV of a burst of 0.5 s, exponential average", mtvv(STEP, burst, average="exponential"),
        2.0 * np.sqrt(1 - np.exp(-0.5)), rel=1e-9, unit="m/s2",
        source="standard: ISO 2631-1:1997, 6.3.1, exponential average",
    )  # fmt: skip
    for time in (0.125, 2.0):
        grown = 2.0 * np.sqrt(1.0 - np.exp(-0.5 / time))
        assert mtvv(STEP, burst, average="exponential", integration_s=time) == pytest.approx(grown, rel=1e-9)
    # another integration time
    validated(
        "Comfort, ISO 2631", "MTVV of a burst of 0.5 s, integration time 0.25 s", mtvv(STEP, burst, integration_s=0.25),
        2.0, rel=1e-9, unit="m/s2", source="closed form: a",
    )  # fmt: skip


def test_mtvv_counts_silence_before_a_record_shorter_than_a_second():
    validated(
        "Comfort, ISO 2631", "MTVV of a record of 0.25 s", mtvv(STEP, np.ones(250)), 0.5, rel=1e-12, unit="m/s2",
        source="closed form: a sqrt(T / 1 s)",
    )  # fmt: skip
    assert mtvv(STEP, np.zeros(250)) == 0.0


def test_mtvv_is_the_largest_window_of_a_random_record():
    record = np.random.default_rng(0).standard_normal(4000)
    # second derivation: every window by itself
    windows = np.lib.stride_tricks.sliding_window_view(record, 1000)
    validated(
        "Comfort, ISO 2631", "MTVV of a random record", mtvv(STEP, record), np.sqrt((windows**2).mean(axis=1).max()),
        rel=1e-12, unit="m/s2", source="second derivation: every window by itself",
    )  # fmt: skip
    # for long stationary records linear and exponential averages are near each other, both above the RMS
    assert mtvv(STEP, record, average="exponential") == pytest.approx(mtvv(STEP, record), rel=0.1)


def test_the_dose_of_a_tiny_or_huge_record_neither_vanishes_nor_overflows():
    for size in (1e-100, 1e100):
        assert vibration_dose_value(STEP, size * SINE) == pytest.approx(size * (22.5) ** 0.25, rel=1e-12)
    assert vibration_dose_value(STEP, np.zeros(100)) == 0.0 and crest_factor(np.zeros(100)) is None


def test_vector_sums():
    assert vector_sum([3.0, 4.0, 12.0], [1.0, 1.0, 1.0]) == pytest.approx(13.0)
    validated(
        "Comfort, ISO 2631", "vector sum with factors 1.4, 1.4, 1", vector_sum([3.0, 4.0, 0.0], [1.4, 1.4, 1.0]), 7.0,
        rel=1e-6, unit="m/s2", source="standard: ISO 2631-1:1997, 6.5",
    )  # fmt: skip
    assert vector_sum([1.0, 1.0], [1.0, 1.0], power=4.0) == pytest.approx(2.0**0.25)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: vector_sum([1.0, 1.0], [1.0, 1.0, 1.0]), ConfigurationError, "2 values and 3 factors"),
        (lambda: weighted_rms([np.nan, 1.0]), DataError, "nan at sample 0"),
        (lambda: weighted_rms(np.ones((2, 10))), DataError, r"one axis, shape \(n,\)"),
        (lambda: mtvv(STEP, SINE, average="fast"), ConfigurationError, "not 'fast'"),  # type: ignore[arg-type]
        (lambda: mtvv(STEP, SINE, integration_s=0.0), ConfigurationError, "integration_s: found 0 s"),
        (lambda: estimated_vibration_dose_value(1.0, 0.0), ConfigurationError, "eVDV: .* duration 0.0 s"),
    ],
)
def test_bad_arguments_are_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()
