"""Zero-phase Butterworth low-pass: forwards and backwards over a record, by FFT."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vehicle.signals.analysis.fast_length import fast_length

REST = 1e-17
"""Share of the slowest transient that is left where the periodic continuation of the FFT begins: below round-off."""


def zero_phase_low_pass(values: NDArray[np.float64], corner: float, order: int) -> NDArray[np.float64]:
    """Return records without frequencies above a corner and without delay.

    A digital Butterworth filter (bilinear transformation, prewarped: -3 dB at the corner) is applied forwards and
    backwards: |H|^2 = 1 / (1 + (tan(w / 2) / tan(wc / 2))^(2 order)). Both ends are continued antisymmetrically by
    3 (order + 1) samples, and the filter starts from the steady state of the first sample of each pass, as in
    `scipy.signal.sosfiltfilt`, whose import takes a second of processor time.

    Args:
        values: uniform samples, (..., n) with n > 3 (order + 1).
        corner: corner frequency over the Nyquist frequency, between 0 and 1.
        order: order of the filter.

    Returns:
        Filtered samples, (..., n).

    Raises:
        ValueError: too few samples.
    """
    angles = np.pi * (2 * np.arange(order) + order + 1) / (2 * order)
    poles = 2.0 * np.tan(0.5 * np.pi * corner) * np.exp(1j * angles)
    slowest = float(np.abs((2.0 + poles) / (2.0 - poles)).max())
    edge = 3 * (order + 1)
    if values.shape[-1] <= edge:
        raise ValueError(f"found {values.shape[-1]} samples, must be more than {edge}")
    before = 2.0 * values[..., :1] - values[..., edge:0:-1]
    after = 2.0 * values[..., -1:] - values[..., -2 : -edge - 2 : -1]
    record = np.concatenate((before, values, after), axis=-1)
    samples = record.shape[-1]
    length = fast_length(samples + int(np.ceil(np.log(REST) / np.log(slowest))))
    s = 2j * np.tan(np.pi * np.arange(length // 2 + 1) / length)
    factor = np.prod([-pole / (s - pole) for pole in poles], axis=0)
    for _ in range(2):
        first = record[..., :1]
        record = first + np.fft.irfft(factor * np.fft.rfft(record - first, length), length)[..., :samples]
        record = record[..., ::-1]
    return np.asarray(record[..., edge:-edge])
