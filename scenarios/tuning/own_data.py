"""Targets of a fit from files of the user: FRFs and time histories of any format, and the signals that go with them."""

from __future__ import annotations

import argparse
from pathlib import Path

from scenarios.tuning.data import CHANNELS, driven_channels
from vehicle.commands.compare import clock_of, measured_choice
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.studies.tuning.measured_targets import MeasuredTarget, measured_histories, measured_responses

STUCK = "low"
"""Level at which the dampers stay stuck, so that the car is linear."""


def own_measurements(options: argparse.Namespace, car: Car) -> list[MeasuredTarget]:
    """Targets of the options --frf with --level, and --record with --signal.

    Args:
        options: of the study.
        car: tells the names of the channels, and the rate of its records.

    Raises:
        ConfigurationError: not one level or signal for each file, a band that is none, or a signal that does not exist.
        DataError: a file holds bad data.
    """
    for files, others, words in (
        (options.frf, options.level, "--frf and {} --level; each file of FRFs needs its level: " + repr(STUCK)),
        (options.record, options.signal, "--record and {} --signal; each file of time histories needs its signal"),
    ):
        if len(files) != len(others):
            raise ConfigurationError(
                f"found {len(files)} {words.format(len(others))}, or the displacement signal it was measured with"
                if files is options.frf
                else f"found {len(files)} {words.format(len(others))}: the displacement of the plate"
            )
    band = _numbers("--band", options.band, "LOW:HIGH in Hz, as in 3:45", least=1e-9)
    return [
        *(_responses(options, car, file, level, band) for file, level in zip(options.frf, options.level, strict=True)),
        *(_history(options, car, file, name) for file, name in zip(options.record, options.signal, strict=True)),
    ]


def _responses(
    options: argparse.Namespace, car: Car, file: Path, level: str, band: tuple[float, float]
) -> MeasuredTarget:
    """FRFs of one level; where the file tells no coherence, all lines count alike."""
    return measured_responses(
        car,
        file,
        level,
        stuck=level == STUCK,
        choice=measured_choice(options),
        turned=options.turned,
        fitted=tuple(options.channel)
        or (() if options.mapping else driven_channels(CHANNELS, car.vehicle.shaker_wheel)),
        band=band,
        spacing=options.spacing,
        window=options.window,
    )


def _history(options: argparse.Namespace, car: Car, file: Path, name: str) -> MeasuredTarget:
    """Time histories of one signal at the times of a run; what counts is what both have."""
    delay, drift = clock_of(options)
    words = "FROM:TO in s, as in 4.9:6.5"
    return measured_histories(
        car,
        file,
        name,
        choice=measured_choice(options),
        turned=options.turned,
        fitted=options.channel,
        delay=delay,
        drift=drift,
        stretch=_numbers("--stretch", options.stretch, words, least=0.0) if options.stretch else None,
        lowpass=options.lowpass,
        window=options.window,
    )


def _numbers(option: str, text: str, needed: str, *, least: float) -> tuple[float, float]:
    try:
        low, high = (float(part) for part in text.split(":"))
    except ValueError:
        low, high = 1.0, 0.0
    if not least <= low < high:
        raise ConfigurationError(f"{option} {text}: needed is {needed}")
    return low, high
