"""Ten dampers with known laws on a compliant machine: is the law chosen, are the parameters found?

    python -m tests.benchmarks.known_dampers [NUMBER ...] [MOTION ...]

By default sines of 25 mm at 1 Hz, 8 mm at 4 Hz and 2 mm at 12 Hz, and slow triangles of 4 mm with 4 mm/s, whose corners
the machine rounds over 40 ms, sampled at 1 kHz, with 2 % noise on the force; the machine has 2.5e7 N/m. The forces are
those of LSODA of SciPy (relative tolerance 1e-7) with dry friction that sticks exactly, and sliders that slip with
0.2 N s/m: no code of the program. A law without a series stiffness is right for a damper without an eye: the machine is
no part of the damper.
"""

import dataclasses
import sys
import time
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from vehicle.studies.dampers.damper_choice import choose_law
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_test import DamperTest
from vehicle.studies.dampers.waveform import waveform_of

RATE, MACHINE, CREEP, FINE = 1000, 2.5e7, 0.2, 1e-4
NOISE = 0.02

KNOWN: dict[int, dict[str, Any]] = {
    1: {"curve": [(2200, None)], "gas_force": 120.0},
    2: {"curve": [(1500, None)], "coulomb": 55.0},
    3: {"curve": [(5500, 0.07), (1300, None)], "coulomb": 40.0, "gas_force": 180.0},
    4: {"rebound": [(6500, 0.055), (1600, None)], "bump": [(2800, 0.09), (750, None)], "coulomb": 50.0,
        "gas_force": 150.0},
    5: {"curve": [(6000, 0.05), (1300, None)], "stribeck": (50.0, 85.0, 0.015), "gas_force": 100.0},
    6: {"curve": [(1700, None)], "sliders": [(90.0, 3e-4)], "gas_force": 110.0},
    7: {"curve": [(4500, 0.08), (1100, None)], "sliders": [(60.0, 1.2e-4), (70.0, 1.8e-3)], "gas_force": 90.0},
    8: {"curve": [(9000, 0.035), (3200, 0.13), (950, None)], "eye": 1.8e6, "gas_force": 220.0},
    9: {"rebound": [(2900, None)], "bump": [(1300, None)], "coulomb": 60.0, "gas_stiffness": 4500.0,
        "gas_force": 140.0},
    10: {"rebound": [(6200, 0.06), (1400, None)], "bump": [(2600, 0.08), (800, None)], "sliders": [(80.0, 5e-4)],
         "eye": 2.5e6, "gas_stiffness": 3500.0, "gas_force": 160.0},
}  # fmt: skip
"""Laws: slopes with the ends of their segments, Coulomb or Stribeck friction, sliders (limit, stroke), gas, eye."""


def law_of(known):
    """The parts of a known damper, as the fit names them."""
    side = known.get("curve") or known["rebound"]
    friction = {"coulomb": "coulomb", "stribeck": "stribeck", "sliders": "presliding"}
    return DamperLaw(
        bends=len(side) - 1, own_sides="rebound" in known, elements=len(known.get("sliders", ())), series=True,
        friction=next((name for key, name in friction.items() if key in known), ""),
        gas_stiffness="gas_stiffness" in known,
    )  # fmt: skip


def values_of(known):
    """The parameters of a known damper by the names of the fit; eye and machine are in series."""
    values = {"gas_force": known.get("gas_force", 0.0), "gas_stiffness": known.get("gas_stiffness")}
    values |= {
        "series_stiffness": 1.0 / (1.0 / known.get("machine", MACHINE) + 1.0 / known.get("eye", np.inf)),
        "friction": known.get("coulomb"),
    }
    if "stribeck" in known:
        values |= dict(zip(("friction", "friction_at_rest", "stribeck_velocity"), known["stribeck"], strict=True))
    for side in ("curve", "rebound", "bump"):
        for j, (slope, end) in enumerate(known.get(side, ())):
            prefix = "" if side == "curve" else f"{side}_"
            values |= {f"{prefix}damping_{j + 1}": slope, f"{prefix}velocity_{j + 1}": end}
    for i, (limit, stroke) in enumerate(known.get("sliders", ())):
        values |= {f"slider_limit_{i + 1}": limit, f"slider_stroke_{i + 1}": stroke}
    return {name: value for name, value in values.items() if value is not None}


