"""Figure of the catalogue with its details, from a text as "travel_fr" or "rms:seat_rail_acc_z:5-25", or from a table.

    NAME                       tyre_load
    NAME_AXIS, NAME_WHEEL      weighted_z, travel_fr
    NAME:DETAIL:DETAIL ...     peak:seat_rail_acc_z, rms:seat rail z:5-25:Wk, order:2:seat_rail_acc_z, frequency:heave

Several channels or wheels are joined by "+".
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.channel_words import channels_named
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES, channel_units, is_wheel
from vehicle.runs.figures.catalogue import FIGURES
from vehicle.runs.figures.figure import Details, Figure
from vehicle.runs.figures.rows import SEAT, axis_weighting
from vehicle.runs.figures.turning_figures import ORDER_FREQUENCY
from vehicle.signals.analysis.weighting import WEIGHTINGS
from vehicle.wording import did_you_mean

FORMS = {
    "channels": "CHANNELS", "over": "CHANNELS", "band": "LOW-HIGH", "weighting": "WEIGHTING", "wheels": "WHEELS",
    "axis": "AXIS", "order": "N", "angle": "ANGLE", "motion": "MOTION",
}  # fmt: skip
"""Detail to its form in a text."""

HIGHEST_ORDER = 100.0
"""Highest order of a turning part."""

KEYS = tuple(FORMS)
"""Names of all details."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ChosenFigure(Details):
    """Figure with its details.

    Attributes:
        quantity: name in the catalogue.

    Raises:
        ConfigurationError: unknown quantity, missing or unknown detail, value out of range.
    """

    quantity: str

    def __post_init__(self) -> None:
        name = type(self).__name__
        if self.quantity not in FIGURES:
            raise ConfigurationError(f"{name}.quantity: must be one of {', '.join(FIGURES)}, not {self.quantity!r}")
        for key in KEYS:
            is_set = getattr(self, key) not in ((), "", None)
            if key in self.figure.needs and not is_set:
                raise ConfigurationError(f"{name}.{key}: missing; {self.quantity} needs it")
            if is_set and key not in self.figure.keys:
                raise ConfigurationError(f"{name}.{key}: not used by {self.quantity}; leave it out")
        if self.band is not None and not (len(self.band) == 2 and 0.0 < self.band[0] < self.band[1] < math.inf):
            raise ConfigurationError(f"{name}.band: found {list(self.band)}, must be [LOWEST, HIGHEST] in Hz, above 0")
        if self.weighting and self.weighting not in (SEAT, *WEIGHTINGS):
            raise ConfigurationError(
                f"{name}.weighting: must be one of {', '.join((SEAT, *WEIGHTINGS))}, not {self.weighting!r}"
            )
        if self.axis and self.axis not in AXES:
            raise ConfigurationError(f"{name}.axis: must be x, y or z, not {self.axis!r}")
        if self.order is not None and not 0.0 < self.order <= HIGHEST_ORDER:
            raise ConfigurationError(
                f"{name}.order: found {self.order:g}, must be above 0 and at most {HIGHEST_ORDER:g}"
            )

    @property
    def figure(self) -> Figure:
        """Return the figure of the catalogue."""
        return FIGURES[self.quantity]

    @property
    def details(self) -> dict[str, str]:
        """Return the details that are set as texts, in the order of a text."""
        texts = {}
        for key in self.figure.keys:
            value: Any = getattr(self, key)
            if key == "band" and value is not None:
                texts[key] = f"{value[0]:g}-{value[1]:g}"
            elif key == "order" and value is not None:
                texts[key] = f"{value:g}"
            elif value not in ((), "", None):
                texts[key] = value if isinstance(value, str) else "+".join(value)
        return texts

    @property
    def column(self) -> str:
        """Return the name in tables, as "travel_fr" or "peak_seat_rail_acc_z"; the angle of an order is not in it."""
        if self.quantity == ORDER_FREQUENCY:
            return self.quantity
        parts = [text for key, text in self.details.items() if key != "angle"]
        return "_".join([self.quantity, *parts]).replace(" ", "_")

    @property
    def title(self) -> str:
        """Return the figure in words, as "damper travel, fr"."""
        return ", ".join([self.figure.words, *(text.replace("_", " ") for text in self.details.values())])

    def unit_in(self, units: Mapping[str, str] | None = None) -> str:
        """Return the unit.

        Args:
            units: recorded channel to its unit; by default those of the names.

        Raises:
            ConfigurationError: channels of several units, or of another unit than the figure needs.
        """
        figure = self.figure
        for names in (self.channels, self.over):
            channel_unit = channel_units(names) if units is None else units
            unit_of = {name: channel_unit[name] for name in names}
            needed = figure.of_unit or next(iter(unit_of.values()), "")
            # The largest of crest factors or settling times has no unit of the channels.
            if (figure.of_unit or self.over or not figure.unit) and {*unit_of.values()} - {needed}:
                listed = ", ".join(f"{name} [{unit}]" for name, unit in unit_of.items())
                raise ConfigurationError(
                    f"channels: found {listed}; {self.quantity} needs channels in {figure.of_unit or 'one unit'}"
                )
        return figure.unit or (channel_units(self.channels[:1]) if units is None else units)[self.channels[0]]

    def recorded_in(self, channels: Sequence[str]) -> Self:
        """Return the figure with the names of its channels in place of their words.

        Raises:
            ConfigurationError: no recorded channel has these words.
        """
        return replace(self, channels=channels_named(self.channels, channels), over=channels_named(self.over, channels))

    def channels_of(self, vehicle: Vehicle) -> tuple[str, ...]:
        """Return the channels of a car that the figure reads."""
        return self.figure.reads.channels(self, vehicle)

    def require(self, vehicle: Vehicle) -> None:
        """Check the figure for a car, before a run.

        Raises:
            ConfigurationError: a seat weighting of a channel without an axis, or an unknown motion or angle.
        """
        for name in (*self.channels, *self.over):
            axis_weighting(self.weighting, name)
        self.figure.require(self, vehicle)

    def columns(self) -> tuple[ChosenFigure, ...]:
        """Return the figures of a table: this figure and its companion."""
        other = self.figure.companion
        return (self, *([replace(self, quantity=other)] if other else []))


