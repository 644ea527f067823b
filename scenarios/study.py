"""Common parts of all studies: list, options, run as a command, and notes on the conditions."""

import argparse
import importlib
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.claims import Findings
from vehicle.commands.command_line import parse_and_run
from vehicle.commands.destination import study_folder_of
from vehicle.commands.options import message_options, output_options, setting_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.runs.car import Run
from vehicle.runs.output.folder import study_folder
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

QUICK_NOTE = "Short signals (--quick): numbers differ from those of the full study."

Subject = TypeVar("Subject")

AddOptions = Callable[[Parser], None]


def main_of(name: str) -> Callable[[list[str] | None], int]:
    """Return the command of a study: a module, or a folder with `__main__.py`."""
    module = importlib.import_module(f"scenarios.{name}")
    if hasattr(module, "__path__"):
        module = importlib.import_module(f"scenarios.{name}.__main__")
    command: Callable[[list[str] | None], int] = module.main
    return command


def study_parser(name: str, *, quick: str, jobs: str = "") -> Parser:
    """Return a parser with the common options of studies."""
    parser = Parser(prog=f"python -m scenarios.{name}", description=STUDIES.get(name))
    output_options(parser, Path("runs") / name)
    parser.add_argument("--quick", action="store_true", help=quick)
    setting_options(parser, SweepSettings, "jobs", note=jobs)
    message_options(parser)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class Study(Generic[Subject]):
    """Study as a command."""

    parser: Parser  # parser of the options
    # function of the options that returns the subject of the study; called before the folder is created
    load: Callable[[argparse.Namespace], Subject]
    # function that computes, writes figures into the folder and returns the findings, or a line to print
    study: Callable[[Subject, Path, argparse.Namespace], Findings | str]

    def __call__(self, arguments: list[str] | None = None) -> int:
        """Run the study, write its results, and turn errors into one message and an exit code.

        Args:
            arguments: command line without the program name; by default that of the process.

        Returns:
            Exit code, see `run_command`.
        """

        @one_blas_thread()
        def job(options: argparse.Namespace) -> None:
            started = clock.perf_counter()
            subject = self.load(options)
            output = study_folder_of(options, options.output)
            with study_folder(output, force=options.force) as folder:
                findings = self.study(subject, folder, options)
                line = findings if isinstance(findings, str) else findings.write(folder)
            if isinstance(findings, Findings):
                for text in findings.values:
                    print(text)
            print(f"{output}: {line}; {clock.perf_counter() - started:.0f} s")

        return parse_and_run(self.parser, job, arguments)


def lumped_study(
    name: str,
    load: Callable[[argparse.Namespace], Subject],
    study: Callable[[Subject, Path, argparse.Namespace], Findings | str],
    *options: AddOptions,
) -> Study[Subject]:
    """Return a study of a lumped model with a parameter file; arguments as in `Study`, and functions for options."""
    jobs = "; this study batches its runs in one process, so that it changes nothing"
    parser = study_parser(name, quick="fewer points on the curves", jobs=jobs)
    text = "own parameters, named as the shipped ones"
    parser.add_argument("--parameters", type=Path, metavar="FILE.toml", help=text)
    for add in options:
        add(parser)
    return Study(parser=parser, load=load, study=study)


def car_study(
    name: str, study: Callable[[CarRuns, Path, argparse.Namespace], Findings], *options: AddOptions
) -> Study[CarRuns]:
    """Return a study of the complete car; arguments as in `Study`, and functions for options."""
    parser = study_parser(name, quick="short signals; what they cannot judge is left open")
    vehicle_options(parser)
    setting_options(parser, SweepSettings, "engine", default="mujoco")
    for add in options:
        add(parser)
    return Study(parser=parser, load=_car_runs, study=study)


def _car_runs(options: argparse.Namespace) -> CarRuns:
    runs = CarRuns(vehicle=options.vehicle, overrides=options.overrides, engine=options.engine, jobs=options.jobs)
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
