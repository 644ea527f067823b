"""Headline figures of a car with the modes of the whole car that share their motions.

Frequency and damping ratio of each figure are those of `vehicle.engines.kinematics.ride_figures`: one motion alone, by
its mass and its rates. A mode contains several motions, so a mode is never the figure; the modes are listed with it,
each with its share of this motion in its kinetic energy (`vehicle.engines.linear.motion_names`).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from vehicle.digits import finite
from vehicle.engines.kinematics.axle_ride import DAMPER_VELOCITY, DamperState, axle_rides, damper_constant
from vehicle.engines.kinematics.ride_figures import ride_figures
from vehicle.engines.linear.car_modes import Mode
from vehicle.runs.car.axle import car_at_rest
from vehicle.threads import one_blas_thread

STATES: tuple[DamperState, ...] = ("sliding", "stuck")
"""States of the dampers."""

BODY_MOTIONS = {"heave": "body heave (z)", "pitch": "body pitch (Ry)", "roll": "body roll (Rx)"}
"""Motions of the body to their names in `Mode.motions`."""

MINIMUM_SHARE = 0.2
"""Minimum share of a motion in the kinetic energy of a mode that is listed for it."""

MAXIMUM_DIFFERENCE = 0.01
"""Maximum relative difference of the damping constants of figures and modes without a note: a digit of the ratio."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MotionMode:
    """Mode of the whole car with at least `MINIMUM_SHARE` of a motion."""

    frequency_hz: float  # natural frequency [Hz]
    damping_ratio: float  # damping ratio [-]
    share: float  # share of the motion in the kinetic energy of the mode [-]
    description: str  # name of the mode; of its two largest motions if none has half of the energy


@dataclass(frozen=True, kw_only=True, slots=True)
class MotionFigure:
    """Headline figure of a car: one motion of the sprung mass or of the wheels of an axle on its rates."""

    motion: str  # "heave", "pitch", "roll", or "front wheel hop" and so on by axle
    dampers: DamperState  # "sliding" or "stuck"
    frequency_hz: float | None  # undamped natural frequency [Hz]; None if it is not defined
    damping_ratio: float | None  # damping ratio [-], dampers at 0.1 m/s; None if it is not defined
    modes: tuple[MotionMode, ...]  # modes of the whole car with this motion, by frequency


@lru_cache(maxsize=4)
@one_blas_thread()
def motion_figures(car: Any, states: tuple[DamperState, ...] = STATES) -> tuple[MotionFigure, ...]:
    """Return the headline figures of a car; kept, because a saved run, its report and `show` print them.

    Args:
        car: the car; on rolling tyres the figures are those of the car at rest, and the modes those at its speed.
        states: states of the dampers.

    Raises:
        ConfigurationError: the car cannot be built.
        SimulationError: an axle has no equilibrium near its design position.
    """
    still = car_at_rest(car).model
    figures = []
    for state in states:
        modes = [mode for mode in car.modes(state) if not mode.grows]
        figures += [
            MotionFigure(
                motion=motion,
                dampers=state,
                frequency_hz=finite(figure.frequency_hz),
                damping_ratio=finite(figure.damping_ratio),
                modes=tuple(_modes(modes, motion)),
            )
            for motion, figure in ride_figures(still, axle_rides(still, state)).items()
        ]
    return tuple(figures)


def _modes(modes: Sequence[Mode], motion: str) -> Iterator[MotionMode]:
    """Yield the modes with a motion."""
    for mode in modes:
        share = motion_share(mode, motion)
        if share >= MINIMUM_SHARE:
            yield MotionMode(
                frequency_hz=mode.frequency,
                damping_ratio=mode.damping_ratio,
                share=share,
                description=mode.description,
            )


def motion_share(mode: Mode, motion: str) -> float:
    """Return the share of a motion in the kinetic energy of a mode [-].

    Args:
        motion: as in `MotionFigure`; for the wheels of an axle the vertical motion of both, in any phase.
    """
    if motion in BODY_MOTIONS:
        return mode.motions.get(BODY_MOTIONS[motion], 0.0)
    axle, hop = motion.removesuffix(" wheel hop"), (" wheel hop", " wheel vertical")
    return sum(
        share
        for name, share in mode.motions.items()
        if any(word in name for word in hop) and axle in name.partition(" wheel ")[0].split()
    )


def damper_notes(car: Any) -> Iterator[str]:
    """Yield a sentence for each axle whose figures and modes take different constants of its dampers."""
    constants = {}
    for damper, smallest in zip(car.vehicle.composition.dampers, car.matrices.viscous, strict=True):
        constants[damper.path.split(".")[0]] = damper_constant(damper.law), float(smallest)
    axles = dict.fromkeys(wheel.axle for wheel in car.vehicle.composition.wheels)
    for axle, (at_velocity, smallest) in ((axle, constants[axle]) for axle in axles if axle in constants):
        if smallest < (1.0 - MAXIMUM_DIFFERENCE) * at_velocity:
            yield (
                f"{axle}: the figures heave, pitch, roll and wheel hop take the dampers at {DAMPER_VELOCITY:g} m/s, "
                f"{at_velocity:.0f} N s/m; modes with sliding dampers take their smallest slope, that of fast motion, "
                f"{smallest:.0f} N s/m: their damping is smaller"
            )
