"""Curves of the plots of the bench."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from vehicle.handover.bench.curves import frf_curves
from vehicle.signals.analysis.phase_averages import PERIOD, PHASES, PhaseInputs, phase_inputs


def test_the_band_of_an_frf_contains_the_true_value_in_95_of_100_lines():
    rng = np.random.default_rng(2)
    inputs = phase_inputs(0.002, {"fr": np.cumsum(rng.normal(size=5000))})
    inside = [_inside(inputs, rng) for _ in range(50)]
    # 50 x 200 independent lines: the standard error of the share is 0.2 %.
    assert abs(np.mean(inside) - 0.95) < 0.007


def _inside(inputs: PhaseInputs, rng: np.random.Generator) -> float:
    """Share of the lines of H = 1 whose band contains 1, with scatter of 10 % in each response."""
    size = round(PERIOD / inputs.time_step)
    spectra = np.zeros((PHASES, size // 2 + 1), dtype=complex)
    scatter = rng.normal(size=(2, *inputs.spectra.shape))
    spectra[:, inputs.lines] = inputs.spectra * (1.0 + 0.1 * (scatter[0] + 1j * scatter[1]))
    lead = inputs.samples["fr"].size // PHASES - size
    response = np.hstack([np.zeros((PHASES, lead)), np.fft.irfft(spectra, size, axis=1)]).ravel()
    numbers: Any = SimpleNamespace(frf=inputs.response(response[None]))
    _, _, low, high, _ = frf_curves(numbers, numbers)
    return float(np.mean((low <= 1.0) & (high >= 1.0)))
