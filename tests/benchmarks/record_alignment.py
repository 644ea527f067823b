"""Time shift, clock drift and rating of made records: asked and found. `python -m tests.benchmarks.record_alignment`.

Each record is drawn with a given band, evaluated at shifted and stretched times, and given noise of its own.
"""

import argparse
import time
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.signals.analysis.record_rating import rate_record
from vehicle.signals.analysis.time_shift import time_shift

Vector = npt.NDArray[np.float64]

STEP = 1e-3
"""Sampling interval [s]."""
SHIFTS = (5e-3, 0.37e-3, 0.5)
"""[s]"""
DRIFT = 2e-3
"""[-]"""
FINE = 8
"""Samples in a sampling interval between which a cubic spline is drawn: its error is below 1e-5 at 0.2 of the rate."""


def made_pair(
    duration: float, shift: float, drift: float, *, band: tuple[float, float] = (0.5, 50.0), noise: float = 0.0,
    fall: float = 0.0, seed: int = 1,
) -> tuple[Vector, Vector]:  # fmt: skip
    """Return x(t) = y(t + shift + drift (t - duration / 2)) and y(t), each with noise of its own, (n,).

    Args:
        duration: [s].
        shift: by which y is late [s].
        drift: [-].
        band: of the motion [Hz].
        noise: RMS over that of the motion [-].
        fall: exponent of the fall of the amplitudes with frequency [-].
        seed: of the random numbers.
    """
    random = np.random.default_rng(seed)
    margin = 1.0 + abs(shift) + abs(drift) * duration
    count = 2 * int((duration + 2.0 * margin) / STEP / 2.0)
    frequency = np.fft.rfftfreq(count, STEP)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    lines = np.where(inside, random.standard_normal(frequency.size) + 1j * random.standard_normal(frequency.size), 0.0)
    lines[inside] /= frequency[inside] ** fall
    fine = np.fft.irfft(np.concatenate([lines, np.zeros((FINE - 1) * count // 2)]), FINE * count)
    motion = scipy.interpolate.CubicSpline(np.arange(fine.size) * STEP / FINE - margin, fine / np.std(fine))
    times = np.arange(round(duration / STEP)) * STEP
    pair = motion(times + shift + drift * (times - 0.5 * times[-1])), motion(times)
    first, second = (values + noise * random.standard_normal(times.size) for values in pair)
    return first, second


def right_below(frequency: float, duration: float, seed: int = 1) -> tuple[Vector, Vector]:
    """Return two records of one band, equal below a frequency [Hz] and independent above, (n,)."""
    first, second = (made_pair(duration, 0.0, 0.0, seed=one)[0] for one in (seed, seed + 1))
    lines = np.fft.rfftfreq(first.size, STEP)
    return first, np.fft.irfft(np.where(lines <= frequency, np.fft.rfft(first), np.fft.rfft(second)), first.size)


def rows(durations: Sequence[float], noises: Sequence[float]) -> list[str]:
    """Return a line for each case."""
    found = []
    for duration in durations:
        for noise in noises:
            for shift, drift in (*((one, 0.0) for one in SHIFTS), (0.0, DRIFT), (SHIFTS[-1], -DRIFT)):
                first, second = made_pair(duration, shift, drift, noise=noise)
                began = time.process_time()
                one = time_shift(first, second, STEP)
                seconds = time.process_time() - began
                assert one is not None
                wanted = shift + drift * (one.middle - 0.5 * (first.size - 1) * STEP)
                found.append(
                    f"{duration:8g}{noise:8g}{1e3 * shift:12.3f}{1e6 * drift:10.0f}{(one.shift - wanted) / STEP:12.4f}"
                    f"{one.shift_error / STEP:10.4f}{1e6 * one.drift:12.2f}{1e6 * one.drift_error:10.2f}{seconds:8.2f}"
                )
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--durations", type=float, nargs="+", default=[6.0, 60.0, 600.0], metavar="S")
    parser.add_argument("--noise", type=float, nargs="+", default=[0.0, 0.1, 0.5], metavar="SHARE")
    options = parser.parse_args()
    print(f"{'T [s]':>8}{'noise':>8}{'shift [ms]':>12}{'[ppm]':>10}{'off [smp]':>12}{'error':>10}"
          f"{'found [ppm]':>12}{'error':>10}{'CPU [s]':>8}")  # fmt: skip
    for row in rows(options.durations, options.noise):
        print(row, flush=True)
    print(f"\n{'T [s]':>8}  rating of a record that is right below 3 Hz only, of one 5 ms late, of one with 10 % noise")
    for duration in options.durations:
        pairs = (right_below(3.0, duration), made_pair(duration, 5e-3, 0.0), made_pair(duration, 0.0, 0.0, noise=0.1))
        ratings = []
        began = time.process_time()
        for first, second in pairs:
            one = rate_record(first, second, STEP)
            ratings.append(f"{one.overall:.3f} {one.grade}")
        seconds = (time.process_time() - began) / len(pairs)
        print(f"{duration:8g}  {', '.join(ratings)}  ({one.windows} windows of {one.window:g} s, CPU {seconds:.2f} s)")


if __name__ == "__main__":
    main()
