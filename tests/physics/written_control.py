"""Control laws of semi-active dampers written for the tests, from the tables of their sources.

Karnopp, Crosby and Harwood (1974): a skyhook damper pulls on the body with c_sky vb; where a damper between body and
wheel cannot do so, its force has the wrong sign, it is as soft as it can be. Ahmadian (1997): groundhook likewise with
-c_ground vw, and the hybrid as a weighted sum of both. Scalars, cases and events in place of the arrays, signs and ring
of the program (`vehicle.model.laws.control_laws`, `vehicle/core/source/laws.h`).
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from scenarios.lumped import semi_active_half_car
from vehicle.arrays import Vector
from vehicle.model.laws.control_laws import PRESENT
from vehicle.model.parameters.semi_active_damper import SemiActiveDamper


def wanted(control: SemiActiveDamper, body: float, wheel: float) -> float:
    """Return the coefficient that a controller asks for [N s/m] at velocities of body and wheel [m/s]."""
    softest, firmest, extension = control.minimum_damping, control.maximum_damping, body - wheel
    if extension == 0.0:
        return softest
    of_sky = {"skyhook": 1.0, "groundhook": 0.0, "hybrid": control.skyhook_share}[control.law.replace("_on_off", "")]
    assert of_sky is not None
    total = 0.0
    for weight, velocity, gain in (
        (of_sky, body, control.skyhook_damping or 0.0),
        (1.0 - of_sky, -wheel, control.groundhook_damping or 0.0),
    ):
        if velocity / extension > 0.0:  # a damper can pull this way
            total += weight * (firmest - softest if "on_off" in control.law else gain * velocity / extension)
    return softest + total if "on_off" in control.law else min(max(total, softest), firmest)


@dataclass
class WrittenControl:
    """Controllers of a batch of dampers, with readings and coefficients of the past."""

    control: SemiActiveDamper
    step: float  # [s]
    demands: list[Vector] = field(default_factory=list)  # asked for at every step so far [N s/m]
    reached: Vector | None = None  # coefficients at the end of the last step [N s/m]

    def mean(self, index: int, body: Vector, wheel: Vector) -> Vector:
        """Return the mean coefficients over a step [N s/m] from the velocities at its beginning [m/s]."""
        control, every = self.control, max(1, round(self.control.control_period / self.step))
        if index % every:
            self.demands.append(self.demands[-1])
        else:
            pairs = zip(body.ravel(), wheel.ravel(), strict=True)
            self.demands.append(np.array([wanted(control, *pair) for pair in pairs]).reshape(body.shape))
        soft = np.full(body.shape, control.minimum_damping)
        arrived = index - round(control.delay / self.step)
        goal, start = self.demands[arrived] if arrived >= 0 else soft, soft if self.reached is None else self.reached
        moving = np.minimum(np.abs(goal - start) / control.rate, self.step)  # time that the valve moves in this step
        self.reached = start + np.sign(goal - start) * control.rate * moving
        return (0.5 * (start + self.reached) * moving + self.reached * (self.step - moving)) / self.step


def use_written_control(monkeypatch: Any) -> None:
    """Have the lumped half car drive its dampers by these laws in place of those of the program."""

    def act(record: WrittenControl, step: int, body: Vector, wheel: Vector, memory: dict[int, Vector]) -> None:
        memory[PRESENT] = record.mean(step, body, wheel)

    monkeypatch.setattr(semi_active_half_car, "pack", lambda control: control)
    monkeypatch.setattr(semi_active_half_car, "in_steps", WrittenControl)
    monkeypatch.setattr(semi_active_half_car, "at_rest", lambda *_: {})
    monkeypatch.setattr(semi_active_half_car, "act", act)
