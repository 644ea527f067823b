"""The position of the sensors of plates is decided once for a record."""

import numpy as np
import pytest

from vehicle.signals.excitation.plausibility import drifts
from vehicle.signals.records.plate_offset import offset_of, without_offsets

MOTION = 1e-3 * np.sin(np.arange(4000) / 20.0)


@pytest.mark.parametrize("stands", [0.0, 0.08])
def test_a_plate_that_stands_loses_its_position_too(stands):
    """It stayed at 80 mm beside a plate that was moved to 0: the car was twisted."""
    plates, (finding,) = without_offsets({"fl": 0.08 + MOTION, "fr": np.full(4000, stands)})
    assert np.mean(plates["fl"]) == pytest.approx(0.0, abs=1e-12) and np.all(plates["fr"] == 0.0)
    assert "80 mm" in finding and finding.endswith("it was subtracted")


def test_beside_a_plate_about_zero_nothing_is_subtracted():
    plates, (finding,) = without_offsets({"fl": 0.08 + MOTION, "fr": MOTION})
    assert np.mean(plates["fl"]) == pytest.approx(0.08, rel=1e-3) and "because fr has none" in finding


def test_rounding_is_no_motion_and_no_drift():
    assert all(offset_of(np.full(count, 0.08)) == 0.0 for count in range(1000, 1100))
    assert drifts({"fl": 1e-17 * np.arange(1000.0)}) == []


def test_a_drift_is_a_question_without_an_option():
    """A kerb of 50 mm at half time was tilted by --detrend."""
    (finding,) = drifts({"fl": np.where(np.arange(4000) < 2000, 0.0, 0.05)})
    assert finding.kind == "drift" and finding.options == ()
