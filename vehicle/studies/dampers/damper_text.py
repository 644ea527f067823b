"""Fitted dampers as text: lines of a vehicle file, table of the tests, printed summary."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from vehicle.digits import number, rounded
from vehicle.model.parameters.tested_range import range_lines
from vehicle.signals.formats.csv_table import table_text
from vehicle.studies.dampers.damper_law import EXPONENT, SMOOTHING, values_of
from vehicle.studies.dampers.fitted_damper import FittedDamper

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
        lines.append(_line("stribeck_friction", max(at_rest, friction), "N", spread["friction_at_rest"]))
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
    lines += range_lines(fitted.tested)
    if law.series:
        lines += [
            f"# series stiffness {values.series:.4g} N/m, standard error {number(spread['series_stiffness'], 2)} N/m:",
            "# eye, oil and machine together. It belongs to the mount of the rod, 1/K = 1/K_mount + 1/K_series:",
            f"# [AXLE.bushings.MOUNT] stiffness.z = {_short(values.series)} where the eye of the test is the mount",
        ]
    return "\n".join(lines + [f"# not determined: {text}" for text in fitted.left_open()]) + "\n"


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


def _short(value: float) -> str:
    """Return a number with five digits, as TOML has it."""
    return repr(rounded(value, 5))


def _line(name: str, value: float, unit: str, error: float) -> str:
    """Return the line of a parameter with its standard error."""
    return f"{name} = {_short(float(value))}  # [{unit}] standard error {number(error, 2)}"


def fit_json(fitted: FittedDamper) -> dict[str, Any]:
    """Return the fit for `--json`: law, parameters, lines for `--set`, and the errors of the tests.

    `rms_relative` is the RMS error over the standard deviation of the force, without run-up and run-down of a sine;
    `left_out` the same of the law fitted to the other tests; None for a single test.
    """
    fit = fitted.fit
    lines = (line.partition("#")[0].strip() for line in vehicle_lines(fitted).splitlines())
    errors = zip(fitted.tests, fit.fitted.tolist(), fit.left_out.tolist(), fit.whole.tolist(), strict=True)
    return {
        "conditions": dict(fitted.conditions),
        "chosen": fit.law.title,
        "parameters": [
            {
                "path": f"damper.{name}",
                "value": value,
                "standard_error": error if math.isfinite(error) else None,
                "unit": unit,
            }
            for (name, unit), value, error in zip(
                fit.law.parameters.items(), fit.values.tolist(), fit.errors.tolist(), strict=True
            )
        ],
        "set": [f"damper.{line.replace(' = ', '=', 1)}" for line in lines if line],
        "tests": [
            {
                "file": test.name,
                "rms_relative": inside,
                "left_out": outside if math.isfinite(outside) else None,
                "whole": whole,
            }
            for test, inside, outside, whole in errors
        ],
        "not_determined": fitted.left_open(),
        "notices": [f"{test.name}: {text}" for test in fitted.tests for text in test.notices],
    }


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
    return table_text(rows)


def summary_lines(fitted: FittedDamper) -> list[str]:
    """Return the printed summary: laws with their errors on tests left out, tests, parameters, what is left open."""
    fit = fitted.fit
    lines = [caption_of(fitted), *(f"notice: {test.name}: {text}" for test in fitted.tests for text in test.notices)]
    lines.append(f"{'left out':>9} {'parameters':>10}  law, {len(fitted.compared)} compared")
    for other in fitted.compared[:SHOWN_LAWS]:
        lines.append(f"{other.left_out_error:>9.4f} {len(other.parameters):>10}  {other.law.title}")
    lines.append(
        f"chosen: {fit.law.title}, the simplest law whose error on left-out tests is within one standard "
        "error of the best"
    )
    lines.append(f"{'RMS error divided by standard deviation of force':<44}{'fitted':>8}{'left out':>10}{'whole':>8}")
    for test, inside, outside, whole in zip(fitted.tests, fit.fitted, fit.left_out, fit.whole, strict=True):
        lines.append(f"{f'{test.name}: {test.caption}':<44}{inside:>8.3f}{outside:>10.3f}{whole:>8.3f}")
    if float(np.max(fit.fitted)) > POOR:
        lines.append(
            f"poor fit: an error is above {POOR:g}; check signs and time shifts of the channels, and look at the "
            "pictures"
        )
    lines.append(f"{'parameter':<22}{'value':>12}   standard error")
    for (name, unit), value, error in zip(fit.law.parameters.items(), fit.values, fit.errors, strict=True):
        lines.append(f"{name:<22}{value:>12.5g}   {number(error, 2)} {unit}")
    return lines + [f"not determined: {sentence}" for sentence in fitted.left_open()]
