"""Direction of damper tests by physics: gas pushes the rod out, and dampers of cars damp rebound more than bump.

The work of a damper is positive, sum F v > 0, in extension and in compression alike, so that the signs of force and
motion in a file determine each other (`read_test`); both together follow from the fit of each test

    F = -F_gas + k (x - x_0) + F_f clamp(v/v_f, 1) + straight segments over v, separate for both directions,

a linear least-squares problem. With the wrong direction F_gas is negative, and bump and rebound are exchanged. Standard
errors: White's estimator with blocks of a cycle, as in `damper_fit`.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.studies.dampers.damper_test import DamperTest

BENDS = (0.0, 0.1, 0.3, 0.6)
"""Velocities at which the segments begin, over the highest velocity of the test."""

FRICTION = 0.02
"""Velocity of full friction over the highest velocity."""

COMPARED = 0.8
"""Velocity at which bump and rebound are compared, over the lower one of their highest velocities."""

LEAST_GAS = 30.0
"""Minimum gas force [N] that determines the direction: the weight of the 3 kg that may hang on a load cell."""

LEAST_SHARE, LEAST_DIFFERENCE = 0.05, 0.1
"""Minimum gas force over the standard deviation of the force, and difference of bump and rebound over their sum, that
determine the direction: ten times the error of a load cell."""

ERRORS = 5.0
"""Minimum ratio of both to their standard errors; the segments are an approximation."""


class Direction(NamedTuple):
    """Witnesses of the direction of a test."""

    gas: tuple[float, float]  # F_gas with its standard error [N]
    rebound: float  # rebound, bump: forces without gas at `velocity` [N]
    bump: float
    velocity: float  # velocity at which they are compared [m/s]
    by_gas: int  # by_gas, by_damping: 1 for extension positive, -1 for compression positive, 0 for no decision
    by_damping: int

    @property
    def words(self) -> str:
        """The witnesses against this direction in a sentence without a full stop."""
        value, error = self.gas
        texts = []
        if self.by_gas < 0:
            texts.append(
                f"the gas force is {value:.1f} +- {error:.1f} N, but gas pushes the rod out, which is positive"
            )
        if self.by_damping < 0:
            texts.append(
                f"the force at {1e3 * self.velocity:.0f} mm/s is {self.bump:.0f} N in bump and {self.rebound:.0f} N "
                "in rebound, but car dampers are stiffer in rebound"
            )
        return "; ".join(texts)


def direction_of(test: DamperTest) -> Direction:
    """Return the witnesses of the direction of a test."""
    settled = test.settled
    x, v, force, weights = (each[settled] for each in (test.displacement, test.velocity, test.force, test.weights))
    top = float(np.max(np.abs(v)))
    columns = _columns(x - 0.5 * (np.min(x) + np.max(x)), v, top)
    sizes = np.sqrt(np.mean(columns**2, axis=0))
    sizes[sizes == 0.0] = 1.0  # a direction without samples
    columns = columns / sizes
    inverse = np.linalg.pinv((weights[:, None] * columns).T @ columns, hermitian=True, rcond=1e-9)
    values = inverse @ columns.T @ (weights * force)
    error = weights * (force - columns @ values)
    row_of_sample = np.cumsum(settled) - 1
    scores = np.array([columns[row_of_sample[rows]].T @ error[row_of_sample[rows]] for rows in test.cycle_rows])
    blocks = len(scores)
    covariance = inverse @ scores.T @ scores @ inverse * blocks / max(blocks - 1, 1)
    velocity = COMPARED * max(min(float(np.max(v)), float(-np.min(v))), 0.0)
    sides = _columns(np.zeros(2), np.array([velocity, -velocity]), top) / sizes
    sides[:, 0] = 0.0  # without gas
    rebound, bump = float(sides[0] @ values), float(-sides[1] @ values)
    difference, spread = rebound - bump, float(np.sqrt((sides.sum(axis=0)) @ covariance @ sides.sum(axis=0)))
    gas, gas_error = float(values[0] / sizes[0]), float(np.sqrt(covariance[0, 0]) / sizes[0])
    decided = abs(gas) > max(LEAST_GAS, LEAST_SHARE * test.scale, ERRORS * gas_error)
    unequal = abs(difference) > max(LEAST_DIFFERENCE * abs(rebound + bump), ERRORS * spread)
    return Direction(
        (gas, gas_error), rebound, bump, velocity, decided * int(np.sign(gas)), unequal * int(np.sign(difference))
    )


def require_direction(tests: Sequence[DamperTest], compression: bool | None) -> None:
    """Check that the tests are positive in extension.

    A gas force of the wrong sign is accepted if bump and rebound show the right direction: then it is the offset of a
    load cell. Bump above rebound without a gas force is accepted if the direction was specified.

    Args:
        tests: the tests, turned to extension positive.
        compression: direction of the files that was specified; None for the default, extension.
    """
    directions = {test.name: direction_of(test) for test in tests}
    wrong = {name: each for name, each in directions.items() if each.by_gas < 0 and each.by_damping <= 0}
    right = [name for name, each in directions.items() if each.by_gas > 0]
    if wrong and right:
        (name, first), other = next(iter(wrong.items())), right[0]
        raise DataError(
            f"{name}: has the opposite direction to {other}, whose gas force is {directions[other].gas[0]:.0f} N: "
            f"{first.words}; change the signs of displacement, velocity and force in {', '.join(wrong)}"
        )
    if (
        not wrong
        and compression is None
        and not any(each.by_gas > 0 or each.by_damping > 0 for each in directions.values())
    ):
        wrong = {name: each for name, each in directions.items() if each.by_damping < 0}
        more = ", or --positive extension if this damper damps bump more than rebound"
    else:
        more = ", or remove the offset of the load cell from the files"
    if wrong:
        name = min(wrong, key=lambda each: (wrong[each].by_damping, wrong[each].gas[1] / abs(wrong[each].gas[0])))
        read, other = ("compression", "extension") if compression else ("extension", "compression")
        raise DataError(
            f"{', '.join(wrong)}: positive in {other}, but read as positive in {read}: in {name} {wrong[name].words}; "
            f"set --positive {other}{more}"
        )


def _columns(x: Vector, v: Vector, top: float) -> Vector:
    """Return the columns of gas, stiffness, friction and of the segments of both directions; (n, 3 + 2 segments)."""
    columns = [-np.ones(v.size), x, np.clip(v / (FRICTION * top), -1.0, 1.0)]
    for sign in (1.0, -1.0):
        for begin, end in zip(BENDS, (*BENDS[1:], np.inf), strict=True):
            columns.append(sign * np.clip(sign * v / top - begin, 0.0, end - begin))
    return np.column_stack(columns)
