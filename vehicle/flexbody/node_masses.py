"""Lumped node masses of the trimmed body with exactly the published mass, centre of gravity and moments of inertia.

These numbers do not determine 43 masses. A guess of where a trimmed estate carries its weight (sheet metal, doors,
seats, dash) is changed as little as possible, in relative entropy, which keeps every mass positive; nodes that springs
and mounts act on get little freedom, so that no interface becomes a lone heavy lump.

The masses are those of a body that is symmetric about y = 0: Ixy = Iyz = 0 instead of the published 82 and -50 kg m2.
The thesis measured the rigid-body properties separately from the modes and published no mode shape. Lumped at 43 nodes
those products need one side of the car some tens of kilograms heavier at the bottom and lighter at the top, and the
modes of such a body are lopsided as no car's are. The rigid inertia of the complete car keeps the published products.
"""

from __future__ import annotations

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.flexbody.beam import FloatArray
from vehicle.flexbody.inertia import about_cog, inertia_tensor, second_moments
from vehicle.flexbody.wireframe import side_names

# Published: Bommer 2006, section 3.1.2, with Ixx improved from 1000 to 1200 as the thesis itself suggests: no set of
# positive masses has the published Ixx.
BODY_MASS = 813.0
"""[kg]"""
BODY_COG = (2.157, 0.0, 1.011)
"""[m]"""
BODY_INERTIA_ABOUT_ORIGIN = inertia_tensor(ixx=1200.0, iyy=5268.0, izz=4600.0, ixy=0.0, izx=1800.0, iyz=0.0)
"""[kg m2], shape (3, 3); of the symmetric body, so without the published Ixy = 82.03 and Iyz = -50.04"""

# pair or node: (guess [kg], freedom to change [1]); all assumed
_PAIRS: dict[str, tuple[float, float]] = {
    "arm_front": (4.0, 0.15),
    "arm_rear": (5.0, 0.15),
    "strut_top": (14.0, 0.3),
    "tie_inner": (2.0, 0.15),
    "stab_body": (2.0, 0.15),
    "rear_support": (14.0, 0.3),
    "rail_front": (9.0, 0.15),
    "cowl": (40.0, 0.4),
    "sill_front": (34.0, 0.4),
    "sill_middle": (36.0, 0.4),
    "sill_rear": (34.0, 0.4),
    "a_pillar_top": (13.0, 0.4),
    "b_pillar_top": (15.0, 0.4),
    "b_pillar_belt": (46.0, 0.4),
    "c_pillar_belt": (26.0, 0.4),
    "d_pillar_belt": (9.0, 0.2),
    "rear_end": (9.0, 0.2),
}
_CENTRE: dict[str, tuple[float, float]] = {
    "hydromount": (3.0, 0.15),
    "linear_mount": (3.0, 0.15),
    "bottom_body": (14.0, 0.3),
    "seat_rail": (46.0, 0.3),  # with the seat as heavy as its counterpart
    "seat": (7.0, 0.1),
    "seat_rail_right": (53.0, 0.3),
    "roof_left_rear": (4.0, 0.2),
    "roof_right_rear": (4.0, 0.2),
    "body_front": (8.0, 0.2),
}
_MAX_STEPS = 50


def prior_masses(nodes: tuple[str, ...]) -> tuple[FloatArray, FloatArray]:
    """Guessed mass [kg] and freedom [1] of each node, both of shape (n,)."""
    prior = {name: guess for pair, guess in _PAIRS.items() for name in side_names(pair)} | _CENTRE
    table = np.array([prior[name] for name in nodes])
    return table[:, 0], table[:, 1]


def matched_masses(
    guess: FloatArray,
    freedom: FloatArray,
    positions: FloatArray,
    *,
    mass: float,
    cog: FloatArray,
    inertia_about_cog: FloatArray,
) -> FloatArray:
    """Positive masses nearest to a guess that have the given mass, centre of gravity and inertia.

    Minimise sum (m ln(m/g) - m + g) / r subject to A m = b (ten rows: mass, first and second moments about the CoG).
    The solution is m = g exp(r A^T l); Newton's method on the convex dual finds the ten multipliers l.

    Args:
        guess: prior masses g [kg], positive, shape (n,).
        freedom: weight r of each node's relative change [1], positive, shape (n,).
        positions: node positions [m], shape (n, 3).
        mass: wanted mass [kg].
        cog: wanted centre of gravity [m], shape (3,).
        inertia_about_cog: wanted tensor [kg m2], shape (3, 3).

    Returns:
        Masses [kg], shape (n,).

    Raises:
        ConfigurationError: no positive masses at these positions have the wanted properties.
    """
    arm = positions - cog
    upper = np.triu_indices(3)
    rows = np.vstack(
        [np.ones(len(arm)), arm.T, [arm[:, i] * arm[:, j] for i, j in zip(*upper, strict=True)]]
    )  # (10, n)
    wanted = np.concatenate([[mass, 0.0, 0.0, 0.0], second_moments(inertia_about_cog)[upper]])

    def dual(multiplier: FloatArray) -> float:
        with np.errstate(over="ignore"):  # an overflow is an infinite dual, which the line search turns down
            return float((guess / freedom * np.exp(freedom * (multiplier @ rows))).sum() - wanted @ multiplier)

    multiplier = np.zeros(10)
    for _ in range(_MAX_STEPS):
        with np.errstate(over="ignore"):  # caught below
            masses = guess * np.exp(freedom * (multiplier @ rows))
        if not np.all(np.isfinite(masses)):
            break  # masses have run to infinity: the wanted moments lie outside what positive masses can have
        gap = rows @ masses - wanted
        if np.abs(gap).max() < 1e-13 * mass:  # round-off of sums of 43 terms
            return np.asarray(masses)
        try:
            direction = -np.linalg.solve((rows * (masses * freedom)) @ rows.T, gap)
        except np.linalg.LinAlgError:
            break  # masses have run to zero, for the same reason
        step = 1.0
        while dual(multiplier + step * direction) > dual(multiplier) + 1e-4 * step * float(gap @ direction):
            step /= 2.0
            if step < 1e-9:
                break
        multiplier = multiplier + step * direction
    raise ConfigurationError(
        f"node masses: no positive masses at the {len(guess)} nodes have mass {mass:g} kg, CoG "
        f"{np.asarray(cog).tolist()} m and the inertia asked for. "
        "Check the inertia (triangle inequality, about which point) and the node positions."
    )


def body_masses(nodes: tuple[str, ...], positions: FloatArray) -> FloatArray:
    """Node masses of the trimmed body [kg], shape (n,): the assumed guess matched to the published properties."""
    guess, freedom = prior_masses(nodes)
    cog = np.array(BODY_COG)
    inertia = about_cog(BODY_INERTIA_ABOUT_ORIGIN, BODY_MASS, cog)
    return matched_masses(guess, freedom, positions, mass=BODY_MASS, cog=cog, inertia_about_cog=inertia)
