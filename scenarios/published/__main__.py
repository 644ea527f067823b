"""Table and page of all published results with our values, from new or finished runs of the studies.

python -m scenarios.published [--output DIR] [--quick] [--jobs N] [--reuse]
"""

import json
import sys
import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from scenarios.claims import headline
from scenarios.published.page import page
from scenarios.published.pictures import write_copy
from scenarios.published.sources import BESIDE, BESIDE_NAME, BESIDE_STUDIES, SOURCES
from scenarios.published.table import collect
from scenarios.study import main_of
from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import message_options, output_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.errors import DataError, SimulationError
from vehicle.runs.output.destination import Destination
from vehicle.runs.output.folder import study_folder, write_text
from vehicle.settings import Settings, part, setting
from vehicle.studies.sweeps.sweep_settings import SweepSettings

HOME = Path("renders/published")
"""The table and the pictures of the full studies are kept under version control."""

PAGE = Path("docs/published-results.md")
"""The page of the full studies."""

QUICK_HOME = Path("runs/published/quick_table")

CHOICE = "source_choice"
"""Study whose notes are the last section of the page."""

STUDIES = tuple(study for source in SOURCES for study in source.studies)


@dataclass(frozen=True, kw_only=True, slots=True)
class PublishedSettings(Settings):
    """Settings of the table of all studies.

    Attributes:
        destination: folder of the table.
        jobs: worker processes of each study.
    """

    destination: Destination = part(Destination)
    jobs: int = 1
    runs: Path = setting("folder of the studies' own results", Path("runs/published"), type=Path, metavar="DIR")
    reuse: bool = setting("read studies that are finished there, run the others", False, action="store_true")
    quick: bool = setting("short signals; what they cannot judge is left open", False, action="store_true")


def parser() -> Parser:
    """Return the options of the command."""
    result = Parser(
        prog="python -m scenarios.published",
        description="Compare all results of the thesis and the two papers with ours.",
    )
    output_options(result, None, default=f"{HOME} with the page {PAGE}, or {QUICK_HOME} with --quick")
    setting_options(result, PublishedSettings)
    setting_options(result, SweepSettings, "jobs")
    message_options(result)
    return result


def _job(settings: PublishedSettings, console: Console) -> None:
    output = settings.destination.study_folder(QUICK_HOME if settings.quick else HOME)
    started = clock.perf_counter()
    results, seconds = {}, {}
    for number, name in enumerate(STUDIES, start=1):
        print(f"{number}/{len(STUDIES)} {name}", flush=True)
        began = clock.perf_counter()
        results[name] = study_results(name, settings)
        seconds[name] = clock.perf_counter() - began
    beside: dict[str, dict[str, Any]] = {}
    for name in () if settings.quick else (name for name in STUDIES if name in BESIDE_STUDIES):
        print(f"{name}, {BESIDE_NAME}", flush=True)
        beside[name] = study_results(name, settings, f"{name}_beside", (*BESIDE_STUDIES[name], "--vehicle", BESIDE))
    rows = collect(results, beside)
    notes = results.get(CHOICE, {}).get("notes", [])
    left_open = [f"{name}: {row}" for name, content in results.items() for row in content.get("not_judged", {})]
    with study_folder(output, force=settings.destination.force) as folder:
        content = {"rows": rows, "choice": notes}
        write_text(folder / "results.json", json.dumps(content, indent=1, allow_nan=False) + "\n")
        copied = copy_pictures(results, settings.runs, folder / "figures")
        home = output == HOME
        text = page(
            rows, notes, f"../{HOME}/figures" if home else "figures", copied, quick=settings.quick, left_open=left_open
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
    name: str, settings: PublishedSettings, folder_name: str = "", more: Sequence[str] = ()
) -> dict[str, Any]:
    """Return the content of `results.json` of a study; run the study unless a finished run may be used.

    Args:
        name: name of the study.
        settings: settings of the table.
        folder_name: folder of the results, by default the name of the study.
        more: further options of the study.

    Raises:
        SimulationError: the study failed; its message is printed above.
        DataError: the file of the study cannot be read.
    """
    folder = settings.runs / (folder_name or name)
    path = folder / "results.json"
    if not (settings.reuse and path.exists()):
        arguments = ["--output", str(folder), "--force", "--jobs", str(settings.jobs), *more]
        if settings.quick:
            arguments.append("--quick")
        code = main_of(name)(arguments)
        if code:
            raise SimulationError(f"scenarios.{name}: ended with exit code {code}; its message is above")
    try:
        content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataError(f"{path}: cannot be read ({error}); run without --reuse") from None
    return content


main = command(parser, PublishedSettings, _job)


if __name__ == "__main__":
    sys.exit(main())
