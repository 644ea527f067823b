"""Own measurements: FRF files and the signals they were measured with, from the command line."""

from __future__ import annotations

import argparse

from scenarios.tuning_data import CHANNELS, Measurement
from vehicle.errors import ConfigurationError
from vehicle.excitation.csv_file import read_signal
from vehicle.excitation.input_files import find_input
from vehicle.tuning.frf_file import read_frf
from vehicle.tuning.frf_target import FrfTarget

STUCK = "low"
"""Level at which the dampers stay stuck, so that the car is linear."""


def own_measurements(options: argparse.Namespace) -> list[Measurement]:
    """Targets of the options --frf and --level.

    Raises:
        ConfigurationError: not one level for each file, a band that is none, or a signal that does not exist.
        DataError: a file holds bad data.
    """
    if len(options.frf) != len(options.level):
        raise ConfigurationError(
            f"found {len(options.frf)} --frf and {len(options.level)} --level; each file of FRFs needs its level: "
            f"{STUCK!r}, or the displacement signal it was measured with"
        )
    band = _band(options.band)
    channels = tuple(options.channel) or CHANNELS
    found = []
    for file, level in zip(options.frf, options.level, strict=True):
        name = level if "." in level else f"{level}.csv"
        signal = read_signal(find_input(name))
        target = FrfTarget(
            name=file.stem,
            data=read_frf(file).select(channels, band=band, spacing=options.spacing),
            signal=None if level == STUCK else signal,
            window=options.window,
        )
        found.append(Measurement(target=target, signal=signal))
    return found


def _band(text: str) -> tuple[float, float]:
    try:
        low, high = (float(part) for part in text.split(":"))
    except ValueError:
        low, high = 1.0, 0.0
    if not 0.0 < low < high:
        raise ConfigurationError(f"--band {text}: needed is LOW:HIGH in Hz, as in 3:45")
    return low, high
