"""Values of a car on a short input, from two runs of the reduced engine, for the bench and for tests."""

import math
import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.handover.bench.drive import BenchDrive
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.runs.car import Car, Run
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.runs.figures.run_batch import evaluated
from vehicle.runs.figures.value import ShownFigure, shown_figures
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.vibration_spectra import ChannelSpectrum
from vehicle.threads import one_blas_thread

RAIL = tuple(f"seat_rail_acc_{axis}" for axis in AXES)
"""Channels of the seat rail."""

FRF_STEP = 5e-4
"""Maximum time step of the second run [s]. Linear parts are exact at any step; with friction, FRFs differ from those at
1/64 ms by 0.04 to 0.15 % (RMS, 2 to 50 Hz, `focus`, `focus_road`, `kinematic_reference`), 2 % of their standard error
where the dampers slip."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BenchNumbers:
    """Values of a car on the input of a bench."""

    table: Mapping[str, tuple[float, str]]  # figures of the table: name to value and unit, NaN where undefined
    spectra: tuple[ChannelSpectrum, ...]  # spectra of the vertical seat rail, unweighted and weighted, as `Run.psd`
    names: tuple[str, ...]  # channels of `frf`
    frf: FrequencyResponse  # FRFs [m/s2 per m] to the first plate at the level of the excerpt, with standard error
    time: Vector  # times of the evaluated excerpt [s]; (n,)
    acceleration: Vector  # vertical acceleration of the seat rail [m/s2]; (n,)
    # damper_velocity, damper_force: damper to velocity [m/s] and force [N]; (n,) each
    damper_velocity: Mapping[str, Vector]
    damper_force: Mapping[str, Vector]
    warnings: tuple[str, ...]  # exceeded limits of the reduced engine
    seconds: float  # processor time of this thread for all of this [s]


def table_figures(vehicle: Vehicle, *, obstacle: bool) -> dict[str, str]:
    """Return the rows of the table, names to figures of the catalogue.

    Args:
        obstacle: True for the crossing of an obstacle.
    """
    rows = {}
    for point in ("seat_rail", *(["seat"] if vehicle.seated else [])) if obstacle else ():
        name, axes = point.replace("_", " "), "+".join(f"{point}_acc_{axis}" for axis in AXES)
        rows[f"peak to peak {name} z"] = f"peak_to_peak:{point}_acc_z"
        rows[f"VDV {name}"] = f"vdv:{axes}:seat"
        rows[f"settling time {name} z"] = f"settling:{point}_acc_z"
    for wheel in vehicle.wheels if obstacle else ():
        if (knuckle := f"knuckle_{wheel}_acc_z") in vehicle.channels:
            rows[f"peak knuckle {wheel} z"] = f"peak:{knuckle}"
    rows |= {"comfort unweighted": "unweighted", "comfort weighted": "weighted"}
    rows |= {"on the seat, weighted": "seat_weighted", "SEAT value": "seat_value"} if vehicle.seated else {}
    return rows | {f"slip {wheel}": f"slip_share_{wheel}" for wheel in vehicle.damped_wheels}


def _row(shown: ShownFigure, name: str) -> tuple[float, str]:
    """Return value and unit of a row: the time in slip in percent, NaN for motion that has not settled."""
    value = shown.value if math.isfinite(shown.value) else math.nan
    return (100.0 * value, "%") if name.startswith("slip ") else (value, shown.unit)


def require_figures(car: Car, measure: Sequence[str]) -> None:
    """Check the names of figures for a car, before anything is compiled.

    Raises:
        ConfigurationError: the car lacks a figure.
    """
    for name in measure:
        chosen_figure(name, car.vehicle, "--measure")


@one_blas_thread()
def numbers(car: Car, drive: BenchDrive, measure: Sequence[str] = ()) -> BenchNumbers:
    """Run a car on the input of a bench with the reduced engine, and evaluate the runs.

    Args:
        car: the car, with the overrides of the drive; fastest as `Car.with_` of a car whose matrices exist.
        measure: further figures by their names in the catalogue (`Run.figure`).

    Raises:
        ConfigurationError: the car is unstable or cannot be built.
        SimulationError: the run could not be carried through.
    """
    started = clock.thread_time()
    vehicle, drive = car.vehicle, drive.under(car)
    wheels = vehicle.damped_wheels
    dampers = [f"damper_{wheel}_{quantity}" for wheel in wheels for quantity in ("velocity", "force")]
    over = drive.road is not None and "obstacle" in drive.road
    named = table_figures(vehicle, obstacle=over)
    figures = [chosen_figure(each, vehicle, "--measure") for each in (*named.values(), *measure)]
    # Each position of a slider is another car, whose second order would take longer than all else.
    read = [name for figure in figures for name in figure.channels_of(vehicle)]
    channels = [*dict.fromkeys([*RAIL, *dampers, *read])]
    _, recording, reason = simulated_run(car, drive.record, None, "reduced", channels, stated=False)
    run = Run(car=car, signal=drive.record, recording=recording, engine_reason=reason, skip=drive.skip, road=drive.road)
    shown = ("seat_rail_acc_z", f"knuckle_{next(iter(drive.inputs.samples))}_acc_z")
    names = tuple(name for name in shown if name in vehicle.channels)
    probe = simulate_reduced(
        car.poles,
        drive.probe,
        dampers=[damper.law for damper in vehicle.composition.dampers],
        record_rate=1.0 / drive.inputs.time_step,
        tyre_load=car.static.tyre_load,
        channels=names,
        step=FRF_STEP,
    )
    frf = drive.inputs.response(np.array([probe[name] for name in names]))
    part = run.evaluated
    values = shown_figures([*named.values(), *measure], replace(evaluated(run), errors=False))
    rows = [*named, *(each.title for each in values[len(named) :])]
    return BenchNumbers(
        table={name: _row(each, name) for name, each in zip(rows, values, strict=True)},
        spectra=run.psd(["seat_rail_acc_z"]).channels,
        names=names,
        frf=frf,
        time=run.time[part],
        acceleration=run["seat_rail_acc_z"][part],
        damper_velocity={wheel: run[f"damper_{wheel}_velocity"][part] for wheel in wheels},
        damper_force={wheel: run[f"damper_{wheel}_force"][part] for wheel in wheels},
        warnings=run.recording.statistics.warnings,
        seconds=clock.thread_time() - started,
    )
