"""Damping and friction over the conditions of the tests, for example current: numbers of a semi-active damper.

The damping is the constant with the work of the curve in the tests, sum F_c v / sum v^2; F_c = F_b + c v holds beyond
the last bend, where F_b is the force that a magnetorheological damper has to yield at.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import rounded
from vehicle.model.parameters.tested_range import range_lines
from vehicle.studies.dampers.damper_law import values_of
from vehicle.studies.dampers.fitted_damper import FittedDamper

POINTS = 400
"""Even number of points of a curve in a picture: none at rest, where the friction changes its sign."""


class Setting(NamedTuple):
    """Damping and friction of a damper at a condition."""

    words: str  # condition, for example "current 1"
    damping: float  # constant with the work of the curve in the tests [N s/m]
    friction: float  # sliding friction in addition to the curve [N]
    bend_force: float  # mean force of the curve beyond its last bend, extended to rest, of rebound and bump [N]
    slope: float  # mean slope there [N s/m]


def settings_of(fits: Sequence[FittedDamper]) -> list[Setting]:
    """Return the settings of fits in the order of their conditions."""
    settings = []
    for fitted in fits:
        values = values_of(fitted.fit.law, fitted.fit.parameters)
        bend = ((values.slopes[:, :-1] - values.slopes[:, -1:]) * values.widths).sum(axis=1)
        friction = float(values.friction[0] + values.limit.sum())
        settings.append(
            Setting(
                words=fitted.condition_words, damping=fitted.curve_damping(), friction=friction,
                bend_force=float(bend.mean()), slope=float(values.slopes[:, -1].mean()),
            )
        )  # fmt: skip
    return settings


def curve_lines(fits: Sequence[FittedDamper]) -> list[tuple[str, Vector, Vector]]:
    """Return condition, velocities [m/s] and forces of curve and friction [N] of each fit, for a picture."""
    lines = []
    for fitted, setting in zip(fits, settings_of(fits), strict=True):
        velocity = np.linspace(-fitted.speeds[1], fitted.speeds[1], POINTS)
        lines.append((setting.words, velocity, fitted.curve(velocity) + setting.friction * np.sign(velocity)))
    return lines


def setting_values(fitted: FittedDamper) -> dict[str, float]:
    """Return lag [s], delay [s] and saturation [-] of a condition that changes during the tests; empty without."""
    fit = fitted.changing
    numbers = dict(zip(fit.law.parameters, fit.parameters.tolist(), strict=True)) if fit is not None else {}
    return {name: numbers[name] for name in ("lag", "delay", "saturation") if name in numbers}


def switching_of(fits: Sequence[FittedDamper]) -> tuple[float, float]:
    """Return delay [s] and rate [N s/m per s] of a semi-active damper, from a condition that changes during its tests.

    A lag of first order is behind a step by its time constant in the mean, a constant rate by half of its duration: the
    rate is the range of the damping over twice the lag. Zeros without a changing condition.
    """
    values = setting_values(fits[0])
    if not values:
        return 0.0, 0.0
    dampings = [each.damping for each in settings_of(fits)]
    return values.get("delay", 0.0), (max(dampings) - min(dampings)) / (2.0 * values["lag"])


def control_lines(fits: Sequence[FittedDamper]) -> str:
    """Return lines for the table of a semi-active damper: its softest and firmest setting over the conditions."""
    settings = settings_of(fits)
    lines = [
        "# damping: constant with the work of the curve in the tests; beyond its last bend the curve is bend force +",
        "# slope times velocity; friction acts in addition to the curve",
        "# condition           damping [N s/m]  friction [N]  bend force [N]  slope [N s/m]",
    ]
    for condition, damping, friction, force, slope in settings:
        lines.append(f"# {condition:<18} {damping:>16.5g} {friction:>13.4g} {force:>15.4g} {slope:>14.4g}")
    dampings = [each.damping for each in settings]
    ranges = [fitted.tested for fitted in fits]
    tested = {
        name: (min(each[name][0] for each in ranges), max(each[name][1] for each in ranges)) for name in ranges[0]
    }
    delay, rate = switching_of(fits)
    lines += [
        "# values for the section [AXLE.damper.control]: the coefficient replaces the curve; friction, gas and stop",
        f"# stay in the section of the damper, e.g. as in damper{fits[0].name}.toml, with the range of all tests:",
        *(f"# {line}" for line in range_lines(tested)),
        f"minimum_damping = {rounded(min(dampings), 5)!r}  # [N s/m]",
        f"maximum_damping = {rounded(max(dampings), 5)!r}  # [N s/m]",
    ]
    if rate:
        lag = setting_values(fits[0])["lag"]
        lines += [
            f"delay = {rounded(delay, 3)!r}  # [s]",
            f"rate = {rounded(rate, 3)!r}  # [N s/m per s] from softest to firmest in twice the lag,",
            f"# {2e3 * lag:.3g} ms: a constant rate that is as late in the mean",
        ]
    return "\n".join(lines) + "\n"
