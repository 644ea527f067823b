"""From velocity or acceleration to displacement: in the frequency domain, with a corner that the user chose."""

from __future__ import annotations

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.signals.records.choice import Choice, Chosen
from vehicle.signals.records.table import Vector

ORDER = 4
"""Order of the Butterworth high-pass, whose squared magnitude acts: forwards and backwards."""
PERIODS = 5.0
"""Zeros behind a record that is filtered, in periods of the corner frequency: the filter rings so long."""


def displacement(chosen: Chosen, choice: Choice, where: str) -> tuple[dict[str, Vector], tuple[str, ...]]:
    """Displacements [m] of chosen channels, integrated where they are velocities or accelerations.

    Args:
        chosen: as of `choose`.
        choice: the corner frequency.
        where: file, for messages.

    Returns:
        Role to displacement, and notices.

    Raises:
        DataError: another quantity, or one to be integrated without a corner frequency.
    """
    orders = {"displacement": 0, "velocity": 1, "acceleration": 2}
    found, notices = {}, []
    step = float(chosen.time[-1] - chosen.time[0]) / (chosen.time.size - 1)
    for role, values in chosen.values.items():
        quantity = chosen.quantities[role]
        if quantity not in orders:
            raise DataError(
                f"{where}: {role}: a {quantity} drives no plate; needed is a displacement, a velocity or an "
                "acceleration"
            )
        if choice.highpass is None:
            if orders[quantity]:
                raise DataError(
                    f"{where}: {role} is {'an' if quantity[0] == 'a' else 'a'} {quantity}: the plate needs a "
                    "displacement; give --highpass HZ with the corner below the band of interest, and it is integrated"
                )
            found[role] = values
            continue
        chosen.require_uniform(where)
        found[role] = integrate(values, step, orders[quantity], choice.highpass)
        how = f"{quantity} integrated in the frequency domain, " if orders[quantity] else ""
        notices.append(
            f"{role}: {how}high-pass {choice.highpass:g} Hz on request (Butterworth, order {ORDER}, forwards and "
            "backwards)"
        )
    return found, tuple(notices)


def filtered(chosen: Chosen, corner: float) -> tuple[dict[str, Vector], tuple[str, ...]]:
    """Chosen channels behind the high-pass alone, and the notices with it.

    Args:
        chosen: as of `choose`.
        corner: fc [Hz].

    Raises:
        DataError: as of `integrate`.
    """
    step = float(chosen.time[-1] - chosen.time[0]) / (chosen.time.size - 1)
    said = f"high-pass {corner:g} Hz on request (Butterworth, order {ORDER}, forwards and backwards)"
    return {role: integrate(one, step, 0, corner) for role, one in chosen.values.items()}, (*chosen.notices, said)


def integrate(values: Vector, step: float, order: int, corner: float) -> Vector:
    """High-pass and integrate: X(f) = A(f) / (2 pi i f)^k * r / (1 + r), r = (f / fc)^(2 n), without phase shift.

    Args:
        values: samples, (n,).
        step: of the time [s].
        order: k, integrations.
        corner: fc [Hz].

    Returns:
        (n,), without its straight line before and with zeros around it, so that its ends do not meet.

    Raises:
        DataError: the corner is not between 2 / duration and 0.4 / step.
    """
    count, duration = np.arange(values.size), step * values.size
    if not 2.0 / duration <= corner <= 0.4 / step:
        raise DataError(
            f"--highpass {corner:g} Hz: allowed is {2.0 / duration:.3g} to {0.4 / step:.4g} Hz for this record"
        )
    plain = values - np.polynomial.Polynomial.fit(count, values, 1)(count)
    size = scipy.fft.next_fast_len(values.size + int(np.ceil(PERIODS / (corner * step))), real=True)
    frequency = scipy.fft.rfftfreq(size, step)
    ratio = (frequency / corner) ** (2 * ORDER)
    gain = (ratio / (1.0 + ratio)).astype(complex)
    gain[1:] /= (2j * np.pi * frequency[1:]) ** order
    gain[0] = 0.0
    found: Vector = scipy.fft.irfft(scipy.fft.rfft(plain, size) * gain, size)[: values.size]
    return found
