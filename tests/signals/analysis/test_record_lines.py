"""Long records: the lines of their spectra from blocks, and what is estimated from them."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.signals.analysis import local_rational, record_lines, spectra
from vehicle.signals.analysis.input_floor import tapered_power
from vehicle.signals.analysis.local_rational import local_rational_responses
from vehicle.signals.analysis.record_lines import RecordLines
from vehicle.signals.analysis.spectra import band_rms, power_spectral_density

PRIME = 4001
RATE = 500.0


@pytest.fixture
def in_blocks(monkeypatch):
    """Makes every record a long one, of blocks of a few hundred samples."""

    def make():
        monkeypatch.setattr(record_lines, "LONG", 0)
        monkeypatch.setattr(record_lines, "SHORTEST_BLOCK", 300)
        monkeypatch.setattr(local_rational, "OUTPUTS_OF_A_LONG_RECORD", 2)
        monkeypatch.setattr(spectra, "SEGMENTS_AT_ONCE", 3)

    return make


@pytest.mark.parametrize(("first", "last"), [(0, 40), (70, 471), (1900, 2001)])
def test_lines_are_sums_over_the_record(in_blocks, first, last):
    record = np.random.default_rng(1).normal(size=PRIME)
    turns = np.outer(np.arange(first, last), np.arange(PRIME)) % PRIME / PRIME
    expected = np.exp(-2j * np.pi * turns) @ record
    whole = RecordLines(PRIME, first, last)
    assert len(whole.parts) == 1
    validated(
        "FRF estimation and spectra", f"lines {first} to {last} of a record of prime length",
        whole.of(record.__getitem__), expected, abs=1e-10, source="closed form: sum of the discrete Fourier transform",
    )  # fmt: skip
    in_blocks()
    blocks = RecordLines(PRIME, first, last)
    assert len(blocks.parts) > 5
    np.testing.assert_allclose(blocks.of(record.__getitem__), expected, rtol=0.0, atol=1e-10)


def test_estimates_of_a_long_record_equal_those_of_a_whole_transform(in_blocks):
    rng = np.random.default_rng(2)
    drive = np.convolve(rng.normal(size=PRIME + 40), np.hanning(6), mode="same")[:PRIME]
    answers = [
        np.convolve(drive, shape)[:PRIME] for shape in ([1.0, 0.5], [0.3, 0.0, -0.4], np.exp(-np.arange(90) / 9))
    ]
    answers = [answer + 0.1 * rng.normal(size=PRIME) for answer in answers] + [np.zeros(PRIME)]

    def estimates():
        (frf,) = local_rational_responses(1.0 / RATE, [drive], answers, band=(2.0, 45.0))
        density = power_spectral_density(1.0 / RATE, np.array(answers), window_s=0.5).density
        return frf, band_rms(1.0 / RATE, np.array(answers), (2.0, 45.0)), density

    frf, *others = estimates()
    in_blocks()
    again, *found = estimates()
    assert again.reasons == frf.reasons and len(frf.reasons) > 1
    for name in ("frequency", "response", "coherence", "random_error", "averages"):
        np.testing.assert_allclose(getattr(again, name), getattr(frf, name), rtol=1e-8, atol=1e-11, err_msg=name)
    assert np.isfinite(frf.response[:3]).mean() > 0.9
    for expected, value in zip(others, found, strict=True):
        np.testing.assert_allclose(value, expected, rtol=1e-10)


@pytest.mark.parametrize(("strength", "looked_at"), [(1e-3, 200), (1e6, PRIME // 2 + 1)])
def test_the_strongest_line_is_found_beyond_the_requested_lines(in_blocks, strength, looked_at):
    time = np.arange(PRIME) / RATE
    low = np.convolve(np.random.default_rng(3).normal(size=PRIME), np.hanning(90), mode="same")
    record = low + strength * np.sin(2.0 * np.pi * 200.0 * time)
    expected, floor = tapered_power(record, 0.0)
    in_blocks()
    found = tapered_power(record, 0.0, 200)
    assert found[0].size == looked_at
    np.testing.assert_allclose(found[0][:200], expected[:200], rtol=1e-6)
    assert found[1] == pytest.approx(floor, rel=1e-9)
