"""Bars of the tornado chart: each parameter at the two ends of its range, on both roads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scenarios.comfort_observation import Question
from scenarios.comfort_sensitivity_runs import Changes, ComfortRuns, Point, Variation
from scenarios.road_signals import ROAD_RMS

SHARE = 0.2
"""Change of each parameter, down and up."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """A parameter of the chart.

    Attributes:
        label: with its unit.
        path: of the parameter.
        ends: its two values, where they are not the nominal one -20 and +20 %.
        reason: why not.
        power: the value follows (1 -+ 20 %) to this power.
    """

    label: str
    path: str
    ends: tuple[float, float] | None = None
    reason: str = ""
    power: float = 1.0


PARAMETERS = (
    Parameter(label="Coulomb friction Fd [N]", path="damper.coulomb_friction"),
    Parameter(label="damper constant D [N s/m]", path="damper.viscous"),
    Parameter(label="suspension mount stiffness, z [N/m]", path="bushings.suspension_mount.stiffness.z"),
    Parameter(
        label="suspension mount damping, z [N s/m]",
        path="bushings.suspension_mount.damping.z",
        ends=(0.0, 500.0),
        reason="nominal 0, so from there to the first step of source 1",
    ),
    Parameter(label="main spring [N/m]", path="main_spring.stiffness"),
    Parameter(label="tyre stiffness, z [N/m]", path="bushings.tyre.stiffness.z"),
    Parameter(label="stabilizer [N m/rad]", path="stabilizer.torsional_stiffness"),
    Parameter(
        label="body stiffness, as factor on its frequencies [-]",
        path="body.frequency_scale",
        power=0.5,
        reason="stiffness -20 and +20 %, frequencies with its square root",
    ),
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Bar:
    """A parameter and what its two ends make of comfort.

    Attributes:
        label: with its unit.
        nominal, low, high: values of the parameter.
        reason: why the ends are not -20 and +20 %.
        at_low, at_high: by road; NaN error of a single record.
    """

    label: str
    nominal: float
    low: float
    high: float
    reason: str
    at_low: Mapping[str, Point]
    at_high: Mapping[str, Point]

    def swing(self, road: str) -> float:
        """Largest minus smallest relative comfort value, the nominal car included [-]."""
        found = (self.at_low[road].relative, self.at_high[road].relative, 1.0)
        return max(found) - min(found)


def ends(comfort: ComfortRuns, parameter: Parameter) -> dict[float, Changes]:
    """The two cars of a parameter by its value, low end first."""
    vehicle = comfort.runs.car().vehicle
    pair = parameter.ends or tuple(
        _variation(parameter).nominal(vehicle) * factor**parameter.power for factor in (1.0 - SHARE, 1.0 + SHARE)
    )
    return {value: _variation(parameter).changes(vehicle, value) for value in pair}


def tornado_questions(comfort: ComfortRuns) -> list[Question]:
    """All runs of the chart."""
    cars: list[Changes] = [(), *(car for parameter in PARAMETERS for car in ends(comfort, parameter).values())]
    return [question for car in cars for road in ROAD_RMS for question in comfort.questions(car, road)]


def all_bars(comfort: ComfortRuns) -> list[Bar]:
    """Bars of all parameters, the largest swing on either road first."""
    vehicle = comfort.runs.car().vehicle
    bars = []
    for parameter in PARAMETERS:
        (low, low_car), (high, high_car) = ends(comfort, parameter).items()
        bars.append(
            Bar(
                label=parameter.label,
                nominal=_variation(parameter).nominal(vehicle),
                low=low,
                high=high,
                reason=parameter.reason,
                at_low={road: comfort.point(low, low_car, road, ()) for road in ROAD_RMS},
                at_high={road: comfort.point(high, high_car, road, ()) for road in ROAD_RMS},
            )
        )
    return sorted(bars, key=lambda bar: -max(bar.swing(road) for road in ROAD_RMS))


def _variation(parameter: Parameter) -> Variation:
    return Variation(name="", label=parameter.label, path=parameter.path, values=())
