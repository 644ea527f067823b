"""Every published result of source 1 beside ours: runs all scenarios, or reads finished ones, and says where we stand.

python -m scenarios.published [--output DIR] [--quick] [--jobs N] [--reuse]
"""

from __future__ import annotations

import argparse
import json
import sys
import time as clock
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from scenarios.bump.runs import FIRST_SLIP, FIRST_SLIP_TOLERANCE, PUBLISHED_FRICTION
from scenarios.claims import LEGEND, claim_table, headline, markdown
from scenarios.comfort_sensitivity.claims import PUBLISHED_SLIP as PUBLISHED_ROAD_SLIP
from scenarios.levels import PUBLISHED_SLIP, SLIP_TOLERANCE
from scenarios.study import main_of
from vehicle.commands.command_line import parse_and_run
from vehicle.commands.destination import prepared_folder_of
from vehicle.commands.options import jobs_option, message_options, output_options
from vehicle.commands.parser import Parser
from vehicle.errors import DataError, SimulationError
from vehicle.output.folder import write_text

CAR_SCENARIOS = ("levels", "inertia", "bump", "stribeck", "comfort_sensitivity", "tornado", "tuning")
LUMPED_SCENARIOS = ("quarter_car",)
SCENARIOS = CAR_SCENARIOS + LUMPED_SCENARIOS
"""Scenarios in the order of the table; the first ones take the options of the complete car."""

HOME = Path("renders/published")
"""The table of the full study is kept under version control."""

QUICK_HOME = Path("runs/published/quick_table")


COMPLETE_CAR = {
    "slip share, low / mid / high": ("levels: slip share of the *",),
    "vertical wheel mode": ("levels: vertical wheel mode*",),
    "damper top and knuckle FRF": ("levels: damper top against knuckle*",),
    "roll mode of the body": ("inertia: roll peak*",),
    "six rigid body modes": ("inertia: six rigid body modes",),
    "engine modes": ("inertia: engine modes",),
    "flexible body modes": ("inertia: flexible modes*",),
    "FRFs, axes": ("levels: * line of the FRFs*",),
    "bump 7.5 mm, first slip": ("bump: bump 7.5 mm, first slip*",),
    "bump 7.5 mm, extremes": ("bump: bump 7.5 mm, lowest*", "bump: bump 7.5 mm, highest*"),
    "bump 1.5 mm, no slip, rings down slowly": ("bump: bump 1.5 mm*", "bump: *ring*down*"),
    "Stribeck law, extra peak": ("stribeck: *",),
    "road slip share": ("comfort_sensitivity: *slip share*",),
    "level of the seat rail": ("comfort_sensitivity: largest *",),
    "swing of a road": ("comfort_sensitivity: swing *",),
    "comfort against Fd": ("comfort_sensitivity: *Fd*",),
    "comfort against mount damping": ("comfort_sensitivity: *mount damping*",),
    "comfort against mount stiffness": ("comfort_sensitivity: *mount stiffness*",),
}
"""Rows of "Published results: what the model must reproduce", and the claims that answer each: `scenario: name` with
wild cards."""


def parser() -> Parser:
    """The options of the command."""
    found = Parser(
        prog="python -m scenarios.published", description="Every published result of the complete car beside ours."
    )
    output_options(found, None, default=f"{HOME}, or {QUICK_HOME} with --quick,")
    found.add_argument(
        "--runs", type=Path, default=Path("runs/published"), metavar="DIR", help="folder of the scenarios' own results"
    )
    found.add_argument("--reuse", action="store_true", help="read scenarios that are finished there, run the others")
    found.add_argument("--quick", action="store_true", help="short signals; what they cannot judge is left open")
    jobs_option(found)
    message_options(found)
    return found


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return parse_and_run(parser(), _job, arguments)


def _job(options: argparse.Namespace) -> None:
    home = QUICK_HOME if options.quick else HOME
    folder = prepared_folder_of(options, home)
    started = clock.perf_counter()
    results, seconds = {}, {}
    for number, name in enumerate(SCENARIOS, start=1):
        print(f"{number}/{len(SCENARIOS)} {name}", flush=True)
        began = clock.perf_counter()
        results[name] = scenario_results(name, options)
        seconds[name] = clock.perf_counter() - began
    rows = collect(results)
    uncovered = missing_rows(results)
    write(folder, rows, results, uncovered, quick=options.quick)
    print(
        f"{folder}: {headline(rows)}; see results.md; {clock.perf_counter() - started:.0f} s ("
        + ", ".join(f"{name} {value:.0f}" for name, value in seconds.items())
        + ")"
    )


def scenario_results(name: str, options: argparse.Namespace) -> dict[str, Any]:
    """Content of `results.json` of a scenario, run now unless a finished one may be read.

    Raises:
        SimulationError: the scenario failed; its own message is printed above.
        DataError: its file cannot be read.
    """
    folder = options.runs / name
    path = folder / "results.json"
    if not (options.reuse and path.exists()):
        arguments = ["--output", str(folder), "--force", "--jobs", str(options.jobs)]
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


