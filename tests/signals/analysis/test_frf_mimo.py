import numpy as np
import pytest

from tests.signals.analysis.oscillator import stationary_response, transmissibility
from tests.signals.analysis.single_input import frequency_response
from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.analysis.frf import frequency_responses

STEP = 1e-3
SAMPLES = 200_000


@pytest.fixture(scope="module")
def plates():
    """Two partly related inputs: ordinary coherence 0.2 of fr and fl."""
    rng = np.random.default_rng(7)
    right, left = rng.standard_normal((2, SAMPLES))
    return np.stack([right, 0.5 * right + left])


def test_gains_of_related_inputs_are_separated_exactly(plates):
    found = frequency_responses(STEP, plates, [3.0 * plates[0] - 2.0 * plates[1], plates[1]])
    shape = found[0].frequency.shape
    # constant factors: only rounding is left
    for number, gain in enumerate((3.0, -2.0)):
        validated(
            "FRF estimation and spectra", f"two related inputs: gain of input {number + 1}", found[number].response[0],
            np.full(shape, gain), rel=1e-10, source="closed form: the gain",
        )  # fmt: skip
    assert found[0].response[1] == pytest.approx(np.zeros(shape), abs=1e-10)
    assert found[1].response[1] == pytest.approx(np.ones(shape), rel=1e-10)
    assert found[0].coherence == pytest.approx(np.ones((2, *shape)), abs=1e-10)
    assert found[0].reasons == ()
    # coherence of the inputs 0.2: (Sxx^-1)_ii Sxx_ii = 1 / (1 - 0.2), so the averages are worth 0.8 of 94 less one
    validated(
        "FRF estimation and spectra", "two related inputs: effective averages", np.median(found[0].averages),
        0.8 * 93.0, rel=0.03, source="closed form: (1 - coherence of the inputs) (n - 1)",
    )  # fmt: skip


def test_two_oscillators_are_separated(plates):
    first = stationary_response(plates[0], STEP, transmissibility)
    second = stationary_response(plates[1], STEP, lambda f: transmissibility(f, 15.0, 0.2))
    found = frequency_responses(STEP, plates, first + second, window_s=16.0)
    # bias and random error as in the single-input test, with 23 averages and twice the response
    assert np.abs(found[0].response[0] / transmissibility(found[0].frequency) - 1)[: 16 * 20].max() < 0.1
    assert np.abs(found[1].response[0] / transmissibility(found[0].frequency, 15.0, 0.2) - 1)[: 16 * 20].max() < 0.1
    assert found[0].coherence.min() > 0.97
    # a single-input estimate takes the related part of the other input for its own
    single = frequency_response(STEP, plates[0], first + second, window_s=16.0)
    assert np.median(single.coherence) < 0.8


def test_multiple_coherence_shows_the_known_share_of_noise(plates):
    rng = np.random.default_rng(8)
    clean = plates[0] + plates[1]  # variance 1.5^2 + 1
    found = frequency_responses(STEP, plates, clean + rng.standard_normal(SAMPLES))
    expected = 3.25 / 4.25
    # one line scatters by sqrt(2 / 94) * 0.24 * 0.87 = 0.03, the mean over 197 by 0.003; bias (1 - g) / nd = 0.0025
    validated(
        "FRF estimation and spectra", "two related inputs: multiple coherence with noise", found[0].coherence.mean(),
        expected + 0.0025, abs=0.012, source="closed form: variance of the signal over that of the response, with bias",
    )  # fmt: skip


@pytest.mark.parametrize(
    "copy",
    [
        pytest.param(lambda x: x, id="equal"),
        pytest.param(lambda x: -2.0 * x + 0.3, id="scaled"),
        pytest.param(lambda x: np.roll(x, 40), id="delayed"),
    ],
)
def test_fully_correlated_inputs_are_refused_by_name(plates, copy):
    with pytest.raises(DataError, match=r"^excitations: copies: fr and fl \(coherence 1?[\d.]+\),") as refusal:
        frequency_responses(STEP, [plates[0], copy(plates[0]), plates[1]], plates[0], input_names=("fr", "fl", "rear"))
    assert "rear" not in str(refusal.value)


def test_an_input_that_is_the_sum_of_two_others_is_rejected(plates):
    with pytest.raises(DataError, match="one of fr, fl, sum depends linearly on the others"):
        frequency_responses(STEP, [*plates, plates[0] - plates[1]], plates[0], input_names=("fr", "fl", "sum"))


def test_lines_where_the_inputs_coincide_are_nan_with_a_reason(plates):
    lines = np.fft.rfftfreq(SAMPLES, STEP)
    spectra = np.fft.rfft(plates, axis=1)
    spectra[1, lines < 5.0] = spectra[0, lines < 5.0]
    inputs = np.fft.irfft(spectra, SAMPLES, axis=1)
    found = frequency_responses(STEP, inputs, inputs[0] + 2.0 * inputs[1])
    assert np.isnan(found[0].response[0, found[0].frequency < 4.5]).all()
    assert np.isfinite(found[1].response[0, found[0].frequency > 5.5]).all()
    (reason,) = found[0].reasons
    assert "1 to 4.5 Hz" in reason and "fully correlated" in reason


def test_a_constant_input_is_rejected_and_the_moving_input_is_named(plates):
    with pytest.raises(DataError, match=r"fl: constant at 0, .* use fr$"):
        frequency_responses(STEP, [plates[0], np.zeros(SAMPLES)], plates[0], input_names=("fr", "fl"))


def test_a_still_response_is_nan_with_a_reason(plates):
    found = frequency_responses(STEP, plates, [plates[0], np.zeros(SAMPLES)], names=("knuckle", "seat"))
    assert np.isfinite(found[0].response[0]).all()
    assert np.isnan(found[1].response[1]).all()
    assert np.isnan(found[0].coherence[1]).all()
    (reason,) = found[0].reasons
    assert reason.startswith("seat: constant")