def form_of(name: str) -> str:
    """Return the form of a text, as "order:N:CHANNELS[:ANGLE]"."""
    figure = FIGURES[name]
    needed = "".join(f":{FORMS[key]}" for key in figure.needs)
    return f"{name}{needed}{''.join(f'[:{FORMS[key]}]' for key in figure.takes)}"


def available(vehicle: Vehicle) -> dict[str, Figure]:
    """Return the figures of a car by name."""
    has = {"": True, "seat": vehicle.seated, "damper": bool(vehicle.damped_wheels)}
    return {name: figure for name, figure in FIGURES.items() if has[figure.of_car]}


def chosen_figure(text: str, vehicle: Vehicle, option: str = "figure") -> ChosenFigure:
    """Return the figure of a text, with channels by name, checked for a car.

    Args:
        text: see the head of this module.
        vehicle: the car.
        option: option of the text, for messages.

    Raises:
        ConfigurationError: an unknown figure, another form, or the car lacks a channel or part.
    """
    name, *parts = (part.strip() for part in text.split(":"))
    if name not in FIGURES:
        beginnings = [each for each in FIGURES if name.startswith(f"{each}_")]
        whole, name = name, max(beginnings, key=len, default=name)
        parts = [whole[len(name) + 1 :], *parts] if beginnings else parts
    if name not in available(vehicle):
        near = did_you_mean(name, available(vehicle), cutoff=0.6)
        near = near or f"; choose from {', '.join(map(form_of, available(vehicle)))}"
        raise ConfigurationError(f"{option} {text!r}: {vehicle.name} has no figure {name!r}{near}")
    try:
        chosen = ChosenFigure(quantity=name, **_details(FIGURES[name], parts))
    except (ConfigurationError, ValueError):
        raise ConfigurationError(f"{option} {text!r}: must have the form {form_of(name)}") from None
    try:
        channels = (*vehicle.channels, *vehicle.load_channels)
        chosen = chosen.recorded_in(channels)
        chosen.channels_of(vehicle)
        chosen.unit_in()
        chosen.require(vehicle)
    except ConfigurationError as error:
        raise ConfigurationError(f"{option} {text!r}: {error}") from None
    return chosen


def _details(figure: Figure, parts: Sequence[str]) -> dict[str, Any]:
    """Return the details in the parts of a text; a part of no other form is the next name.

    Raises:
        ValueError: a part belongs to no detail.
    """
    details: dict[str, Any] = {}
    for part in parts:
        left = [key for key in figure.keys if key not in details]
        values = {key: value for key in left if (value := _read(key, part)) is not None}
        free = {"channels", "over", "angle", "motion"}
        key = next((each for each in values if each not in free), next(iter(values), None))
        if key is None:
            raise ValueError(part)
        details[key] = values[key]
    return details


def _read(key: str, part: str) -> Any:
    """Return the value of a detail in a text; None for another text."""
    if not part:
        return None
    several = tuple(each.strip() for each in re.split(r"[+,]", part))
    if key == "axis":
        return part if part in AXES else None
    if key == "weighting":
        return part if part in (SEAT, *WEIGHTINGS) else None
    if key == "wheels":
        return several if all(map(is_wheel, several)) else None
    if key in ("band", "order"):
        numbers = re.fullmatch(r"([0-9.]+)-([0-9.]+)" if key == "band" else r"([0-9.]+)", part)
        try:
            values = tuple(map(float, numbers.groups())) if numbers else None
        except ValueError:
            return None
        return values and (values if key == "band" else values[0])
    return part if key in ("angle", "motion") else several
