"""Records of a run whose sensors lag its plates: a shift of the spectrum, which holds at every frequency."""

import numpy as np
import scipy

from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.csv_table import write_table

RATE = 1000.0


def shaken(wheels, duration, *, rms=0.5e-3, band=(1.0, 50.0), seed=1):
    """Return independent motions of plates in a band, at rest at both ends."""
    random, count = np.random.default_rng(seed), round(RATE * duration)
    sections = scipy.signal.butter(4, band, "band", fs=RATE, output="sos")
    displacement = {}
    for wheel in wheels:
        values = scipy.signal.sosfiltfilt(sections, random.standard_normal(count))
        displacement[wheel] = rms * values / values.std() * scipy.signal.windows.tukey(count, 0.1)
    return Signal(time=np.arange(count) / RATE, displacement=displacement, source=f"{len(displacement)} plates")


def late(values, delay):
    """Return values(t - delay) [s] by the spectrum, zero-padded."""
    size = scipy.fft.next_fast_len(2 * values.size)
    turn = np.exp(-2j * np.pi * np.fft.rfftfreq(size, 1.0 / RATE) * delay)
    return np.fft.irfft(np.fft.rfft(values, size) * turn, size)[: values.size]


def write_record(path, run, delays, *, noise=0.0, seed=100, noisy="_acc_"):
    """Write channels of a run, each late by its delay [s], with noise relative to their RMS."""
    random, columns, heads = np.random.default_rng(seed), [run.time], ["time [s]"]
    for name, delay in delays.items():
        values = late(run[name], delay) if delay else run[name]
        if noisy in name:
            values = values + noise * values.std() * random.standard_normal(values.size)
        columns.append(values)
        heads.append(f"{name} [{run.recording.units[name]}]")
    write_table(path, heads, columns, [])
    return path
