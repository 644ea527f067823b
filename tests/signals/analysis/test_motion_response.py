"""FRFs to each motion of several inputs: constant gains are separated exactly, shared motions count once."""

import numpy as np
import pytest

from vehicle.signals.analysis.dependence import DependentInputsError, what_moves
from vehicle.signals.analysis.motion_response import motion_responses

STEP, SAMPLES, BAND = 4e-3, 2500, (2.0, 20.0)
NAMES = ("seat", "engine")
GAINS = {"fr": (2.0, -1.0), "fl": (0.5, 3.0), "rr": (-4.0, 0.25), "rl": (1.0, 1.0)}


@pytest.fixture(scope="module")
def noise():
    return dict(zip(GAINS, np.random.default_rng(5).standard_normal((4, SAMPLES)), strict=True))


def found(inputs, window=None):
    answers = np.array([sum(GAINS[one][row] * z for one, z in inputs.items()) for row in range(2)])
    return motion_responses(STEP, inputs, answers, names=NAMES, band=BAND, window=window)


@pytest.mark.parametrize("window", [None, 1.0])
def test_four_independent_plates_have_an_frf_each(noise, window):
    responses = found(noise, window)
    assert [dict(one.motion) for one in responses] == [{wheel: 1.0} for wheel in GAINS]
    for one in responses:
        for row, gain in enumerate(GAINS[one.first]):
            np.testing.assert_allclose(one.response.response[row], gain, rtol=1e-6)
        np.testing.assert_allclose(one.response.coherence, 1.0, rtol=1e-6)
    said = what_moves([one.motion for one in responses])
    assert "4 plates move independently" in said and "each of fr, fl, rr, rl," in said


def test_a_front_axle_in_roll_is_one_motion(noise):
    """Its FRF is that to the right plate while the left one does the opposite: gains are taken from each other."""
    inputs = noise | {"fl": -noise["fr"]}
    responses = found(inputs)
    assert [list(one.motion.values()) for one in responses] == [pytest.approx([1.0, -1.0]), [1.0], [1.0]]
    np.testing.assert_allclose(responses[0].response.response[0], 2.0 - 0.5, rtol=1e-6)
    np.testing.assert_allclose(responses[2].response.response[1], 1.0, rtol=1e-6)
    said = what_moves([one.motion for one in responses])
    assert "4 plates move; fr, fl move together, one -1 times the other" in said and "each of fr, rr, rl," in said
    said = what_moves([responses[0].motion])
    assert "both plates move together, one -1 times the other" in said and "plate_fr_displacement" in said


def test_a_single_plate_has_no_message_and_a_delayed_plate_is_rejected(noise):
    assert what_moves([{"fr": 1.0}]) == ""
    with pytest.raises(DependentInputsError, match="rr_displacement is 1 times plate_fr_displacement, delayed by"):
        found(noise | {"rr": np.roll(noise["fr"], 50)})
