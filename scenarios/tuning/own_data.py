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
    """Return the targets of the options --frf with --level, and --record with --signal.

    Args:
        options: options of the study.
        car: the car, with channel names and record rate.

    Raises:
        ConfigurationError: a level or signal is missing for a file, or a band or signal is invalid.
        DataError: a file contains bad data.
    """
    for files, others, name_parts in (
        (options.frf, options.level, "--frf and {} --level; each file of FRFs needs its level: " + repr(STUCK)),
        (options.record, options.signal, "--record and {} --signal; each file of time histories needs its signal"),
    ):
        if len(files) != len(others):
            raise ConfigurationError(
                f"found {len(files)} {name_parts.format(len(others))}, or the displacement signal it was measured with"
                if files is options.frf
                else f"found {len(files)} {name_parts.format(len(others))}: the displacement of the plate"
            )
    band = _numbers("--band", options.band, "LOW:HIGH in Hz, as in 3:45", minimum=1e-9)
    return [
        *(_responses(options, car, file, level, band) for file, level in zip(options.frf, options.level, strict=True)),
        *(_history(options, car, file, name) for file, name in zip(options.record, options.signal, strict=True)),
    ]


def _responses(
    options: argparse.Namespace, car: Car, file: Path, level: str, band: tuple[float, float]
) -> MeasuredTarget:
    """Return the target of the FRFs of one level; without a measured coherence all lines have equal weights."""
    return measured_responses(
        car,
        file,
        level,
        stuck=level == STUCK,
        choice=measured_choice(options),
        inverted=options.turned,
        fitted=tuple(options.channel)
        or (() if options.mapping else driven_channels(CHANNELS, car.vehicle.shaker_wheel)),
        band=band,
        spacing=options.spacing,
        window=options.window,
    )


def _history(options: argparse.Namespace, car: Car, file: Path, name: str) -> MeasuredTarget:
    """Return the target of the time histories on one signal, in the time common to signal and record."""
    delay, drift = clock_of(options)
    form = "FROM:TO in s, as in 4.9:6.5"
    return measured_histories(
        car,
        file,
        name,
        choice=measured_choice(options),
        inverted=options.turned,
        fitted=options.channel,
        delay=delay,
        drift=drift,
        stretch=_numbers("--stretch", options.stretch, form, minimum=0.0) if options.stretch else None,
        lowpass=options.lowpass,
        window=options.window,
    )


def _numbers(option: str, text: str, needed: str, *, minimum: float) -> tuple[float, float]:
    try:
        low, high = (float(part) for part in text.split(":"))
    except ValueError:
        low, high = 1.0, 0.0
    if not minimum <= low < high:
        raise ConfigurationError(f"{option} {text}: needed is {needed}")
    return low, high
