"""Ten dampers with known laws on a compliant machine: is the law chosen, are the parameters found?

    python -m tests.benchmarks.known_dampers [NUMBER ...]

Sines of 25 mm at 1 Hz, 8 mm at 4 Hz and 2 mm at 12 Hz, slow triangles of 4 mm with 4 mm/s, whose corners the machine
rounds over 40 ms, sampled at 1 kHz, with 2 % noise on the force. The forces are integrated with steps of 0.1 ms by
backward differences of first order, with the curve of `vehicle.model.laws`: no code of the fit. The machine has
2e7 N/m.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter1d

from vehicle.model.laws.curve import Curve
from vehicle.studies.dampers.damper_fit import choose_law
from vehicle.studies.dampers.damper_law import SMOOTHING, DamperLaw
from vehicle.studies.dampers.damper_test import DamperTest, settled_part

RATE, FINER, MACHINE = 1000, 10, 2e7
CORNER = 0.04
"""Time in which the machine reverses its velocity in the slow test [s]."""

STEP = np.pi / 2.0 / SMOOTHING

KNOWN: dict[int, dict[str, Any]] = {
    1: {"curve": [(1800, None)], "coulomb": 60.0},
    2: {"curve": [(6000, 0.06), (1100, None)], "coulomb": 45.0, "gas_force": 200.0},
    3: {"rebound": [(7000, 0.05), (1500, None)], "bump": [(3000, 0.08), (700, None)], "gas_force": 150.0},
    4: {"curve": [(9000, 0.04), (3500, 0.12), (900, None)], "gas_force": 250.0, "gas_stiffness": 3000.0},
    5: {"curve": [(4000, 0.08), (1000, None)], "sliders": [(80.0, 4e-4)], "gas_force": 120.0},
    6: {"curve": [(1500, None)], "sliders": [(70.0, 1.5e-4), (60.0, 1.5e-3)]},
    7: {"curve": [(8000, 0.05), (1200, None)], "eye": 1.5e6, "gas_force": 180.0},
    8: {"rebound": [(6000, 0.06), (1300, None)], "bump": [(2500, 0.09), (800, None)], "sliders": [(90.0, 5e-4)],
        "eye": 3e6},
    9: {"rebound": [(2600, None)], "bump": [(1200, None)], "coulomb": 70.0, "gas_stiffness": 4000.0,
        "gas_force": 100.0},
    10: {"curve": [(5000, 0.07), (1400, None)], "coulomb": 50.0, "eye": 2e6, "gas_stiffness": 2500.0},
}  # fmt: skip
"""Laws: slopes with the ends of their segments, Coulomb friction, sliders (limit, stroke), gas, eye in series."""


def law_of(known):
    """The parts of a known damper, as the fit names them."""
    side = known.get("curve") or known["rebound"]
    return DamperLaw(
        bends=len(side) - 1, own_sides="rebound" in known, elements=len(known.get("sliders", ())), series=True,
        friction="coulomb" if "coulomb" in known else "presliding" if "sliders" in known else "",
        gas_stiffness="gas_stiffness" in known,
    )  # fmt: skip


def values_of(known):
    """The parameters of a known damper by the names of the fit; eye and machine are in series."""
    values = {"gas_force": known.get("gas_force", 0.0), "gas_stiffness": known.get("gas_stiffness")}
    values |= {
        "series_stiffness": 1.0 / (1.0 / MACHINE + 1.0 / known.get("eye", np.inf)),
        "friction": known.get("coulomb"),
    }
    for side in ("curve", "rebound", "bump"):
        for j, (slope, end) in enumerate(known.get(side, ())):
            prefix = "" if side == "curve" else f"{side}_"
            values |= {f"{prefix}damping_{j + 1}": slope, f"{prefix}velocity_{j + 1}": end}
    for i, (limit, stroke) in enumerate(known.get("sliders", ())):
        values |= {f"slider_limit_{i + 1}": limit, f"slider_stroke_{i + 1}": stroke}
    return {name: value for name, value in values.items() if value is not None}


def motions():
    """Displacements [m] of the tests over fine times."""

    def sine(amplitude, frequency, duration):
        t = np.arange(round(duration * RATE * FINER) + 1) / (RATE * FINER)
        return amplitude * np.sin(2.0 * np.pi * frequency * t)

    t = np.arange(20 * RATE * FINER + 1) / (RATE * FINER)
    slow = 0.032 * np.abs((t / 8.0 + 0.25) % 1.0 - 0.5) - 0.008
    rounded = uniform_filter1d(slow, round(CORNER * RATE * FINER), mode="nearest")
    return {
        "25mm": sine(0.025, 1.0, 4.0),
        "8mm": sine(0.008, 4.0, 2.0),
        "2mm": sine(0.002, 12.0, 1.0),
        "slow": rounded,
    }


def curve_of(known):
    """Force over velocity with Coulomb friction."""
    points = [(0.0, 0.0)]
    for sign, side in ((1.0, "rebound"), (-1.0, "bump")):
        at = force = 0.0
        for slope, end in known.get(side) or known["curve"]:
            far = 10.0 if end is None else end
            force, at = force + slope * (far - at), far
            points.append((sign * at, sign * force))
    v, f = np.array(sorted(points)).T
    extra = np.sort(np.append(v, [-STEP, STEP]))
    force = np.interp(extra, v, f) + known.get("coulomb", 0.0) * np.clip(extra / STEP, -1.0, 1.0)
    return Curve.through(extra.tolist(), force.tolist())


def force_of(known, x, velocity):
    """Force over fine displacements [m] and velocities [m/s]: deflection of eye and machine by Newton's method."""
    curve, h = curve_of(known), 1.0 / (RATE * FINER)
    knots, slopes, offsets = curve.knots.tolist(), curve.slopes.tolist(), curve.offsets.tolist()
    spring, gas = values_of(known)["series_stiffness"], known.get("gas_stiffness", 0.0)
    sliders = [(limit / stroke, limit) for limit, stroke in known.get("sliders", ())]
    held, s, out = [0.0] * len(sliders), -known.get("gas_force", 0.0) / spring, []
    u, before = x[0] - s, s
    for position, v in zip(x.tolist(), velocity.tolist(), strict=True):
        low, high = -0.05, 0.05
        while high - low > 1e-13:
            middle = s if low < s < high else 0.5 * (low + high)
            w = v - (middle - before) / h
            j = sum(w > knot for knot in knots)
            error = (
                spring * middle - slopes[j] * w - offsets[j] - gas * (position - middle) + known.get("gas_force", 0.0)
            )
            rise = spring + slopes[j] / h + gas
            for (k, limit), t in zip(sliders, held, strict=True):
                t += k * (position - middle - u)
                error -= min(max(t, -limit), limit)
                rise += k if abs(t) < limit else 0.0
            low, high = (low, middle) if error > 0.0 else (middle, high)
            s = middle - error / rise
            if abs(error) < 1e-6:
                break
        held = [
            min(max(t + k * (position - s - u), -limit), limit) for (k, limit), t in zip(sliders, held, strict=True)
        ]
        u, before = position - s, s
        out.append(spring * s)
    return np.array(out)


