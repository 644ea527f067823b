"""Accuracy of the FRF estimate on known systems: `python -m tests.benchmarks.frf_accuracy [--seeds N] [--json]`.

Peaks are judged by B = 2 zeta f T, the lines within the half-power width of their mode; noise leaves the stated
coherence at every peak. Then lines without input, resonances of 1 and 20 minutes, two plates, time of 33 channels.
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from tests.benchmarks.known_systems import (
    CAR,
    PARALLEL,
    RATE,
    SYSTEMS,
    Vector,
    answer,
    cut,
    drive,
    exact,
    noise,
    true_peaks,
)
from tests.signals.analysis.single_input import local_rational_response
from vehicle.signals.analysis.local_rational import local_rational_responses
from vehicle.signals.analysis.peaks import resonances

CLASSES = ((16.0, np.inf), (10.0, 16.0), (4.0, 10.0))
REGION = 2.448
"""Radius of the 95 % region in the complex plane, in standard errors of |H|: sqrt(-2 ln 0.05)."""


def estimates(seconds: float, coherence: float, seeds: int, systems: Sequence[str] = SYSTEMS) -> Vector:
    """One row for each peak and seed: B, relative error of |H|, error over region, estimated coherence, |error|."""
    rows = []
    for seed in range(seeds):
        rng = np.random.default_rng([seed, round(seconds), round(100 * coherence)])
        moving = drive(seconds, rng)
        answers = [answer(moving, name, seconds) + noise(name, seconds, coherence, rng) for name in systems]
        found = local_rational_response(1.0 / RATE, cut(moving, seconds), answers)
        for row, name in enumerate(systems):
            for top, width in true_peaks(name):
                at = int(np.nanargmin(np.abs(found.frequency - top) + 0.0 * found.random_error[row]))
                value, truth = found.response[row, at], complex(exact(name, found.frequency[at]))
                error = abs(value - truth)
                inside = error / (REGION * found.random_error[row, at])
                rows.append(
                    (width * seconds, abs(value / truth) - 1.0, inside, found.coherence[row, at], error / abs(truth))
                )
    return np.array(rows)


def peak_accuracy(seeds: int, durations: Sequence[float] = (60.0, 30.0, 10.0)) -> list[dict[str, Any]]:
    """Bias, scatter, coverage of the 95 % region and estimated coherence, for classes of B."""
    table = []
    for coherence in (0.9, 0.5):
        whole = {seconds: estimates(seconds, coherence, seeds) for seconds in durations}
        rows = np.concatenate(list(whole.values()))
        for low, high in CLASSES:
            part = rows[(rows[:, 0] >= low) & (rows[:, 0] < high)]
            table.append(
                {
                    "coherence": coherence,
                    "B": f"{low:g} to {high:g}",
                    "peaks": len(part),
                    "bias_percent": 100.0 * float(np.mean(part[:, 1])),
                    "rms_percent": 100.0 * float(np.sqrt(np.mean(part[:, 4] ** 2))),
                    "inside_region_percent": 100.0 * float(np.mean(part[:, 2] <= 1.0)),
                    "estimated_coherence": float(np.mean(part[:, 3])),
                }
            )
        first = whole[durations[0]]
        table.append(
            {
                "coherence": coherence,
                "B": f"all, {durations[0]:g} s",
                "peaks": len(first),
                "estimated_coherence": float(np.mean(first[:, 3])),
            }
        )
    return table


def banded_input(seconds: float, rng: np.random.Generator, *, rate: float = 2048.0, step: float = 3e-7) -> Vector:
    """Displacement with a PSD of 1/f^2 from 3 to 30 Hz, 0.45 mm RMS, rounded."""
    frequency = np.fft.rfftfreq(round(2 * seconds * rate), 1.0 / rate)
    shape = np.where((frequency >= 3.0) & (frequency <= 30.0), 1.0 / np.maximum(frequency, 1.0), 0.0)
    real, imaginary = rng.normal(size=(2, frequency.size))
    values = np.fft.irfft(shape * (real + 1j * imaginary), round(2 * seconds * rate))[: round(seconds * rate)]
    return np.asarray(np.round(values * 0.45e-3 / values.std() / step) * step)


def lines_without_input(seeds: int) -> dict[str, float]:
    """Most lines kept outside the band, least share kept inside, and most lines kept of sines, ramped or not."""
    outside: list[int] = []
    inside: list[float] = []
    sine: list[int] = []
    for seed in range(seeds):
        seconds = (30.0, 60.0)[seed % 2]
        rng = np.random.default_rng(seed)
        values = banded_input(seconds, rng)
        at = np.arange(values.size) / 2048.0
        ramp = np.minimum(1.0, np.minimum(at, at[-1] - at) / 2.0)
        tone = 0.4e-3 * np.sin(2.0 * np.pi * rng.uniform(3.0, 40.0) * at + rng.uniform(0.0, 6.0))
        for signal, kept in ((values, None), (tone, sine), (tone * ramp, sine)):
            echo = np.convolve(signal, [0.5, 0.3, -0.2], mode="same") + 1e-7 * rng.normal(size=signal.size)
            found = local_rational_response(1.0 / 2048.0, signal, echo)
            told = np.isfinite(found.response[0])
            within = (found.frequency >= 3.0) & (found.frequency <= 30.0)
            if kept is None:
                outside.append(int(np.sum(told & ~within)))
                inside.append(float(np.mean(told[within])))
            else:
                kept.append(int(np.sum(told)))
    return {"outside": max(outside), "inside_percent": 100.0 * min(inside), "sine": max(sine)}


def resonance_lists(seeds: int, durations: Sequence[float] = (60.0, 1200.0)) -> list[dict[str, Any]]:
    """False and missing resonances at a coherence of 0.9; one is missing or false by more than 0.15 Hz + 3 %."""
    table = []
    for seconds in durations:
        false = missed = total = 0
        for seed in range(seeds):
            rng = np.random.default_rng([seed, round(seconds)])
            moving = drive(seconds, rng)
            names = list(PARALLEL)
            answers = [answer(moving, name, seconds) + noise(name, seconds, 0.9, rng) for name in names]
            found = local_rational_response(1.0 / RATE, cut(moving, seconds), answers, band=(2.0, 45.0))
            for row, name in enumerate(names):
                listed = np.array([peak.frequency_hz for peak in resonances(found, row)])
                truth = np.array([top for top, _ in true_peaks(name)])
                distance = np.abs(listed[:, None] - truth) - 0.15 - 0.03 * truth
                false += int(np.sum(np.min(distance, axis=1, initial=np.inf) > 0.0))
                missed += int(np.sum(np.min(distance, axis=0, initial=np.inf) > 0.0))
                total += truth.size
        table.append({"seconds": seconds, "true": total, "false": false, "missed": missed})
    return table


def two_plates(seeds: int, coherence: float, related: float, seconds: float = 60.0) -> dict[str, float]:
    """Deviation from the matrices, bias and least coherence with both plates, between 2 and 45 Hz.

    Args:
        seeds: records.
        coherence: left by noise on the channels at their peaks.
        related: coherence of the two plates.
        seconds: length of a record.
    """
    deviation, bias, least = [], [], []
    for seed in range(seeds):
        rng = np.random.default_rng([seed, round(100 * coherence), round(100 * related)])
        right, other = drive(seconds, rng), drive(seconds, rng)
        left = np.sqrt(related) * right + np.sqrt(1.0 - related) * other
        answers = [
            answer(right, name, seconds) + answer(left, name, seconds, "fl") + noise(name, seconds, coherence, rng)
            for name in CAR
        ]
        found = local_rational_responses(1.0 / RATE, [cut(right, seconds), cut(left, seconds)], answers)[0]
        band = (found.frequency >= 2.0) & (found.frequency <= 45.0)
        truth = np.array([exact(name, found.frequency[band]) for name in CAR])
        error = found.response[:, band] - truth
        deviation.append(np.linalg.norm(error, axis=1) / np.linalg.norm(truth, axis=1))
        bias.append(np.sum(error.conj() * truth, axis=1).real / np.linalg.norm(truth, axis=1) ** 2)
        least.append(np.min(found.coherence[:, band]))
    return {
        "coherence": coherence,
        "related": related,
        "rms_percent": 100.0 * float(np.sqrt(np.mean(np.square(deviation)))),
        "bias_percent": 100.0 * float(np.abs(np.mean(bias))),
        "least_coherence": float(min(least)),
    }


def computing_time(repeats: int = 3) -> dict[str, float]:
    """Time [s] of one core for 33 channels of 60 s at 1 kHz, shortest of some."""
    rng = np.random.default_rng(0)
    signal = rng.normal(size=60_000)
    answers = [np.convolve(signal, rng.normal(size=20), "same") + rng.normal(size=signal.size) for _ in range(33)]
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        local_rational_response(1e-3, signal, answers)
        times.append(time.process_time() - begin)
    return {"cpu_s_33_channels_60_s": min(times)}


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables."""
    parser = argparse.ArgumentParser(prog="tests.benchmarks.frf_accuracy", description=(__doc__ or "").split(":")[0])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args(arguments)
    few = max(options.seeds // 4, 1)
    tables: dict[str, list[Any]] = {
        "peaks": peak_accuracy(options.seeds),
        "lines without input": [lines_without_input(options.seeds)],
        "resonances": resonance_lists(few),
        "two plates": [two_plates(few, *case) for case in ((1.0, 0.0), (0.9, 0.0), (1.0, 0.7), (0.9, 0.7))],
        "time": [computing_time()],
    }
    if options.json:
        print(json.dumps(tables))
        return 0
    for title, rows in tables.items():
        print(title)
        for row in rows:
            print(
                "  "
                + ", ".join(
                    f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}"
                    for name, value in row.items()
                )
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