def sine(amplitude, frequency, duration):
    """Fine times, displacements and velocities of a sine."""
    t = np.arange(round(duration / FINE) + 1) * FINE
    w = 2.0 * np.pi * frequency
    return t, amplitude * np.sin(w * t), amplitude * w * np.cos(w * t)


def strokes(speeds, stroke, corner, cycles):
    """Fine times, displacements and velocities of strokes of constant velocity, for each of some velocities."""
    parts = []
    for speed in speeds:
        ramp = (np.arange(round(0.5 * corner / FINE)) + 0.5) * FINE / (0.5 * corner) * speed
        hold = np.full(round(stroke / speed / FINE) - ramp.size, speed)
        there = np.concatenate([ramp, hold, ramp[::-1]])
        parts += cycles * [there, -there]
    steps = np.concatenate(parts)
    velocity = np.concatenate([[0.0], 0.5 * (steps[1:] + steps[:-1]), [0.0]])
    return np.arange(steps.size + 1) * FINE, np.concatenate([[0.0], np.cumsum(steps)]) * FINE - 0.5 * stroke, velocity


def random_motion(duration, rms, seed):
    """Fine times, displacements and velocities of a random motion up to 12 Hz."""
    noise, count = np.random.default_rng(seed), round(duration / FINE)
    f = np.fft.rfftfreq(count, FINE)
    inside = (f > 0.3) & (f < 12.0)
    spectrum = inside * np.exp(2j * np.pi * noise.random(f.size)) / np.maximum(f, 1.0) ** 1.5
    x = np.fft.irfft(spectrum, count)
    size = rms / np.std(x)
    return np.arange(count) * FINE, size * x, size * np.fft.irfft(2j * np.pi * f * spectrum, count)


MOTIONS = {
    "25mm": lambda: sine(0.025, 1.0, 4.0),
    "8mm": lambda: sine(0.008, 4.0, 2.0),
    "2mm": lambda: sine(0.002, 12.0, 1.0),
    "slow": lambda: strokes([0.004], 0.008, 0.04, 5),
    "steps": lambda: strokes([0.005, 0.02, 0.05, 0.1, 0.3, 0.6], 0.04, 0.04, 2),
    "random": lambda: random_motion(8.0, 0.008, 1),
    "few steps": lambda: strokes([0.02, 0.1, 0.5], 0.03, 0.03, 1),
    "short random": lambda: random_motion(3.0, 0.008, 1),
}
"""Motions of the tests: fine times [s], displacements [m] and velocities [m/s]."""
PLAN = ("25mm", "8mm", "2mm", "slow")


def _inverse(known, side):
    """Friction limit at rest, and the velocity over the force beyond: forces and velocities of a fine table."""
    w = np.concatenate([[0.0], np.logspace(-6.0, 1.0, 60001)])
    force, at = np.zeros(w.size), 0.0
    for slope, end in known.get("curve") or known.get(side, ()):
        far = 1e3 if end is None else end
        force, at = force + slope * np.clip(w - at, 0.0, far - at), far
    if "power" in known:
        coefficient, exponent = known["power"]
        force += coefficient * w**exponent * (known.get("share", 1.0) if side == "bump" else 1.0)
    limit = known.get(f"coulomb {side}", known.get("coulomb", 0.0))
    if "stribeck" in known:
        sliding, limit, critical = known["stribeck"]
        return limit, force + sliding + (limit - sliding) * np.exp(-((w / critical) ** 2)), w
    return limit, force + limit, w


