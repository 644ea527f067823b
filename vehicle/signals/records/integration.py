"""Integrate velocities and accelerations to displacements in the frequency domain, with a high-pass filter."""

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.records.choice import Choice, Chosen

ORDER = 4
"""Order of the Butterworth high-pass, applied forwards and backwards (squared magnitude)."""

PERIODS = 5.0
"""Length of the zeros appended before filtering, in periods of the corner frequency: decay time of the filter."""


def displacement(chosen: Chosen, choice: Choice, where: str) -> tuple[dict[str, Vector], tuple[str, ...]]:
    """Return the displacements [m] of the selected channels; integrate velocities and accelerations.

    Args:
        chosen: selected channels, see `choose`.
        choice: selection with the corner frequency of the high-pass.

    Returns:
        Role to displacement, and notices.
    """
    orders = {"displacement": 0, "velocity": 1, "acceleration": 2}
    displacements, notices = {}, []
    for role, values in chosen.values.items():
        quantity = chosen.quantities[role]
        if quantity not in orders:
            raise DataError(f"{where}: {role} is a {quantity} but must be a motion of the plate")
        if choice.highpass is None:
            if orders[quantity]:
                raise DataError(
                    f"{where}: {role} is {'an' if quantity[0] == 'a' else 'a'} {quantity}: but the plate needs a "
                    "displacement; to integrate it, set --highpass HZ below the band of interest"
                )
            displacements[role] = values
            continue
        chosen.require_uniform(where)
        displacements[role] = integrate(values, chosen.step, orders[quantity], choice.highpass)
        process = f"{quantity} integrated in the frequency domain, " if orders[quantity] else ""
        notices.append(
            f"{role}: {process}high-pass {choice.highpass:g} Hz, as requested (Butterworth, order "
            f"{ORDER}, forwards and backwards)"
        )
    return displacements, tuple(notices)


def filtered(chosen: Chosen, corner: float) -> tuple[dict[str, Vector], tuple[str, ...]]:
    """Return the selected channels after the high-pass filter, without integration, and the notices."""
    notice = f"high-pass {corner:g} Hz, as requested (Butterworth, order {ORDER}, forwards and backwards)"
    values = {role: integrate(samples, chosen.step, 0, corner) for role, samples in chosen.values.items()}
    return values, (*chosen.notices, notice)


def integrate(values: Vector, step: float, order: int, corner: float) -> Vector:
    """High-pass and integrate: X(f) = A(f) / (2 pi i f)^k * r / (1 + r), r = (f / fc)^(2 n), without phase shift.

    Args:
        values: samples, (n,).
        step: sampling interval [s].
        order: number k of integrations.
        corner: corner frequency fc [Hz].

    Returns:
        Filtered samples, (n,). Trend removal and zero padding before the transform avoid wrap-around.
    """
    count, duration = np.arange(values.size), step * values.size
    if not 2.0 / duration <= corner <= 0.4 / step:
        raise DataError(f"--highpass {corner:g} Hz: must be {2.0 / duration:.3g} to {0.4 / step:.4g} Hz here")
    detrended = values - np.polynomial.Polynomial.fit(count, values, 1)(count)
    size = fast_length(values.size + int(np.ceil(PERIODS / (corner * step))))
    frequency = np.fft.rfftfreq(size, step)
    ratio = (frequency / corner) ** (2 * ORDER)
    gain = (ratio / (1.0 + ratio)).astype(complex)
    gain[1:] /= (2j * np.pi * frequency[1:]) ** order
    gain[0] = 0.0
    result: Vector = np.fft.irfft(np.fft.rfft(detrended, size) * gain, size)[: values.size]
    return result
