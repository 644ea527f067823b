"""Moment of inertia Ixx of the trimmed body, 1000 and 1200 kg m2: FRF of the seat rail and modes (section 3.4).

python -m scenarios.inertia [--output DIR] [--quick] [--jobs N] [--engine mujoco|reduced|auto] [--vehicle FILE.toml]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from scenarios.car_runs import CarRuns, Case
from scenarios.car_study import Findings, car_parser, run_car_study, setting
from scenarios.inertia_claims import mode_claims, mode_table, roll_claims, roll_mode, roll_peak
from scenarios.inertia_figures import CHANNELS, inertia_figure
from scenarios.levels import TOO_SHORT, level_signal

VARIANTS = {"Ixx 1000 kg m²": "published", "Ixx 1200 kg m²": "improved"}
"""Label of a variant and its name in the parameters."""


def study(runs: CarRuns, folder: Path, *, quick: bool) -> Findings:
    """Run the low level with both inertias, draw the FRFs into the folder, and compare."""
    signal = level_signal("low", quick=quick)
    changes = [(f"body.inertia_variant={name}",) for name in VARIANTS.values()]
    found = runs([Case(signal=signal, overrides=change) for change in changes])
    cars = [runs.car(change) for change in changes]
    responses = [run.frf(CHANNELS) for run in found]
    rolls = [roll_mode(car) for car in cars]
    by_label = dict(zip(VARIANTS, found, strict=True))
    frequencies = [roll.frequency for roll in rolls]
    inertia_figure(folder / "seat_rail.png", by_label, responses, frequencies)
    peaks = [roll_peak(response, roll) for response, roll in zip(responses, frequencies, strict=True)]
    seen = roll_claims(peaks, frequencies)
    claims = mode_claims(cars)
    return Findings(
        title="Moment of inertia Ixx of the body (source 1, sections 3.2.1 and 3.4)",
        claims=claims if quick else [*claims, *seen],
        unjudged={claim.name: TOO_SHORT for claim in seen} if quick else {},
        notes=[mode_table(dict(zip(VARIANTS, cars, strict=True))), *setting(runs, found[0], quick)],
        data={
            "roll_hz": dict(zip(VARIANTS.values(), frequencies, strict=True)),
            "roll_peak_hz": dict(zip(VARIANTS.values(), peaks, strict=True)),
            "modes": {
                name: [
                    {"frequency_hz": m.frequency, "damping_ratio": m.damping_ratio, "description": m.description}
                    for m in car.modes("stuck")
                ]
                for name, car in zip(VARIANTS.values(), cars, strict=True)
            },
        },
    )


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    return run_car_study(car_parser("inertia", "Ixx of the body: FRF of the seat rail and modes."), _study, arguments)


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    return study(runs, folder, quick=options.quick)


if __name__ == "__main__":
    sys.exit(main())
