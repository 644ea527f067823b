"""Values of a car on a short input, from two runs of the reduced engine, for the bench and for tests."""

import math
import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.handover.bench.drive import BenchDrive
from vehicle.names import AXES
from vehicle.runs.car import Car, Run
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.runs.figures.run_batch import evaluated
from vehicle.runs.figures.value import ShownFigure, shown_figures
from vehicle.runs.output.run_obstacle import obstacle_values
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.ride_comfort import RunComfort
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.vibration_spectra import ChannelSpectrum
from vehicle.signals.records.run_summary import ObstacleSummary
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

    comfort: RunComfort  # comfort of the excerpt, as `Run.comfort`
    slip: Mapping[str, float]  # wheel to slip share of its damper, as `Run.slip_share` [-]
    spectra: tuple[ChannelSpectrum, ...]  # spectra of the vertical seat rail, unweighted and weighted, as `Run.psd`
    names: tuple[str, ...]  # channels of `frf`
    frf: FrequencyResponse  # FRFs [m/s2 per m] to the first plate at the level of the excerpt, with standard error
    time: Vector  # times of the evaluated excerpt [s]; (n,)
    acceleration: Vector  # vertical acceleration of the seat rail [m/s2]; (n,)
    # damper_velocity, damper_force: damper to velocity [m/s] and force [N]; (n,) each
    damper_velocity: Mapping[str, Vector]
    damper_force: Mapping[str, Vector]
    # values of the crossing of an obstacle, as in `summary.json`; None without an obstacle
    obstacle: ObstacleSummary | None
    further: tuple[ShownFigure, ...]  # figures that were asked for
    warnings: tuple[str, ...]  # exceeded limits of the reduced engine
    seconds: float  # processor time of this thread for all of this [s]

    def table(self) -> dict[str, tuple[float, str]]:
        """Return the numbers of the table: name to value and unit."""
        rows = {} if self.obstacle is None else _obstacle_rows(self.obstacle)
        rows |= {
            "comfort unweighted": (self.comfort.unweighted.overall, "m/s2"),
            "comfort weighted": (self.comfort.weighted.overall, "m/s2"),
        }
        if self.comfort.cushion is not None:
            rows["on the seat, weighted"] = (self.comfort.cushion.weighted.overall, "m/s2")
        if self.comfort.seat_value is not None:
            rows["SEAT value"] = (self.comfort.seat_value, "-")
        rows |= {f"slip {wheel}": (100.0 * share, "%") for wheel, share in self.slip.items()}
        return rows | {each.title: (each.value, each.unit) for each in self.further}


def _obstacle_rows(values: ObstacleSummary) -> dict[str, tuple[float, str]]:
    """Return the rows of the table of an obstacle: name to value and unit; NaN for motion that has not settled."""
    rows = {}
    for point, peaks in values["peak_to_peak"].items():
        name, settling = point.replace("_", " "), values["settling_s"][point]
        rows[f"peak to peak {name} z"] = peaks["z"], "m/s2"
        rows[f"VDV {name}"] = values["vdv"][point]["overall"], "m/s1.75"
        rows[f"settling time {name} z"] = math.nan if settling is None else settling, "s"
    return rows | {f"peak knuckle {wheel} z": (peak, "m/s2") for wheel, peak in values["knuckle_peak"].items()}


@one_blas_thread()
def numbers(car: Car, drive: BenchDrive, measure: Sequence[str] = ()) -> BenchNumbers:
    """Run a car on the input of a bench with the reduced engine, and evaluate the runs.

    Args:
        car: the car, with the overrides of the drive; fastest as `Car.with_` of a car whose matrices exist.
        measure: further figures by their names in the catalogue (`vehicle.figure_of`).

    Raises:
        ConfigurationError: the car is unstable or cannot be built.
        SimulationError: the run could not be carried through.
    """
    started = clock.thread_time()
    vehicle, drive = car.vehicle, drive.under(car)
    wheels = vehicle.damped_wheels
    seat = tuple(f"seat_acc_{axis}" for axis in AXES) if vehicle.seated else ()
    dampers = [f"damper_{wheel}_{quantity}" for wheel in wheels for quantity in ("velocity", "force")]
    over = drive.road is not None and "obstacle" in drive.road
    knuckles = [name for wheel in vehicle.wheels if over and (name := f"knuckle_{wheel}_acc_z") in vehicle.channels]
    # Each position of a slider is another car, whose second order would take longer than all else.
    asked = [name for each in measure for name in chosen_figure(each, vehicle, "--measure").channels_of(vehicle)]
    channels = [*dict.fromkeys([*RAIL, *seat, *dampers, *knuckles, *asked])]
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
    return BenchNumbers(
        comfort=run.comfort(),
        slip={wheel: run.slip_share(wheel) for wheel in wheels},
        spectra=run.psd(["seat_rail_acc_z"]).channels,
        names=names,
        frf=frf,
        time=run.time[part],
        acceleration=run["seat_rail_acc_z"][part],
        damper_velocity={wheel: run[f"damper_{wheel}_velocity"][part] for wheel in wheels},
        damper_force={wheel: run[f"damper_{wheel}_force"][part] for wheel in wheels},
        obstacle=obstacle_values(run),
        further=tuple(shown_figures(measure, evaluated(run))),
        warnings=run.recording.statistics.warnings,
        seconds=clock.thread_time() - started,
    )
