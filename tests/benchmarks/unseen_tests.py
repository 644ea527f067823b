"""Twenty dampers with known laws: do the stated errors hold in tests that the fit has not seen?

    python -m tests.benchmarks.unseen_tests [NUMBER ...]

Ten dampers of `known_dampers`, and ten that no law of the family describes: curves that are a power of the velocity,
unequal friction in rebound and bump, a gap in the eye, six sliders, a bend beyond the tests. Odd dampers are fitted
without slow tests, even ones without fast tests; each law then predicts the tests that are left. Records as in
`known_dampers`: LSODA, machine of 2.5e7 N/m, 2 % noise.
"""

import sys
import time

import numpy as np

from tests.benchmarks.known_dampers import KNOWN, MOTIONS, records_of, sine, strokes
from vehicle.studies.dampers.damper_choice import choose_law
from vehicle.studies.dampers.damper_fit import squares_of
from vehicle.studies.dampers.damper_ranges import expected_error, speeds_of

STRANGE = {
    11: {"power": (900.0, 0.5), "coulomb": 40.0, "gas_force": 120.0},
    12: {"power": (1500.0, 0.7), "coulomb": 60.0},
    13: {"curve": [(1200, None)], "power": (6000.0, 2.0), "coulomb": 50.0, "gas_force": 150.0},
    14: {"power": (1800.0, 0.6), "share": 0.4, "coulomb": 45.0, "gas_force": 100.0},
    15: {"curve": [(5000, 0.06), (1300, None)], "coulomb rebound": 90.0, "coulomb bump": 45.0, "gas_force": 110.0},
    16: {"curve": [(4500, 0.07), (1200, None)], "coulomb": 50.0, "gap": 3e-4, "gas_force": 130.0},
    17: {"curve": [(2500, None)], "coulomb": 35.0, "gap": 1e-3},
    18: {"curve": [(1600, None)], "sliders": [(25.0, 1e-4 * 2.0**i) for i in range(6)], "gas_force": 90.0},
    19: {"curve": [(5200, 0.05), (1500, 0.3), (500, None)], "coulomb": 40.0, "gas_force": 140.0},
    20: {"power": (1300.0, 0.6), "sliders": [(70.0, 4e-4)], "gas_stiffness": 3000.0, "gas_force": 150.0},
}  # fmt: skip
"""Laws outside the family, as in `known_dampers`: force c |v|^e, unequal friction, gap in the eye [m]."""

MOTIONS |= {
    "10mm": lambda: sine(0.01, 0.3, 10.0),
    "6mm": lambda: sine(0.006, 1.5, 2.0),
    "4mm": lambda: sine(0.004, 8.0, 1.0),
    "fast": lambda: sine(0.025, 2.5, 1.6),
    "30mm": lambda: sine(0.03, 1.7, 1.8),
    "slow sine": lambda: sine(0.008, 0.1, 20.0),
    "strokes": lambda: strokes([0.02], 0.03, 0.03, 2),
}
WITHOUT_SLOW = ("25mm", "8mm", "2mm"), ("10mm", "slow sine", "strokes", "6mm")
WITHOUT_FAST = ("10mm", "6mm", "slow sine", "slow"), ("25mm", "4mm", "30mm", "fast")
"""Tests that are fitted, and tests that are predicted."""


def predictions(known, seed, plan):
    """Chosen fit, and for each test that it has not seen: name, True if slower than all tests, error, stated errors."""
    fitted, unseen = plan
    tests = records_of(known, seed, fitted + unseen)
    seen, rest = tests[: len(fitted)], tests[len(fitted) :]
    fit, _ = choose_law(seen)
    rows = []
    for test in rest:
        (squares,) = squares_of([test], fit.law, fit.parameters)
        error = float(np.sqrt(np.average(squares[test.settled], weights=test.weights[test.settled])))
        speed = float(np.max(np.abs(test.velocity)))
        side = "slower" if speed < speeds_of(seen)[0] else "faster" if speed > speeds_of(seen)[1] else "between"
        rows.append((test.name, side, error, expected_error(fit, speeds_of(seen), speed)))
    return fit, rows


def coverage(rows):
    """Numbers of tests below the limit, within 1.5 times the stated error, and below it, by the side of a test."""
    parts = []
    for side in ("slower", "between", "faster"):
        inside = [
            (error <= stated.limit, error <= 1.5 * stated.usual, error <= stated.usual)
            for _, where, error, stated in rows
            if where == side
        ]
        if inside:
            below, near, covered = np.sum(inside, axis=0).tolist()
            parts.append(f"{side}: {below} of {len(inside)} below the limit, {near} within 1.5 times the stated error, "
                         f"{covered} below it")  # fmt: skip
    return "; ".join(parts)


def printed(rows):
    """Lines with the error of each test."""
    return "\n".join(
        f"   {name:<10} {side:<8} {error:.3f}, stated {stated.usual:.3f}, nine of ten below {stated.limit:.3f}"
        for name, side, error, stated in rows
    )


def main(numbers):
    """Print the errors of each damper, and the share of tests within the limit of nine of ten."""
    every = []
    for number in numbers or range(1, 21):
        begun = time.process_time()
        fit, rows = predictions((KNOWN | STRANGE)[number], number, WITHOUT_SLOW if number % 2 else WITHOUT_FAST)
        print(f"{number:2d} {fit.law.title}; {time.process_time() - begun:.0f} s of processor time")
        print(printed(rows), flush=True)
        every += rows
    print(coverage(every))


if __name__ == "__main__":
    main([int(text) for text in sys.argv[1:]])
