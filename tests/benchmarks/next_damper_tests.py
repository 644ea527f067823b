"""Known dampers: what is left of the uncertainty of the force after the further test that `next_tests` names first?

    python -m tests.benchmarks.next_damper_tests [NUMBER ...]

Dampers and records of `unseen_tests`: odd ones have no slow tests, even ones no fast tests. The best sine of
`next_tests` is recorded, and all tests are fitted again, with a new choice of the law. Printed are u before, u expected
after, and u of the new fit; and the true error of the curve before and after, with the same weights.
"""

import sys

import numpy as np

from tests.benchmarks.known_dampers import FINE, KNOWN, NOISE, _inverse, force_of, records_of, sine
from tests.benchmarks.unseen_tests import STRANGE, WITHOUT_FAST, WITHOUT_SLOW
from vehicle.studies.dampers.damper_choice import choose_law
from vehicle.studies.dampers.damper_force import steady_force
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.fitted_damper import FittedDamper
from vehicle.studies.dampers.next_tests import even_use, next_tests
from vehicle.studies.dampers.waveform import waveform_of


def record_of(known, seed, amplitude, frequency):
    """Two cycles of a sine and a quarter, at 1 kHz or 1000 samples a cycle, with noise."""
    t, x, v = sine(amplitude, frequency, 2.25 / frequency)
    rows = slice(None, None, max(round(1e-3 / FINE), round(1e-3 / frequency / FINE)))
    force = force_of(known, t, x, v, t[rows])
    force = force + NOISE * np.std(force) * np.random.default_rng(seed + 1000).standard_normal(force.size)
    return DamperTest(
        name="next", time=t[rows], displacement=x[rows], velocity=v[rows], force=force,
        waveform=waveform_of(t[rows], x[rows], v[rows]), conditions={}, notices=(),
    )  # fmt: skip


def true_curve(known, velocity):
    """Force of curve and sliding friction [N]."""
    force = np.array([np.interp(abs(v), *_inverse(known, "rebound" if v > 0.0 else "bump")[:0:-1]) for v in velocity])
    return np.sign(velocity) * (force + sum(limit for limit, _ in known.get("sliders", ())))


def fitted_to(tests):
    """Fitted damper."""
    fit, compared = choose_law(tests)
    return FittedDamper(conditions={}, tests=tests, fit=fit, compared=compared)


def true_error(known, fitted):
    """Error of the curve with the weights of `even_use` [-]."""
    use, fit = even_use(), fitted.fit
    force = steady_force(fit.law, fit.parameters, use.velocity)[0]
    return float(np.sqrt(use.weights(force) @ (force - true_curve(known, use.velocity)) ** 2))


def main(numbers):
    """Print the uncertainties of each damper, and the factors between expected and new ones."""
    factors, errors = [], []
    for number in numbers or range(1, 21):
        known, plan = (KNOWN | STRANGE)[number], WITHOUT_SLOW if number % 2 else WITHOUT_FAST
        first = fitted_to(records_of(known, number, plan[0]))
        best = next_tests([first])[0]
        second = fitted_to([*first.tests, record_of(known, number, best.amplitude, best.frequency)])
        after = next_tests([second])[0].before
        true = [true_error(known, fitted) for fitted in (first, second)]
        factors.append(after / best.after)
        errors.append(np.array(true) / [best.before, after])
        print(
            f"{number:2d} {1e3 * best.amplitude:g} mm, {best.frequency:g} Hz, {1e3 * best.velocity:.0f} mm/s: u "
            f"{best.before:.3f}, expected {best.after:.3f}, new fit {after:.3f}; true error "
            f"{true[0]:.3f}, then {true[1]:.3f}",
            flush=True,
        )
    print(f"u of the new fit over the expected one: {min(factors):.2f} to {max(factors):.2f}, "
          f"geometric mean {np.exp(np.mean(np.log(factors))):.2f}")  # fmt: skip
    print("true error over u, before and after: RMS", np.sqrt(np.mean(np.square(errors), axis=0)).round(2),
          "largest", np.max(errors, axis=0).round(2))  # fmt: skip


if __name__ == "__main__":
    main([int(text) for text in sys.argv[1:]])
