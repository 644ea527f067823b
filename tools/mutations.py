"""Forty-four seeded faults over all packages: does a test of the wing see each of them?

    python tools/mutations.py [NUMBER ...] [--list]

A fault is one changed text of one file. It is written, those of the named tests that `make test` runs are run up to the
first failure, and the file is restored, also after Ctrl-C. Run it in a checkout without changes of your own: a fault is
read by whoever reads the file meanwhile. The exit code is 1 if a fault survives, or if its text is no longer there once.

All 44 are caught: 26 by the tests that were there when they were seeded. 18 survived at first; tests were written for
them, and two that were too small to matter were made larger. Try a fault whose tests do not end within `LONGEST_S` on
a busy machine again on an idle one.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
LONGEST_S = 900.0
"""Maximum time of the tests of a fault [s]; a fault that makes them hang is caught."""


class Fault(NamedTuple):
    """A changed text, and the tests under tests/ that have to see it."""

    file: str
    old: str
    new: str
    tests: str


FAULTS = (
    # signals
    Fault("vehicle/signals/analysis/exposure.py", "np.exp(-step / integration_s)", "np.exp(-step)", "signals/analysis/test_exposure.py"),
    Fault("vehicle/signals/analysis/exposure.py", "rms * duration_s**0.25", "rms * duration_s**0.5", "signals/analysis/test_exposure.py"),
    Fault("vehicle/signals/analysis/comfort.py", "np.sqrt(x * x + y * y + z * z)", "np.sqrt(x * x + y * y + 1.001 * z * z)", "signals/analysis/test_comfort.py"),
    Fault("vehicle/signals/analysis/frf_agreement.py", "np.abs(np.vdot(bottom, top)) ** 2 / power", "np.abs(np.vdot(bottom, top)) / power**0.5", "signals/analysis/test_frf_agreement.py"),
    Fault("vehicle/signals/analysis/slip.py", "> limits[:, None])", ">= 1.05 * limits[:, None])", "signals/analysis/test_slip.py"),
    Fault("vehicle/signals/excitation/iso_road.py", "int(np.ceil(self.envelope.reach * parts / step)) + 1", "1", "signals/excitation/test_iso_road.py signals/excitation/test_tyre_envelope.py"),
    Fault("vehicle/signals/excitation/iso_road.py", "_finished(speed * _repeated(slope, steps + 1) * rise + rising)", "_finished(speed * _repeated(slope, steps + 1) * rise)", "signals/excitation/test_iso_road.py signals/excitation/test_tyre_envelope.py"),
    Fault("scenarios/signals/bump.py", "6.0 * np.pi * since", "5.9 * np.pi * since", "scenarios/signals signals/excitation"),
    Fault("vehicle/signals/records/integration.py", "(frequency / corner) ** (2 * ORDER)", "(frequency / corner) ** ORDER", "signals/records/test_integration.py"),
    Fault("vehicle/signals/formats/units.py", '"lbf": 4.4482216152605', '"lbf": 4.4822216152605', "signals/formats/test_units.py"),
    Fault("vehicle/signals/formats/clock.py", "long = multiples > 1.5", "long = multiples > 2.5", "signals/formats/test_stamps.py signals/records/test_resampled.py signals/formats/test_logger.py"),
    # model
    Fault("vehicle/model/laws/control_laws.py", "np.maximum(-wheel * way, 0.0)", "np.maximum(wheel * way, 0.0)", "model/laws"),
    Fault("vehicle/model/laws/elastomer.py", "self.branch_stiffness / (2.0 * np.sqrt(", "self.branch_stiffness / (2.1 * np.sqrt(", "model/laws/test_maxwell.py"),
    Fault("vehicle/model/laws/friction.py", "steep * (limit + fall)", "steep * limit", "model/laws scenarios/lumped"),
    Fault("vehicle/model/flexbody/mass_properties.py", "np.atleast_2d(self.cog - cog)", "np.atleast_2d(0.0 * cog)", "model/flexbody/test_body_units.py"),
    Fault("vehicle/model/flexbody/sources/body_units.py", "np.sqrt(3.0 * mass *", "np.sqrt(30.0 * mass *", "model/flexbody/test_body_units.py"),
    Fault("vehicle/model/parameters/ranges.py", "(high - low) * index / (count - 1)", "(high - low) * index / count", "model/parameters/test_ranges.py studies/sweeps/test_sweep_command.py"),
    Fault("vehicle/model/shapes/surface.py", "np.linalg.norm(np.diff(p, axis=0), axis=1) ** 0.5", "np.linalg.norm(np.diff(p, axis=0), axis=1)", "model/shapes/test_surface.py model/shapes"),
    Fault("vehicle/model/assembly/element_numbers.py", "part.numbers.mass * (x**2 + y**2)", "part.numbers.mass * x**2", "model/assembly engines/simulation physics/test_channel_sums.py physics/test_rolling_tyre.py"),
    # engines
    Fault("vehicle/engines/linear/step_map.py", "beta * ((e - 2.0) * e + 1.0)", "beta * ((e - 2.0) * e + 1.1)", "engines/linear/test_step_map.py engines/linear/test_step_error.py"),
    Fault("vehicle/engines/linear/mode_shares.py", "residues = inputs[:, :w] + poles[:, None]", "residues = inputs[:, :w] - poles[:, None]", "engines/linear/test_mode_shares.py"),
    Fault("vehicle/engines/linear/displacement_laws.py", "share = 0.5 * (breakpoints[near] / DIFFERENCE_STEP + 1.0)", "share = 0.5 * (1.0 - breakpoints[near] / DIFFERENCE_STEP)", "engines/reduced/test_small_terms.py engines/reduced/test_displacement_laws.py"),
    Fault("vehicle/engines/reduced/plate_samples.py", "np.diff(values, 2) / 24.0", "np.diff(values, 2) / 12.0", "engines/reduced/test_small_terms.py engines/reduced/test_rolling_road.py"),
    Fault("vehicle/engines/reduced/equivalent_damping.py", "np.mean((force - force.mean()) * velocity)", "np.mean(force * velocity)", "engines/reduced/test_small_terms.py"),
    Fault("vehicle/engines/kinematics/axle_curves.py", "/ (2.0 * SMALL)", "/ SMALL", "engines/kinematics/test_axle_statics.py runs/car/test_motion_figures.py"),
    Fault("scenarios/lumped/road_holding.py", "LINES_PER_BAND) + 0.5)", "LINES_PER_BAND) + 0.0)", "scenarios/lumped"),
    Fault("vehicle/core/source/dampers.h", "1.5 * body[0] - 0.5 * body[1]", "body[0]", "physics/test_semi_active_half_car.py physics/test_semi_active_car.py"),
    Fault("vehicle/core/source/rows.h", "+ c->gain.at[i] * rate", "+ 0.98 * c->gain.at[i] * rate", "engines/simulation/test_maxwell_rows.py engines/simulation/test_native.py engines/reduced/test_reduced_car.py"),
    Fault("vehicle/core/source/rolling.h", "root(1.0 - frame[7] * frame[7])", "1.0", "physics/test_round_tyre.py physics/test_rolling_tyre.py physics/test_road_slope.py"),
    # drawing, runs
    Fault("vehicle/drawing/rendering/rounding.py", "[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0]", "[1.0, 2.0, 5.0, 10.0]", "drawing/rendering"),
    Fault("vehicle/runs/report/findings.py", "low = float(np.mean(finite < COHERENT))", "low = float(np.mean(finite > COHERENT))", "runs/report/test_findings.py"),
    Fault("vehicle/runs/report/differences.py", "100.0 * (other / first - 1.0)", "100.0 * (first / other - 1.0)", "runs/report/test_page.py runs/report runs/comparison"),
    Fault("vehicle/runs/comparison/frf_comparison.py", "np.nan_to_num(coherences[0], nan=1.0) * np", "np.nan_to_num(coherences[0], nan=1.0) + 0.0 * np", "runs/comparison/test_weights.py"),
    Fault("vehicle/handover/fmu/output_rows.py", "rate = displacements.poles * model.poles", "rate = displacements.poles * model.poles * 1.01", "handover/fmu/test_against_the_engine.py"),
    Fault("vehicle/handover/page/trial_data.py", "high = max(FRICTION[name].usual, 2.0 * value)", "high = max(FRICTION[name].usual, 0.5 * value)", "runs/report"),
    # studies, commands, scenarios
    Fault("vehicle/studies/tuning/frf_target.py", "np.exp(-2j * np.pi * delays[:, None] * frequency)", "np.exp(2j * np.pi * delays[:, None] * frequency)", "studies/tuning"),
    Fault("vehicle/studies/optimisation/front.py", "np.all(costs[kept] <= costs[row], axis=1)", "np.any(costs[kept] <= costs[row], axis=1)", "studies/optimisation/test_front.py"),
    Fault("vehicle/studies/mounts/decoupler_balance.py", "np.arcsin(ratio) + ratio * np.sqrt", "np.arcsin(ratio) - ratio * np.sqrt", "studies/mounts"),
    Fault("vehicle/studies/replication/iteration.py", "0.5 * current_gain", "1.0 * current_gain", "studies/replication commands/test_drive_command.py"),
    Fault("vehicle/studies/design/mass_balance.py", "share = 1.0 - front / mass", "share = front / mass", "studies/design/test_new_car.py"),
    Fault("vehicle/commands/input_options.py", "return float(text)", "return float(text) * 1.0001", "commands system"),
    Fault("scenarios/verdict.py", "(-ERRORS, 0.0, ERRORS)", "(0.0, ERRORS)", "scenarios/test_claim.py"),
    Fault("scenarios/interval_probability.py", "math.sqrt(1.0 + 1.0 / n)", "math.sqrt(1.0 / n)", "scenarios/test_interval_probability.py"),
    Fault("scenarios/damper_choice/optimum.py", "float(coarse[max(best - 1, 0)])", "float(coarse[best])", "scenarios/test_damper_optimum.py"),
)  # fmt: skip


def main() -> int:
    """Run faults and print the table; return the exit code."""
    parser = argparse.ArgumentParser(description="Seeded faults over all packages: does a test see each of them?")
    parser.add_argument("numbers", nargs="*", type=int, help="faults to try, one after the other; all by default")
    parser.add_argument("--list", action="store_true", help="print each fault and its tests, and try none")
    options = parser.parse_args()
    if unknown := [number for number in options.numbers if not 1 <= number <= len(FAULTS)]:
        parser.error(f"found fault {unknown[0]}, must be 1 to {len(FAULTS)}")
    numbers = options.numbers or range(1, len(FAULTS) + 1)
    return try_all(((f"{number} ", FAULTS[number - 1]) for number in numbers), only_list=options.list)


def try_all(faults: Iterable[tuple[str, Fault]], *, only_list: bool) -> int:
    """Try faults and print a line for each; return 1 if one survives.

    Args:
        faults: label and fault.
        only_list: print each fault with its tests, and try none.
    """
    worst = 0
    for label, fault in faults:
        change = f"{label}{fault.file}: {fault.old.strip()} -> {fault.new.strip()}"
        if only_list:
            print(f"{change}\n    {fault.tests}")
            continue
        started = time.monotonic()
        outcome = tried(fault)
        worst |= not outcome.startswith("caught")
        print(f"{time.monotonic() - started:5.0f} s  {change}\n         {outcome}", flush=True)
    return worst


def tried(fault: Fault) -> str:
    """Return what became of a fault in words."""
    path = ROOT / fault.file
    text = path.read_text(encoding="utf-8")
    if text.count(fault.old) != 1:
        return f"not tried: its text stands {text.count(fault.old)} times in the file"
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-n", "0", "-p", "no:cacheprovider", "--tb=no"]
    command += ["--part", "product"]
    try:
        path.write_text(text.replace(fault.old, fault.new), encoding="utf-8")
        done = subprocess.run(
            [*command, *(f"tests/{name}" for name in fault.tests.split())],
            cwd=ROOT,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
            capture_output=True,
            text=True,
            timeout=LONGEST_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "caught: its tests do not end"
    finally:
        path.write_text(text, encoding="utf-8")
    failed = next((line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))), "")
    if done.returncode == 0:
        return "SURVIVED"
    return f"caught by {failed.split(' ')[1]}" if failed else f"not tried: pytest ends with {done.returncode}"


if __name__ == "__main__":
    sys.exit(main())
