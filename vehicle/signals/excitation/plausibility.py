"""Check the plausibility of plate displacements: level, acceleration, bandwidth, drift."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.records.finding import Finding
from vehicle.signals.records.rare_events import rare_events

LARGEST_DISPLACEMENT = 0.15
"""Maximum plausible |z| [m]: stroke of a rig; above it a wheel lifts off the ground."""

LARGEST_ACCELERATION = 50.0
"""Maximum plausible |z''| below 100 Hz [m/s2]."""

SMALLEST_RMS = 1e-7
"""Minimum plausible RMS [m]: resolution limit of sensors."""

ACCELERATION_BAND = 100.0
"""Maximum frequency of the checked acceleration [Hz]."""

RINGING = 40.0
"""Samples of the extension of a record over its relative cut-off frequency: the filter rings by e^-24 in 0.2 s."""

ALIAS_SHARE = 0.05
"""Maximum share of the velocity variance above 0.8 of the Nyquist frequency without a notice [-]."""

DRIFT_SHARE = 1.0
"""Minimum drift over the record for a notice, over the RMS about the drift line [-]. A stationary record of 20 periods
of its lowest frequency has less than 0.2."""

SMALLEST_DRIFT = 1e-9
"""Minimum drift for a notice [m]: smaller ones are rounding."""


class ImplausibleError(DataError):
    """A level that indicates a wrong unit or quantity.

    Args:
        observation: what was found, and what is allowed.
        remedy: what may be wrong, and how to mend it.
    """

    def __init__(self, observation: str, remedy: str) -> None:
        super().__init__(f"{observation}; {remedy}")
        self.observation = observation


def check_level(
    path: Path, displacement: Mapping[str, Vector], timestep: float, units: Mapping[str, str] | None = None
) -> list[str]:
    """Reject levels that indicate a wrong unit or quantity; return notices on rare events, for example a pothole.

    Args:
        displacement: wheel -> plate displacement [m], shape (n,).
        timestep: sampling interval [s].
        units: wheel -> unit of its column, "m" (by default) or "mm", used in messages; "" for a channel of a
            measurement file with a unit from the file or --unit.

    Returns:
        A notice for each plate that exceeds a level in rare events; see `rare_events`.

    Raises:
        ImplausibleError: |z| > 0.15 m or |z''| > 50 m/s2 other than rare events, or RMS < 1e-7 m (unless another
            plate moves).
    """
    events = []
    moving = any(np.std(z) >= SMALLEST_RMS for z in displacement.values())
    for wheel, z in displacement.items():
        unit = (units or {}).get(wheel, "m")
        per_metre, other_unit = (1e3, "um") if unit == "mm" else (1.0, "mm")
        question, remedy = f"are the values in {other_unit}, not [{unit}]?", "correct the header ([m] or [mm])"
        if not unit:
            unit, question, remedy = "m", "is the unit of the channel wrong?", f"set --unit {wheel}=UNIT"
        index = int(np.argmax(np.abs(z)))
        if abs(z[index]) > LARGEST_DISPLACEMENT and rare_events(z, LARGEST_DISPLACEMENT):
            events.append(
                f"plate {wheel} is displaced by {per_metre * z[index]:.3g} {unit} at {index * timestep:.4g} s, usually "
                f"at most {per_metre * LARGEST_DISPLACEMENT:g} {unit}: a pothole or a kerb?"
            )
        elif abs(z[index]) > LARGEST_DISPLACEMENT:
            raise ImplausibleError(
                f"{path}: plate {wheel} is displaced by {per_metre * z[index]:.3g} {unit} at {index * timestep:.4g} s, "
                f"must be at most {per_metre * LARGEST_DISPLACEMENT:g} {unit}",
                f"{question} If so, {remedy}; --remove-mean removes a constant offset",
            )
        rms = float(np.std(z))
        if rms < SMALLEST_RMS and not (moving and np.ptp(z) == 0.0):
            raise ImplausibleError(
                f"{path}: RMS of plate {wheel} is {per_metre * rms:.3g} {unit} but must be at least "
                f"{per_metre * SMALLEST_RMS:g} {unit}",
                f"does the column contain values in metres{', not [mm]' if unit == 'mm' else ''}? Otherwise the "
                "column is another quantity, or the sensor is dead",
            )
        acceleration, index, peak = _peak_acceleration(wheel, z, timestep)
        # A pothole has high accelerations: 60 mm within 12 ms give 800 m/s2. Its depth is checked above.
        if abs(acceleration[index]) > LARGEST_ACCELERATION and rare_events(acceleration, LARGEST_ACCELERATION, np.inf):
            events.append(f"{peak}, usually at most {LARGEST_ACCELERATION:g} m/s2: a pothole, or a spike?")
        elif abs(acceleration[index]) > LARGEST_ACCELERATION:
            raise ImplausibleError(
                f"{path}: {peak}, must be at most {LARGEST_ACCELERATION:g} m/s2",
                f"{question} If so, {remedy}; else look for a spike at this time, or set --any-level for a road",
            )
    return events


def acceleration_events(displacement: Mapping[str, Vector], timestep: float) -> list[str]:
    """Return a notice for each plate of a road that accelerates more than a shaker, with its maximum."""
    events = []
    for wheel, z in displacement.items():
        acceleration, index, peak = _peak_acceleration(wheel, z, timestep)
        if abs(acceleration[index]) > LARGEST_ACCELERATION:
            share = 100.0 * float(np.mean(np.abs(acceleration) > LARGEST_ACCELERATION))
            events.append(
                f"{peak}, and by more than {LARGEST_ACCELERATION:g} m/s2 for {number(share, 2)} % of the time: a "
                "pothole or a rough road? The tyre may lift off"
            )
    return events


def _peak_acceleration(wheel: str, z: Vector, timestep: float) -> tuple[Vector, int, str]:
    """Return the acceleration of a plate [m/s2], the index of its maximum, and the maximum in words."""
    acceleration = band_limited_acceleration(z, timestep)
    index = int(np.argmax(np.abs(acceleration)))
    return (
        acceleration,
        index,
        f"plate {wheel} accelerates by {acceleration[index]:.3g} m/s2 at {index * timestep:.4g} s (below "
        f"{ACCELERATION_BAND:g} Hz)",
    )


def band_limited_acceleration(z: Vector, timestep: float) -> Vector:
    """Return the second time derivative of the record below 100 Hz [m/s2], shape (n,).

    z'' = (z[i+1] - 2 z[i] + z[i-1]) / dt^2, after a zero-phase low pass: a digital Butterworth filter of 4th order,
    forwards and backwards, 1 / (1 + (tan(pi f dt) / tan(pi fc dt))^8) over the lines of the record. Unfiltered second
    differences amplify quantisation: steps of 10 um at 1 kHz give an error of 7 m/s2 RMS, with the filter 0.2 m/s2.
    Differences are too small near the Nyquist frequency, so a low sampling rate alone is never rejected. Within 10 ms
    of both ends the filter may add 10 %.
    """
    nyquist = 0.5 / timestep
    smooth = z
    if nyquist > 1.25 * ACCELERATION_BAND:  # below, the sampling itself limits the band
        smooth = _low_pass(z, ACCELERATION_BAND / nyquist)
    inner = np.diff(smooth, 2) / timestep**2
    return np.concatenate((inner[:1], inner, inner[-1:]))


def _low_pass(z: Vector, cutoff: float) -> Vector:
    """Return a record without its share above a cut-off frequency, without phase."""
    # The record goes on as its point reflection in both ends, for longer than the filter rings.
    beyond = min(int(RINGING / cutoff), z.size - 1)
    left, right = 2.0 * z[0] - z[beyond:0:-1], 2.0 * z[-1] - z[-2 : -beyond - 2 : -1]
    longer = np.concatenate([left, z, right]) - z.mean()
    # A straight line through both ends leaves no step in the period of the transform.
    line = np.linspace(longer[0], longer[-1], longer.size)
    size = fast_length(longer.size)
    spectrum = np.fft.rfft(longer - line, size)
    warped = np.tan(0.5 * np.pi * np.minimum(np.linspace(0.0, 2.0 * (size // 2) / size, spectrum.size), 1.0 - 1e-9))
    gain = 1.0 / (1.0 + (warped / np.tan(0.5 * np.pi * cutoff)) ** 8)
    smooth = np.fft.irfft(spectrum * gain, size)[: longer.size] + line + z.mean()
    return np.asarray(smooth[beyond : beyond + z.size])


def velocity_share_near_nyquist(z: Vector) -> float:
    """Return the share of the VELOCITY variance above 0.8 of the Nyquist frequency [-].

    sum over f > 0.8 fN of f^2 |Z(f)|^2 / sum over all f, Hann window. The displacement PSD of a road falls so steeply
    (1/f^2) that its variance is insensitive to the upper end of the band, and the acceleration contains sensor noise
    there even in a good record; the velocity PSD of a road is flat, so without anti-alias filter it has a share of a
    fifth there.
    """
    centred = z - z.mean()
    spectrum = np.fft.rfft(centred * np.hanning(z.size), fast_length(z.size))
    frequency = np.linspace(0.0, 1.0, spectrum.size)  # share of the Nyquist frequency
    power = (frequency * np.abs(spectrum)) ** 2
    total = float(power.sum())
    return float(power[frequency > 0.8].sum()) / total if total > 0.0 else 0.0


def aliasing_notices(displacement: Mapping[str, Vector], timestep: float) -> tuple[str, ...]:
    """Return a notice for each plate with more than 5 % of its velocity variance above 0.8 of the Nyquist frequency."""
    limit = 0.4 / timestep
    shares = {wheel: velocity_share_near_nyquist(z) for wheel, z in displacement.items()}
    return tuple(
        f"plate {wheel}: recorded without an anti-alias filter? {100.0 * share:.3g} % of the velocity variance lies "
        f"above {limit:.4g} Hz (0.8 of half the sampling rate), usually less than {100.0 * ALIAS_SHARE:g} %"
        for wheel, share in shares.items()
        if share > ALIAS_SHARE
    )


def drifts(displacement: Mapping[str, Vector]) -> list[Finding]:
    """Return a finding for each plate (wheel -> [m], (n,)) whose least-squares line rises by more than its RMS.

    It has no option: a kerb or a ramp rises as well, and --detrend would make it another road.

    Slope b = 12 / (n^2 - 1) mean((k - (n - 1)/2) z_k) per sample, k = 0 ... n - 1; drift b (n - 1); RMS about the line.
    """
    notices = []
    for wheel, z in displacement.items():
        offsets = np.arange(z.size) - 0.5 * (z.size - 1)
        slope = 12.0 / (z.size**2 - 1.0) * float(np.mean(offsets * z))
        drift, rms = slope * (z.size - 1), float(np.std(z - slope * offsets))
        if abs(drift) > max(DRIFT_SHARE * rms, SMALLEST_DRIFT):
            notices.append(
                Finding(
                    f"plate {wheel} drifts by {1e3 * drift:.3g} mm from beginning to end and moves by {1e3 * rms:.3g} "
                    "mm (RMS): a drifting sensor or integrator? Not subtracted; --detrend subtracts it",
                    "drift",
                )
            )
    return notices
