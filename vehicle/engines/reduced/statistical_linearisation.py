"""Statistical linearisation of dampers without a run: viscous constants for the Gaussian velocity of the linear car.

On a random road the velocity v of a damper is nearly Gaussian, with the standard deviation s. The viscous damper that
minimises the mean square error of the force F(v) has the constant

    c = E[(F - E F) v]/s^2 = E[dF/dv]

by Stein's lemma, and s in turn follows from the responses of the car with the constants c: a fixed point. For a force
of straight lines between breakpoints v_j with slopes b_j, and the normal distribution Phi,

    c = sum of b_j [Phi(v_(j+1)/s) - Phi(v_j/s)]

is exact; every law is replaced by straight lines between its breakpoints and a graded grid. A table that is stiffer in
rebound has a mean force E F, which moves the mean position and changes no vibration of a car that is linear otherwise.

Sources: Booton, IRE Transactions on Circuit Theory 1 (1954) 9; Caughey, J. Acoust. Soc. Am. 35 (1963) 1706; Roberts and
Spanos, Random Vibration and Statistical Linearization, 1990, chapters 2 and 5; Stein, Annals of Statistics 9 (1981).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.engines.reduced.linear_twin import LinearTwin
from vehicle.engines.reduced.road_expectation import Lines, damper_speeds
from vehicle.errors import SimulationError
from vehicle.model.laws.damper import damper_curve, damper_law
from vehicle.model.laws.friction import Clamped, Friction
from vehicle.model.laws.law import Parallel
from vehicle.model.parameters.force_elements import Damper

SLOWEST, FASTEST, POINTS = 1e-6, 10.0, 400
"""Range [m/s] and number of the graded grid on each side of rest: neighbours differ by 4 %, so that the lines between
them miss an exponential law by at most 2e-4 of its force."""

START = 0.1
"""Velocity of the first constants [m/s]: a usual RMS velocity of a damper on class B to C."""

TOLERANCE, MOST_STEPS = 1e-4, 40
"""Maximum relative change of a constant in the last step, and maximum number of steps. Comfort changes by less than a
fifth of the change of all constants."""


class LineSegments(NamedTuple):
    """Straight lines of a force over velocity."""

    edges: Vector
    """inner breakpoints [m/s], ascending; (n,)"""
    slopes: Vector
    """slopes [N s/m], the outer two continue to infinity; (n + 1,)"""

    def damping(self, speed: float) -> float:
        """Return c = E[dF/dv] [N s/m] for a Gaussian velocity with the standard deviation `speed` [m/s], above 0."""
        below = np.concatenate([[0.0], scipy.special.ndtr(self.edges / speed), [1.0]])
        return float(np.diff(below) @ self.slopes)


def line_segments(damper: Damper) -> LineSegments:
    """Return the force of a passive damper over its velocity as straight lines, as both engines have it."""
    smooth = damper_law(damper)
    laws = tuple(Clamped(law=law) if isinstance(law, Friction) else law for law in smooth.laws)
    # The clamped friction is complete at pi/(2 eps).
    complete = 0.5 * np.pi / damper.smoothing
    knots = damper_curve(damper).knots
    graded = np.geomspace(SLOWEST, FASTEST, POINTS)
    edges = np.unique(np.concatenate([-graded, graded, [-complete, 0.0, complete], knots]))
    force = Parallel(laws=laws).force(edges)
    slopes = np.diff(force) / np.diff(edges)
    return LineSegments(edges, np.concatenate([slopes[:1], slopes, slopes[-1:]]))


def linearised_damping(twin: LinearTwin, lines: Lines, laws: Sequence[LineSegments]) -> tuple[Vector, Vector]:
    """Return the damping constants c [N s/m] and the RMS velocities s [m/s] of the dampers on a road; (d,) each.

    Each constant follows the secant of its last two steps, since more damping makes its damper slower, and friction of
    a slower damper makes more damping.

    Args:
        twin: responses of the damper velocities to the sources of the road.
        lines: lines of the integral.
        laws: lines of the force of each damper.

    Raises:
        SimulationError: the constants do not settle.
    """
    damping = np.array([law.damping(START) for law in laws])
    before: tuple[Vector, Vector] | None = None
    for _ in range(MOST_STEPS):
        speeds = damper_speeds(twin, damping, lines)
        following = np.array([law.damping(speed) for law, speed in zip(laws, speeds, strict=True)])
        step = following - damping
        if np.all(np.abs(step) <= TOLERANCE * np.abs(following)):
            return following, speeds
        if before is not None:
            run = damping - before[0]
            slope = np.divide(following - before[1], run, out=np.zeros_like(run), where=run != 0.0)
            # Steps of a fifth to five times the plain step.
            step = step / (1.0 - np.clip(slope, -4.0, 0.8))
        before = damping, following
        damping = np.maximum(damping + step, 0.1 * following)
    raise SimulationError(
        "estimate: the dampers stick so much that their friction and their velocity find no common state in "
        f"{MOST_STEPS} steps; run the car instead"
    )
