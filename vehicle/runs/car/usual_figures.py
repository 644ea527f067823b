"""Figures of a car with their usual ranges: names, values, and a flag outside the range.

Ranges and their sources are data: `usual_ranges.toml`, and the survey of measured cars for the moments of inertia.
"""

import dataclasses
import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.model.parameters.toml_file import read_table
from vehicle.runs.car.axle_data import AxleData
from vehicle.runs.car.inertia_survey import SURVEY, AxleGeometry
from vehicle.runs.car.motion_figures import MotionFigure

GRAVITY = 9.81
"""Gravity by which a load of an axle becomes a mass [m/s2]."""

DEGREES = math.pi / 180.0
"""One degree [rad]."""

MASS = "mass [kg]"
"""Figure whose range is that of the vehicles of all other ranges."""


@dataclass(frozen=True, kw_only=True, slots=True)
class UsualFigure:
    """Figure of a car or of an axle in its printed unit."""

    name: str  # name with the unit
    axle: str  # name of the axle; empty for a figure of the car
    value: float  # value; nan if it is not defined
    decimals: int  # decimals of the printed value
    low: float = math.nan  # low, high: usual range; nan without a range
    high: float = math.nan
    source: str = ""  # source of the range

    @property
    def unusual(self) -> bool:
        """True if the value is outside the usual range."""
        return self.value < self.low or self.value > self.high

    @property
    def value_text(self) -> str:
        """Return the value with its decimals, and a flag outside the usual range; a dash for an undefined value."""
        return f"{self.value:z.{self.decimals}f}{' !' if self.unusual else ''}" if math.isfinite(self.value) else "-"

    @property
    def range_text(self) -> str:
        """Return the usual range as "1 to 1.6"; a dash without a range."""
        return f"{self.low:.4g} to {self.high:.4g}" if math.isfinite(self.low) else "-"

    def __str__(self) -> str:
        """Return a text about the value and its range."""
        axle = f"{self.axle}: " if self.axle else ""
        return f"{axle}{self.name} {self.value:z.{self.decimals}f}, usual are {self.range_text} ({self.source})"


AXLE_FIGURES: dict[str, tuple[Callable[[AxleData], float | None], int]] = {
    "sprung mass [kg]": (lambda axle: axle.sprung_kg, 1),
    "unsprung mass, both wheels [kg]": (lambda axle: axle.unsprung_kg, 1),
    "track [mm]": (lambda axle: 1e3 * axle.track_m, 0),
    "loaded tyre radius [mm]": (lambda axle: 1e3 * axle.radius_m, 0),
    "spring stiffness [N/mm]": (lambda axle: _milli(axle.spring_n_per_m), 2),
    "motion ratio, spring / wheel": (lambda axle: axle.spring_ratio, 3),
    "motion ratio, damper / wheel": (lambda axle: axle.damper_ratio, 3),
    "damping constant, smallest slope [N s/m]": (lambda axle: axle.damper_n_s_per_m, 0),
    "wheel rate [N/mm]": (lambda axle: _milli(axle.wheel_rate_n_per_m), 2),
    "  spring times ratio squared [N/mm]": (lambda axle: _milli(axle.spring_at_wheel_n_per_m), 2),
    "tyre stiffness [N/mm]": (lambda axle: _milli(axle.tyre_n_per_m), 1),
    "tyre deflection, static [mm]": (lambda axle: 1e3 * _mean_load(axle) / axle.tyre_n_per_m, 1),
    "ride rate [N/mm]": (lambda axle: _milli(axle.ride_rate_n_per_m), 2),
    "ride frequency [Hz]": (lambda axle: axle.ride_frequency_hz, 2),
    "roll stiffness, springs [N m/deg]": (lambda axle: axle.roll.springs * DEGREES, 0),
    "roll stiffness, anti-roll bar or beam [N m/deg]": (lambda axle: axle.roll.bars * DEGREES, 0),
    "roll stiffness, tyres [N m/deg]": (lambda axle: axle.roll.tyres * DEGREES, 0),
    "roll stiffness, all in series [N m/deg]": (lambda axle: axle.roll.total * DEGREES, 0),
    "share of roll stiffness, suspension [%]": (lambda axle: None, 1),
    "share of roll stiffness, with tyres [%]": (lambda axle: None, 1),
    "roll centre above ground [mm]": (lambda axle: 1e3 * axle.geometry.roll_centre_height_m, 1),
    "front-view swing arm [m]": (lambda axle: axle.geometry.front_swing_arm_m, 2),
    "side-view swing arm [m]": (lambda axle: axle.geometry.side_swing_arm_m, 2),
    "anti-dive / anti-lift angle, braking [deg]": (lambda axle: axle.geometry.brake_support_deg, 2),
    "anti-lift / anti-squat angle, driving [deg]": (lambda axle: axle.geometry.drive_support_deg, 2),
    "anti-dive (front) or anti-lift (rear), braking [%]": (lambda axle: None, 1),
    "anti-lift (front) or anti-squat (rear), driving [%]": (lambda axle: None, 1),
    "caster [deg]": (lambda axle: axle.geometry.caster_deg, 2),
    "kingpin inclination [deg]": (lambda axle: axle.geometry.kingpin_inclination_deg, 2),
    "caster trail [mm]": (lambda axle: 1e3 * axle.geometry.caster_trail_m, 1),
    "scrub radius [mm]": (lambda axle: 1e3 * axle.geometry.scrub_radius_m, 1),
    "bump steer, toe-in per 100 mm [deg]": (lambda axle: 0.1 * axle.bump_steer_deg_per_m, 2),
}
"""Figures of an axle in their order: value, and decimals; None: a figure of the car, see `_of_the_car`."""