def collect(results: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Rows of all scenarios with the scenario before their names."""
    return [
        {**row, "name": f"{scenario}: {row['name']}"}
        for scenario, content in results.items()
        for row in content["rows"]
    ]


def missing_rows(results: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Rows of the table of published results that no claim answers, not even one that was left open."""
    names = [
        f"{scenario}: {name}"
        for scenario, content in results.items()
        for name in (*(row["name"] for row in content["rows"]), *content.get("not_judged", {}))
    ]
    return [
        row
        for row, patterns in COMPLETE_CAR.items()
        if not any(fnmatchcase(name, pattern) for name in names for pattern in patterns)
    ]


def write(
    folder: Path,
    rows: Sequence[Mapping[str, Any]],
    results: Mapping[str, Mapping[str, Any]],
    uncovered: Sequence[str],
    *,
    quick: bool,
) -> None:
    """Write `results.md` and `results.json`."""
    lines = ["# Published results of the complete car and of the quarter car, and ours", "", f"{headline(rows)}.", ""]
    lines.append(f"A row agrees by the rule that its last column gives; rows that do not say why. {LEGEND}")
    if quick:
        lines += ["", "Made with `--quick`: short signals, numbers differ from those of the full study."]
    if uncovered:
        lines += ["", "Published results that no row answers: " + "; ".join(uncovered) + "."]
    lines += ["", *definition_lines(results)]
    for scenario, content in results.items():
        own = content["rows"]
        lines += ["", f"## {content['title']}", "", f"`python -m scenarios.{scenario}`: {headline(own)}.", ""]
        lines.append(claim_table(own))
        for note in content.get("notes", ()):
            lines += ["", str(note)]
    write_text(folder / "results.md", "\n".join(lines) + "\n")
    write_text(folder / "results.json", json.dumps(list(rows), indent=1, allow_nan=False) + "\n")


def definition_lines(results: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A section that compares both velocities, from the `results.json` of levels, bump and comfort_sensitivity.

    Args:
        results: scenario to its content; empty when one of the three is missing.
    """
    try:
        velocity = results["levels"]["slip_velocity"]
        roads = results["comfort_sensitivity"]["source"]["coulomb_friction"]
        rows = [*_share_rows(results["levels"]["levels"], roads), *_bump_rows(results["bump"], velocity)]
    except KeyError:
        return []
    table = [
        (name, published, *(cell for text, agrees in found for cell in (text, "yes" if agrees else "NO")))
        for name, published, *found in rows
    ]
    columns = ("result", "published", f"slip: above {1e3 * velocity:g} mm/s", "agrees")
    return [
        "## One definition of slip",
        "",
        f"A damper slips above {1e3 * velocity:g} mm/s, in every row, table, figure and film. That velocity and the "
        "band edges of shaker and road are not published; they were fitted, as one set, to the slip shares below. "
        "Above 1 mm/s the friction is saturated: stick has ended.",
        "",
        *markdown((*columns, "stick ended: above 1 mm/s", "agrees"), table).split("\n"),
    ]


SlipRow = tuple[str, str, tuple[str, bool], tuple[str, bool]]
"""Name, published value, and ours with whether it agrees: above the slip velocity, and above 1 mm/s."""


def _share_rows(levels: Mapping[str, Any], roads: Mapping[str, Sequence[Mapping[str, float]]]) -> Iterator[SlipRow]:
    """Slip shares of the shaker levels, and of the roads with the nominal friction."""
    shares = [
        (f"{wheel} damper, {level}", published[side], *(levels[level][name][side] for name in ("slip", "saturated")))
        for side, wheel in enumerate(("right", "left"))
        for level, published in PUBLISHED_SLIP.items()
    ]
    for road, published in PUBLISHED_ROAD_SLIP.items():
        nominal = next(point for point in roads[road] if point["value"] == PUBLISHED_FRICTION)
        shares.append((f"{road} road", published, nominal["slip"], nominal["saturated"]))
    for name, share, *ours in shares:
        slip, saturated = ((f"{100 * one:.1f} %", abs(one - share) <= SLIP_TOLERANCE) for one in ours)
        yield f"slip share, {name}", f"{100 * share:g} %", slip, saturated


def _bump_rows(content: Mapping[str, Any], velocity: float) -> Iterator[SlipRow]:
    low = content["low_bump"]
    times = [content[key][f"{PUBLISHED_FRICTION:g} N"] for key in ("first_slip_s", "first_saturated_s")]
    slip, saturated = (
        ("never", False) if time is None else (f"{time:.3f} s", abs(time - FIRST_SLIP) <= FIRST_SLIP_TOLERANCE)
        for time in times
    )
    yield "first slip, 7.5 mm bump", f"{FIRST_SLIP:g} s", slip, saturated
    largest = f"largest {1e3 * low['largest_velocity']:.1f} mm/s"
    above = f"for {1e3 * low['time_above_1_mm_s']:.0f} ms"
    slips, ends = low["largest_velocity"] <= velocity, low["time_above_1_mm_s"] == 0.0
    yield "1.5 mm bump", "no slip", (largest, slips), (above, ends)


if __name__ == "__main__":
    sys.exit(main())
