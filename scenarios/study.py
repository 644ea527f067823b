"""What all studies share: their list, options and findings, and how these are run, written down and printed."""

from __future__ import annotations

import argparse
import importlib
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.claims import Claim, headline, write_claims
from scenarios.output_folder import prepare_folder
from vehicle.analysis.frf import FrequencyResponse
from vehicle.car import Run
from vehicle.commands.command_line import Parser, parse_and_run
from vehicle.commands.options import engine_option, jobs_option, message_options, output_options, vehicle_options

STUDIES = {
    "levels": "Low, mid and high random input: FRFs, slip shares, wheel mode.",
    "inertia": "Ixx of the body: FRF of the seat rail and modes.",
    "bump": "Bumps of 1.5 and 7.5 mm: first slip against friction, ring-down, time histories.",
    "stribeck": "Coulomb against Stribeck friction: relative acceleration and damper force.",
    "comfort_sensitivity": "Comfort on a smooth and a rough road against parameters.",
    "tornado": "Comfort on both roads against all parameters, as a tornado chart.",
    "global_sensitivity": "Sobol indices, Morris effects or a Latin hypercube of the comfort value, ten parameters.",
    "tuning": "Fit parameters of the car to FRFs and bump records.",
    "quarter_car": "Quarter-car models with friction, engine, degressive damper and inclined strut.",
    "half_car_rider": "Half car with seat and rider over a bump.",
    "damper_choice": "Choice of dampers for road holding.",
    "published": "Every published result of the complete car beside ours.",
}
"""Name of a study, `python -m scenarios.NAME`, and what it does."""

QUICK_NOTE = "Short signals (--quick): numbers differ from those of the full study."

Parameters = TypeVar("Parameters")


def main_of(name: str) -> Callable[[list[str] | None], int]:
    """The command of a study: a module, or a folder with `__main__.py`."""
    module = importlib.import_module(f"scenarios.{name}")
    if hasattr(module, "__path__"):
        module = importlib.import_module(f"scenarios.{name}.__main__")
    command: Callable[[list[str] | None], int] = module.main
    return command


@dataclass(frozen=True, kw_only=True, slots=True)
class Findings:
    """Result of a study.

    Attributes:
        title: first line of the text.
        claims: published statements beside ours.
        unjudged: statements that short signals cannot judge: name, and why; None where they judge all.
        notes: paragraphs below the table.
        data: further numbers for `results.json`.
    """

    title: str
    claims: Sequence[Claim]
    unjudged: Mapping[str, str] | None = field(default_factory=dict)
    notes: Sequence[str] = ()
    data: Mapping[str, Any] = field(default_factory=dict)

    def write(self, folder: Path) -> str:
        """Write `results.md` and `results.json`; returns the line to print."""
        unjudged = self.unjudged or {}
        left = [f"Not judged here: {name}: {why}." for name, why in unjudged.items()]
        data = self.data if self.unjudged is None else {"not_judged": dict(unjudged), **self.data}
        write_claims(folder, self.title, self.claims, [*left, *self.notes], data)
        more = f", {len(unjudged)} not judged" if unjudged else ""
        return f"{headline([asdict(claim) for claim in self.claims])}{more}; see results.md"


def study_parser(name: str, *, quick: str, jobs: str = "") -> argparse.ArgumentParser:
    """Parser with the options every study has.

    Args:
        name: of the study; results go to runs/<name> without --output.
        quick: what --quick means here.
        jobs: a remark on --jobs.
    """
    parser = Parser(prog=f"python -m scenarios.{name}", description=STUDIES.get(name))
    output_options(parser, Path("runs") / name)
    parser.add_argument("--quick", action="store_true", help=quick)
    jobs_option(parser, note=jobs)
    message_options(parser)
    return parser


def lumped_parser(name: str) -> argparse.ArgumentParser:
    """Parser of a study of few masses, with a parameter file of its own."""
    jobs = "; this study batches its runs in one process, so that it changes nothing"
    parser = study_parser(name, quick="fewer points on the curves", jobs=jobs)
    own = "own parameters, named as the shipped ones"
    parser.add_argument("--parameters", type=Path, metavar="FILE.toml", help=own)
    return parser


def run_lumped_study(
    parser: argparse.ArgumentParser,
    load: Callable[[argparse.Namespace], Parameters],
    study: Callable[[Parameters, Path, argparse.Namespace], Findings | str],
    arguments: list[str] | None,
) -> int:
    """Run a study of few masses, write its results, and turn errors into one message and an exit code.

    Args:
        parser: of `lumped_parser`.
        load: reads the parameters; a wrong one is refused before the folder is made.
        study: computes, draws into the folder and returns the findings, or the line to print if there are none.
        arguments: without the program name; those of the process by default.

    Returns:
        Exit code, as of `run_command`.
    """

    def job(options: argparse.Namespace) -> None:
        parameters = load(options)
        folder = prepare_folder(options.output, force=options.force)
        found = study(parameters, folder, options)
        print(f"{folder}: {found if isinstance(found, str) else found.write(folder)}")

    return parse_and_run(parser, job, arguments)


def car_parser(name: str) -> argparse.ArgumentParser:
    """Parser with the options every study of the complete car has; results go to runs/<name> without --output."""
    parser = study_parser(name, quick="short signals; what they cannot judge is left open")
    vehicle_options(parser)
    engine_option(parser, "mujoco")
    return parser


def run_car_study(
    parser: argparse.ArgumentParser,
    study: Callable[[CarRuns, Path, argparse.Namespace], Findings],
    arguments: list[str] | None,
) -> int:
    """Run a study of the complete car, as `run_lumped_study` does.

    Args:
        parser: of `car_parser`.
        study: computes, draws into the folder and returns the findings.
        arguments: without the program name; those of the process by default.

    Returns:
        Exit code, as of `run_command`.
    """

    def job(options: argparse.Namespace) -> None:
        started = clock.perf_counter()
        runs = CarRuns(vehicle=options.vehicle, overrides=options.overrides, engine=options.engine, jobs=options.jobs)
        # A wrong parameter is refused before the folder is made.
        runs.car()
        folder = prepare_folder(options.output, force=options.force)
        line = study(runs, folder, options).write(folder)
        print(f"{folder}: {line}; {clock.perf_counter() - started:.0f} s")

    return parse_and_run(parser, job, arguments)


def computed_by(run: Run) -> str:
    """Engine and step of a run, for captions and notes."""
    statistics = run.recording.statistics
    return f"engine {statistics.engine}, step {1e3 * statistics.timestep:g} ms"


def estimator_text(response: FrequencyResponse) -> str:
    """Estimator, averages and resolution of FRFs from whole records, for captions."""
    return (
        f"estimator: {response.estimator} on the whole record, {np.nanmedian(response.averages):.2g} averages (degrees "
        f"of freedom, median), resolution {response.resolution_hz:.2g} Hz"
    )


def car_text(runs: CarRuns) -> str:
    """The car that all numbers were made with."""
    file = "the car of source 1" if runs.vehicle is None else runs.vehicle.name
    return file + (f", changed: {', '.join(runs.overrides)}" if runs.overrides else "")


def setting(runs: CarRuns, run: Run, quick: bool) -> list[str]:
    """Paragraphs that say what all numbers were made with."""
    return [f"Made with {car_text(runs)}; {computed_by(run)}.", *([QUICK_NOTE] if quick else [])]
