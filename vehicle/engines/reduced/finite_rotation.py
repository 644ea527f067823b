"""Estimate of what the linear geometry of the reduced engine leaves out of accelerations at the wheels.

A part that rotates by theta takes theta of a vertical force or acceleration along x and y. These products of two
motions are the second order of the equations of motion: accelerations of the size theta a_z. They do not change sign
with the road, as all that is linear does, so on a random road both are uncorrelated and their squares add:

    E = Theta RMS(a_z^2) / max |a_z|,    S^2 = S_1^2 + E^2,    loss of RMS = 1 - S_1 / S,

with the largest rotation Theta of the parts at the wheel and a rotation in proportion to a_z, S_1 being the RMS of the
reduced engine and S that of the car. E of `kinematic_reference` and `focus_road` in MuJoCo, on classes A to C at 50 to
120 km/h and on cleats of 5 to 20 mm, is 0.4 to 1.7 times this value along x of the rear knuckles and along y (0 where
both sides cancel), 0.1 to 0.6 times along x of the front knuckles. `sedan`, whose trailing arms are longer, has 1.3 to
2.1 times this value at the rear knuckles. Equations and exact values: `docs/theory/reduced-engine.md`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]

LOSS = 0.02
"""Minimum estimated loss of RMS for a notice."""

NAMED = 4
"""Maximum number of channels in a notice."""


def rotation_products(angle: float, vertical: Vector) -> float:
    """Return the RMS E [m/s2] of products of rotation and vertical acceleration.

    Args:
        angle: largest rotation of the parts [rad].
        vertical: vertical acceleration [m/s2]; (n,).
    """
    squares = np.square(vertical)
    highest = float(np.max(squares, initial=0.0))
    return angle * float(np.sqrt(np.mean(np.square(squares)) / highest)) if highest > 0.0 else 0.0


def lost_share(horizontal: Vector, products: float) -> float:
    """Return the share 1 - S_1/S of the RMS that a record lacks without products of the RMS E.

    Args:
        horizontal: acceleration of the reduced engine [m/s2]; (n,).
        products: RMS E of the products [m/s2].
    """
    linear = float(np.sqrt(np.mean(np.square(horizontal))))
    return 1.0 - linear / float(np.hypot(linear, products)) if products > 0.0 else 0.0


def rotation_notices(
    channels: Mapping[str, Vector], angles: Mapping[str, float], wheels: Iterable[str]
) -> tuple[str, ...]:
    """Return a notice on horizontal accelerations at the wheels whose RMS is too low by `LOSS` or more.

    Args:
        channels: time histories by name; places at a wheel end with its name, as "knuckle_fr_acc_y".
        angles: largest rotation of each part [rad]; parts at a wheel end with its name, as "lower_link_fr".
        wheels: names of the wheels.
    """
    losses, largest = dict[str, float](), 0.0
    for wheel in wheels:
        angle = max((value for part, value in angles.items() if part.endswith(f"_{wheel}")), default=0.0)
        for name, vertical in channels.items():
            if name.endswith(f"_{wheel}_acc_z"):
                products = rotation_products(angle, vertical)
                for horizontal in (f"{name[:-1]}x", f"{name[:-1]}y"):
                    loss = lost_share(channels[horizontal], products) if horizontal in channels else 0.0
                    if loss >= LOSS:
                        losses[horizontal], largest = loss, max(largest, angle)
    if not losses:
        return ()
    ordered = sorted(losses, key=lambda channel: -losses[channel])
    texts = [f"{channel} by {100.0 * losses[channel]:.0f} %" for channel in ordered[:NAMED]]
    more = f" and {len(ordered) - NAMED} more" if len(ordered) > NAMED else ""
    return (
        f"the RMS is too low, by roughly: {', '.join(texts)}{more}; parts at these wheels rotate by up to "
        f"{largest:.3f} rad, and the reduced engine leaves out products of rotations and vertical accelerations; use "
        "the MuJoCo engine for accelerations along x and y at the wheels",
    )
