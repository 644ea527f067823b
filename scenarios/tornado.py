"""Which parameters of the car comfort answers to: all changed by -20 and +20 %, smooth and rough road in one chart.

python -m scenarios.tornado [--output DIR] [--quick] [--jobs N] [--engine auto|reduced|mujoco] [--records N]
    [--vehicle FILE.toml] [--set PATH=VALUE]
"""

from __future__ import annotations

import argparse
import sys
import time as clock
from dataclasses import asdict
from pathlib import Path

from scenarios.car_runs import CarRuns
from scenarios.comfort_command import comfort_parser, records_of
from scenarios.comfort_sensitivity_runs import ComfortRuns
from scenarios.comfort_setting import setting
from scenarios.study import QUICK_NOTE, Findings, run_car_study
from scenarios.tornado_bars import all_bars, tornado_questions
from scenarios.tornado_claims import bar_table, tornado_claims
from scenarios.tornado_figures import draw_tornado


def study(comfort: ComfortRuns, folder: Path, *, quick: bool) -> Findings:
    """Run all cars on both roads, draw the chart into the folder, and say what stands out."""
    started = clock.perf_counter()
    comfort(tornado_questions(comfort))
    seconds = clock.perf_counter() - started
    bars = all_bars(comfort)
    draw_tornado(folder / "tornado.png", comfort, bars)
    notes = [
        *setting(comfort),
        f"{comfort.computed} runs of {comfort.records.duration:g} s, computed in {seconds:.1f} s with --jobs "
        f"{comfort.runs.jobs}.",
        bar_table(bars),
    ]
    return Findings(
        title="Comfort against all parameters of the suspension and the stiffness of the body (beyond source 1)",
        claims=tornado_claims(bars),
        notes=[*notes, *([QUICK_NOTE] if quick else [])],
        data={
            "bars": [asdict(bar) for bar in bars],
            "engine": comfort.engine,
            "records": asdict(comfort.records),
            "seconds": seconds,
        },
    )


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = comfort_parser("tornado")
    return run_car_study(parser, _study, arguments)


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    return study(ComfortRuns(runs, records_of(options), folder / "sweep"), folder, quick=options.quick)


if __name__ == "__main__":
    sys.exit(main())
