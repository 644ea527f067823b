"""Fitted dampers as text: lines of a vehicle file, table of the tests, printed summary."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from vehicle.digits import number, rounded
from vehicle.model.parameters.tested_range import range_lines
from vehicle.signals.formats.csv_table import table_text
from vehicle.studies.dampers.damper_band import stored_band
from vehicle.studies.dampers.damper_choice import WORST
from vehicle.studies.dampers.damper_fit import RANGES, DamperFit
from vehicle.studies.dampers.damper_force import steady_force
from vehicle.studies.dampers.damper_law import EXPONENT, SETTING, SMOOTHING, values_of
from vehicle.studies.dampers.damper_ranges import RATIO, Expected, expected_error
from vehicle.studies.dampers.fitted_damper import AT_LIMIT, FittedDamper
from vehicle.studies.dampers.residual_diagnosis import missing_text

SLIP = 0.006
"""Velocity above which a damper counts as slipping [m/s], as in the shipped cars; no test shows it."""

POOR = 0.2
"""RMS error over the standard deviation of the force above which a fit is called poor: twice that in a good law."""

SHOWN_LAWS = 5
"""Number of laws in the summary."""


def caption_of(fitted: FittedDamper) -> str:
    """Return the conditions, the number and the names of the tests."""
    names, condition = ", ".join(test.name for test in fitted.tests), fitted.condition_words
    return f"{f'{condition}: ' if condition else ''}{len(fitted.tests)} test{'s'[: len(fitted.tests) > 1]}: {names}"


def notice_lines(fitted: FittedDamper) -> list[str]:
    """Return each notice once, after the names of its tests."""
    names: dict[str, list[str]] = {}
    for test in fitted.tests:
        for text in test.notices:
            names.setdefault(text, []).append(test.name)
    return [f"{', '.join(tests)}: {text}" for text, tests in names.items()]


class Candidate(NamedTuple):
    """Law that was compared."""

    fit: DamperFit
    left_out: float  # error left out
    slower: float  # slower, faster: errors in ranges of velocity that the fit does not contain; NaN if not computed
    faster: float
    below: float  # below, above: force at half of the slowest and at twice the fastest test [N]
    above: float


def candidates(fitted: FittedDamper) -> list[Candidate]:
    """Return the laws with the least errors left out, and the chosen one."""
    slowest, fastest = fitted.speeds
    velocity = np.array([slowest / RATIO, RATIO * fastest])
    shown = [
        fit
        for number_of_law, fit in enumerate(fitted.compared)
        if number_of_law < SHOWN_LAWS or fit.tested_law == fitted.fit.tested_law
    ]
    rows = []
    for fit in shown:
        ranges = (_range_error(fit, name)[0] for name in ("slower", "faster"))
        forces = steady_force(fit.law, fit.parameters, velocity)[0].tolist()
        rows.append(Candidate(fit, fit.left_out_error, *ranges, *forces))
    return rows


def _range_error(fit: DamperFit, name: str) -> tuple[float, float]:
    """Return the RMS error in a range over all tests, without the range in the fit and with it; NaN if unknown."""
    squares = fit.ranges.get(name, np.full((2, 1), np.nan)) ** 2
    inside = ~np.isnan(squares[0])
    return tuple(np.sqrt(np.mean(squares[:, inside], axis=1)).tolist()) if inside.any() else (math.nan, math.nan)


def range_rows(fitted: FittedDamper) -> list[tuple[str, float, float]]:
    """Return ranges in words, with the errors there without the range in the fit, and with it."""
    slowest, fastest = (1e3 * speed for speed in fitted.speeds)
    texts = {
        "slower": f"slower than {number(slowest / RATIO, 2)} mm/s, fitted to faster motion",
        "faster": f"faster than {number(fastest / RATIO, 2)} mm/s, fitted to slower motion",
        "smaller": "smaller half of the amplitudes, fitted to larger",
        "larger": "larger half of the amplitudes, fitted to smaller",
    }
    rows = [(text, *_range_error(fitted.fit, name)) for name, text in texts.items()]
    return [row for row in rows if not math.isnan(row[1])]


def expected_rows(fitted: FittedDamper) -> list[tuple[str, Expected]]:
    """Return velocities in words, with the error that is expected in a further test up to there."""
    slowest, fastest = fitted.speeds
    inside = number(1e3 * slowest, 2), number(1e3 * fastest, 2)
    texts = {
        slowest / RATIO: f"{number(1e3 * slowest / RATIO, 2)} mm/s, half of the slowest test",
        fastest: f"{' to '.join(dict.fromkeys(inside))} mm/s, the range of the tests",
        RATIO * fastest: f"{number(1e3 * RATIO * fastest, 2)} mm/s, twice the fastest test",
    }
    return [(text, expected_error(fitted.fit, fitted.speeds, speed)) for speed, text in texts.items()]


def choice_sentence(fitted: FittedDamper) -> str:
    """Return the rule of the choice in words, with its tolerance."""
    tolerance = number(100.0 * math.expm1(fitted.fit.tolerance), 2)
    return (
        f"the law with the fewest parameters of {len(fitted.accepted)} whose error left out is within one standard "
        f"error of the best law ({tolerance} %) and in no test {WORST:g} times as "
        "large"
    )


def vehicle_lines(fitted: FittedDamper) -> str:
    """Return the law as lines for the table of a damper in a vehicle file, with standard errors."""
    fit, law = fitted.fit, fitted.fit.law
    values = values_of(law, fit.parameters)
    spread = dict(zip(law.parameters, fit.errors.tolist(), strict=True))
    estimates = dict(zip(law.parameters, fit.values.tolist(), strict=True))
    lines = [f"# {law.title}, fitted to {caption_of(fitted)}", *_curve_lines(fitted, spread)]
    lines.append(_line("gas_force", max(estimates["gas_force"], 0.0), "N", spread["gas_force"]))
    if estimates["gas_force"] < 0.0:
        lines[-1] += f"; the mean force of the tests has the other sign: {-estimates['gas_force']:.3g} N in extension"
    friction, at_rest, critical = values.friction
    if law.elements:
        order = np.argsort(values.limit / values.stiffness)
        stiffness, limit = values.stiffness[order], values.limit[order]
        corners = limit / stiffness
        backbone = [float(np.sum(np.minimum(stiffness * corner, limit))) for corner in corners]
        slopes = [float(np.sum(stiffness[i:]) / np.sum(stiffness)) for i in range(law.elements)]
        lines += [
            'friction_law = "presliding"',
            f"coulomb_friction = {_short(float(np.sum(limit)))}  # [N] sum of the limits of all elements",
            f"presliding_stiffness = {_short(float(np.sum(stiffness)))}  # [N/m]",
            f"presliding_force = [{', '.join([*(_short(f / np.sum(limit)) for f in backbone[:-1]), '1.0'])}]",
            f"presliding_slope = [{', '.join(['1.0', *(_short(s) for s in slopes[1:])])}]",
        ]
    else:
        lines.append(f'friction_law = "{law.friction or "coulomb"}"')
        lines.append(_line("coulomb_friction", friction, "N", spread.get("friction", 0.0)))
    if law.friction == "stribeck":
        lines.append(_line("stribeck_friction", at_rest, "N", spread["friction_at_rest"]))
        lines.append(_line("stribeck_velocity", critical, "m/s", spread["stribeck_velocity"]))
        lines.append(f"stribeck_exponent = {EXPONENT}  # [-] assumed")
    lines += [f"smoothing = {SMOOTHING}  # [s/m] assumed", f"slip_velocity = {SLIP}  # [m/s] assumed"]
    if law.gas_stiffness:
        travel = max(float(np.max(np.abs(test.displacement))) for test in fitted.tests)
        force = _short(values.gas_stiffness * travel)
        lines.append(f"stop = {{ displacement = [{_short(-travel)}, {_short(travel)}], force = [-{force}, {force}] }}  "
                     f"# stiffness of the gas, {values.gas_stiffness:.4g} N/m, standard error "
                     f"{number(spread['gas_stiffness'], 2)} N/m; add the bump stops of the car, "
                     "which the errors of this fit do not contain")  # fmt: skip
    # Without a fit (`finished`) there are no covariances and no band.
    lines += range_lines(fitted.tested | (stored_band(fitted) if fit.spreads.size else {}))
    lines += _mount_lines(fitted, spread)
    return "\n".join(lines + [f"# not determined: {text}" for text in fitted.left_open()]) + "\n"


def _mount_lines(fitted: FittedDamper, spread: Mapping[str, float]) -> list[str]:
    """Return series stiffness and gap as comments: lines for the mount of the rod, which both engines run."""
    law, values = fitted.fit.law, values_of(fitted.fit.law, fitted.fit.parameters)
    if not law.series:
        return []
    if not law.gap and values.series > RANGES["series_stiffness"][1] / AT_LIMIT:
        return ["# no series stiffness: the tests show none, and the mount of the rod stays as it is"]
    lines = [
        f"# series stiffness {values.series:.4g} N/m, standard error {number(spread['series_stiffness'], 2)} N/m:",
        "# eye, oil and machine together. It belongs to the mount of the rod, 1/K = 1/K_mount + 1/K_series:",
    ]
    if not law.gap:
        where = "where the eye of the test is the mount"
        return [*lines, f"# [AXLE.bushings.MOUNT] stiffness.z = {_short(values.series)} {where}"]
    # The outer segments of a table go on with their slope, K.
    largest = max(float(np.max(np.abs(test.force))) for test in fitted.tests)
    ends = [0.5 * values.gap, 0.5 * values.gap + largest / values.series]
    displacement = ", ".join(_short(each) for each in (-ends[1], -ends[0], ends[0], ends[1]))
    return [
        *lines,
        f"# gap {1e3 * values.gap:.4g} mm, standard error {number(1e3 * spread['gap'], 2)} mm, in series with both, in "
        "place of stiffness.z where the eye of the test is the mount of the damper alone:",
        f"# [AXLE.bushings.MOUNT] table_z = {{ displacement = [{displacement}], force = "
        f"[{_short(-largest)}, 0.0, 0.0, {_short(largest)}] }}",
        f"# {values.outer_friction:.4g} N of friction beside the gap has no element in the vehicle file: without it, "
        "and without this mount, the errors of the tests do not hold in the car",
    ]


def _curve_lines(fitted: FittedDamper, spread: dict[str, float]) -> list[str]:
    """Return the lines of the curve: linear, degressive, or a table of velocity and force."""
    law, values = fitted.fit.law, values_of(fitted.fit.law, fitted.fit.parameters)
    slopes, widths = values.slopes, values.widths
    if not law.bends and not law.own_sides:
        return ['viscous_law = "linear"', _line("viscous", slopes[0, 0], "N s/m", spread["damping_1"])]
    if law.bends == 1 and not law.own_sides and slopes[0, 0] >= slopes[0, 1]:
        return [
            'viscous_law = "degressive"',
            _line("viscous", slopes[0, 1], "N s/m", spread["damping_2"]),
            _line("degressive_viscous", slopes[0, 0], "N s/m", spread["damping_1"]),
            _line("degressive_velocity", widths[0, 0], "m/s", spread["velocity_1"]),
        ]
    # The last segment goes on beyond the last point with its slope.
    points = [(0.0, 0.0)]
    for sign, inner, steep in zip((1.0, -1.0), widths, slopes, strict=True):
        ends = np.cumsum([*inner, max(fitted.speeds[1], 1.0)])
        forces = np.cumsum(steep * [*inner, max(fitted.speeds[1], 1.0)])
        points += [(sign * v, sign * f) for v, f in zip(ends.tolist(), forces.tolist(), strict=True)]
    points.sort()
    errors = [
        f"{n} {number(spread[n], 2)}"
        for n in law.parameters
        if "damping" in n or n.rstrip("0123456789").endswith("velocity_")
    ]
    return [
        'viscous_law = "table"',
        f"velocity = [{', '.join(_short(v) for v, _ in points)}]  # [m/s]",
        f"force = [{', '.join(_short(f) for _, f in points)}]  # [N]",
        f"# standard errors of slopes [N s/m] and breakpoints [m/s] from rest outwards: {', '.join(errors)}",
    ]


def _or_dash(value: float, digits: int) -> str:
    """Return a number with decimal places, or a dash for an unknown one."""
    return "-" if math.isnan(value) else f"{value:.{digits}f}"


def _short(value: float) -> str:
    """Return a number with five digits, as TOML has it."""
    return repr(rounded(value, 5))


def _line(name: str, value: float, unit: str, error: float) -> str:
    """Return the line of a parameter with its standard error."""
    return f"{name} = {_short(float(value))}  # [{unit}] standard error {number(error, 2)}"


def set_lines(text: str, section: str) -> list[str]:
    """Return the lines of a section of a vehicle file as `section.key=value`, for `--set` after the name of an axle."""
    lines = (line.partition("#")[0].strip() for line in text.splitlines())
    return [f"{section}.{line.replace(' = ', '=', 1)}" for line in lines if line]


def fit_json(fitted: FittedDamper) -> dict[str, Any]:
    """Return the fit for `--json`: law, parameters, lines for `--set`, and the errors of the tests.

    `rms_relative` is the RMS error over the standard deviation of the force, without run-up and run-down of a sine;
    `left_out` the same of the law fitted to the other tests; None for a single test.
    """
    fit = fitted.fit
    errors = zip(fitted.tests, fit.fitted.tolist(), fit.left_out.tolist(), fit.whole.tolist(), strict=True)
    return {
        "conditions": dict(fitted.conditions),
        "chosen": fit.tested_law.title,
        "parameters": [
            {
                "path": f"damper.{name}",
                "value": value,
                "standard_error": _or_none(error),
                "unit": unit,
            }
            for (name, unit), value, error in zip(
                fit.law.parameters.items(), fit.values.tolist(), fit.errors.tolist(), strict=True
            )
        ],
        "set": set_lines(vehicle_lines(fitted), "damper"),
        "tests": [
            {
                "file": test.name,
                "rms_relative": inside,
                "left_out": _or_none(outside),
                "whole": whole,
            }
            for test, inside, outside, whole in errors
        ],
        "candidates": [
            {
                "law": each.fit.tested_law.title,
                "parameters": len(each.fit.tested_law.parameters),
                "accepted": each.fit.accepted,
            }
            | {name: _or_none(getattr(each, name)) for name in ("left_out", "slower", "faster", "below", "above")}
            for each in candidates(fitted)
        ],
        "ranges": [
            {"range": text, "left_out": outside, "fitted": inside} for text, outside, inside in range_rows(fitted)
        ],
        "expected": [
            {"velocity": text, "usual": usual, "nine_of_ten_below": _or_none(limit)}
            for text, (usual, limit) in expected_rows(fitted)
        ],
        "missing": missing_text(fitted),
        "setting": [
            {"name": name, "value": value, "standard_error": _or_none(error), "unit": unit}
            for name, unit, value, error in setting_rows(fitted)
        ],
        "not_determined": fitted.left_open(),
        "notices": [f"{test.name}: {text}" for test in fitted.tests for text in test.notices],
    }


def _or_none(value: float) -> float | None:
    """Return a finite number, or None."""
    return value if math.isfinite(value) else None


def setting_rows(fitted: FittedDamper) -> list[tuple[str, str, float, float]]:
    """Return name, unit, value and standard error of lag, saturation and delay of a changing condition."""
    fit = fitted.changing
    if fit is None:
        return []
    rows = zip(fit.law.parameters.items(), fit.values.tolist(), fit.errors.tolist(), strict=True)
    return [(*name, value, error) for name, value, error in rows if name[0] in SETTING]


def tests_text(fits: Sequence[FittedDamper]) -> str:
    """Return a table of the tests as CSV, with the RMS errors over the standard deviation of the force."""
    names = list(dict.fromkeys(name for fitted in fits for name in fitted.conditions))
    rows = [["test", *names, "stroke [mm]", "velocity [mm/s]", "force [N]", "fitted [-]", "left_out [-]", "whole [-]"]]
    for fitted in fits:
        errors = zip(fitted.tests, fitted.fit.fitted, fitted.fit.left_out, fitted.fit.whole, strict=True)
        for test, inside, outside, whole in errors:
            sizes = [1e3 * np.ptp(test.displacement), 1e3 * np.max(np.abs(test.velocity)), test.scale]
            conditions = [str(test.conditions.get(name, "")) for name in names]
            rows.append([test.name, *conditions, *(f"{value:.4g}" for value in [*sizes, inside, outside, whole])])
    return table_text(list(map(list, dict.fromkeys(map(tuple, rows)))))


def summary_lines(fitted: FittedDamper, again: bool = False) -> list[str]:
    """Return the printed summary: laws with their errors on tests left out, tests, parameters, what is left open.

    Args:
        again: print the parameters only, after the other law for the same tests.
    """
    if again:
        return [caption_of(fitted), *parameter_lines(fitted)]
    fit = fitted.fit
    lines = [caption_of(fitted), *(f"notice: {text}" for text in notice_lines(fitted))]
    slow, fast = (number(1e3 * speed, 2) for speed in (fitted.speeds[0] / RATIO, RATIO * fitted.speeds[1]))
    lines.append(
        f"{'left out':>9}{'slower':>8}{'faster':>8}{f'at {slow} mm/s':>14}{f'at {fast} mm/s':>14}{'parameters':>11}  "
        f"law, {len(fitted.compared)} compared"
    )
    for each in candidates(fitted):
        errors = "".join(f"{_or_dash(value, 3):>8}" for value in (each.slower, each.faster))
        forces = "".join(f"{number(force, 3) + ' N':>14}" for force in (each.below, each.above))
        law = each.fit.tested_law
        lines.append(f"{each.left_out:>9.4f}{errors}{forces}{len(law.parameters):>11}  {law.title}")
    lines.append(f"chosen: {fit.tested_law.title}, {choice_sentence(fitted)}")
    lines.append(f"{'RMS error divided by standard deviation of force':<44}{'fitted':>8}{'left out':>10}{'whole':>8}")
    for test, inside, outside, whole in zip(fitted.tests, fit.fitted, fit.left_out, fit.whole, strict=True):
        lines.append(f"{f'{test.name}: {test.caption}':<44}{inside:>8.3f}{outside:>10.3f}{whole:>8.3f}")
    if rows := range_rows(fitted):
        lines.append(f"{'error in a range that the fit does not contain':<52}{'fitted':>8}{'left out':>10}")
        lines += [f"{text:<52}{inside:>8.3f}{outside:>10.3f}" for text, outside, inside in rows]
    lines.append(f"{'error to expect in a further test with up to':<52}{'usual':>8}{'nine of ten below':>20}")
    lines += [f"{text:<52}{usual:>8.3f}{_or_dash(limit, 3):>20}" for text, (usual, limit) in expected_rows(fitted)]
    if missing := missing_text(fitted):
        lines.append(f"missing: {missing}")
    if float(np.max(fit.fitted)) > POOR:
        lines.append(
            f"poor fit: an error is above {POOR:g}; check signs and time shifts of the channels, and look at the "
            "pictures"
        )
    return lines + parameter_lines(fitted)


def parameter_lines(fitted: FittedDamper) -> list[str]:
    """Return the printed parameters with their standard errors, and what is left open."""
    fit, lines = fitted.fit, []
    lines.append(f"{'parameter':<22}{'value':>12}   standard error")
    for (name, unit), value, error in zip(fit.law.parameters.items(), fit.values, fit.errors, strict=True):
        lines.append(f"{name:<22}{value:>12.5g}   {number(error, 2)} {unit}")
    for name, unit, value, error in setting_rows(fitted):
        lines.append(f"{f'{name} of the setting':<22}{value:>12.5g}   {number(error, 2)} {unit}")
    return lines + [f"not determined: {sentence}" for sentence in fitted.left_open()]
