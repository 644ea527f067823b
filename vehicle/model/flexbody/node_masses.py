"""Lumped node masses of the body with exactly the published mass, centre of gravity and moments of inertia.

Mass properties do not determine 43 masses. An estimate of the mass distribution of an estate car (sheet metal, doors,
seats, dash) is changed as little as possible in relative entropy, which keeps every mass positive. Nodes with springs
and mounts may change little, so that no interface node becomes a concentrated mass.

The masses are symmetric about y = 0: products Ixy and Iyz about the centre of gravity are zero, independent of the
vehicle file (published: 82 and -50 kg m2). The thesis measured the rigid-body properties separately from the modes and
published no mode shape. With these products, 43 nodes need one side of the car some tens of kilograms heavier at the
bottom and lighter at the top, and its modes are far more asymmetric than the modes of a car. A body design may
set a minimum Ixx about the centre of gravity for the fit of the node masses (`least_ixx`): no set of positive masses
has the published 1000 kg m2, which violates the triangle inequality; the thesis itself suggests 1200. The rigid inertia
of the complete car keeps the products and the Ixx of the vehicle file.

If only the mass of a body is varied (`body.model_mass`), its node masses are those of the original body times a factor.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.inertia_tensor import inertia_tensor, second_moments
from vehicle.model.flexbody.rigid_body import cog_inertia
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.hardpoints import Point

_MAX_STEPS = 50
"""Maximum number of Newton steps; convergence is quadratic, so more steps would not help."""


def matched_masses(
    guess: Vector, freedom: Vector, positions: Vector, *, mass: float, cog: Vector, inertia_about_cog: Vector
) -> Vector:
    """Return the positive masses [kg], (n,), nearest to an estimate that have a given mass, CoG and inertia.

    Minimise sum (m ln(m/g) - m + g) / r subject to A m = b (ten rows: mass, first and second moments about the CoG).
    The solution is m = g exp(r A^T l); Newton's method on the convex dual finds the ten multipliers l.

    Args:
        guess: estimated masses g [kg], positive, shape (n,).
        freedom: weight r of the relative change of each node [1], positive, shape (n,).
        positions: node positions [m], shape (n, 3).
        mass: required total mass [kg].
        cog: required centre of gravity [m], shape (3,).
        inertia_about_cog: required tensor [kg m2], shape (3, 3).

    Raises:
        ConfigurationError: no positive masses at these positions have the required properties.
    """
    arm = positions - cog
    upper = np.triu_indices(3)
    rows = np.vstack(
        [np.ones(len(arm)), arm.T, [arm[:, i] * arm[:, j] for i, j in zip(*upper, strict=True)]]
    )  # (10, n)
    required = np.concatenate([[mass, 0.0, 0.0, 0.0], second_moments(inertia_about_cog)[upper]])

    def dual(multiplier: Vector) -> float:
        with np.errstate(over="ignore"):  # an overflow is an infinite dual, rejected by the line search
            return float((guess / freedom * np.exp(freedom * (multiplier @ rows))).sum() - required @ multiplier)

    multiplier = np.zeros(10)
    for _ in range(_MAX_STEPS):
        with np.errstate(over="ignore"):  # caught below
            masses = guess * np.exp(freedom * (multiplier @ rows))
        if not np.all(np.isfinite(masses)):
            break  # masses diverge: no positive masses have the required moments
        gap = rows @ masses - required
        if np.abs(gap).max() < 1e-13 * mass:  # round-off of sums of 43 terms
            return np.asarray(masses)
        try:
            # Newton step of the convex dual: gradient A m - b, Hessian A diag(r m) A'.
            direction = -np.linalg.solve((rows * (masses * freedom)) @ rows.T, gap)
        except np.linalg.LinAlgError:
            break  # masses vanish: no positive masses have the required moments
        step, current = 1.0, dual(multiplier)
        blur = 1e-12 * abs(current)  # round-off of the dual, which exceeds its differences near the minimum
        # Step halved until the dual falls by a ten-thousandth of the predicted decrease (Armijo).
        while dual(multiplier + step * direction) > current + 1e-4 * step * float(gap @ direction) + blur:
            step /= 2.0
            if step < 1e-9:
                break
        multiplier = multiplier + step * direction
    raise ConfigurationError(
        f"node masses: the {len(guess)} nodes cannot have positive masses that give the mass {mass:g} kg, the "
        f"CoG {np.asarray(cog).tolist()} m and the required inertia. Check the inertia (triangle inequality, "
        "reference point) and the node positions."
    )


class NodeProperties(NamedTuple):
    """Mass properties that the node masses of a frame must have: mass [kg], CoG [m], moments about the CoG [kg m2]."""

    mass: float
    cog: Point
    ixx: float
    iyy: float
    izz: float
    izx: float

    @classmethod
    def of_body(cls, body: TrimmedBody, least_ixx: float) -> NodeProperties:
        """Return the mass properties of a body made symmetric about y = 0; ignores a variation of its mass alone.

        Args:
            body: mass properties of the vehicle file.
            least_ixx: minimum Ixx about the CoG [kg m2].
        """
        model = body.of_model
        tensor = cog_inertia(model)
        xx, yy, zz, zx = (float(tensor[component]) for component in ((0, 0), (1, 1), (2, 2), (2, 0)))
        return cls(mass=model.mass, cog=model.cog, ixx=max(xx, least_ixx), iyy=yy, izz=zz, izx=-zx)

    def masses(self, guess: Vector, freedom: Vector, positions: Vector) -> Vector:
        """Return the node masses nearest to an estimate that have these mass properties [kg], shape (n,).

        Args:
            guess: estimated masses [kg], shape (n,).
            freedom: weight of the relative change of each node [1], shape (n,).
            positions: node positions [m], shape (n, 3).

        Raises:
            ConfigurationError: see `matched_masses`; the message names the parameters of the vehicle.
        """
        mass, cog, xx, yy, zz, zx = self
        inertia = inertia_tensor(ixx=xx, iyy=yy, izz=zz, ixy=0.0, izx=zx, iyz=0.0)
        try:
            return matched_masses(guess, freedom, positions, mass=mass, cog=np.array(cog), inertia_about_cog=inertia)
        except ConfigurationError as error:
            raise ConfigurationError(
                f"body.mass ({mass:g}), body.cog {list(cog)}, body.inertia about the CoG (Ixx {xx:g}, Iyy {yy:g}, Izz "
                f"{zz:g}, Izx {zx:g}): {error} Or set body.flexible = false for a rigid body, or another "
                "body.superelement"
            ) from None
