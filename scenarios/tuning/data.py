"""Made measurements: runs of a hidden car with 3 % noise, written and read back as a measurement would be."""

import dataclasses
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from scenarios.car_runs import CarRuns
from vehicle.model.parameters.paths import overrides_of
from vehicle.model.parameters.ranges import Range
from vehicle.names import channel_units
from vehicle.runs.car import Run
from vehicle.runs.output.folder import write_whole
from vehicle.runs.output.run_files import FRAME
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.response_name import ResponseName, plates_of
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats.frf_file import read_frf, write_frf
from vehicle.signals.formats.table import Record
from vehicle.studies.tuning.fit_settings import BAND, SPACING
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget

CHANNELS = ("knuckle_{wheel}_acc_z", "engine_acc_z", "suspension_mount_{wheel}_acc_z", "seat_rail_acc_z")
"""The four places that the authors compared (section 3.2.1): wheel, engine and body modes."""

RECORDED = ("knuckle_{wheel}_acc_z", "damper_top_{wheel}_acc_z", "damper_{wheel}_velocity")
"""Of the bump records."""

NOISE = 0.03
"""Standard deviation of the noise on ln|H| and on the phase [rad], and of that on a record over its RMS."""

SEED = 2006
"""Seed of all noise, with the index of the input in `INPUTS`: the noise of a level does not depend on other levels."""

INPUTS = ("low", "mid", "high", "bump_1p5mm", "bump_7p5mm")
BUMP_WINDOW = (4.9, 6.5)
"""Part of the bump records that counts [s]: the bump begins at 5 s and has rung down by the end."""


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
) -> list[MeasuredTarget]:
    """Return synthetic measurements of the hidden car.

    Args:
        runs: runs of cars.
        folder: folder in which the FRFs are written as `<level>_frf.csv` and read back.
        fitted: paths with hidden values; other parameters have the values of the vehicle.
        levels: inputs with FRFs; "low" is compared with the stuck linear car.
        bumps: inputs with time histories.
        channels: channels of the FRFs; `{wheel}` is replaced by the wheel on the shaker.
        spacing: distance of the frequencies [Hz].
        engine: engine of the data; by default that of the command line.

    Returns:
        A measurement for each level and bump.
    """
    vehicle = runs.car().vehicle
    changes = overrides_of(vehicle, {path: HIDDEN[path] for path in fitted})
    channels = driven_channels(channels, vehicle.shaker_wheel)
    signals = [read_signal(find_input(f"{name}.csv"), wheel=vehicle.shaker_wheel) for name in (*levels, *bumps)]
    done = runs([runs.case(signal, changes, engine=engine) for signal in signals])
    measurements, plate = [], ResponseName("", plates_of({vehicle.shaker_wheel: 1.0}))
    for name, signal, run in zip((*levels, *bumps), signals, done, strict=True):
        noise = np.random.default_rng([SEED, INPUTS.index(name)])
        if name in bumps:
            measurements.append(MeasuredTarget(target=_record(name, run, noise), signal=signal))
            continue
        response = _noisy(run.frf(channels), noise)
        file = folder / f"{name}_frf.csv"
        write_whole(file, partial(write_frf, responses={plate.input: response}, channels=channels, frame=FRAME))
        data = read_frf(file).select(channels, band=BAND, spacing=spacing)
        target = FrfTarget(
            name=name,
            data=data.renamed([dataclasses.replace(plate, output=channel) for channel in data.channels]),
            signal=None if name == "low" else signal,
            averages=float(np.nanmedian(response.averages)),
        )
        measurements.append(MeasuredTarget(target=target, signal=signal))
    return measurements


