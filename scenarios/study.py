"""Common parts of all studies: list, options, run as a command, and notes on the conditions."""

import importlib
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.claims import Findings
from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import message_options, output_options, setting_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.car import Run
from vehicle.runs.output.destination import Destination
from vehicle.runs.output.folder import study_folder
from vehicle.settings import Settings, part
from vehicle.settings import setting as declared
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.threads import one_blas_thread

STUDIES = {
    "levels": "Low, mid and high random input: FRFs, slip shares, wheel mode.",
    "inertia": "Ixx of the body: FRF of the seat rail and modes.",
    "bump": "Bumps of 1.5 and 7.5 mm: first slip against friction, ring-down, time histories.",
    "stribeck": "Coulomb against Stribeck friction: relative acceleration and damper force.",
    "comfort_sensitivity": "Comfort on a smooth and a rough road against parameters.",
    "quarter_car": "Quarter-car models with friction, engine, degressive damper and inclined strut.",
    "half_car_rider": "Half car with seat and rider over a bump.",
    "damper_choice": "Choice of dampers for road holding.",
    "source_choice": "Sides, slip velocity, band edges and body that Bommer 2006 does not print, chosen together.",
    "published": "Every published result of the complete car beside ours.",
}
"""Name of a study, `python -m scenarios.NAME`, to its description."""

VERTICAL_TYRES = "vertical springs, the same rolling and standing"
"""State of the tyres of lumped models."""

QUICK_NOTE = "Short signals (--quick): numbers differ from the full study."

Subject = TypeVar("Subject")
S = TypeVar("S", bound="StudySettings")


@dataclass(frozen=True, kw_only=True, slots=True)
class StudySettings(Settings):
    """Settings of every study.

    Attributes:
        destination: folder of the results.
        quick: a small study.
        jobs: worker processes.
    """

    destination: Destination = part(Destination)
    quick: bool = False
    jobs: int = 1


@dataclass(frozen=True, kw_only=True, slots=True)
class LumpedSettings(StudySettings):
    """Settings of a study of a lumped model."""

    parameters: Path | None = declared("own parameters, named as the shipped ones", type=Path, metavar="FILE.toml")


@dataclass(frozen=True, kw_only=True, slots=True)
class CarSettings(StudySettings):
    """Settings of a study of the complete car."""

    car: CarChoice = part(CarChoice)
    engine: str = "mujoco"


def main_of(name: str) -> Callable[[list[str] | None], int]:
    """Return the command of a study: a module, or a folder with `__main__.py`."""
    module = importlib.import_module(f"scenarios.{name}")
    if hasattr(module, "__path__"):
        module = importlib.import_module(f"scenarios.{name}.__main__")
    command: Callable[[list[str] | None], int] = module.main
    return command


def study_parser(name: str, settings: type[StudySettings] = StudySettings, *, quick: str, jobs: str = "") -> Parser:
    """Return a parser with the common options of studies, and those that the settings declare."""
    parser = Parser(prog=f"python -m scenarios.{name}", description=STUDIES.get(name))
    output_options(parser, Path("runs") / name)
    parser.add_argument("--quick", action="store_true", help=quick)
    setting_options(parser, SweepSettings, "jobs", note=jobs)
    setting_options(parser, settings)
    message_options(parser)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class Study(Generic[S, Subject]):
    """Study as a command."""

    name: str
    parser: Parser  # parser of the options
    settings: type[S]
    load: Callable[[S], Subject]  # returns the subject of the study; called before the folder is created
    # computes, writes figures into the folder and returns the findings, or a line to print
    study: Callable[[Subject, Path, S], Findings | str]

    def __call__(self, arguments: list[str] | None = None) -> int:
        """Run the study, write its results, and turn errors into one message and an exit code.

        Args:
            arguments: command line without the program name; by default the arguments of the process.

        Returns:
            Exit code, see `run_command`.
        """
        return command(lambda: self.parser, self.settings, one_blas_thread()(self._run))(arguments)

    def _run(self, settings: S, console: Console) -> None:
        started = clock.perf_counter()
        subject = self.load(settings)
        output = settings.destination.study_folder(Path("runs") / self.name)
        with study_folder(output, force=settings.destination.force) as folder:
            findings = self.study(subject, folder, settings)
            line = findings if isinstance(findings, str) else findings.write(folder)
        if isinstance(findings, Findings):
            for text in findings.values:
                print(text)
        print(f"{output}: {line}; {clock.perf_counter() - started:.0f} s")


def lumped_study(
    name: str, load: Callable[[S], Subject], study: Callable[[Subject, Path, S], Findings | str], settings: type[S]
) -> Study[S, Subject]:
    """Return a study of a lumped model with a parameter file; arguments as in `Study`."""
    jobs = "; without effect here, because the study batches its runs in one process"
    parser = study_parser(name, settings, quick="fewer points on the curves", jobs=jobs)
    return Study(name=name, parser=parser, settings=settings, load=load, study=study)


C = TypeVar("C", bound=CarSettings)


def car_study(
    name: str, study: Callable[[CarRuns, Path, C], Findings], settings: type[C], *, engine: str = "mujoco"
) -> Study[C, CarRuns]:
    """Return a study of the complete car; arguments as in `Study`, and the default engine."""
    parser = study_parser(name, settings, quick="short signals; what they cannot judge is left open")
    vehicle_options(parser)
    setting_options(parser, SweepSettings, "engine", default=engine)
    return Study(name=name, parser=parser, settings=settings, load=_car_runs, study=study)


def _car_runs(settings: CarSettings) -> CarRuns:
    car = settings.car
    runs = CarRuns(vehicle=car.vehicle, overrides=car.overrides, engine=settings.engine, jobs=settings.jobs)
    runs.car()
    return runs


def computed_by(run: Run) -> str:
    """Return a text on tyres, engine and step of a run for captions and notes."""
    statistics = run.recording.statistics
    tyres = f"tyres {run.car.vehicle.driving.words}"
    return f"{tyres}, engine {statistics.engine}, step {1e3 * statistics.timestep:g} ms"


def estimator_text(response: FrequencyResponse) -> str:
    """Return a text on estimator, averages and resolution of FRFs for captions."""
    return (
        f"estimator: {response.estimator} on the whole record, {np.nanmedian(response.averages):.2g} averages (degrees "
        f"of freedom, median), resolution {response.resolution_hz:.2g} Hz"
    )


def car_text(runs: CarRuns) -> str:
    """Return a text on the car and its overrides."""
    file = "the car of Bommer 2006" if runs.vehicle is None else runs.vehicle.name
    return file + (f", changed: {', '.join(runs.overrides)}" if runs.overrides else "")


def setting(runs: CarRuns, run: Run, quick: bool) -> list[str]:
    """Return the paragraphs on the conditions of all values."""
    return [f"Made with {car_text(runs)}; {computed_by(run)}.", *([QUICK_NOTE] if quick else [])]
