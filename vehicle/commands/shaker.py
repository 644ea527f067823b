"""`python -m vehicle.shaker`: simulate the car on the shaker or a road, and write the results."""

from __future__ import annotations

import argparse
import math
import shlex
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.accepted_advice import accept
from vehicle.commands.command_line import ProgressLine, command
from vehicle.commands.compare import measured_beside, measured_options
from vehicle.commands.crank_speed import crank_overrides, steady_points
from vehicle.commands.destination import output_folder_of, path_beside, report_path
from vehicle.commands.film_options import check_film_options, film_options, take_settings
from vehicle.commands.input_options import (
    RECORD_NEEDS,
    drives_on_road,
    record_choice,
    record_options,
    recorded_over_time,
    signal_options,
    unit_option,
)
from vehicle.commands.loads import recorded_channels
from vehicle.commands.options import (
    command_parser,
    figures_option,
    film_name,
    message_options,
    output_options,
    report_option,
    set_once,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.commands.summary_text import summary_text
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import PATH_PATTERN
from vehicle.model.parameters.semi_active_damper import FMU
from vehicle.names import CORNERS
from vehicle.signals.formats.formats import TABLES, WRITTEN
from vehicle.studies.sweeps.sweep_settings import SweepSettings

if TYPE_CHECKING:
    from vehicle.signals.excitation.signal import Signal
    from vehicle.signals.records.choice import Choice
    from vehicle.signals.records.run_summary import RunSummary


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("shaker", "Put shaker signals or a road under the wheels of the complete car.")
    file = signal_options(parser)
    recorded = parser.scoped_group(
        "a file of signals or a recorded road",
        needs=RECORD_NEEDS,
        active=lambda options: bool(options.input) or recorded_over_time(options),
    )
    record_options(
        recorded, 'a plate, for example fr="Shaker FR", or the speed rpm of the crankshaft', rate=False, unit=False
    )
    parser.add_argument(
        "--rpm",
        metavar="N|A:B|A:B:STEP",
        help="speed of the crankshaft [1/min]; A:B is a run-up over --duration; A:B:STEP are steady speeds, a "
        "run each, as in `python -m vehicle orders`. Without --input and --road the road is level",
    )
    parser.add_argument(
        "--no-forces",
        action="store_true",
        help="simulate without the applied forces of the car; the same as --set apply_forces=false",
    )
    file.add_argument("--interpolate", action="store_true", help="fill gaps in the displacement by interpolation")
    file.add_argument("--remove-mean", action="store_true", help="subtract the mean of the displacement")
    read = parser.scoped_group(
        "a file of signals or of a measurement",
        needs="--input, --measured, or a road recorded over time; any other road has no file",
        active=lambda options: bool(options.input or options.measured) or recorded_over_time(options),
    )
    unit_option(read)
    output_options(parser, None, default="runs/<input stem> or runs/road_C_80")
    car = vehicle_options(parser)
    car.add_argument(
        "--controller",
        type=Path,
        metavar="FILE.fmu",
        help="FMU (FMI 2.0 or 3.0 co-simulation) that controls each semi-active damper: velocities in, damping "
        "coefficient out. It runs native code with all your rights, so you must allow it: --trust, or vehicle trust",
    )
    car.add_argument(
        "--trust",
        action="store_true",
        help="allow the native code of the FMU controllers from now on: add them to your list (vehicle trust --list)",
    )
    setting_options(parser, SweepSettings, "engine", default="mujoco")
    setting_options(parser, SweepSettings, "skip")
    parser.add_argument(
        "--timestep",
        type=float,
        metavar="S",
        help="time step of the integration [s]; default: time step of the vehicle file",
    )
    parser.add_argument(
        "--time-format",
        choices=TABLES,
        default="npz",
        help="format of the time histories; default: %(default)s",
    )
    parser.add_argument(
        "--channels",
        dest="recorded",
        metavar="loads|all|NAME,...",
        help="record more channels. loads: forces of all elements [N] and suspension travel [m], for `python -m "
        "vehicle loads`; names: some of these; all: also coefficients of semi-active dampers [N s/m] and "
        "applied forces (force_NAME, torque_NAME, angle_crank, speed_crank)",
    )
    parser.add_argument(
        "--format",
        dest="formats",
        action="append",
        default=[],
        choices=WRITTEN,
        help="also write the time histories in this format; mat, uff and h5 also contain FRFs and coherence, uff "
        "also the points of the car. May be repeated",
    )
    figures_option(parser)
    film = film_options(parser, "render a film of the run")
    film.add_argument(
        "--video-mode",
        type=float,
        nargs="?",
        const=math.nan,
        metavar="HZ",
        help="show a mode beside the run: the one nearest to this frequency [Hz]; without a number the one with the "
        "largest share in the vertical acceleration of the seat rail",
    )
    measured_options(parser)
    report_option(parser, "an HTML file with findings, figures, moving modes and tables", "the run")
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.runs.output.folder import output_folder
    from vehicle.signals.excitation.evaluation_start import evaluation_start
    from vehicle.signals.excitation.input_files import find_input

    if options.no_forces:
        if options.rpm is not None or any(text.startswith("rpm=") for text in options.picks):
            raise ConfigurationError(
                "--rpm has no effect with --no-forces, which leaves out the forces of the crankshaft; leave "
                "out one of them"
            )
        options.overrides = [*options.overrides, *set_once(options.overrides, "--no-forces", ["apply_forces=false"])]
    if options.rpm is not None and options.rpm.count(":") == 2:
        steady_points(options)
        return
    drive = None
    crank = set_once(options.overrides, "--rpm" if options.rpm else "--channel rpm", crank_overrides(options))
    overrides = options.overrides = [*options.overrides, *crank]
    if drives_on_road(options):
        from vehicle.commands.road import class_or_profile, road_drive
        from vehicle.model.parameters.vehicle import load_vehicle

        drive = road_drive(class_or_profile(options.road), options, load_vehicle(options.vehicle, options.overrides))
        source, stem = drive.road, drive.name
        overrides += drive.overrides
    else:
        source = find_input(options.input)
        stem = source.stem
    inputs = tuple(
        path for path in (source, options.vehicle, options.measured, options.controller) if isinstance(path, Path)
    )
    check_film_options(options)
    output = output_folder_of(options, Path("runs") / stem, protect=inputs)
    if "h5" in options.formats:
        from vehicle.signals.formats.optional_library import extra

        extra("h5py", "hdf5", "--format h5")
    engine, reason = _engine(options)
    video_name = None
    if options.video is not None:
        from vehicle.drawing.rendering.backend import require_film

        video_name = path_beside(film_name(options.video, f"{stem}.mp4"), "--video", output, options)
        require_film()
    report_name = None if options.report is None else report_path(options, output)
    if options.timestep is not None:
        overrides += set_once(overrides, "--timestep", [f"solver.timestep={options.timestep!r}"])
    if options.controller is not None or options.trust:
        overrides += set_once(
            overrides, "--controller" if options.controller else "--trust", _controller_overrides(options)
        )

    from vehicle.errors import SimulationError
    from vehicle.runs.car import Car
    from vehicle.runs.output.run_files import save_last_state, write_run
    from vehicle.runs.output.run_size import run_size

    car = Car.load(options.vehicle, overrides)
    wheel = CORNERS[options.wheel] if options.wheel else car.vehicle.shaker_wheel
    choice = record_choice(options, wheel) if drive is None else None
    signal = drive.signal() if drive is not None else plate_signal(options, wheel, choice)
    accept(options, signal.notices)
    _check_signal(options, signal)
    skip = evaluation_start({stem: signal.duration}, options.skip, 0.0 if drive is None else drive.skip)
    channels = None if options.recorded is None else recorded_channels(options.recorded, car.vehicle)
    measured = measured_beside(options, channels or car.vehicle.channels, choice.units if choice else ())
    # A car that cannot be run is refused before anything is written.
    car.check(engine)
    controls = [damper.law.controlled for damper in car.vehicle.composition.dampers]
    for file in dict.fromkeys(control.fmu for control in controls if control and control.law == FMU):
        if not options.quiet:
            print(f"controller  {file} runs as native code with all your rights")
    road = None if drive is None else drive.summary(signal)
    signal = signal if drive is None else replace(signal, source=drive.name)
    count, rate = len(channels or car.vehicle.channels), car.vehicle.solver.record_rate
    if size := run_size(output, signal.duration, rate, count, [options.time_format, *options.formats]):
        print(f"notice: {size}", file=sys.stderr, flush=True)
    with output_folder(output, force=options.force, protect=inputs) as folder:
        try:
            progress = ProgressLine("simulation", enabled=not options.quiet)
            run = replace(car.run(signal, progress, engine=engine, channels=channels, skip=skip), road=road)
        except SimulationError as error:
            raise save_last_state(error, output) from None

        def make_film(path: Path) -> None:
            from vehicle.drawing.rendering.crew import drawing_jobs
            from vehicle.drawing.rendering.film import film
            from vehicle.drawing.rendering.shot import Take
            from vehicle.runs.car.main_mode import beside

            take = Take(
                **take_settings(options),
                speed=None if drive is None or drive.speed is None else drive.speed / 3.6,
                profile=(signal.time, signal.profile) if signal.profile else None,
            )
            if options.video_mode is not None:
                take = replace(take, mode=beside(run, None if math.isnan(options.video_mode) else options.video_mode))
            progress = ProgressLine("film      ", enabled=not options.quiet)
            film(run, path, take, jobs=drawing_jobs(), progress=progress)

        def make_report(path: Path) -> None:
            from vehicle.handover.page.trial_section import trial
            from vehicle.runs.report.finished_run import read_run
            from vehicle.runs.report.page import report_page

            progress = ProgressLine("report    ", enabled=not options.quiet)
            finished = read_run(folder, final_path=output, car=car, recording=run.recording)
            page = report_page([finished], progress, trial=trial, author=options.author, project=options.project)
            path.write_text(page, encoding="utf-8")

        def print_numbers(summary: RunSummary) -> None:
            from vehicle.runs.report.general_notices import without_general

            if not options.quiet:
                run_notices = without_general(summary["notices"], car.vehicle)
                print(summary_text({**summary, "notices": run_notices}), flush=True)

        summary = write_run(
            folder,
            run,
            time_format=options.time_format,
            formats=options.formats,
            engine_reason=reason,
            figures=options.figures,
            video=None if video_name is None else (video_name, make_film),
            measured=measured,
            report=None if report_name is None else (report_name, make_report),
            command=shlex.join(["python", "-m", "vehicle.shaker", *options.words]),
            tell=print_numbers,
        )
    if not options.quiet:
        print(f"files       {output}: {', '.join(summary['files'].values())}")


def plate_signal(options: argparse.Namespace, wheel: str, choice: Choice | None) -> Signal:
    """Return the plate signals of --input, by default at `wheel`; reject plates whose FRFs cannot be estimated."""
    from vehicle.runs.output.run_files import require_plates
    from vehicle.signals.excitation.input_files import find_input
    from vehicle.signals.excitation.signal_file import read_signal

    signal = read_signal(
        find_input(options.input),
        wheel=wheel,
        interpolate=options.interpolate,
        remove_mean=options.remove_mean,
        accept_implausible=options.any_level,
        choice=choice,
    )
    require_plates(signal, separable=not options.any_level)
    return signal


def _check_signal(options: argparse.Namespace, signal: Signal) -> None:
    """Check --wheel against the wheels of the file, and the excerpt of the film against the record."""
    if options.wheel is not None and len(signal.wheels) > 1:
        raise ConfigurationError(
            f"--wheel {options.wheel}: the columns of {options.input} already state their wheels; leave --wheel out"
        )
    if options.video_start is not None:
        chosen = options.video_duration is not None and options.slow_motion is not None
        latest = signal.duration - (options.video_duration / options.slow_motion if chosen else 0.0)
        if not 0.0 <= options.video_start <= latest:
            raise ConfigurationError(
                f"--video-start {options.video_start:g}: must be 0 to {latest:g} s, so that the film lies "
                "within the record"
            )


def _controller_overrides(options: argparse.Namespace) -> list[str]:
    """Return the overrides of --controller for all semi-active dampers, and of --trust for all FMUs."""
    from vehicle.core.trusted_code import trust
    from vehicle.model.parameters.vehicle import load_vehicle

    vehicle = load_vehicle(options.vehicle, options.overrides)
    controls = {damper.path: control for damper in vehicle.composition.dampers if (control := damper.law.control)}
    if options.controller is None:
        files = {path: Path(control.fmu) for path, control in controls.items() if control.law == FMU and control.fmu}
        files = {path: file for path, file in files.items() if file.is_file()}
        if not files:
            raise ConfigurationError(
                f"--trust: no damper of {vehicle.name} is controlled by an FMU; leave --trust out, or add "
                "--controller FILE"
            )
        return [f"{path}.control.fmu_sha256={trust(file)}" for path, file in files.items()]
    paths = list(controls)
    if not paths:
        raise ConfigurationError(
            f"--controller {options.controller}: {vehicle.name} has no semi-active damper; use --vehicle "
            "focus_road, or add a section [front.damper.control] to the vehicle file (docs/vehicle-file.md)"
        )
    if options.trust and not options.controller.is_file():
        raise ConfigurationError(f"--controller {options.controller}: the file does not exist; set the path of an FMU")
    file = options.controller.resolve().as_posix()
    if not PATH_PATTERN.fullmatch(file):
        raise ConfigurationError(
            f"--controller {file}: the path contains a quotation mark, bracket, # or backslash, which vehicle "
            "files do not allow; rename or move the FMU"
        )
    texts = [f"law={FMU}", f"fmu={file}"]
    texts += [f"fmu_sha256={trust(options.controller)}"] if options.trust else []
    return [f"{path}.control.{text}" for path in paths for text in texts]


def _engine(options: argparse.Namespace) -> tuple[str, str]:
    """Return the engine, and the reason if it differs from the option."""
    needs = "--video" if options.video is not None else "--timestep" if options.timestep is not None else None
    if needs is None or options.engine == "mujoco":
        return options.engine, ""
    why = f"{needs}: the reduced engine " + (
        "does not store the positions that a film needs" if needs == "--video" else "chooses its time step itself"
    )
    if options.engine == "reduced":
        raise ConfigurationError(f"{why}; leave --engine reduced out, or {needs}")
    return "mujoco", why


main = command(parser, _job)
