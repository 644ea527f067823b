"""Files of a run: summary, parameters as used, time histories, FRFs, plots, film."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from vehicle.digits import number
from vehicle.drawing.rendering.frf_plot import plot_frfs
from vehicle.drawing.rendering.plots import plot_time
from vehicle.errors import DataError, SimulationError
from vehicle.model.flexbody.body_loads import body_loads
from vehicle.model.flexbody.mass_difference import mass_difference
from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.model.parameters.body_notices import body_notices
from vehicle.model.parameters.idle import idle_parameters
from vehicle.names import wheel_words
from vehicle.runs.car import FRF_BAND, SATURATED_VELOCITY, Run
from vehicle.runs.output.folder import write_json, write_text, write_whole
from vehicle.runs.output.own_files import parameters_text, write_own_files
from vehicle.runs.output.run_comfort import comfort_notices, comfort_values, rim_values, seat_values
from vehicle.runs.output.run_forces import force_values
from vehicle.runs.output.run_obstacle import obstacle_values
from vehicle.runs.output.spectra_files import write_densities
from vehicle.signals.analysis.dependence import DependentInputsError, common_motions, what_moves
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.local_rational import shortest_record
from vehicle.signals.analysis.motion_response import MotionResponse
from vehicle.signals.analysis.peaks import resonances
from vehicle.signals.analysis.periodic_record import whole_record_responses
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.formats import write_record
from vehicle.signals.formats.frf_file import write_frf
from vehicle.signals.formats.table import Record
from vehicle.signals.records.law_band_summary import LawBandSummary
from vehicle.signals.records.measured import Measured
from vehicle.signals.records.run_frf import CHANNEL
from vehicle.signals.records.run_summary import (
    SUMMARY_FILE,
    FrfSummary,
    InputSummary,
    MeasuredSummary,
    MotionSummary,
    Peaks,
    PeakSummary,
    PlacedLoad,
    RunSummary,
    SolverSummary,
    StaticSummary,
    VehicleSummary,
)

FRAME = "x to the rear, y to the driver's right, z up; SI units"
LOADS = (
    "; forces of elements: on the moving part, in the axes of the carrier; springs: compression positive; "
    "suspension travel: wheel centre against body, upwards from the design position"
)
"""Addition to the header of time histories with loads."""


def require_plates(signal: Signal, *, separable: bool = True) -> None:
    """Check that the FRFs to the plates can be estimated: long enough, and no plate repeats another with a delay.

    Args:
        separable: False accepts plates that repeat another with a delay; their run has no FRFs.

    Raises:
        DataError: the message contains the shortest length, or the plates and the delay.
    """
    moving = [wheel for wheel in signal.wheels if signal.rms(wheel) > 0.0]
    plates, band = np.array([signal.displacement[wheel] for wheel in moving]), signal.band(FRF_BAND)
    names = [f"plate {wheel}" for wheel in moving]
    motions = [{n: 1.0} for n in range(len(moving))]
    try:
        if len(moving) > 1:
            motions = common_motions(signal.timestep, plates, names, band)
    except DependentInputsError as error:
        if separable:
            raise DataError(f"{error}, or run without FRFs with --any-level") from None
        return
    if motions and signal.duration < shortest_record(len(motions), band[1]):
        plates = plates[[min(group) for group in motions]]
        whole_record_responses(signal.timestep, plates, plates, band=band)  # accepts a short record if it is periodic


def write_run(
    folder: Path,
    run: Run,
    *,
    time_format: str = "npz",
    formats: Sequence[str] = (),
    figures: bool = True,
    engine_reason: str = "",
    video: tuple[Path, Callable[[Path], None]] | None = None,
    measured: Measured | None = None,
    law_band: LawBandSummary | None = None,
    notices: Sequence[str] = (),
    report: tuple[Path, Callable[[Path], None]] | None = None,
    command: str = "",
    tell: Callable[[RunSummary], None] | None = None,
) -> RunSummary:
    """Write all files of a finished run.

    Args:
        folder: temporary folder of `output_folder`.
        time_format: "npz" or "csv".
        formats: further formats of `vehicle.signals.formats.formats.WRITTEN`.
        figures: False writes no pictures.
        engine_reason: reason for the choice of the engine; by default that of the run.
        video: name of the film, or a path outside the folder, and the function that writes it.
        measured: measurement to compare with the run.
        law_band: values at the edges of the band of its dampers.
        notices: further notices for the summary.
        report: path of the report and the function that writes it from the other files.
        command: command line that makes this run, for the summary.
        tell: function that is called with the summary before the film and the report, which take the longest.

    Returns:
        The content of `summary.json`.

    Raises:
        VehicleError: a file cannot be made or written.
    """
    channels = run.car.vehicle.acceleration_channels
    responses, missing = _frfs(run, DependentInputsError if run.road is None else DataError)
    if run.road is not None:
        missing = []  # on every road the rear plates repeat the front plates, which no user can change
    files = {"summary": SUMMARY_FILE, "vehicle": "vehicle.toml", "time": f"time.{time_format}"}
    if responses:
        files["frf"] = "frf.csv"
        if figures:
            files["frf_plot"] = "frf.png"
    if run.road is not None:
        files["psd"] = "psd.csv"
        write_whole(folder / "psd.csv", lambda path: write_densities(path, run, f"frame: {FRAME}"))
    if figures:
        files["time_plot"] = "time.png"
    header = f"parameters of this run, as used\nframe: {FRAME}"
    write_text(folder / "vehicle.toml", parameters_text(run.car, header))
    files |= write_own_files(folder, run.car)
    record = Record(time=run.time, channels=run.recording.channels, units=run.recording.units)
    frame = FRAME + LOADS if set(run.car.vehicle.load_channels) & set(record.channels) else FRAME
    write_whole(folder / files["time"], lambda path: write_record(path, time_format, record, frame))
    if responses:
        by_input = {response.input: response.response for response in responses}
        motions = what_moves([response.motion for response in responses])
        write_whole(folder / "frf.csv", lambda path: write_frf(path, by_input, channels, FRAME, motions))
        if figures:
            caption = _caption(run, responses[0].response)
            write_whole(folder / "frf.png", lambda path: plot_frfs(path, run, responses, caption))
    for file_format in dict.fromkeys(formats):
        if file_format != time_format:
            from vehicle.runs.output.run_formats import writer

            files[f"time_{file_format}"] = f"time.{file_format}"
            write_whole(folder / f"time.{file_format}", writer(file_format, run, responses, channels, FRAME))
    if figures:
        write_whole(folder / "time.png", lambda path: plot_time(path, run))
    if video is not None:
        files["video"] = str(video[0])
    beside = None
    if measured is not None:
        from vehicle.runs.output.comparison_files import write_beside

        beside = write_beside(folder, measured, run, files, figures=figures)
    if report is not None:
        files["report"] = str(report[0])
    summary = summarise(
        run,
        responses,
        files,
        measured=beside,
        law_band=law_band,
        engine_reason=engine_reason or run.engine_reason,
        notices=[*missing, *notices],
        command=command,
    )
    write_json(folder / SUMMARY_FILE, summary.to_json())
    if tell is not None:
        tell(summary)
    for name, make in filter(None, (video, report)):
        write_whole(folder / name if name.parent == Path() else name, make)
    return summary


def _frfs(run: Run, accepted: type[DataError]) -> tuple[Sequence[MotionResponse], list[str]]:
    """Return the FRFs of a run; after an accepted error, no FRFs and a notice."""
    try:
        return run.frfs(), []
    except accepted as error:
        return (), [f"no FRFs: {error}"]


def save_last_state(error: SimulationError, output: Path) -> SimulationError:
    """Save the last good state of a failed run next to its folder, which is not made.

    Returns:
        The same error; its message contains the file.
    """
    if error.state is None:
        return error
    state = dict(error.state)
    path = output.with_name(f"{output.name}.failed.npz")

    def save(temporary: Path) -> None:
        with temporary.open("wb") as file:
            np.savez(file, allow_pickle=False, **state)

    write_whole(path, save)
    return SimulationError(f"{error}; last good state (t = {float(state['time']):.3f} s): {path}")


def summarise(
    run: Run,
    responses: Sequence[MotionResponse],
    files: dict[str, str],
    *,
    measured: MeasuredSummary | None = None,
    law_band: LawBandSummary | None = None,
    engine_reason: str = "",
    notices: Sequence[str] = (),
    command: str = "",
) -> RunSummary:
    """Return the content of `summary.json`.

    Args:
        responses: its FRFs of all acceleration channels to each independent plate motion; may be empty.
        files: name of each file by its purpose.
        measured: measurement that the run was compared with.
        law_band: values at the edges of the band of its dampers.
        engine_reason: reason for the choice of the engine.
        notices: notices of the writer of the files, after those of the run.
        command: command line that makes this run.
    """
    statistics, static, vehicle = run.recording.statistics, run.car.static, run.car.vehicle
    energies, wheels = statistics.energies, vehicle.wheels
    channels, dampers = vehicle.acceleration_channels, vehicle.damped_wheels
    limits = {wheel: vehicle.slip_velocities[wheel] for wheel in dampers}
    motion_notice = what_moves([motion.motion for motion in responses]) if responses else ""
    body = rigid_body(vehicle.body)
    loads = {
        load.path.partition(".")[2]: PlacedLoad(mass_kg=load.numbers.mass, at_m=list(load.cog), on=load.parent)
        for load in vehicle.composition.loads
    }
    return RunSummary(
        frame=FRAME,
        vehicle=VehicleSummary(
            name=vehicle.name,
            file=run.car.origin["file"],
            overrides=run.car.origin["overrides"],
            inertia_about=vehicle.body.inertia.about,
            inertia=body.report,
            loads=loads or None,
            superelement=run.car.model.superelement.provenance,
        ),
        input=InputSummary(
            file=Path(run.signal.source).name,
            sha256=run.signal.sha256,
            rms_m=run.signal.rms(run.wheel),
            plate_rms_m={wheel: run.signal.rms(wheel) for wheel in wheels},
            duration_s=run.signal.duration,
            highest_hz=run.signal.highest,
            wheel=run.wheel,
            wheel_text=vehicle.wheel_text(run.wheel),
            road=None if run.road is None else dict(run.road),
        ),
        evaluated_s=[run.skip, run.signal.duration],
        slip_share={wheel: run.slip_share(wheel) for wheel in dampers}
        | ({"slip_velocity": limits[dampers[0]]} if dampers else {}),
        slip_velocities=limits if len(set(limits.values())) > 1 else None,
        first_slip_s={wheel: run.first_slip(wheel) for wheel in dampers},
        friction_saturated_share={wheel: run.slip_share(wheel, SATURATED_VELOCITY) for wheel in dampers},
        first_friction_saturated_s={wheel: run.first_slip(wheel, SATURATED_VELOCITY) for wheel in dampers},
        saturated_velocity=SATURATED_VELOCITY,
        peaks=_peaks(responses[0].response if responses else None, channels),
        comfort=comfort_values(run),
        seat_value=seat_values(run),
        steering_wheel_rim=rim_values(run),
        law_band=law_band,
        obstacle=obstacle_values(run),
        **force_values(run),
        static=StaticSummary(
            tyre_load_n=static.tyre_load,
            rear_support_load_n={
                name.removeprefix("rear_support_"): load for name, load in static.support_load.items()
            },
            residual_m=static.residual,
        ),
        solver=SolverSummary(
            engine=statistics.engine,
            callback=statistics.callback,
            timestep_s=statistics.timestep,
            steps=statistics.steps,
            wall_s=statistics.wall_time,
            realtime_factor=statistics.realtime_factor,
            warnings=list(statistics.warnings),
            energy_residual=energies.residual if energies else None,
            work_in_j=energies.work_in if energies else None,
            dissipated_j=energies.dissipated if energies else None,
            stored_j=energies.stored if energies else None,
            engine_reason=engine_reason,
        ),
        frf=_frf_summary(responses, channels) if responses else None,
        # A loaded run contains all notices of the saved run, and most of them are generated again.
        notices=list(
            dict.fromkeys(
                [
                    *([body.report] if body.repaired else []),
                    *mass_difference(run.car.trimmed_body, vehicle.body, body_loads(vehicle)),
                    *idle_parameters(vehicle, run.car.overrides, statistics.engine),
                    *body_notices(vehicle, run.car.overrides),
                    *run.signal.notices,
                    *([motion_notice] if motion_notice else []),
                    *dict.fromkeys(reason for motion in responses for reason in motion.response.reasons),
                    *comfort_notices(run),
                    *statistics.notices,
                    *([f"{measured.file}: {text}" for text in measured.notices] if measured else []),
                    *notices,
                ]
            )
        ),
        files=files,
        measured=measured,
        tyre=vehicle.driving.words,
        command=command or None,
    )


def _frf_summary(responses: Sequence[MotionResponse], channels: Sequence[str]) -> FrfSummary:
    """Return the settings and the accuracy of an FRF estimate, and the plate motions.

    Degrees of freedom: averages that would give the random errors by H1, median and range over lines and channels.
    """
    response, several = responses[0].response, len(responses) > 1
    averages = response.averages[np.isfinite(response.averages)]
    return FrfSummary(
        estimator=response.estimator,
        window=response.window,
        resolution_hz=response.resolution_hz,
        degrees_of_freedom=float(np.median(averages)) if averages.size else None,
        degrees_of_freedom_range=[float(averages.min()), float(averages.max())] if averages.size else None,
        to=[
            MotionSummary(
                plates=dict(motion.motion),
                input=motion.input,
                columns=f"{CHANNEL}/{motion.input}" if several else CHANNEL,
                peaks=_peaks(motion.response, channels) if several else None,
            )
            for motion in responses
        ],
    )


def _peaks(response: FrequencyResponse | None, channels: Sequence[str]) -> Peaks:
    """Return the resonances of every acceleration channel; empty lists without FRFs."""
    return {
        channel: [
            PeakSummary(
                frequency_hz=peak.frequency_hz,
                magnitude=peak.magnitude,
                coherence=peak.coherence,
                random_error=peak.random_error,
            )
            for peak in (resonances(response, row) if response else ())
        ]
        for row, channel in enumerate(channels)
    }


def _caption(run: Run, response: FrequencyResponse) -> str:
    """Return the caption of the FRF plot: input, levels, estimator."""
    moving = [wheel for wheel in run.signal.wheels if run.signal.rms(wheel) > 0.0] or [run.wheel]
    levels = ", ".join(
        f"{1e3 * run.signal.rms(wheel):.3g} mm at the {wheel_words(wheel, run.car.vehicle.wheels)}" for wheel in moving
    )
    return (
        f"{Path(run.signal.source).name}, RMS {levels}, {run.signal.duration:g} s; estimator: {response.estimator}, "
        f"resolution {number(response.resolution_hz, 2)} Hz; tyres {run.car.vehicle.driving.words}; engine: "
        f"{run.recording.statistics.engine}"
    )
