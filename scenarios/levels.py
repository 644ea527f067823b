"""Low, mid and high random input under the right front wheel: FRFs of chapter 3 of source 1, slip shares, wheel mode.

python -m scenarios.levels [--output DIR] [--quick] [--jobs N] [--engine mujoco|reduced|auto] [--vehicle FILE.toml]
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import asdict
from pathlib import Path

from scenarios.car_runs import CarRuns, Case
from scenarios.car_study import Findings, car_parser, run_car_study, setting
from scenarios.inputs.make_inputs import LEVELS, SEED
from scenarios.levels_claims import (
    axis_claims,
    frequency_claims,
    numbers,
    order_claims,
    slip_claims,
    slip_table,
)
from scenarios.levels_figures import CHANNELS, OUTPUTS, level_figures
from vehicle.excitation.band import SHAKER_EDGE_HZ, SHAKER_ROLL_OFF_ORDER
from vehicle.excitation.csv_file import read_signal
from vehicle.excitation.input_files import find_input
from vehicle.excitation.random_road import random_road
from vehicle.excitation.signal import Signal
from vehicle.excitation.slip_set import sets_text

QUICK_DURATION = 5.0
"""Length of the signals with --quick [s]."""

QUICK_OUTPUTS = ("seat_rail_acc_z",)
"""Outputs drawn with --quick."""

TOO_SHORT = f"{QUICK_DURATION:g} s of signal tell it too coarsely"


def level_signal(level: str, *, quick: bool) -> Signal:
    """The shipped input of a level, or a short one of the same spectrum and level."""
    if not quick:
        return read_signal(find_input(f"{level}.csv"))
    return random_road(
        rms=LEVELS[level],
        seed=SEED,
        duration=QUICK_DURATION,
        lower_band_edge=SHAKER_EDGE_HZ,
        roll_off_order=SHAKER_ROLL_OFF_ORDER,
    )


def study(runs: CarRuns, folder: Path, *, quick: bool) -> Findings:
    """Run the three levels, draw the figures into the folder, and compare."""
    found = runs([Case(signal=level_signal(level, quick=quick)) for level in LEVELS])
    by_level = dict(zip(LEVELS, found, strict=True))
    responses = {level: run.frf(CHANNELS) for level, run in by_level.items()}
    level_figures(folder, by_level, responses, QUICK_OUTPUTS if quick else tuple(OUTPUTS))
    values = {level: numbers(run, responses[level]) for level, run in by_level.items()}
    slip_velocity = runs.car().vehicle.damper.slip_velocity
    claims = [*slip_claims(values, slip_velocity), *frequency_claims(values), *order_claims(values)]
    claims += axis_claims(responses)
    judged = order_claims(values) if quick else claims
    names = {claim.name for claim in judged}
    return Findings(
        title="Low, mid and high level (source 1, sections 3.2.1 and 3.3)",
        claims=judged,
        unjudged={claim.name: TOO_SHORT for claim in claims if claim.name not in names},
        notes=[slip_table(values, slip_velocity), sets_text(), *setting(runs, found[0], quick)],
        data={"levels": {level: asdict(value) for level, value in values.items()}, "slip_velocity": slip_velocity},
    )


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = car_parser("levels", "Low, mid and high random input: FRFs, slip shares, wheel mode.")
    return run_car_study(parser, _study, arguments)


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    return study(runs, folder, quick=options.quick)


if __name__ == "__main__":
    sys.exit(main())
