"""Dampers drawn at random: laws, parameters and stated errors of dampers that no one has looked at before.

    python -m tests.benchmarks.drawn_dampers SEED

Seven dampers of the family and seven outside it; their parts, parameters, noise and machine follow from the seed. All
are fitted without slow or without fast tests in turn, and predict the tests that are left, as in `unseen_tests`. Those
of the family are also fitted with slow and fast tests: law and parameters, as in `known_dampers`. A result counts only
for a seed that was not used to develop the rule of choice and the stated errors: use a new one after a change.
"""

import sys
import time

import numpy as np

from tests.benchmarks.known_dampers import deviations, is_right, law_of, records_of
from tests.benchmarks.unseen_tests import WITHOUT_FAST, WITHOUT_SLOW, coverage, predictions, printed
from vehicle.studies.dampers.damper_choice import choose_law

COUNT = 7
"""Number of dampers of the family, and of those outside."""


def _curve(rng, bends):
    """Slopes and ends of a degressive curve."""
    ends = np.sort(rng.uniform(0.03, 0.14, bends))
    ends = ends + 0.02 * np.arange(bends)
    slopes = [rng.uniform(900.0, 1900.0)]
    for _ in range(bends):
        slopes.insert(0, slopes[0] * rng.uniform(1.8, 4.0))
    return [(slope, end) for slope, end in zip(slopes, [*ends.tolist(), None], strict=True)]


def _sliders(rng, count):
    """Limits and strokes of sliders."""
    return [(rng.uniform(40.0, 90.0), stroke) for stroke in np.geomspace(1.5e-4, 2e-3, 2)[:count] * rng.uniform(0.7, 2)]


def of_family(rng):
    """A damper of the family."""
    bends = int(rng.integers(3))
    known = {"gas_force": rng.uniform(50.0, 250.0), "machine": 10.0 ** rng.uniform(7.0, 7.7)}
    if bends < 2 and rng.random() < 0.5:
        known |= {"rebound": _curve(rng, bends), "bump": [(0.45 * c, v) for c, v in _curve(rng, bends)]}
    else:
        known["curve"] = _curve(rng, bends)
    friction = rng.choice(["none", "coulomb", "stribeck", "one slider", "two sliders"])
    if friction == "coulomb":
        known["coulomb"] = rng.uniform(30.0, 90.0)
    elif friction == "stribeck":
        sliding = rng.uniform(30.0, 60.0)
        at_rest, critical = sliding * rng.uniform(1.4, 2.0), rng.uniform(0.008, 0.03)
        # The reference inverts the force, which must rise with the velocity: the friction falls by at most
        # sqrt(2/e) (F_s - F_c)/v_s, at v_s/sqrt(2).
        steepest = np.sqrt(2.0 / np.e) * (at_rest - sliding)
        slopes = [known[side][0][0] for side in ("curve", "rebound", "bump") if side in known]
        known["stribeck"] = (sliding, at_rest, max(critical, 1.1 * steepest / min(slopes)))
    elif friction != "none":
        known["sliders"] = _sliders(rng, 1 if friction == "one slider" else 2)
    if rng.random() < 0.4:
        known["eye"] = 10.0 ** rng.uniform(6.1, 6.6)
    if rng.random() < 0.4:
        known["gas_stiffness"] = rng.uniform(2500.0, 7000.0)
    return known


def outside(rng, number):
    """A damper outside the family; the kind follows from the number."""
    known = {"gas_force": rng.uniform(50.0, 250.0), "machine": 10.0 ** rng.uniform(7.0, 7.7)}
    exponent = rng.uniform(0.45, 0.75)
    power = (rng.uniform(700.0, 1000.0) * 0.2 ** (0.5 - exponent), exponent)
    match number % COUNT:
        case 0:
            known |= {"power": power, "coulomb rebound": rng.uniform(60, 100), "coulomb bump": rng.uniform(20, 50)}
        case 1:
            known |= {"curve": _curve(rng, 1), "gap": rng.uniform(2e-4, 8e-4), "sliders": _sliders(rng, 1)}
        case 2:
            progressive = rng.uniform(1.6, 2.2)
            known |= {"curve": _curve(rng, 1), "power": (rng.uniform(1500.0, 4000.0), progressive), "coulomb": 40.0}
        case 3:
            known |= {"power": power, "share": rng.uniform(0.3, 0.6), "gap": rng.uniform(1e-4, 3e-4), "coulomb": 50.0}
        case 4:
            known["curve"] = [*_curve(rng, 1)[:1], (1600.0, rng.uniform(0.22, 0.35)), (rng.uniform(300, 800), None)]
            known["coulomb"] = rng.uniform(30.0, 60.0)
        case 5:
            limits = rng.uniform(10.0, 35.0, 6)
            known |= {"power": power, "sliders": [(limit, 8e-5 * 2.0**i) for i, limit in enumerate(limits.tolist())]}
        case _:
            known |= {"power": power, "coulomb": rng.uniform(30.0, 60.0), "eye": 2e6, "gas_stiffness": 4000.0}
    return known


def drawn(seed):
    """Dampers of the family, then those outside."""
    rng = np.random.default_rng(seed)
    return [of_family(rng) for _ in range(COUNT)] + [outside(rng, number) for number in range(COUNT)]


def main(seed):
    """Print the results of each damper, then all together."""
    right = inside = parameters = 0
    every = []
    for number, known in enumerate(drawn(seed)):
        begun = time.process_time()
        fit, rows = predictions(known, (seed, number), WITHOUT_FAST if number % 2 else WITHOUT_SLOW)
        print(f"{number:2d} {'without fast' if number % 2 else 'without slow'} tests: {fit.law.title}")
        print(printed(rows), flush=True)
        every += rows
        if number < COUNT:
            fit, _ = choose_law(records_of(known, (seed, number, 1)))
            same = is_right(known, fit.law)
            print(f"   all tests: {'right' if same else 'WRONG'} {fit.law.title}; known: {law_of(known).title}")
            right += same
            if same:
                errors = deviations(known, fit)
                parameters, inside = (
                    parameters + len(errors),
                    inside + sum(abs(each) <= 3.0 for each in errors.values()),
                )
                worst = max(errors, key=lambda name: abs(errors[name]))
                print(f"   largest deviation {errors[worst]:.2f} standard errors, {worst}")
        print(f"   {time.process_time() - begun:.0f} s of processor time", flush=True)
    print(f"right law: {right} of {COUNT}; parameters within three standard errors: {inside} of {parameters}")
    print(coverage(every))


if __name__ == "__main__":
    main(int(sys.argv[1]))
