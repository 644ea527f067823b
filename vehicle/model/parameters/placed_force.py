"""A force on a part of the car, placed, with its history."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.applied_force import AppliedForce
from vehicle.model.parameters.driving import RunUp
from vehicle.model.parameters.hardpoints import Point
from vehicle.wording import did_you_mean

NONE = (0.0, 0.0, 0.0)
"""Direction of a force or moment that is absent."""

DRIVING = "driving"
"""Path of the drive torques of a car in steady acceleration."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedForce:
    """A force or a moment on a part along a fixed direction of the vehicle frame, or a torque or force in a joint.

    Or a motion of the road under the tyre of one wheel alone: along z the height [m] that its run-out adds, without a
    slope; along x the velocity [m/s] of its tread that its rolling radius adds.

    Attributes:
        name: name of the force.
        on: part that it acts on; empty for a torque on a joint.
        at: point at which it acts [m].
        force, moment: unit direction of the force and of the moment; one of both is zero.
        follows: the directions turn with the part that it acts on.
        against: part with the reaction at the same point; empty for none.
        joint: joint with the torque, on its part and against the parent; empty for a force on a part.
        law: its history.
        speed: angular speed of its angle [rad/s]; in a run-up the highest.
        path: path of its table in the vehicle file.
        unit: "N", or "N m" of a moment and of a torque in a hinge; "m" and "m/s" of the motion below a tyre.
        run_up: run-up of its angle; None for a constant speed.
        tyre: wheel whose tyre it changes, for example "fr"; empty for a force or a torque.
        given: history from Python, a `RecordedForce`, which replaces the history of the law; None without one.
    """

    name: str
    on: str = ""
    at: Point = NONE
    force: Point = NONE
    moment: Point = NONE
    against: str = ""
    joint: str = ""
    law: AppliedForce
    speed: float
    path: str
    unit: str = "N"
    run_up: RunUp | None = None
    tyre: str = ""
    given: Any = None
    follows: bool = False

    @property
    def ends(self) -> tuple[tuple[str, float], ...]:
        """Parts with a force, each with its sign."""
        return tuple((part, sign) for part, sign in ((self.on, 1.0), (self.against, -1.0)) if part)

    @property
    def harmonics(self) -> dict[float, complex]:
        """Angular frequencies [rad/s] and complex amplitudes, in a run-up at its highest speed: see `AppliedForce`."""
        return self.law.amplitudes(self.speed)

    @property
    def channel(self) -> str:
        """Channel of its history, recorded on request; empty if it changes a tyre or is the steady drive torque."""
        return "" if self.tyre or self.path == DRIVING else f"{'torque' if self.unit == 'N m' else 'force'}_{self.name}"

    @property
    def acts(self) -> bool:
        """True if it has harmonics at the speed of its angle, a record or a mean."""
        return bool(self.harmonics or self.mean or self.recorded)

    @property
    def recorded(self) -> bool:
        """True if its history comes from a file or from Python."""
        return self.law.enabled and bool(self.law.file or self.given)

    @property
    def mean(self) -> float:
        """Constant part [N or N m]."""
        return self.law.mean if self.law.enabled else 0.0


def on_parts(forces: Iterable[PlacedForce]) -> list[PlacedForce]:
    """Return the forces on parts and joints: all but those that change a tyre, which come last."""
    return [force for force in forces if not force.tyre]


def force_named(name: str, forces: Sequence[PlacedForce], *, own: bool = False) -> int:
    """Return the index of a force.

    Args:
        name: its name.
        forces: forces of a car.
        own: only forces of a table [force.NAME].

    Raises:
        ConfigurationError: the car has no force of this name.
    """
    indices = {force.name: index for index, force in enumerate(forces) if not own or force.path.startswith("force.")}
    if name not in indices:
        table = "no table [force.NAME]" if own else "no force"
        raise ConfigurationError(
            f"force: unknown name {name!r}, {table} of this car"
            + (did_you_mean(name, indices) or "; add a section [force.NAME] to the vehicle file")
        )
    return indices[name]