def _noisy(clean: FrequencyResponse, noise: np.random.Generator) -> FrequencyResponse:
    """Return H (1 + e (a + j b)) with e = NOISE and its coherence: 1 / gamma^2 times 1 + 2 n e^2."""
    real, imaginary = noise.standard_normal((2, *clean.response.shape))
    return dataclasses.replace(
        clean,
        response=clean.response * (1.0 + NOISE * (real + 1j * imaginary)),
        coherence=clean.coherence / (1.0 + 2.0 * clean.averages * NOISE**2),
        random_error=np.hypot(clean.random_error, NOISE * np.abs(clean.response)),
        estimator=f"{clean.estimator}, with {100 * NOISE:g} % noise",
    )


def driven_channels(channels: Sequence[str], wheel: str) -> tuple[str, ...]:
    """Return the names of channels, with the wheel on the shaker in place of `{wheel}`."""
    return tuple(name.format(wheel=wheel) for name in channels)


def _record(name: str, run: Run, noise: np.random.Generator) -> RecordTarget:
    """Return time histories with white noise of NOISE times their RMS in the window."""
    inside = (run.time >= BUMP_WINDOW[0]) & (run.time <= BUMP_WINDOW[1])
    histories, recorded = {}, driven_channels(RECORDED, run.car.vehicle.shaker_wheel)
    for channel in recorded:
        values = run[channel]
        level = NOISE * float(np.sqrt(np.mean(values[inside] ** 2)))
        histories[channel] = values + level * noise.standard_normal(values.size)
    record = Record(time=run.time, channels=histories, units=channel_units(recorded))
    return RecordTarget(name=name, signal=run.signal, record=record, window=BUMP_WINDOW)


HIDDEN = {
    "bushings.suspension_mount.stiffness.x": 2.85e6,
    "bushings.suspension_mount.stiffness.y": 3.2e6,
    "bushings.suspension_mount.stiffness.z": 6.8e5,
    "stabilizer.torsional_stiffness": 4.7e3,
    "main_spring.stiffness": 2.62e4,
    "bushings.linear_mount.stiffness.z": 5.2e5,
    "bushings.torque_arm_engine.stiffness.x": 4.8e5,
    "damper.viscous": 2150.0,
    "damper.coulomb_friction": 118.0,
    "bushings.torque_arm_body.stiffness.z": 1.1e5,
}
"""Hidden values: each value of appendix F changed by a few percent."""

AUTHORS = (
    # Section 3.1.3.2: stiffness of the suspension mount, measured at its driving point.
    Range(path="bushings.suspension_mount.stiffness.x", low=1e6, high=9e6, start=3.0e6),
    Range(path="bushings.suspension_mount.stiffness.y", low=1e6, high=9e6, start=3.0e6),
    Range(path="bushings.suspension_mount.stiffness.z", low=2e5, high=3e6, start=8.2e5),
    # Section 3.2.1.1: estimate; main spring: supplier.
    Range(path="stabilizer.torsional_stiffness", low=5e2, high=2e4, start=3e3),
    Range(path="main_spring.stiffness", low=1e4, high=6e4, start=2.5e4),
    # Section 3.2.1.3: engine mounts, measured with a hammer.
    Range(path="bushings.linear_mount.stiffness.z", low=1e5, high=2e6, start=6e5),
    Range(path="bushings.torque_arm_engine.stiffness.x", low=1e5, high=2e6, start=6.5e5),
    # Section 3.1.3.2: damper of the quarter car.
    Range(path="damper.viscous", low=3e2, high=8e3, start=1500.0),
    Range(path="damper.coulomb_friction", low=15.0, high=400.0, start=75.0),
    # Appendix F prints 1.2e6 and the thesis finds little effect: is it identifiable from the data?
    Range(path="bushings.torque_arm_body.stiffness.z", low=1.2e4, high=1.2e6, start=1.3e5),
)
"""Section "starting values before tuning" of Bommer 2006; the bounds are ours and far from start and result."""

SLIDING = ("damper.viscous", "damper.coulomb_friction")
"""Parameters that a stuck damper does not identify: the authors tuned them on bumps (section 3.2.2)."""

QUICK = ("bushings.suspension_mount.stiffness.z", "damper.coulomb_friction")
"""Fitted with --quick; the others stay at the values of the vehicle file, which the data then have too."""
