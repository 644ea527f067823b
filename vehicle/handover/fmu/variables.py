"""Variables of an FMU: names, units, value references, first values.

Value references are defined in runtime/instance.c.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.handover.fmu.car_numbers import COMMANDS, FRICTION, PARAMETERS, CarNumbers, friction_numbers
from vehicle.model.parameters.force_elements import Damper

FIRST_PLATE, FIRST_SLOPE, FIRST_FORCE, FIRST_COMMAND, FIRST_PARAMETER = 100, 5000, 7000, 10000, 20000
FIRST_OUTPUT = 30000
"""First value references."""

UNITS = {
    "m": {"m": 1},
    "s": {"s": 1},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N m": {"kg": 1, "m": 2, "s": -2},
    "N s/m": {"kg": 1, "s": -1},
}
"""Units of the variables in base units of the SI."""

_MEANING = {
    **{name: number.meaning for name, number in FRICTION.items()},
    "curve_scale": "factor on the damping curve (without friction and gas); other values than 1 are exact to 0.1 %",
    "control": "1: the control law of the car acts; 0: softest setting, for an external controller that sets the "
    "coefficient command",
    "displacement": "displacement of the plate or road at the END of the communication step, upwards",
    "velocity": "velocity of the plate or road at the END of the communication step, upwards; must be set, or the tyre "
    "forces are wrong",
    "slope_excess": "mean of V tan(beta) - z' over the communication step, for a road whose slope under the tyre is "
    "not the derivative of the height (tyre enveloping an obstacle); otherwise 0",
    "applied": "force or moment [force.NAME] that is added to its mean in the vehicle file: value at the END of the "
    "communication step; it changes linearly during the step",
    "force": "force that is added to the damper force, constant over the communication step; positive pulls body and "
    "wheel together",
    "coefficient": "damping constant that is added to the damping curve, constant over the communication step",
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Variable:
    """Variable of an FMU."""

    name: str  # its name
    reference: int  # value reference
    causality: str  # "independent", "input", "parameter" or "output"
    unit: str  # key of `UNITS`; empty for a number
    start: float | None = None  # first value of an input or a parameter; None for time and outputs
    meaning: str = ""  # description

    @property
    def variability(self) -> str:
        """Return "tunable" for a parameter, otherwise "continuous"."""
        return "tunable" if self.causality == "parameter" else "continuous"


def variables(numbers: CarNumbers, dampers: Sequence[Damper]) -> list[Variable]:
    """Return the variables of the FMU of a car: time, inputs, parameters, outputs."""
    entries = [Variable(name="time", reference=0, causality="independent", unit="s")]

    def add(reference: int, name: str, quantity: str, unit: str, start: float = 0.0, causality: str = "input") -> None:
        meaning = _MEANING[quantity]
        entries.append(
            Variable(name=name, reference=reference, causality=causality, unit=unit, start=start, meaning=meaning)
        )

    for k, wheel in enumerate(numbers.plates):
        add(FIRST_PLATE + 2 * k, f"plate_{wheel}_displacement", "displacement", "m")
        add(FIRST_PLATE + 2 * k + 1, f"plate_{wheel}_velocity", "velocity", "m/s")
    for k, wheel in enumerate(numbers.plates if numbers.rolling else ()):
        add(FIRST_SLOPE + k, f"plate_{wheel}_slope_excess", "slope_excess", "m/s")
    for k, (name, unit) in enumerate(numbers.forces):
        add(FIRST_FORCE + k, name, "applied", unit)
    for i, name in enumerate(numbers.dampers):
        for part, (quantity, unit) in enumerate(COMMANDS.items()):
            add(FIRST_COMMAND + 2 * i + part, f"{name}_{quantity}_command", quantity, unit)
    for i, (name, law) in enumerate(zip(numbers.dampers, dampers, strict=True)):
        missing = FRICTION.keys() - friction_numbers(law) | ({"control"} if not law.controlled else set())
        for k, (quantity, unit) in enumerate(PARAMETERS.items()):
            if quantity in missing:
                continue
            start = float(np.asarray(numbers.parameters)[i, k])
            add(FIRST_PARAMETER + len(PARAMETERS) * i + k, f"{name}_{quantity}", quantity, unit, start, "parameter")
    entries += [
        Variable(
            name=output.name,
            reference=FIRST_OUTPUT + index,
            causality="output",
            unit=output.unit,
            meaning=output.meaning,
        )
        for index, output in enumerate(numbers.outputs)
    ]
    return entries