@functools.cache
def usual_ranges() -> Mapping[str, Mapping[str, Any]]:
    """Return the table of the usual ranges by the names of the figures."""
    return read_table(Path(__file__).parent / "usual_ranges.toml")


def too_heavy(mass: float) -> bool:
    """Return True if a vehicle of a mass [kg] is heavier than the cars and vans of the usual ranges."""
    return bool(mass > usual_ranges()[MASS]["all"][1])


def car_figures(data: Any) -> tuple[UsualFigure, ...]:
    """Return the figures of the whole car, from its `CarData`."""
    mean_track = float(np.mean([axle.track_m for axle in data.axles])) if data.axles else math.nan
    values = {
        MASS: (data.mass_kg, 1),
        "unsprung mass [% of the mass]": (100.0 * data.unsprung_kg / data.mass_kg, 1),
        "track over twice the CoG height": (mean_track / (2.0 * data.cog_height_m), 2),
    }
    figures = [_ranged(name, "", *value, data.mass_kg) for name, value in values.items()]
    if data.wheelbase_m is None:
        # Without a second axle on wheels the masses of the rear axle are not in the car.
        return (figures[0], figures[2])
    figures.append(_ranged("wheelbase [mm]", "", 1e3 * data.wheelbase_m, 0, data.mass_kg))
    figures.append(_ranged("load on the front axle [%]", "", 100.0 * data.front_share, 1, data.mass_kg))
    behind = data.cog_behind_front_m
    geometry = AxleGeometry(track=mean_track, front=behind, rear=data.wheelbase_m - behind)
    for (name, index), value in zip(
        SURVEY.items(), geometry.indices(data.mass_kg, data.inertia_kg_m2[:3]), strict=True
    ):
        source = "73 measured cars, NHTSA's inertial parameter database, SAE 1999-01-1336"
        low, high = (math.nan, math.nan) if too_heavy(data.mass_kg) else (index.least, index.most)
        figures.append(UsualFigure(name=name, axle="", value=value, decimals=3, low=low, high=high, source=source))
    return tuple(figures)


def axle_figures(data: Any) -> tuple[tuple[UsualFigure, ...], ...]:
    """Return the figures of all axles: for each name a figure an axle; names undefined for the car are absent."""
    rows = []
    for name, (value_of, decimals) in AXLE_FIGURES.items():
        values: list[float | None] = _of_the_car(data, name) or [value_of(axle) for axle in data.axles]
        if name not in _OF_THE_CAR or data.wheelbase_m is not None:
            pairs = zip(data.axles, values, strict=True)
            rows.append(tuple(_ranged(name, axle, value, decimals, data.mass_kg) for axle, value in pairs))
    return tuple(rows)


