"""Lumped node masses of the trimmed body with exactly the published mass, centre of gravity and moments of inertia.

These numbers do not determine 43 masses. A guess of where a trimmed estate carries its weight (sheet metal, doors,
seats, dash) is changed as little as possible, in relative entropy, which keeps every mass positive; nodes that springs
and mounts act on get little freedom, so that no interface becomes a lone heavy lump.

The masses are those of a body that is symmetric about y = 0, with its products Ixy and Iyz about the centre of gravity
zero whatever the vehicle file says (published: 82 and -50 kg m2). The thesis measured the rigid-body properties
separately from the modes and published no mode shape. Lumped at 43 nodes those products need one side of the car some
tens of kilograms heavier at the bottom and lighter at the top, and the modes of such a body are lopsided as no car's
are. A body design may give the least Ixx about the centre of gravity that its nodes are fitted to (`least_ixx`): no set
of positive masses has the published 1000 kg m2, which breaks the triangle inequality; 1200 is what the thesis itself
suggests. The rigid inertia of the complete car keeps the products and the Ixx of the vehicle file.

A body whose mass is varied alone (`body.model_mass`) has the node masses of the body before that, times a factor.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.inertia_tensor import inertia_tensor, second_moments
from vehicle.model.flexbody.rigid_body import cog_inertia
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.hardpoints import Point

_MAX_STEPS = 50
"""Newton steps at most; they converge quadratically, so that more would not help."""


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
        step, now = 1.0, dual(multiplier)
        blur = 1e-12 * abs(now)  # round-off of the dual: near the minimum its differences say nothing
        while dual(multiplier + step * direction) > now + 1e-4 * step * float(gap @ direction) + blur:
            step /= 2.0
            if step < 1e-9:
                break
        multiplier = multiplier + step * direction
    raise ConfigurationError(
        f"node masses: no positive masses at the {len(guess)} nodes have mass {mass:g} kg, CoG "
        f"{np.asarray(cog).tolist()} m and the inertia asked for. "
        "Check the inertia (triangle inequality, about which point) and the node positions."
    )


class NodeProperties(NamedTuple):
    """Mass [kg], CoG [m] and moments about it [kg m2] that the node masses of a frame have together."""

    mass: float
    cog: Point
    ixx: float
    iyy: float
    izz: float
    izx: float

    @classmethod
    def of_body(cls, body: TrimmedBody, least_ixx: float) -> NodeProperties:
        """Return the mass properties of a trimmed body before its mass was varied alone, made symmetric.

        Args:
            body: mass properties of the vehicle.
            least_ixx: the least Ixx about the CoG [kg m2].
        """
        model = body.of_model
        tensor = cog_inertia(model)
        xx, yy, zz, zx = (float(tensor[place]) for place in ((0, 0), (1, 1), (2, 2), (2, 0)))
        return cls(mass=model.mass, cog=model.cog, ixx=max(xx, least_ixx), iyy=yy, izz=zz, izx=-zx)

    def masses(self, guess: FloatArray, freedom: FloatArray, positions: FloatArray) -> FloatArray:
        """Return node masses: the guess matched to these properties.

        Args:
            guess: prior masses [kg], shape (n,).
            freedom: weight of each node's relative change [1], shape (n,).
            positions: node positions [m], shape (n, 3).

        Returns:
            Masses [kg], shape (n,).

        Raises:
            ConfigurationError: see `matched_masses`, with the parameters of the vehicle.
        """
        mass, cog, xx, yy, zz, zx = self
        inertia = inertia_tensor(ixx=xx, iyy=yy, izz=zz, ixy=0.0, izx=zx, iyz=0.0)
        try:
            return matched_masses(guess, freedom, positions, mass=mass, cog=np.array(cog), inertia_about_cog=inertia)
        except ConfigurationError as error:
            raise ConfigurationError(
                f"body.mass ({mass:g}), body.cog {list(cog)}, body.inertia about the CoG (Ixx {xx:g}, Iyy {yy:g}, Izz "
                f"{zz:g}, Izx {zx:g}): {error} Or take a rigid body (body.flexible = false) or another "
                "body.superelement"
            ) from None
