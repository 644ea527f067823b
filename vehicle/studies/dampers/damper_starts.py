"""Start values for the fit of a damper law, from the fit of a law with one part less or more."""

from collections.abc import Callable, Sequence

import numpy as np

from vehicle.arrays import Vector
from vehicle.studies.dampers.damper_fit import DamperFit
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_test import DamperTest

NEW_SETTING = {"lag": 5e-3, "saturation": 1.5, "delay": 1e-3}
"""Start values of the parameters of a changing setting."""


def first_start(law: DamperLaw, tests: Sequence[DamperTest]) -> list[Vector]:
    """Return start values of linear damping; with a changing setting, for several lags."""
    size = max(test.scale for test in tests) / max(float(np.std(test.velocity)) for test in tests)
    if not law.setting:
        return [np.array([0.0, size])]
    return [np.array([0.0, 0.5 * size, 1.5 * size, lag]) for lag in (2e-3, 1e-2, 5e-2, 1.0)]


def starts_of(law: DamperLaw, smaller: DamperFit, tests: Sequence[DamperTest]) -> list[Vector]:
    """Return start values of a law from the fit of a law with one part less."""
    if law.setting:
        return _of_halves(law, smaller, lambda half: starts_of(law.passive, half, tests))
    force = max(test.scale for test in tests)
    speed = max(float(np.percentile(np.abs(test.velocity), 95.0)) for test in tests)
    previous = dict(zip(smaller.law.parameters, smaller.parameters.tolist(), strict=True))
    stroke = min(float(np.ptp(test.displacement)) for test in tests)
    starts = []
    for share in (0.1, 0.4):
        new = {
            "friction": share * force, "friction_at_rest": 0.3 * previous.get("friction", share * force),
            "stribeck_velocity": 0.2 * share * speed, "gas_stiffness": 100.0, "gas_force": previous["gas_force"],
            "series_stiffness": force / (speed * (3e-4 if share < 0.2 else 5e-3)), "gap": 0.5 * share * stroke,
            "outer_friction": share * force,
        }  # fmt: skip
        for i in range(law.elements):
            new |= {f"slider_limit_{i + 1}": share * force, f"slider_stroke_{i + 1}": 1e-3 * 4.0**-i}
        for side in law.sides:
            fallback = previous.get(f"{side}damping_1") or previous.get("damping_1") or previous["rebound_damping_1"]
            for j in range(law.bends + 1):
                beyond = law.bends > smaller.law.bends
                before = previous.get(f"{side}damping_{j + 1}") or previous.get(f"damping_{j + 1}")
                if beyond:
                    shifted = previous.get(f"{side}damping_{j}") or previous.get(f"damping_{j}") or fallback
                    before = shifted if j else (1.5 + 3.0 * share) * fallback
                new[f"{side}damping_{j + 1}"] = before or fallback
                if j < law.bends:
                    width = previous.get(f"{side}velocity_{j}") or previous.get(f"velocity_{j}") or share * speed
                    same = previous.get(f"{side}velocity_{j + 1}") or previous.get(f"velocity_{j + 1}")
                    new[f"{side}velocity_{j + 1}"] = (width if j else share * speed / law.bends) if beyond else same
        merged = new | {name: value for name, value in previous.items() if law.bends == smaller.law.bends}
        starts.append(np.array([merged[name] for name in law.parameters]))
    return starts


def starts_from_larger(law: DamperLaw, larger: DamperFit) -> list[Vector]:
    """Return start values of a law from the fit of a law with one part more.

    Each bend that may be missing is left out in turn, and each slider. Bump and rebound become their geometric means,
    and a slider becomes Coulomb friction with its limit.
    """
    if law.setting:
        return _of_halves(law, larger, lambda half: starts_from_larger(law.passive, half))
    previous = dict(zip(larger.law.parameters, larger.parameters.tolist(), strict=True))
    before = larger.law
    curves = {
        side: (
            [previous[f"{side}damping_{j + 1}"] for j in range(before.bends + 1)],
            [previous[f"{side}velocity_{j + 1}"] for j in range(before.bends)],
        )
        for side in before.sides
    }
    if law.own_sides != before.own_sides:
        pairs = zip(*curves.values(), strict=True)
        curves = {"": tuple(np.sqrt(np.prod(each, axis=0)).tolist() for each in pairs)}
    limits = [previous[f"slider_limit_{i + 1}"] for i in range(before.elements)]
    if limits:
        previous["friction"] = sum(limits)
    starts = []
    for bend in range(before.bends) if law.bends < before.bends else [None]:
        for slider in range(before.elements) if 0 < law.elements < before.elements else [None]:
            new = dict(previous)
            for side, (slopes, widths) in curves.items():
                slopes, widths = (slopes, widths) if bend is None else without_bend(slopes, widths, bend)
                new |= {f"{side}damping_{j + 1}": slope for j, slope in enumerate(slopes)}
                new |= {f"{side}velocity_{j + 1}": width for j, width in enumerate(widths)}
            remaining = [i for i in range(before.elements) if i != slider]
            for at, i in enumerate(remaining):
                for name in ("slider_limit", "slider_stroke"):
                    new[f"{name}_{at + 1}"] = previous[f"{name}_{i + 1}"]
            starts.append(np.array([new[name] for name in law.parameters]))
    return starts


def _of_halves(law: DamperLaw, other: DamperFit, of_half: Callable[[DamperFit], list[Vector]]) -> list[Vector]:
    """Return start values of a law with a changing setting: each half has one."""
    previous = dict(zip(other.law.parameters, other.parameters.tolist(), strict=True))
    halves = [other.at_setting(firm) for firm in (False, True)]
    starts = [[half.parameters] if half.law == law.passive else of_half(half) for half in halves]
    values = []
    for soft, firm in zip(*starts, strict=True):
        new = np.array([previous.get(name, NEW_SETTING.get(name, 0.0)) for name in law.parameters])
        for half, start in zip(law.halves, (soft, firm), strict=True):
            new[half] = start
        values.append(new)
    return values


def without_bend(slopes: Sequence[float], widths: Sequence[float], bend: int) -> tuple[list[float], list[float]]:
    """Return slopes and widths of a curve with the segments on both sides of a bend merged to one.

    Between two bends the merged segment has the same force at its end; the last segment gets the geometric mean slope.
    """
    first, second = slopes[bend], slopes[bend + 1]
    inner = list(widths[bend : bend + 2])
    merged = float(np.dot(inner, [first, second])) / sum(inner) if len(inner) == 2 else float(np.sqrt(first * second))
    width = [sum(inner)] if len(inner) == 2 else []
    return [*slopes[:bend], merged, *slopes[bend + 2 :]], [*widths[:bend], *width, *widths[bend + 2 :]]
