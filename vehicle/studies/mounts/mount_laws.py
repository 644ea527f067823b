"""Dynamic stiffness of the laws of mounts over frequency and amplitude, as functions of their parameters.

All are first harmonics under x = A cos(w t):

    rubber       K = K1 + i w D2 K2 / (K2 + i w D2) + Kf(A)
    hydromount   K = K1 + i w D1 + Kb Z / (Kb + Z),  Z = -w^2 mt + i w ct
    decoupler    hydromount with a decoupler parallel to its track: `vehicle.studies.mounts.decoupler_balance`

Kf is the friction of rubber with Berg's curve of first loading, P(x) = F x/(x2 + x), and Masing's rule for reversals:
F -+ 2 P(|x - x_r|/2) from the point of reversal. Its first harmonic, with q = sqrt(x2 (x2 + A)), and its loss a cycle,

    Re Kf = 8 F x2/A^2 ((x2 + A/2)/q - 1),    Im Kf = E/(pi A^2),    E = 8 (F (A - x2 ln(1 + A/x2)) - P(A) A/2),

follow by integration over a cycle. Re Kf falls from F/x2 at small to 0 at large amplitudes.

Source: Berg, A non-linear rubber spring model for rail vehicle dynamics analysis, Vehicle System Dynamics 30 (1998);
Masing, Proc. 2nd International Congress of Applied Mechanics (1926); hydromount: see
`vehicle/core/source/rows.h`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.studies.mounts.decoupler_balance import DecouplerBalance, decoupled_stiffness, describing_stiffness

Stiffness = Callable[[Vector, Vector, Vector], Complex]
"""Function from parameters (p,), angular frequencies [rad/s] and amplitudes [m] to K [N/m], all (m,)."""

SMALL = 1e-3
"""Amplitude over stroke below which the series of the friction stiffness is used: its closed form cancels there."""


def friction_stiffness(amplitude: Vector, force: float, stroke: float) -> Complex:
    """Return the first harmonic Kf of the friction of rubber over its amplitude [N/m], (m,).

    Args:
        amplitude: peak amplitudes A [m]; (m,).
        force: F [N].
        stroke: x2 [m], the displacement with half of F on first loading.
    """
    ratio = np.asarray(amplitude, dtype=float) / stroke
    large = np.maximum(ratio, SMALL)
    real = 8.0 / large**2 * ((1.0 + large / 2.0) / np.sqrt(1.0 + large) - 1.0)
    loss = 8.0 / (np.pi * large**2) * (large - np.log1p(large) - 0.5 * large**2 / (1.0 + large))
    # Series in A/x2: 1 - A/x2, and 4 A/(3 pi x2).
    real = np.where(ratio < SMALL, 1.0 - ratio, real)
    loss = np.where(ratio < SMALL, 4.0 * ratio / (3.0 * np.pi), loss)
    return np.asarray(force / stroke * (real + 1j * loss))


@dataclass(frozen=True, kw_only=True, slots=True)
class MountLaw:
    """Law of a mount with positive parameters."""

    name: str  # name of the law
    parameters: dict[str, str]  # name to unit of each parameter
    stiffness: Stiffness  # dynamic stiffness
    # function from angular frequencies, amplitudes and measured K to starting values of fits, (k, p)
    starts: Callable[[Vector, Vector, Complex], Vector]
    approximation: Stiffness | None = None  # faster approximation of `stiffness`, with which fits begin; None without
    # makes a function `stiffness` that starts from its previous solution; None without
    refined: Callable[[], Stiffness] | None = None


def _rubber(values: Vector, omega: Vector, amplitude: Vector) -> Complex:
    static, spring, dashpot, force, stroke = values
    branch = 1j * omega * dashpot * spring / (spring + 1j * omega * dashpot)
    return np.asarray(static + branch + friction_stiffness(amplitude, force, stroke))


def _rubber_starts(omega: Vector, amplitude: Vector, stiffness: Complex) -> Vector:
    low, high = float(np.min(np.abs(stiffness))), float(np.max(np.abs(stiffness)))
    middle = float(np.sqrt(np.min(omega) * np.max(omega)))
    strokes, spring = np.geomspace(np.min(amplitude), np.max(amplitude), 3), 0.3 * low
    return np.array(
        [
            [0.8 * low, spring, spring / (rate * middle), 0.7 * (high - low + 0.1 * low) * stroke, stroke]
            for stroke in strokes
            for rate in (0.3, 1.0, 3.0)
        ]
    )


def _hydromount(values: Vector, omega: Vector, amplitude: Vector) -> Complex:
    static, dashpot, chamber, mass, flow = values
    track = -(omega**2) * mass + 1j * omega * flow
    return np.asarray(static + 1j * omega * dashpot + chamber * track / (chamber + track))


def _hydromount_starts(omega: Vector, amplitude: Vector, stiffness: Complex) -> Vector:
    low, high = float(np.min(np.abs(stiffness))), float(np.max(np.abs(stiffness)))
    peak, chamber = float(omega[np.argmax(np.angle(stiffness))]), high - low + 0.1 * low
    return np.array(
        [
            [low, 1e-3 * low, chamber, chamber / rate**2, 2.0 * ratio * chamber / rate]
            for rate in (peak, 1.3 * peak, 1.8 * peak)
            for ratio in (0.1, 0.3, 0.8)
        ]
    )


def _decoupler_starts(omega: Vector, amplitude: Vector, stiffness: Complex) -> Vector:
    """Return starts with the track of the largest amplitudes, and gaps between and below the amplitudes; (k, 10)."""
    large = amplitude > 0.9 * np.max(amplitude)
    tracks = _hydromount_starts(omega[large], amplitude[large], stiffness[large])

    def distance(track: Vector) -> float:
        fitted = _hydromount(track, omega[large], amplitude[large])
        return float(np.sum(np.abs(np.log(fitted / stiffness[large])) ** 2))

    static, dashpot, chamber, mass, flow = min(tracks, key=distance)
    gaps = np.geomspace(0.5 * np.min(amplitude), 0.8 * np.max(amplitude), 4)
    disc = chamber / (3.0 * np.max(omega)) ** 2
    leak, membrane = 0.2 * np.sqrt(chamber * disc), 0.02 * chamber
    return np.array(
        [
            [static, dashpot, chamber, mass, flow, gap, disc, leak, membrane, ratio * chamber]
            for gap in gaps
            for ratio in (1.0, 4.0)
        ]
    )


TRACK_PARAMETERS = {
    "stiffness": "N/m",
    "damping": "N s/m",
    "chamber_stiffness": "N/m",
    "track_mass": "kg",
    "track_damping": "N s/m",
}

LAWS = {
    law.name: law
    for law in (
        MountLaw(
            name="rubber",
            parameters={
                "stiffness": "N/m",
                "maxwell_stiffness": "N/m",
                "maxwell_damping": "N s/m",
                "friction_force": "N",
                "friction_stroke": "m",
            },
            stiffness=_rubber,
            starts=_rubber_starts,
        ),
        MountLaw(name="hydromount", parameters=TRACK_PARAMETERS, stiffness=_hydromount, starts=_hydromount_starts),
        MountLaw(
            name="decoupler",
            parameters=TRACK_PARAMETERS
            | {
                "decoupler_gap": "m",
                "decoupler_mass": "kg",
                "decoupler_damping": "N s/m",
                "decoupler_stiffness": "N/m",
                "decoupler_seat": "N/m",
            },
            stiffness=decoupled_stiffness,
            starts=_decoupler_starts,
            approximation=describing_stiffness,
            refined=DecouplerBalance,
        ),
    )
}
"""Laws of mounts by name, with the parameters of the vehicle file."""
