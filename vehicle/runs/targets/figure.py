"""Figure of a ride with its limit, one table of a targets file."""

import fnmatch
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.weighting import WEIGHTINGS

SEAT = "seat"
"""Weighting of a seat: Wd along x and y, Wk along z (ISO 2631-1)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Quantity:
    """Kind of a figure.

    Attributes:
        meaning: definition with the unit of its channels as U.
        unit: unit; empty for that of the channels, times `suffix`.
        suffix: appended to the unit of the channels.
        needs: required keys of the table.
        takes: further keys.
    """

    meaning: str
    unit: str = ""
    suffix: str = ""
    needs: tuple[str, ...] = ("channels",)
    takes: tuple[str, ...] = ()


QUANTITIES = {
    "rms": Quantity(
        meaning="root of the sum of the mean squares of the channels [U]", takes=("band", "weighting")
    ),
    "peak": Quantity(meaning="maximum of |channel|, over all channels [U]"),
    "peak_to_peak": Quantity(meaning="maximum minus minimum, largest of all channels [U]"),
    "vdv": Quantity(
        meaning="vibration dose value, fourth root of the sum of the fourth powers of the channels [m/s^1.75]",
        unit="m/s^1.75",
        needs=("channels", "weighting"),
    ),
    "settling": Quantity(
        meaning="time after an obstacle in which |channel| stays above 10 % of its peak, longest of all channels [s]",
        unit="s",
    ),
    "ratio": Quantity(
        meaning="RMS of the channels divided by that of the channels in "
            "`over` [-]", unit="-", needs=("channels", "over"),
        takes=("band", "weighting"),
    ),
    "stick_share": Quantity(
        meaning="share of the time in which a damper sticks, largest of all wheels [-]", unit="-", needs=(),
        takes=("wheels",),
    ),
    "tyre_load": Quantity(
        meaning="RMS of the dynamic tyre load divided by the static load, all wheels together [-]", unit="-", needs=(),
        takes=("wheels",),
    ),
    "travel": Quantity(
        meaning="maximum travel of a damper from rest, largest of all wheels [m]", unit="m", needs=(),
        takes=("wheels",),
    ),
}  # fmt: skip
"""Name of each kind of figure to its definition."""

INPUTS = ("road", "obstacle", "signal", "speed", "run")
"""Keys that choose the runs of a figure."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Figure:
    """Figure of a ride with its limit.

    Attributes:
        quantity: kind, one of `QUANTITIES`.
        unit: unit of the limit; must be that of the figure.
        at_most, at_least: limit; one of the two.
        channels, over: names or words of recorded channels, as "seat rail z".
        band: lowest and highest frequency [Hz].
        weighting: frequency weighting of all channels, as "Wk", or "seat".
        wheels: wheels, as "fr"; all by default.
        road, obstacle, signal: only runs on this class of ISO 8608, on obstacles whose text begins so, or with this
            file as their signal.
        speed: only runs at this speed [km/h].
        run: only runs with this folder name, a pattern with *.
        words: name on the page; that of the table by default.
        weight: weight of a violation in a search for the smallest change [-].
        source: where the limit comes from.

    Raises:
        ConfigurationError: unknown quantity, missing or unknown key, or value out of range.
    """

    quantity: str
    unit: str
    at_most: float | None = None
    at_least: float | None = None
    channels: tuple[str, ...] = ()
    over: tuple[str, ...] = ()
    band: tuple[float, ...] | None = None
    weighting: str = ""
    wheels: tuple[str, ...] = ()
    road: str = ""
    obstacle: str = ""
    signal: str = ""
    speed: float | None = None
    run: str = ""
    words: str = ""
    weight: float = 1.0
    source: str = ""

    def __post_init__(self) -> None:
        definition = QUANTITIES.get(self.quantity)
        if definition is None:
            raise ConfigurationError(
                f"Figure.quantity: found {self.quantity!r}, must be one of {', '.join(QUANTITIES)}"
            )
        for key in ("channels", "over", "band", "weighting", "wheels"):
            is_set = getattr(self, key) not in ((), "", None)
            if key in definition.needs and not is_set:
                raise ConfigurationError(f"Figure.{key}: missing; {self.quantity} needs it")
            if is_set and key not in (*definition.needs, *definition.takes):
                raise ConfigurationError(f"Figure.{key}: not used by {self.quantity}; leave it out")
        if (self.at_most is None) == (self.at_least is None):
            raise ConfigurationError("Figure.at_most: set exactly one of at_most and at_least")
        if not (math.isfinite(self.limit) and self.weight > 0.0):
            raise ConfigurationError(
                f"Figure.at_most: found limit {self.limit:g} and weight {self.weight:g}; both must be "
                "finite, the weight above 0"
            )
        if self.band is not None and not (len(self.band) == 2 and 0.0 < self.band[0] < self.band[1]):
            raise ConfigurationError(f"Figure.band: found {list(self.band)}, must be [LOWEST, HIGHEST] in Hz, above 0")
        if self.weighting and self.weighting not in (SEAT, *WEIGHTINGS):
            raise ConfigurationError(
                f"Figure.weighting: found {self.weighting!r}, must be one of {', '.join((SEAT, *WEIGHTINGS))}"
            )

    @property
    def limit(self) -> float:
        """Return the limit."""
        return float(self.at_most if self.at_most is not None else self.at_least or 0.0)

    @property
    def sense(self) -> float:
        """Return 1 for an upper limit, -1 for a lower one."""
        return 1.0 if self.at_most is not None else -1.0

    def on(self, name: str, source: str, road: Mapping[str, object] | None) -> bool:
        """Return True if a run belongs to the figure.

        Args:
            name: name of its folder.
            source: name of its signal.
            road: entry "road" of `summary.json`; None for a signal.
        """
        driven = road or {}
        return (
            (not self.road or str(driven.get("class") or "").upper() == self.road.upper())
            and (not self.obstacle or str(driven.get("obstacle") or "").startswith(self.obstacle))
            and (not self.signal or (road is None and Path(source).name == Path(self.signal).name))
            and (self.speed is None or driven.get("speed_kmh") == self.speed)
            and (not self.run or fnmatch.fnmatchcase(name, self.run))
        )

    @property
    def where(self) -> str:
        """Return the input in words, as "class C, 80 km/h"; empty for every run."""
        parts = (
            f"class {self.road}" if self.road else "",
            self.obstacle,
            self.signal,
            f"{self.speed:g} km/h" if self.speed is not None else "",
            self.run,
        )
        return ", ".join(filter(None, parts))
