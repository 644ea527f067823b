"""Run on the shaker or a road with all its files: summary, time histories, FRFs, pictures, film, report."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError, SimulationError
from vehicle.handover.page.shaker_settings import ShakerSettings
from vehicle.model.laws.controllers import with_controller
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.model.parameters.recorded_channels import recorded_channels
from vehicle.model.parameters.semi_active_damper import FMU
from vehicle.runs.output.folder import output_folder
from vehicle.runs.output.listener import Listener
from vehicle.signals.excitation.crank_speed import crank_overrides, measured_speed
from vehicle.signals.excitation.evaluation_start import evaluation_start
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.input_settings import DriveInput, PlateSettings
from vehicle.signals.excitation.road_drive import evaluated_from
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.optional_library import extra
from vehicle.signals.records.record_settings import RecordSettings

if TYPE_CHECKING:
    from vehicle.runs.car import Car, Run
    from vehicle.runs.car.road import Drive
    from vehicle.signals.records.choice import Choice
    from vehicle.signals.records.run_summary import RunSummary


@dataclass(frozen=True, slots=True)
class ShakenRun:
    """Files of a run.

    Attributes:
        folder: folder of the files.
        summary: content of `summary.json`.
    """

    folder: Path
    summary: RunSummary


def shake(
    settings: ShakerSettings,
    listener: Listener | None = None,
    *,
    tell: Callable[[RunSummary, Car], None] | None = None,
    command: str = "",
) -> ShakenRun:
    """Simulate the car on the shaker or a road, and write all files of the run.

    Args:
        settings: input, car, files.
        listener: receives progress and notices.
        tell: called with the summary and the car before the slow film and report.
        command: command line that makes this run, for the summary.

    Returns:
        Folder and summary of the run.

    Raises:
        VehicleError: wrong settings, bad data, a failed run, or files that cannot be written.
    """
    with settings.destination.held:
        return _shake(settings, listener or Listener(), tell, command)


def _shake(
    settings: ShakerSettings, listener: Listener, tell: Callable[[RunSummary, Car], None] | None, command: str
) -> ShakenRun:
    """Simulate and write, see `shake`."""
    source, choice = _with_forces(settings)
    drive: Drive | None = None
    if isinstance(source, DriveInput):
        from vehicle.runs.car.car import Car
        from vehicle.runs.car.road import road_of
        from vehicle.runs.car.road_precision import with_duration

        road = road_of(source, others=settings.measured.measured is not None)
        drive = evaluated_from(road.under(choice.load(), choice.overrides), settings.skip)
        if road.precision is not None:
            drive = with_duration(Car.load(choice.vehicle, choice.overrides), drive)
        file, stem = drive.road, drive.name
        choice = replace(choice, overrides=(*choice.overrides, *drive.overrides))
    else:
        file = find_input(source.input)
        stem = file.stem
    inputs = (file, settings.car.vehicle, settings.measured.measured, settings.controller)
    protect = tuple(path for path in inputs if isinstance(path, Path))
    output = settings.destination.folder(Path("runs") / stem, protect=protect)
    if "h5" in settings.formats:
        extra("h5py", "hdf5", "--format h5")
    engine, reason = settings.chosen_engine()
    video = None
    if settings.film.video is not None:
        # MuJoCo is imported after the backend of the film is chosen.
        from vehicle.drawing.rendering.backend import require_film

        video = settings.destination.beside(settings.film.path(f"{stem}.mp4"), "--video", output)
        require_film()
    page = settings.report.path(settings.destination, output)
    if settings.timestep is not None:
        choice = choice.with_("--timestep", f"solver.timestep={settings.timestep!r}")
    choice = with_controller(choice, settings.controller, trusted=settings.trust)

    from vehicle.runs.car import Car
    from vehicle.runs.output.run_files import save_last_state, write_run
    from vehicle.runs.output.run_law_band import law_band_values
    from vehicle.runs.output.run_size import run_size

    car = Car.load(choice.vehicle, choice.overrides)
    of_input: Container[str] = ()
    if isinstance(source, PlateSettings):
        wheel = source.corner(car.vehicle.shaker_wheel)
        plates = source.record.choice(wheel, others=settings.measured.measured is not None)
        signal, of_input = plate_signal(source, wheel, plates), plates.units if plates else ()
    else:
        assert drive is not None
        signal = drive.signal()
    listener.accept(signal.notices)
    settings.film.require_inside(signal.duration)
    skip = evaluation_start({stem: signal.duration}, settings.skip, 0.0 if drive is None else drive.skip)
    channels = None if settings.channels is None else recorded_channels(settings.channels, car.vehicle)
    measured = None
    if settings.measured.measured is not None:
        # Rate and excerpt of the options belong to the input; the measurement takes its units only.
        asked = settings.measured.choice(RecordSettings(units=source.record.units), of_input)
        measured = settings.measured.read(channels or car.vehicle.channels, asked)
    # A car that cannot be run is refused before anything is written.
    car.check(engine)
    edges = car.law_band() if settings.law_band else ()
    controls = [damper.law.controlled for damper in car.vehicle.composition.dampers]
    for native in dict.fromkeys(control.fmu for control in controls if control and control.law == FMU):
        listener.say(f"controller  {native} runs as native code with all your rights")
    description = None if drive is None else drive.summary(signal)
    signal = signal if drive is None else replace(signal, source=drive.name)
    count, rate = len(channels or car.vehicle.channels), car.vehicle.solver.record_rate
    formats = [settings.time_format, *settings.formats]
    if size := run_size(output, signal.duration, rate, count, formats, reduced=engine == "reduced"):
        listener.notice(size)
    with output_folder(output, force=settings.destination.force, protect=protect) as folder:
        try:
            progress = listener.progress("simulation")
            run = car.run(
                signal, engine, progress=progress, channels=channels, skip=skip, stated_errors=settings.stated_errors
            )
            run = replace(run, road=description)
            band, warnings = law_band_values(run, edges, stated_errors=settings.stated_errors)
        except SimulationError as error:
            raise save_last_state(error, output) from None
        summary = write_run(
            folder,
            run,
            time_format=settings.time_format,
            formats=settings.formats,
            engine_reason=reason,
            figures=settings.figures,
            video=None if video is None else (video, lambda path: _film(path, settings, run, signal, drive, listener)),
            measured=measured,
            law_band=band,
            notices=warnings,
            report=None
            if page is None
            else (page, lambda path: _report(path, settings, run, folder, output, listener)),
            command=command,
            tell=lambda summary: None if tell is None else tell(summary, car),
        )
    return ShakenRun(output, summary)


def _with_forces(settings: ShakerSettings) -> tuple[PlateSettings | DriveInput, CarChoice]:
    """Return the input without the channel of the crankshaft, and the car with its speed or without its forces."""
    settings.require_forces()
    choice = settings.car
    if settings.no_forces:
        choice = choice.with_("--no-forces", "apply_forces=false")
    source, overrides = measured_speed(settings.source, settings.rpm)
    if settings.rpm is not None:
        overrides = crank_overrides(settings.rpm, settings.duration)
    return source, choice.with_("--rpm" if settings.rpm else "--channel rpm", *overrides)


def plate_signal(source: PlateSettings, wheel: str, choice: Choice | None) -> Signal:
    """Return the signals of the plates; reject plates whose FRFs cannot be estimated.

    Args:
        wheel: wheel of a column without a wheel in its name.
        choice: channels, units and times of the file.

    Raises:
        ConfigurationError: `source.wheel` is set, but the columns of the file state their wheels.
        DataError: see `read_signal` and `require_plates`.
    """
    from vehicle.runs.output.run_files import require_plates

    signal = source.signal(wheel, choice)
    require_plates(signal, separable=not source.any_level)
    if source.wheel is not None and len(signal.wheels) > 1:
        raise ConfigurationError(
            f"--wheel {source.wheel}: the columns of {source.input} already state their wheels; leave --wheel out"
        )
    return signal


def _film(
    path: Path, settings: ShakerSettings, run: Run, signal: Signal, drive: Drive | None, listener: Listener
) -> None:
    from vehicle.drawing.rendering.crew import drawing_jobs
    from vehicle.drawing.rendering.film import film
    from vehicle.drawing.rendering.shot import Take
    from vehicle.runs.car.main_mode import beside

    take = Take(
        **settings.film.values(),
        speed=None if drive is None or drive.speed is None else drive.speed / 3.6,
        profile=(signal.time, signal.profile) if signal.profile else None,
    )
    if settings.video_mode is not None:
        take = replace(take, mode=beside(run, None if settings.video_mode is True else settings.video_mode))
    film(run, path, take, jobs=drawing_jobs(), progress=listener.progress("video     "))


def _report(path: Path, settings: ShakerSettings, run: Run, folder: Path, output: Path, listener: Listener) -> None:
    from vehicle.handover.page.trial_section import trial
    from vehicle.runs.report.finished_run import read_run
    from vehicle.runs.report.page import report_page

    finished = read_run(folder, final_path=output, car=run.car, recording=run.recording)
    progress, report = listener.progress("report    "), settings.report
    text = report_page([finished], progress, trial=trial, author=report.author, project=report.project)
    path.write_text(text, encoding="utf-8")
