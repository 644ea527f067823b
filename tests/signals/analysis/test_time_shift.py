"""Time shift and clock drift against the numbers that records were made with."""

import numpy as np
import pytest

from tests.benchmarks.record_alignment import STEP, made_pair
from tests.validation import validated
from vehicle.signals.analysis.time_shift import time_shift


@pytest.mark.parametrize("noise", [0.0, 0.1])
@pytest.mark.parametrize(
    ("shift", "drift"), [(5e-3, 0.0), (0.37e-3, 0.0), (0.5, 0.0), (0.0, 2e-3), (0.5, -2e-3), (-1.7, 5e-4)]
)
def test_shift_and_drift_are_found(shift, drift, noise):
    """Within a tenth of a sample, and 5 % of the drift."""
    first, second = made_pair(10.0, shift, drift, noise=noise, seed=4)
    found = time_shift(first, second, STEP)
    assert found is not None
    wanted = shift + drift * (found.middle - 0.5 * (first.size - 1) * STEP)
    validated(
        "FRF estimation and spectra", f"shift of two records, {1e3 * shift:g} ms, drift {drift:g}, noise {noise:g}",
        found.shift, wanted, abs=0.1 * STEP, unit="s", source="closed form: the shift that the records were made with",
    )  # fmt: skip
    assert abs(found.drift - drift) < max(0.05 * abs(drift), 5e-6 + 30e-6 * noise / 0.1)
    assert found.correlation > 0.98 and found.period is None and found.gain == pytest.approx(1.0, abs=0.03)
    assert abs(found.shift - wanted) < 5.0 * found.shift_error + 1e-3 * STEP


def test_a_displacement_that_falls_with_frequency():
    """Nearly all of it lies below 1 Hz."""
    first, second = made_pair(40.0, 0.012, 0.0, band=(0.5, 30.0), fall=2.0)
    found = time_shift(first, second, STEP)
    assert found is not None and abs(found.shift - 0.012) < 0.1 * STEP


def test_an_inverted_record_of_another_level():
    first, second = made_pair(8.0, 0.043, 0.0)
    found = time_shift(-first, 9.81 * second, STEP)
    assert found is not None and found.correlation == pytest.approx(-1.0, abs=1e-6)
    assert found.gain == pytest.approx(-1.0 / 9.81, rel=1e-5)  # a filter begins anew at the ends
    assert found.shift == pytest.approx(0.043, abs=1e-5)


def test_records_that_overlap_in_part():
    """The second one begins 6 s after the first; 4 s are common to both."""
    first, second = made_pair(10.0, 0.0, 0.0)
    found = time_shift(first, second[6000:], STEP, start=0.0)
    assert found is not None and found.shift == pytest.approx(-6.0, abs=1e-5)
    again = time_shift(first, second[6000:], STEP, start=6.0)
    assert again is not None and again.shift == pytest.approx(0.0, abs=1e-5)
    assert again.span == pytest.approx(4.0, abs=0.3)


def test_a_single_event_identifies_a_shift_but_no_drift():
    time = np.arange(8000) * STEP
    pulse = np.sin(2.0 * np.pi * 6.0 * (time - 3.0)) * np.exp(-(((time - 3.0) / 0.15) ** 2))
    later = np.sin(2.0 * np.pi * 6.0 * (time - 3.2)) * np.exp(-(((time - 3.2) / 0.15) ** 2))
    found = time_shift(pulse, later, STEP)
    assert found is not None and found.shift == pytest.approx(0.2, abs=0.1 * STEP)
    assert found.drift_error == np.inf or abs(found.drift) < 4.0 * found.drift_error


def test_a_periodic_record_names_its_period():
    time = np.arange(10000) * STEP
    wave = np.sin(2.0 * np.pi * 2.0 * time) + 0.4 * np.sin(2.0 * np.pi * 6.0 * time + 1.0)
    found = time_shift(wave, np.roll(wave, 7), STEP)
    assert found is not None and found.shift == pytest.approx(0.007, abs=0.1 * STEP)
    assert found.period == pytest.approx(0.5, abs=2.0 * STEP)


def test_equal_records_have_no_shift_and_constant_records_no_result():
    first, _ = made_pair(6.0, 0.0, 0.0)
    found = time_shift(first, first, STEP)
    assert found is not None and found.shift == 0.0 and found.drift == 0.0
    assert time_shift(first, np.zeros_like(first), STEP) is None
    assert time_shift(np.ones(100), first, STEP) is None


def test_other_records_do_not_correlate():
    found = time_shift(made_pair(10.0, 0.0, 0.0, seed=1)[0], made_pair(10.0, 0.0, 0.0, seed=2)[0], STEP)
    assert found is None or abs(found.correlation) < 0.5
