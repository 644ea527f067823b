"""Weights of the lines of a comparison: the product of both coherences; an unknown coherence counts as 1."""

import numpy as np
import pytest

from vehicle.runs.comparison.frf_comparison import compare_responses
from vehicle.signals.analysis.response_name import parsed_name
from vehicle.signals.formats.frf_file import FrfData

LINES = np.arange(2.0, 4.0, 0.25)


def responses(response, coherence):
    rows = np.array([response])
    return FrfData(
        frequency=LINES,
        names=(parsed_name("seat_rail_acc_z"),),
        response=rows.astype(complex),
        coherence=np.array([coherence]),
        random_error=np.full(rows.shape, np.nan),
    )


def test_a_line_counts_by_the_coherence_of_both():
    """H_s / H_m = e^0.1 on the lower lines and e^-0.2 on the upper ones, which have other coherences."""
    upper = LINES >= 3.0
    simulated = np.exp(np.where(upper, -0.2, 0.1))
    ones = np.ones(LINES.size)
    known, other = np.where(upper, 0.5, 0.8), np.where(upper, 0.4, 1.0)
    for measured_coherence, simulated_coherence, weight in (
        (known, other, np.where(upper, 0.2, 0.8)),
        (np.full(LINES.size, np.nan), other, other),
        (known, np.full(LINES.size, np.nan), known),
    ):
        (found,), _ = compare_responses(
            responses(ones, measured_coherence), responses(simulated, simulated_coherence), (2.0, 4.0)
        )
        (band,) = found.bands
        assert band.weight == pytest.approx(np.mean(weight))
        assert band.error == pytest.approx(np.sqrt(np.average(np.log(simulated) ** 2, weights=weight)))
