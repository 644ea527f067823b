"""Cumulative RMS and third octaves: against closed forms, the weighted record, and the table of the standard."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.analysis.cumulative_spectrum import CumulativeSpectrum, nominal_midband
from vehicle.signals.analysis.weighting import weighted_record

STEP = 1e-3
TIME = np.arange(20_000) * STEP


def test_bands_add_up_to_the_rms():
    record = np.random.default_rng(3).standard_normal(20_000)
    spectrum = CumulativeSpectrum(STEP, record)
    bands = spectrum.third_octaves(0.5, 80.0)
    # Adjacent bands have no gap and no overlap: equal but for rounding.
    validated(
        "FRF estimation and spectra", "sum of the mean squares of adjacent third octaves",
        np.sum(bands.rms**2), spectrum.mean_square(bands.edges[0], bands.edges[-1]), rel=1e-12, unit="1",
        source="conservation: mean square of the range",
    )  # fmt: skip
    validated(
        "FRF estimation and spectra", "cumulative RMS up to the highest line", spectrum.cumulative_rms(500.1, 0.0),
        np.std(record), rel=1e-12, source="conservation: Parseval's theorem",
    )  # fmt: skip


def test_sines_are_in_their_bands():
    # Whole periods: each sine is a single line, far from the edges of its band.
    record = 3.0 * np.sin(2 * np.pi * 4.0 * TIME) + 0.5 * np.cos(2 * np.pi * 25.0 * TIME)
    bands = CumulativeSpectrum(STEP, record).third_octaves(0.5, 80.0)
    expected = np.where(bands.nominal == 4.0, 3.0, np.where(bands.nominal == 25.0, 0.5, 0.0)) / np.sqrt(2.0)
    validated(
        "FRF estimation and spectra", "third octaves of two sines", bands.rms, expected, abs=1e-9,
        source="closed form: amplitude over the root of 2",
    )  # fmt: skip


def test_weighted_cumulative_rms_is_the_rms_of_the_weighted_record():
    # A sine of whole periods, two periods of the record after its beginning, so that the filter has settled.
    record = np.sin(2 * np.pi * 8.0 * np.arange(40_000) * STEP)
    settled = weighted_record(STEP, record, "Wk")[20_000:]
    validated(
        "Comfort, ISO 2631", "weighted cumulative RMS of a sine of 8 Hz",
        CumulativeSpectrum(STEP, record[20_000:], "Wk").cumulative_rms(80.0, 0.5), np.sqrt(np.mean(settled**2)),
        rel=1e-6, source="second derivation: RMS of the record filtered in time",
    )  # fmt: skip


def test_midband_frequencies_are_those_of_the_standard():
    # IEC 61260-1:2014, annex E, table E.1: nominal frequencies of third octaves from 0.5 to 80 Hz.
    table = [0.5, 0.63, 0.8, 1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8, 10, 12.5, 16, 20, 25, 31.5, 40, 50, 63, 80]
    assert [nominal_midband(number) for number in range(-3, 20)] == table
    bands = CumulativeSpectrum(STEP, np.sin(TIME)).third_octaves(0.5, 80.0)
    assert bands.nominal.tolist() == table
    # 10^(n/10) times or over 10^(1/20): the exact edges around 10 Hz are 8.9125 and 11.220 Hz.
    assert bands.edges[13:15] == pytest.approx([8.91250938, 11.2201845], rel=1e-8)


def test_bands_of_a_short_record_are_left_out():
    bands = CumulativeSpectrum(STEP, np.sin(TIME[:4000])).third_octaves(0.5, 80.0)
    # 4 s resolve a bandwidth of 0.25 Hz: the bands from 1.25 Hz on (0.29 Hz), not that of 1 Hz (0.23 Hz).
    assert bands.nominal[np.isnan(bands.rms)].tolist() == [0.5, 0.63, 0.8, 1.0]
    for lowest, highest, message in ((0.5, 800.0, "at most 500 Hz"), (2.1, 2.2, "2.1 to 2.2 Hz")):
        with pytest.raises(DataError, match=message):
            CumulativeSpectrum(STEP, np.sin(TIME)).third_octaves(lowest, highest)
