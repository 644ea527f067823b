"""Clipped and stuck channels, found and false alarms: `python -m tests.benchmarks.clipped_channels`.

Clipped: Gaussian noise of a band, 60 s, at 200, 500 or 1000 Hz, limited on both sides at a multiple of its standard
deviation. Sound: noise as it is and rounded, sines that the rate is a multiple of and others, sums of them, square
waves as they are and with edges of several samples, telegraph signals, trains of bumps with rests, sweeps, shocks.
"""

import argparse
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from vehicle.signals.records.channel_faults import clipped, stuck

Vector = npt.NDArray[np.float64]

BANDS = ((1.0, 3.0), (1.0, 10.0), (1.0, 20.0), (0.5, 80.0), (20.0, 80.0))
"""[Hz]"""
LEVELS = (1.0, 1.5, 2.0, 2.5, 3.0)
"""In standard deviations of the noise [-]."""
RATES = (200.0, 500.0, 1000.0)
"""[Hz]"""
DURATION = 60.0
"""[s]"""
LENGTHS = (0.2, 0.5, 2.0, 5.0)
"""Durations for which a stuck sensor keeps its value [s]."""
WITH_RESTS = ("half-sine bumps", "haversine bumps", "decaying shocks")
"""Kinds with rests of a second, which are constant parts as is said of them."""
FLAT = 0.01
"""Share of the samples at the limits above which a record counts as clipped [-]."""


def noise(band: tuple[float, float], rate: float, seed: int) -> Vector:
    """Return Gaussian noise of a band [Hz] with a standard deviation of 1, (n,)."""
    random, count = np.random.default_rng(seed), round(DURATION * rate)
    frequency = np.fft.rfftfreq(count, 1.0 / rate)
    lines = random.standard_normal(frequency.size) + 1j * random.standard_normal(frequency.size)
    values = np.fft.irfft(np.where((frequency >= band[0]) & (frequency <= band[1]), lines, 0.0), count)
    return np.asarray(values / np.std(values))


def limited(band: tuple[float, float], level: float, rate: float, seeds: Sequence[int]) -> tuple[int, int]:
    """Return how many records have more than `FLAT` of their samples at the limits, and how many of them are found."""
    records = [np.clip(noise(band, rate, seed), -level, level) for seed in seeds]
    flat = [values for values in records if np.mean(np.abs(values) >= level) > FLAT]
    return len(flat), sum(bool(clipped(values)) for values in flat)


def sound(rate: float, seed: int) -> Iterator[tuple[str, Vector]]:
    """Return the kinds of sound records with their name, (n,) each."""
    random, time = np.random.default_rng(seed), np.arange(round(DURATION * rate)) / rate
    band = BANDS[seed % len(BANDS)]
    yield "noise", noise(band, rate, seed)
    yield "noise, rounded", np.round(noise(band, rate, seed) * (step := random.uniform(5.0, 40.0))) / step
    frequency, phase = np.exp(random.uniform(np.log(0.5), np.log(80.0))), random.uniform(0.0, 2.0 * np.pi)
    yield "sine", np.sin(2.0 * np.pi * frequency * time + phase)
    yield "sine, rounded", np.round(np.sin(2.0 * np.pi * frequency * time + phase), 2)
    samples = int(random.integers(3, 60))
    half = random.integers(0, 2) * np.pi / samples  # two equal samples at the top
    yield "sine with a whole number of samples", np.cos(2.0 * np.pi * np.arange(time.size) / samples + half)
    other = np.sin(2.0 * np.pi * 2.3 * frequency * time) if frequency < 34.0 else noise(band, rate, seed)
    yield "two sines or sine and noise", np.sin(2.0 * np.pi * frequency * time) + 0.3 * other
    slow = np.exp(random.uniform(np.log(0.5), np.log(20.0)))
    square = np.sign(np.sin(2.0 * np.pi * slow * time + phase))
    yield "square wave", square
    edge = int(random.integers(2, 7))
    half_period = int(rate / (2.0 * min(slow, 5.0)))
    yield "square wave with edges", np.convolve(np.resize([1.0] * half_period + [-1.0] * half_period, time.size + edge),
                                                np.ones(edge) / edge, "same")[edge // 2 :][: time.size]  # fmt: skip
    yield "square wave and noise", square + 0.05 * noise(band, rate, seed)
    yield "telegraph signal", np.repeat(random.choice([-1.0, 1.0], time.size // 20 + 1), 20)[: time.size]
    at, length = np.mod(time, random.uniform(2.0, 6.0)) - 1.0, random.uniform(0.05, 0.5)
    yield "half-sine bumps", np.where((at > 0.0) & (at < length), np.sin(np.pi * at / length), 0.0)
    yield "haversine bumps", np.where((at > 0.0) & (at < length), np.sin(np.pi * at / length) ** 2, 0.0)
    yield "sweep", np.sin(2.0 * np.pi * time * (1.0 + 0.3 * time))
    yield "decaying shocks", np.where(at > 0.0, np.exp(-3.0 * at) * np.sin(2.0 * np.pi * frequency * at), 0.0)
    yield "one bump", np.where((time > 5.0) & (time < 5.0 + length), np.sin(np.pi * (time - 5.0) / length), 0.0)


def stopped(band: tuple[float, float], rate: float, seeds: Sequence[int], length: float) -> int:
    """Return in how many records a sensor is found that keeps its value for a time [s]."""
    found = 0
    for seed in seeds:
        values, time = noise(band, rate, seed), np.arange(round(DURATION * rate)) / rate
        values[values.size // 3 :][: round(length * rate)] = values[values.size // 3]
        found += stuck(values, time) is not None
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    given = parser.parse_args(arguments)
    seeds = range(given.first, given.first + given.seeds)
    print("| band [Hz], rate [Hz] | " + " | ".join(f"{level:g} sigma" for level in LEVELS) + " | "
          + " | ".join(f"stuck for {length:g} s" for length in LENGTHS) + " |")  # fmt: skip
    print("|---|" + (len(LEVELS) + len(LENGTHS)) * "---|")
    for band in BANDS:
        for rate in RATES:
            cells = [limited(band, level, rate, seeds) for level in LEVELS]
            row = " | ".join(f"{found} of {flat}" if flat else "-" for flat, found in cells)
            held = " | ".join(f"{stopped(band, rate, seeds, length)} of {len(seeds)}" for length in LENGTHS)
            print(f"| {band[0]:g} to {band[1]:g}, {rate:g} | {row} | {held} |")
    alarms: dict[str, list[bool]] = {}
    for rate in RATES:
        for seed in seeds:
            time = np.arange(round(DURATION * rate)) / rate
            for name, values in sound(rate, seed):
                is_held = name not in WITH_RESTS and stuck(values, time) is not None
                alarms.setdefault(name, []).append(bool(clipped(values)) or is_held)
    for name, said in alarms.items():
        print(f"{name}: {sum(said)} false alarms of {len(said)}")
    print(f"all: {sum(sum(said) for said in alarms.values())} of {sum(len(said) for said in alarms.values())}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
