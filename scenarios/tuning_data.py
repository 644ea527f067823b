"""Made measurements: runs of a hidden car with 3 % noise, written and read back as a measurement would be."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scenarios.car_runs import CarRuns, Case
from scenarios.tuning_hidden import HIDDEN
from vehicle.analysis.frf import FrequencyResponse
from vehicle.car import Run
from vehicle.excitation.csv_file import read_signal
from vehicle.excitation.input_files import find_input
from vehicle.excitation.signal import Signal
from vehicle.output.folder import write_whole
from vehicle.output.run_files import FRAME
from vehicle.output.tables import write_frf
from vehicle.parameters.paths import overrides_of
from vehicle.tuning.frf_file import read_frf
from vehicle.tuning.frf_target import FrfTarget
from vehicle.tuning.record_target import RecordTarget

CHANNELS = ("knuckle_fr_acc_z", "engine_acc_z", "suspension_mount_fr_acc_z", "seat_rail_acc_z")
"""The four places that the authors compared (section 3.2.1): wheel, engine and body modes."""

RECORDED = ("knuckle_fr_acc_z", "damper_top_fr_acc_z", "damper_fr_velocity")
"""Of the bump records."""

NOISE = 0.03
"""Standard deviation of the noise on ln|H| and on the phase [rad], and of that on a record over its RMS."""

SEED = 2006
"""Of all noise, with the place of the input in `INPUTS`: a level has the same noise whatever is fitted beside it."""

INPUTS = ("low", "mid", "high", "bump_1p5mm", "bump_7p5mm")
BAND = (3.0, 45.0)
"""Fitted frequencies [Hz]: the shaker signals drive the car well from 3 Hz on, and the body model ends at 43 Hz."""

SPACING = 0.3
"""Distance of the fitted frequencies [Hz]: the 17 lines of 1/60 Hz at least that an estimate from 60 s is made of."""

BUMP_WINDOW = (4.9, 6.5)
"""Part of the bump records that counts [s]: the bump begins at 5 s and has rung down by the end."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Measurement:
    """A target of the fit and the signal it was measured with."""

    target: FrfTarget | RecordTarget
    signal: Signal


def make_measurements(
    runs: CarRuns,
    folder: Path,
    *,
    fitted: Sequence[str],
    levels: Sequence[str],
    bumps: Sequence[str],
    channels: Sequence[str] = CHANNELS,
    spacing: float = SPACING,
    engine: str | None = None,
) -> list[Measurement]:
    """Measurements of the hidden car.

    Args:
        runs: of cars.
        folder: the FRFs are written into it as `<level>_frf.csv`, and read back.
        fitted: paths that take their hidden values; the others keep those of the vehicle.
        levels: inputs with a FRF; "low" is compared with the stuck linear car.
        bumps: inputs with time histories.
        channels: of the FRFs.
        spacing: of the frequencies [Hz].
        engine: that makes the data; that of the command line by default.

    Returns:
        One for each level and bump.
    """
    changes = overrides_of(runs.car().vehicle, {path: HIDDEN[path] for path in fitted})
    signals = [read_signal(find_input(f"{name}.csv")) for name in (*levels, *bumps)]
    done = runs([Case(signal=signal, overrides=changes, engine=engine) for signal in signals])
    found = []
    for name, signal, run in zip((*levels, *bumps), signals, done, strict=True):
        noise = np.random.default_rng([SEED, INPUTS.index(name)])
        if name in bumps:
            found.append(Measurement(target=_record(name, run, noise), signal=signal))
            continue
        response = _noisy(run.frf(channels), noise)
        file = folder / f"{name}_frf.csv"
        _write(file, response, channels)
        target = FrfTarget(
            name=name,
            data=read_frf(file).select(channels, band=BAND, spacing=spacing),
            signal=None if name == "low" else signal,
            averages=float(np.nanmedian(response.averages)),
        )
        found.append(Measurement(target=target, signal=signal))
    return found


def _write(file: Path, response: FrequencyResponse, channels: Sequence[str]) -> None:
    write_whole(file, lambda path: write_frf(path, response, channels, FRAME))


def _noisy(clean: FrequencyResponse, noise: np.random.Generator) -> FrequencyResponse:
    """H (1 + e (a + j b)) with e = NOISE and the coherence that belongs to it: 1 / gamma^2 times 1 + 2 n e^2."""
    real, imaginary = noise.standard_normal((2, *clean.response.shape))
    return dataclasses.replace(
        clean,
        response=clean.response * (1.0 + NOISE * (real + 1j * imaginary)),
        coherence=clean.coherence / (1.0 + 2.0 * clean.averages * NOISE**2),
        random_error=np.hypot(clean.random_error, NOISE * np.abs(clean.response)),
        estimator=f"{clean.estimator}, with {100 * NOISE:g} % noise",
    )


def _record(name: str, run: Run, noise: np.random.Generator) -> RecordTarget:
    """Time histories with white noise of NOISE times their RMS in the window."""
    inside = (run.time >= BUMP_WINDOW[0]) & (run.time <= BUMP_WINDOW[1])
    histories = {}
    for channel in RECORDED:
        values = run[channel]
        level = NOISE * float(np.sqrt(np.mean(values[inside] ** 2)))
        histories[channel] = values + level * noise.standard_normal(values.size)
    return RecordTarget(name=name, signal=run.signal, time=run.time, histories=histories, window=BUMP_WINDOW)
