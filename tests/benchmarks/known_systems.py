"""Linear systems whose FRF is known, and records of them with a known coherence."""

from functools import cache

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.signal import find_peaks

from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

RATE = 256.0
DRIVEN = (0.7, 60.0)
LEAD = 40.0
"""Time [s] before the record that is thrown away: the car is in motion when it begins, and the ends leak."""

PARALLEL = {
    "1 %": [(3.6, 0.01, 1.0), (20.0, 0.01, 1.0)],
    "3 %": [(3.6, 0.03, 1.0), (20.0, 0.03, 1.0)],
    "5 %": [(3.6, 0.05, 1.0), (20.0, 0.05, 1.0)],
    "many": [
        (2.4, 0.045, 0.5),
        (3.14, 0.017, -0.4),
        (3.64, 0.03, 1.0),
        (6.4, 0.05, 0.6),
        (11.8, 0.027, 0.4),
        (16.4, 0.012, -0.3),
        (20.0, 0.02, 0.5),
        (23.2, 0.025, -0.4),
        (28.4, 0.03, 0.5),
        (36.0, 0.02, 0.3),
        (42.3, 0.025, -0.3),
    ],
    "dense": [(15 + 1.1 * i, 0.02 + 0.005 * (i % 3), (1.0, -0.7, 0.6, 0.9, -0.8)[i % 5]) for i in range(14)],
}
"""Natural frequency [Hz], damping ratio and residue of oscillators in parallel."""

CAR = ("seat_rail_acc_z", "knuckle_fr_acc_z")
SYSTEMS = (*PARALLEL, *CAR)


@cache
def car_response(wheel: str) -> CubicSpline:
    """FRFs of the channels `CAR` to a plate, of the linear car without friction, between 0.05 and 60 Hz."""
    frequency = np.arange(0.05, 60.2, 0.02)
    return CubicSpline(frequency, Car.load().matrix_frf(CAR, frequency, damper="sliding", wheel=wheel), axis=1)


def exact(system: str, frequency: npt.ArrayLike, wheel: str = "fr") -> Complex:
    """FRF of a system."""
    at = np.asarray(frequency, dtype=float)
    if system in CAR:
        return np.asarray(car_response(wheel)(np.clip(at, 0.05, 60.0))[CAR.index(system)])
    s, total = 2j * np.pi * at, np.zeros(at.shape, dtype=complex)
    for natural, damping, residue in PARALLEL[system]:
        w = 2.0 * np.pi * natural
        total += residue * s**2 * w / (s**2 + 2.0 * damping * w * s + w**2)
    return total


@cache
def true_peaks(system: str) -> tuple[tuple[float, float], ...]:
    """Frequency and half-power width [Hz] of the maxima of 1 dB between 2 and 45 Hz.

    The width is that of the mode: of a car's maximum the one of the nearest mode of the sliding car.
    """
    frequency = np.arange(2.0, 45.0, 0.005)
    level = 20.0 * np.log10(np.abs(exact(system, frequency)))
    tops = frequency[find_peaks(level, prominence=1.0)[0]]
    if system in CAR:
        modes = [(mode.frequency, mode.damping_ratio) for mode in Car.load().modes("sliding")]
    else:
        modes = [(natural, damping) for natural, damping, _ in PARALLEL[system]]
    found = []
    for top in tops:
        natural, damping = min(modes, key=lambda mode: abs(mode[0] - top))
        found.append((float(top), 2.0 * damping * natural))
    return tuple(found)


def drive(seconds: float, rng: np.random.Generator) -> Complex:
    """Spectrum of a random displacement of constant velocity power between the edges, for `seconds` and the lead."""
    frequency = np.fft.rfftfreq(round((seconds + LEAD) * RATE), 1.0 / RATE)
    inside = (frequency >= DRIVEN[0]) & (frequency <= DRIVEN[1])
    shape = np.zeros(frequency.size)
    shape[inside] = 1.0 / frequency[inside]
    return _random(frequency.size, rng) * shape


def cut(spectrum: Complex, seconds: float) -> Vector:
    """The last seconds of a periodic signal: a record without beginning and end."""
    return np.fft.irfft(spectrum, round((seconds + LEAD) * RATE))[-round(seconds * RATE) :]


def answer(spectrum: Complex, system: str, seconds: float, wheel: str = "fr") -> Vector:
    """Exact answer of a system to a drive."""
    frequency = np.fft.rfftfreq(round((seconds + LEAD) * RATE), 1.0 / RATE)
    return cut(spectrum * exact(system, frequency, wheel), seconds)


def noise(system: str, seconds: float, coherence: float, rng: np.random.Generator) -> Vector:
    """Noise, smooth over frequency, that leaves a coherence at every peak of a system."""
    frequency = np.fft.rfftfreq(round((seconds + LEAD) * RATE), 1.0 / RATE)
    tops = np.array([top for top, _ in true_peaks(system)])
    level = np.log(np.abs(exact(system, tops)) / tops)
    smooth = np.exp(np.interp(np.log(np.maximum(frequency, 0.1)), np.log(tops), level))
    return cut(_random(frequency.size, rng) * smooth * np.sqrt((1.0 - coherence) / coherence), seconds)


def _random(size: int, rng: np.random.Generator) -> Complex:
    real, imaginary = rng.normal(size=(2, size))
    return np.asarray(real + 1j * imaginary)