def records_of(known, seed, names=("25mm", "8mm", "2mm", "slow")):
    """Tests of a known damper with noise."""
    noise, tests = np.random.default_rng(seed), []
    for name, x in motions().items():
        if name not in names:
            continue
        fine = np.gradient(x, 1.0 / (RATE * FINER))
        force, velocity = force_of(known, x, fine)[::FINER], fine[::FINER]
        force = force + 0.02 * np.std(force) * noise.standard_normal(force.size)
        settled, sine = settled_part(x[::FINER], velocity)
        tests.append(
            DamperTest(
                name=name, time=np.arange(force.size) / RATE, displacement=x[::FINER], velocity=velocity, force=force,
                settled=settled, sine=sine, conditions={}, notices=(),
            )
        )  # fmt: skip
    return tests


def deviations(known, fit):
    """Deviation of each parameter in standard errors, by name; elements of presliding in the order of their stroke."""
    true, names = values_of(known), list(fit.law.parameters)
    order = np.argsort([fit.values[names.index(f"slider_stroke_{i + 1}")] for i in range(fit.law.elements)])
    place = {name: names.index(name) for name in names}
    for new, old in enumerate(order.tolist()):
        for name in ("slider_limit", "slider_stroke"):
            place[f"{name}_{new + 1}"] = names.index(f"{name}_{old + 1}")
    return {name: float((fit.values[at] - true[name]) / fit.errors[at]) for name, at in place.items()}


def main(numbers):
    """Print the chosen law and the largest deviation of each damper."""
    right = 0
    for number in numbers or KNOWN:
        known, begun = KNOWN[number], time.perf_counter()
        fit, _ = choose_law(records_of(known, number))
        same = fit.law == law_of(known)
        right += same
        worst = max(deviations(known, fit).items(), key=lambda each: abs(each[1])) if same else ("", np.nan)
        print(
            f"{number:2d} {'right' if same else 'WRONG'} {fit.law.title}; fitted {np.max(fit.fitted):.4f}; largest "
            f"deviation {worst[1]:.2f} standard errors {worst[0]}; {time.perf_counter() - begun:.0f} s",
            flush=True,
        )
        if not same:
            print("   known:", law_of(known).title)
    print(f"right law: {right} of {len(numbers or KNOWN)}")


if __name__ == "__main__":
    main([int(text) for text in sys.argv[1:]])
