"""Table and page of all published results with our values, from new or finished runs of the studies.

python -m scenarios.published [--output DIR] [--quick] [--jobs N] [--reuse]
"""

import argparse
import json
import sys
import time as clock
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from scenarios.claims import headline
from scenarios.published.page import page
from scenarios.published.pictures import write_copy
from scenarios.published.sources import BESIDE, BESIDE_NAME, BESIDE_STUDIES, SOURCES
from scenarios.published.table import collect
from scenarios.study import main_of
from vehicle.commands.command_line import parse_and_run
from vehicle.commands.console import Console
from vehicle.commands.options import destination_of, message_options, output_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.errors import DataError, SimulationError
from vehicle.runs.output.folder import study_folder, write_text
from vehicle.studies.sweeps.sweep_settings import SweepSettings

HOME = Path("renders/published")
"""The table and the pictures of the full studies are kept under version control."""

PAGE = Path("docs/published-results.md")
"""The page of the full studies."""

QUICK_HOME = Path("runs/published/quick_table")

CHOICE = "source_choice"
"""Study whose notes are the last section of the page."""

STUDIES = tuple(study for source in SOURCES for study in source.studies)


def parser() -> Parser:
    """Return the options of the command."""
    result = Parser(
        prog="python -m scenarios.published",
        description="Compare all results of the thesis and the two papers with ours.",
    )
    output_options(result, None, default=f"{HOME} with the page {PAGE}, or {QUICK_HOME} with --quick")
    result.add_argument(
        "--runs", type=Path, default=Path("runs/published"), metavar="DIR", help="folder of the studies' own results"
    )
    result.add_argument("--reuse", action="store_true", help="read studies that are finished there, run the others")
    result.add_argument("--quick", action="store_true", help="short signals; what they cannot judge is left open")
    setting_options(result, SweepSettings, "jobs")
    message_options(result)
    return result


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return parse_and_run(parser(), _job, arguments)


def _job(options: argparse.Namespace, console: Console) -> None:
    output = destination_of(options).study_folder(QUICK_HOME if options.quick else HOME)
    started = clock.perf_counter()
    results, seconds = {}, {}
    for number, name in enumerate(STUDIES, start=1):
        print(f"{number}/{len(STUDIES)} {name}", flush=True)
        began = clock.perf_counter()
        results[name] = study_results(name, options)
        seconds[name] = clock.perf_counter() - began
    beside: dict[str, dict[str, Any]] = {}
    for name in () if options.quick else (name for name in STUDIES if name in BESIDE_STUDIES):
        print(f"{name}, {BESIDE_NAME}", flush=True)
        beside[name] = study_results(name, options, f"{name}_beside", (*BESIDE_STUDIES[name], "--vehicle", BESIDE))
    rows = collect(results, beside)
    notes = results.get(CHOICE, {}).get("notes", [])
    left_open = [f"{name}: {row}" for name, content in results.items() for row in content.get("not_judged", {})]
    with study_folder(output, force=options.force) as folder:
        content = {"rows": rows, "choice": notes}
        write_text(folder / "results.json", json.dumps(content, indent=1, allow_nan=False) + "\n")
        copied = copy_pictures(results, options.runs, folder / "figures")
        home = output == HOME
        text = page(
            rows, notes, f"../{HOME}/figures" if home else "figures", copied, quick=options.quick, left_open=left_open
        )
        if not home:
            write_text(folder / PAGE.name, text)
    if home:
        write_text(PAGE, text)
    file = PAGE if home else output / PAGE.name
    times = ", ".join(f"{name} {value:.0f}" for name, value in seconds.items())
    print(f"{output}: {headline(rows)}; see {file}; {clock.perf_counter() - started:.0f} s ({times})")


def copy_pictures(results: Mapping[str, Mapping[str, Any]], runs: Path, folder: Path) -> list[str]:
    """Copy the pictures of the rows at reduced size, report missing ones on standard error, and return the names."""
    folder.mkdir(parents=True, exist_ok=True)
    copies = []
    for study, content in results.items():
        for name in dict.fromkeys(row["picture"] for row in content["rows"] if row["picture"]):
            figure = runs / study / name
            if figure.is_file():
                write_copy(figure, folder / f"{study}_{name}")
                copies.append(f"{study}_{name}")
            else:
                print(f"{figure}: picture of a row, but the study did not write it", file=sys.stderr)
    return copies


def study_results(
    name: str, options: argparse.Namespace, folder_name: str = "", more: Sequence[str] = ()
) -> dict[str, Any]:
    """Return the content of `results.json` of a study; run the study unless a finished run may be used.

    Args:
        name: name of the study.
        options: options of `parser`.
        folder_name: name of the folder of the results, by default that of the study.
        more: further options of the study.

    Raises:
        SimulationError: the study failed; its message is printed above.
        DataError: the file of the study cannot be read.
    """
    folder = options.runs / (folder_name or name)
    path = folder / "results.json"
    if not (options.reuse and path.exists()):
        arguments = ["--output", str(folder), "--force", "--jobs", str(options.jobs), *more]
        if options.quick:
            arguments.append("--quick")
        code = main_of(name)(arguments)
        if code:
            raise SimulationError(f"scenarios.{name}: ended with exit code {code}; its message is above")
    try:
        content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataError(f"{path}: cannot be read ({error}); run without --reuse") from None
    return content


if __name__ == "__main__":
    sys.exit(main())