_OF_THE_CAR = (
    "share of roll stiffness, suspension [%]",
    "share of roll stiffness, with tyres [%]",
    "anti-dive (front) or anti-lift (rear), braking [%]",
    "anti-lift (front) or anti-squat (rear), driving [%]",
)
"""Figures of an axle that the rest of the car enters."""


def _of_the_car(data: Any, name: str) -> list[float | None] | None:
    """Return the values of a figure of `_OF_THE_CAR` by axle; None for a figure of the axle alone."""
    if name not in _OF_THE_CAR or data.wheelbase_m is None:
        return None
    index = _OF_THE_CAR.index(name)
    if index < 2:
        stiffness = [getattr(axle.roll, ("suspension", "total")[index]) for axle in data.axles]
        return [100.0 * value / sum(stiffness) for value in stiffness]
    return [(data.support_percent(axle) or (math.nan, math.nan))[index - 2] for axle in data.axles]


def motion_values(figure: MotionFigure, mass: float) -> tuple[UsualFigure, UsualFigure]:
    """Return frequency and damping ratio of a headline figure; they have usual ranges if the dampers slide.

    Args:
        figure: headline figure.
        mass: mass of the car [kg].
    """
    axle, hop, _ = figure.motion.rpartition(" wheel hop")
    name = "wheel hop" if hop else figure.motion
    damping = None if figure.damping_ratio is None else 100.0 * figure.damping_ratio
    pair = (
        _ranged(f"{name} [Hz]", axle, figure.frequency_hz, 2, mass),
        _ranged(f"{name}, damping [%]", axle, damping, 1, mass),
    )
    if figure.dampers == "sliding":
        return pair
    frequency, ratio = (dataclasses.replace(value, low=math.nan, high=math.nan) for value in pair)
    return frequency, ratio


def usual_range(motion: str, mass: float) -> str:
    """Return the usual ranges of a headline figure as text; see `motion_values`."""
    pair = motion_values(
        MotionFigure(motion=motion, dampers="sliding", frequency_hz=None, damping_ratio=None, modes=()), mass
    )
    return "; ".join(figure.range_text for figure in pair)


def usual_figures(data: Any) -> tuple[UsualFigure, ...]:
    """Return all figures of a car: those of the whole car, of its axles, and the headline figures."""
    sliding = [figure for figure in data.figures if figure.dampers == "sliding"]
    rows = (*axle_figures(data), *(motion_values(figure, data.mass_kg) for figure in sliding))
    return (*car_figures(data), *(figure for row in rows for figure in row))


def _ranged(name: str, axle: AxleData | str, value: float | None, decimals: int, mass: float) -> UsualFigure:
    """Return a figure with its usual range; a range with `per` is in proportion to the load of the axle.

    A vehicle that is too heavy by its `mass` [kg] has the range of its mass alone.
    """
    entry = {} if name != MASS and too_heavy(mass) else usual_ranges().get(name, {})
    low, high = entry.get("all", (math.nan, math.nan))
    if isinstance(axle, AxleData):
        low, high = entry.get("front" if axle.front else "rear", (low, high))
        load = sum(axle.load_n.values())
        if entry.get("per") == "axle load":
            low, high = low * load / GRAVITY, high * load / GRAVITY
        if not load:
            # A car without weight is on no road.
            low, high = math.nan, math.nan
    return UsualFigure(
        name=name.strip(),
        axle=axle.name if isinstance(axle, AxleData) else axle,
        value=math.nan if value is None else float(value),
        decimals=decimals,
        low=low,
        high=high,
        source=entry.get("source", ""),
    )


def _milli(value: float | None) -> float | None:
    return None if value is None else 1e-3 * value


def _mean_load(axle: AxleData) -> float:
    """Return the mean static load of the wheels of an axle [N]."""
    return sum(axle.load_n.values()) / len(axle.load_n)
