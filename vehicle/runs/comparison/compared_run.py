"""A measurement of any format compared with a run, a folder of a run, or the modes of a car."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Run
from vehicle.runs.comparison.comparison import comparison_of
from vehicle.runs.comparison.frf_comparison import checked_edges
from vehicle.runs.comparison.simulated import Simulated, of_folder, of_run
from vehicle.runs.comparison.tables import Comparison
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.counterpart import PARTS
from vehicle.signals.records.measured import Measured, read_measured

LARGEST_DRIFT = 0.1
"""Maximum drift of a clock [-]; more is another sampling rate."""


def compare_run(
    run: Run | Simulated | Path | str,
    measured: Measured | Path | str,
    channels: Mapping[str, str] | None = None,
    *,
    choice: Choice | None = None,
    turned: Collection[str] = (),
    delay: float = 0.0,
    drift: float = 0.0,
    window: float | None = None,
    bands: tuple[float, ...] | None = None,
) -> Comparison:
    """Compare measured responses and time histories with those of a run.

    Args:
        run: a run, or the folder of a run, or what `of_folder` read of it.
        measured: measurement file of any format, or what `read_measured` read of it.
        channels: channel of the model to channel of the file, as {"knuckle_fr_acc_z": "Dof 12 +Z"}: number, exact name,
            pattern with *, or place and direction; by default equal names.
        choice: units, rate and excerpt of the file.
        turned: channels that were measured in the other direction.
        delay: the measurement began this long after the run [s].
        drift: the clock of the measurement is slow by this share [-].
        window: length of the Hann windows that the measured responses were averaged over [s]; by default the local
            rational model of the whole record.
        bands: rising edges of the bands of the table [Hz]; octaves by default.

    Returns:
        FRAC, errors per band, RMS ratio, correlation, time shift and ISO 18571 rating, worst first; `print` shows them.

    Raises:
        ConfigurationError: no such file or channel of the model, or a delay, drift or band out of range.
        DataError: bad data, or nothing in common.
    """
    require_clock(delay, drift)
    edges = None if bands is None else checked_edges(bands, f"bands {bands}")
    if isinstance(run, Simulated):
        simulated = run
    else:
        simulated = of_run(run) if isinstance(run, Run) else of_folder(Path(run))
    if not isinstance(measured, Measured):
        asked = choice or Choice()
        asked = replace(asked, channels={**asked.channels, **(channels or {})})
        known = tuple(simulated.record.channels)
        measured = read_measured(Path(measured), known, asked, inverted=turned, window=window)
    return comparison_of(measured, simulated, edges=edges, delay=delay, drift=drift, window=window)


def require_clock(delay: float, drift: float) -> None:
    """Check the clock of a measurement against that of the run.

    Args:
        delay: the measurement began this long after the run [s].
        drift: the clock of the measurement is slow by this share [-].

    Raises:
        ConfigurationError: a number that is not finite, or a drift of more than a tenth.
    """
    if not math.isfinite(delay):
        raise ConfigurationError(f"--delay {delay:g}: must be a finite number of seconds")
    if not abs(drift) <= LARGEST_DRIFT:
        raise ConfigurationError(
            f"--drift {PARTS * drift:g}: must be -100000 to 100000 parts per million; for another rate give --rate HZ"
        )
