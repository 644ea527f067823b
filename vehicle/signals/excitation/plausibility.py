"""Is this the displacement of a shaker plate in metres? Level, acceleration, bandwidth, drift, pauses."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import scipy
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.signals.records.channel_faults import clipped, constant_part
from vehicle.signals.records.clock import PAUSE
from vehicle.signals.records.rare_events import rare_events

LARGEST_DISPLACEMENT = 0.15
"""Largest plausible |z| [m]: beyond it a plate leaves the stroke of a rig and a wheel the ground."""

LARGEST_ACCELERATION = 50.0
"""Largest plausible |z''| [m/s2] below 100 Hz."""

SMALLEST_RMS = 1e-7
"""Smallest plausible RMS [m]: below it no sensor sees the motion."""

ACCELERATION_BAND = 100.0
"""The acceleration is judged up to this frequency [Hz]."""

ALIAS_SHARE = 0.05
"""Share of the velocity variance above 0.8 of the Nyquist frequency that raises a notice [-]."""

DRIFT_SHARE = 1.0
"""Drift from the beginning to the end, as a share of the RMS about it, from which it is mentioned [-]. A stationary
record of 20 periods of its lowest frequency stays below 0.2."""


def check_level(
    path: Path, displacement: Mapping[str, NDArray[np.float64]], timestep: float, units: Mapping[str, str] | None = None
) -> list[str]:
    """Stop at magnitudes that speak of another unit or quantity; name rare events, such as a pothole.

    Args:
        path: file, for messages.
        displacement: wheel -> plate displacement [m], shape (n,).
        timestep: distance of the samples [s].
        units: wheel -> unit that its column is declared in, "m" (by default) or "mm": messages speak in it; "" for a
            channel of a measurement file, whose unit the file or --unit tells.

    Returns:
        A notice for each plate that exceeds a level in rare events; see `rare_events`.

    Raises:
        DataError: |z| > 0.15 m or |z''| > 50 m/s2 beyond rare events, or RMS < 1e-7 m (a plate at rest beside a moving
            one is accepted).
    """
    events = []
    moving = any(np.std(z) >= SMALLEST_RMS for z in displacement.values())
    for wheel, z in displacement.items():
        unit = (units or {}).get(wheel, "m")
        per_metre, other = (1e3, "um") if unit == "mm" else (1.0, "mm")
        doubt, mend = (
            f"looks like {other}? The column is declared in [{unit}]",
            "write its unit into the header ([m] or [mm])",
        )
        if not unit:
            unit, doubt, mend = "m", "is the unit of the channel right?", f"give another: --unit {wheel}=UNIT"
        at = int(np.argmax(np.abs(z)))
        if abs(z[at]) > LARGEST_DISPLACEMENT and rare_events(z, LARGEST_DISPLACEMENT):
            events.append(
                f"plate {wheel} is displaced by {per_metre * z[at]:.4g} {unit} at t = {at * timestep:.6g} s, beyond "
                f"{per_metre * LARGEST_DISPLACEMENT:g} {unit}: a pothole or a kerb?"
            )
        elif abs(z[at]) > LARGEST_DISPLACEMENT:
            raise DataError(
                f"{path}: plate {wheel} is displaced by {per_metre * z[at]:.6g} {unit} at sample {at} "
                f"(t = {at * timestep:.6g} s); allowed {per_metre * LARGEST_DISPLACEMENT:g} {unit}; {doubt}; {mend}, "
                "or remove a constant offset (--remove-mean)"
            )
        rms = float(np.std(z))
        if rms < SMALLEST_RMS and not (moving and np.ptp(z) == 0.0):
            doubt = (
                "does the column, declared in [mm], hold metres?" if unit == "mm" else "does the column hold metres?"
            )
            raise DataError(
                f"{path}: RMS of plate {wheel} is {per_metre * rms:.3g} {unit}; allowed from "
                f"{per_metre * SMALLEST_RMS:g} {unit}; {doubt} Otherwise it is another quantity, or a dead sensor"
            )
        acceleration = band_limited_acceleration(z, timestep)
        at = int(np.argmax(np.abs(acceleration)))
        # The edge of a pothole has any acceleration: 60 mm within 12 ms 800 m/s2. Its depth is judged above.
        if abs(acceleration[at]) > LARGEST_ACCELERATION and rare_events(acceleration, LARGEST_ACCELERATION, np.inf):
            events.append(
                f"plate {wheel} accelerates by {acceleration[at]:.4g} m/s2 at t = {at * timestep:.6g} s (below "
                f"{ACCELERATION_BAND:g} Hz), beyond {LARGEST_ACCELERATION:g} m/s2: a pothole, or a spike of the logger?"
            )
        elif abs(acceleration[at]) > LARGEST_ACCELERATION:
            raise DataError(
                f"{path}: plate {wheel} accelerates by {acceleration[at]:.4g} m/s2 at t = {at * timestep:.6g} s "
                f"(below {ACCELERATION_BAND:g} Hz); allowed {LARGEST_ACCELERATION:g} m/s2; {doubt}; {mend}. Otherwise "
                "look there for a jump or a spike in the record, or give --any-level if it is a road and no signal of "
                "a shaker"
            )
    return events


def acceleration_events(displacement: Mapping[str, NDArray[np.float64]], timestep: float) -> list[str]:
    """Return a notice for each plate of a road whose acceleration exceeds that of a shaker: its largest event.

    Args:
        displacement: wheel -> plate displacement [m], shape (n,).
        timestep: distance of the samples [s].
    """
    found = []
    for wheel, z in displacement.items():
        acceleration = band_limited_acceleration(z, timestep)
        at = int(np.argmax(np.abs(acceleration)))
        if abs(acceleration[at]) > LARGEST_ACCELERATION:
            share = 100.0 * float(np.mean(np.abs(acceleration) > LARGEST_ACCELERATION))
            found.append(
                f"plate {wheel} accelerates by up to {acceleration[at]:.4g} m/s2, at t = {at * timestep:.6g} s, and by "
                f"more than {LARGEST_ACCELERATION:g} m/s2 for {share:.2g} % of the time (below {ACCELERATION_BAND:g} "
                "Hz): a pothole, or a rough road; the tyre may lift off"
            )
    return found


def band_limited_acceleration(z: NDArray[np.float64], timestep: float) -> NDArray[np.float64]:
    """Second time derivative of the record below 100 Hz [m/s2], shape (n,).

    z'' = (z[i+1] - 2 z[i] + z[i-1]) / dt^2, after a zero-phase low pass (Butterworth, 4th order, forwards and
    backwards). Bare second differences amplify quantisation without limit: steps of 10 um at 1 kHz give 7 m/s2 RMS of
    nothing, behind the filter 0.2 m/s2. Differences read low near the Nyquist frequency, so a coarse record is never
    refused for its rate. Within 10 ms of both ends the filter may add 10 %.
    """
    nyquist = 0.5 / timestep
    smooth = z
    if nyquist > 1.25 * ACCELERATION_BAND:  # below, the sampling itself limits the band
        smooth = scipy.signal.sosfiltfilt(scipy.signal.butter(4, ACCELERATION_BAND / nyquist, output="sos"), z)
    inner = np.diff(smooth, 2) / timestep**2
    return np.concatenate((inner[:1], inner, inner[-1:]))


def velocity_share_near_nyquist(z: NDArray[np.float64]) -> float:
    """Share of the variance of the VELOCITY above 0.8 of the Nyquist frequency [-].

    sum over f > 0.8 fN of f^2 |Z(f)|^2 / sum over all f, Hann window. The displacement of a road falls so steeply
    (1/f^2) that its variance never shows the upper end of the band, and the acceleration shows sensor noise there
    even in a good record; the velocity spectrum of a road is flat, so without anti-alias filter a fifth of it lies
    there.
    """
    centred = z - z.mean()
    spectrum = scipy.fft.rfft(centred * np.hanning(z.size), scipy.fft.next_fast_len(z.size, real=True))
    frequency = np.linspace(0.0, 1.0, spectrum.size)  # share of the Nyquist frequency
    power = (frequency * np.abs(spectrum)) ** 2
    total = float(power.sum())
    return float(power[frequency > 0.8].sum()) / total if total > 0.0 else 0.0


def aliasing_notices(displacement: Mapping[str, NDArray[np.float64]], timestep: float) -> tuple[str, ...]:
    """One notice for each plate whose velocity has more than 5 % of its variance above 0.8 of the Nyquist frequency."""
    limit = 0.4 / timestep
    shares = {wheel: velocity_share_near_nyquist(z) for wheel, z in displacement.items()}
    return tuple(
        f"plate {wheel}: {100.0 * share:.1f} % of the velocity variance lies above {limit:.4g} Hz (0.8 of Nyquist; "
        "expected below "
        f"{100.0 * ALIAS_SHARE:g} %): recorded without anti-alias filter?"
        for wheel, share in shares.items()
        if share > ALIAS_SHARE
    )


def drifts(displacement: Mapping[str, NDArray[np.float64]]) -> list[str]:
    """A notice for each plate whose straight line of least squares rises by more than the RMS about it.

    b = 12 / (n^2 - 1) mean((k - (n - 1)/2) z_k) a sample, k = 0 ... n - 1; drift b (n - 1).

    Args:
        displacement: wheel -> plate displacement [m], shape (n,).
    """
    found = []
    for wheel, z in displacement.items():
        place = np.arange(z.size) - 0.5 * (z.size - 1)
        slope = 12.0 / (z.size**2 - 1.0) * float(np.mean(place * z))
        drift, rms = slope * (z.size - 1), float(np.std(z - slope * place))
        if abs(drift) > DRIFT_SHARE * rms:
            found.append(
                f"plate {wheel} drifts by {1e3 * drift:.4g} mm from beginning to end (RMS about that line "
                f"{1e3 * rms:.4g} mm): a drifting sensor or integrator? Nothing was subtracted"
            )
    return found


def pauses(wheel: str, time: NDArray[np.float64], values: NDArray[np.float64]) -> list[str]:
    """A notice for the longest stretch of equal values between two motions, if it is a pause.

    Args:
        wheel: whose plate.
        time: sample times [s], shape (n,).
        values: of the plate in any unit, shape (n,).
    """
    part = constant_part(values)
    if part is None or time[part[1]] - time[part[0]] < PAUSE:
        return []
    moves = np.flatnonzero(np.diff(values) != 0.0)
    more = int(np.count_nonzero(time[moves[1:]] - time[moves[:-1] + 1] >= PAUSE)) - 1
    return [
        f"plate {wheel} stands still for {time[part[1]] - time[part[0]]:.4g} s from t = {time[part[0]]:.6g} s on, "
        "between two motions: a pause of the record? RMS, comfort and slip shares count it"
        + (f"; {more} shorter pauses beside it" if more else "")
    ]


def clipping(wheel: str, values: NDArray[np.float64]) -> list[str]:
    """A notice for each side on which the displacement of a plate is clipped.

    Args:
        wheel: whose plate.
        values: of the plate in any unit, shape (n,).
    """
    return [
        f"plate {wheel}: clipped? {100.0 * share:.3g} % of the samples are equal to the {side}, {level:.4g}, with "
        "sharp edges, where the velocity jumps; measure with a larger range, or take a part without (--from S, --to S)"
        for side, level, share in clipped(values)
    ]
