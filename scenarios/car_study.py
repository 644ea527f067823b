"""What the scenarios of the complete car share: options, findings, and how they are written down."""

from __future__ import annotations

import argparse
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.claim import Claim, headline, write_claims
from scenarios.output_folder import prepare_folder
from scenarios.study_command import scenario_parser
from vehicle.analysis.frf import FrequencyResponse
from vehicle.car import ENGINES, Run
from vehicle.command_line import SET_HELP, parse_and_run
from vehicle.errors import ConfigurationError

QUICK_NOTE = "Short signals (--quick): numbers differ from those of the full study."


@dataclass(frozen=True, kw_only=True, slots=True)
class Findings:
    """Result of a scenario.

    Attributes:
        title: first line of the text.
        claims: published statements beside ours.
        unjudged: statements that short signals cannot judge: name, and why.
        notes: paragraphs below the table.
        data: further numbers for `results.json`.
    """

    title: str
    claims: Sequence[Claim]
    unjudged: Mapping[str, str] = field(default_factory=dict)
    notes: Sequence[str] = ()
    data: Mapping[str, Any] = field(default_factory=dict)

    def write(self, folder: Path) -> None:
        """Write `results.md` and `results.json`."""
        left = [f"Not judged here: {name}: {why}." for name, why in self.unjudged.items()]
        data = {"not_judged": dict(self.unjudged), **self.data}
        write_claims(folder, self.title, self.claims, [*left, *self.notes], data)


def car_parser(name: str, description: str) -> argparse.ArgumentParser:
    """Parser with the options every scenario of the complete car has.

    Args:
        name: module name; results go to runs/<name> without --output.
        description: one line.
    """
    parser = scenario_parser(
        name,
        description,
        quick="short signals; what they cannot judge is left open",
        jobs="processes for independent runs; %(default)s by default",
    )
    parser.add_argument(
        "--vehicle", type=Path, metavar="FILE.toml", help="vehicle file; the car of source 1 by default"
    )
    parser.add_argument(
        "--set",
        dest="overrides",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help=SET_HELP,
    )
    parser.add_argument(
        "--engine", choices=ENGINES, default="mujoco", help="what computes the runs; %(default)s by default"
    )
    return parser


def run_car_study(
    parser: argparse.ArgumentParser,
    study: Callable[[CarRuns, Path, argparse.Namespace], Findings],
    arguments: list[str] | None,
) -> int:
    """Parse, run a scenario, write its results, and turn errors into one message and an exit code.

    Args:
        parser: of `car_parser`.
        study: computes, draws into the folder and returns the findings.
        arguments: without the program name; those of the process by default.

    Returns:
        Exit code, as of `run_command`.
    """

    def job(options: argparse.Namespace) -> None:
        if options.jobs < 1:
            raise ConfigurationError(f"--jobs {options.jobs}: must be at least 1")
        started = clock.perf_counter()
        runs = CarRuns(vehicle=options.vehicle, overrides=options.overrides, engine=options.engine, jobs=options.jobs)
        # A wrong parameter is refused before the folder is made.
        runs.car()
        folder = prepare_folder(options.output, force=options.force)
        found = study(runs, folder, options)
        found.write(folder)
        left = f", {len(found.unjudged)} not judged" if found.unjudged else ""
        seconds = clock.perf_counter() - started
        print(f"{folder}: {headline([asdict(claim) for claim in found.claims])}{left}; see results.md; {seconds:.0f} s")

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


def setting(runs: CarRuns, run: Run, quick: bool) -> list[str]:
    """Paragraphs that say what all numbers were made with."""
    file = "the car of source 1" if runs.vehicle is None else runs.vehicle.name
    changes = f", changed: {', '.join(runs.overrides)}" if runs.overrides else ""
    return [f"Made with {file}{changes}; {computed_by(run)}.", *([QUICK_NOTE] if quick else [])]