def force_of(known, t, x, v, times):
    """Force at times: deflection of eye and machine, and slip of the sliders, by LSODA."""
    spring, gas = values_of(known)["series_stiffness"], known.get("gas_stiffness", 0.0)
    rebound, bump = _inverse(known, "rebound"), _inverse(known, "bump")
    gap = 0.5 * known.get("gap", 0.0)
    sliders, offset = [(limit / stroke, limit) for limit, stroke in known.get("sliders", ())], known.get("gas_force", 0)

    def rate(time, state):
        at, moved = min(time / FINE, t.size - 1.001), state[0]
        i, share = int(at), at % 1.0
        u = x[i] + share * (x[i + 1] - x[i]) - moved
        force, slips = spring * (moved - np.clip(moved, -gap, gap)) - gas * u + offset, []
        for (stiffness, limit), slipped in zip(sliders, state[1:], strict=True):
            held = stiffness * (u - slipped)
            force -= held
            slips.append(np.sign(held) * max(abs(held) - limit, 0.0) / CREEP)
        limit, forces, velocities = rebound if force > 0.0 else bump
        inner = np.sign(force) * np.interp(abs(force), forces, velocities) if abs(force) > limit else 0.0
        return [v[i] + share * (v[i + 1] - v[i]) - inner, *slips]

    start = [-offset / spring, *(x[0] + offset / spring for _ in sliders)]
    solution = solve_ivp(rate, (0.0, times[-1]), start, "LSODA", times, rtol=1e-7, atol=1e-11, max_step=2e-3)
    return spring * (solution.y[0] - np.clip(solution.y[0], -gap, gap))


def records_of(known, seed, names=PLAN):
    """Tests of a known damper with noise."""
    noise, tests = np.random.default_rng(seed), []
    for name in names:
        t, x, v = MOTIONS[name]()
        chosen = slice(None, None, round(1.0 / RATE / FINE))
        times, displacement, velocity = t[chosen], x[chosen], v[chosen]
        force = force_of(known, t, x, v, times)
        force = force + NOISE * np.std(force) * noise.standard_normal(force.size)
        tests.append(
            DamperTest(
                name=name, time=times, displacement=displacement, velocity=velocity, force=force,
                waveform=waveform_of(times, displacement, velocity), conditions={}, notices=(),
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


def is_right(known, law):
    """True if the law of the damper is right; that of a damper without an eye may have no series stiffness."""
    return dataclasses.replace(law, series="eye" in known or law.series) == dataclasses.replace(
        law_of(known), series="eye" in known or law.series
    )


def main(numbers, names=PLAN):
    """Print the chosen law and the deviations of the parameters of each damper, from tests with these motions."""
    right = inside = parameters = 0
    for number in numbers or KNOWN:
        known, begun = KNOWN[number], time.perf_counter()
        fit, _ = choose_law(records_of(known, number, names))
        same = is_right(known, fit.law)
        errors = deviations(known, fit) if same else {"": np.nan}
        right, parameters = right + same, parameters + len(errors) * same
        inside += sum(abs(error) <= 3.0 for error in errors.values())
        worst = max(errors.items(), key=lambda each: abs(each[1]))
        print(
            f"{number:2d} {'right' if same else 'WRONG'} {fit.law.title}; fitted {np.max(fit.fitted):.4f}; largest "
            f"deviation {worst[1]:.2f} standard errors {worst[0]}; {time.perf_counter() - begun:.0f} s",
            flush=True,
        )
        if not same:
            print("   known:", law_of(known).title)
    print(f"right law: {right} of {len(numbers or KNOWN)}; within three standard errors: {inside} of {parameters}")


if __name__ == "__main__":
    motions = tuple(text for text in sys.argv[1:] if not text.isdecimal())
    main([int(text) for text in sys.argv[1:] if text.isdecimal()], motions or PLAN)
