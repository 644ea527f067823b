"""Target: a figure of a ride with its limit, one table of a targets file."""

import fnmatch
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.runs.figures.chosen_figure import ChosenFigure


@dataclass(frozen=True, kw_only=True, slots=True)
class Target(ChosenFigure):
    """Figure of a ride, see `ChosenFigure`, with its limit.

    Attributes:
        unit: unit of the limit; must be that of the figure.
        at_most, at_least: limit; one of the two.
        road, obstacle, signal: only runs on this class of ISO 8608, on obstacles whose text begins so, or with this
            file as their signal.
        speed: only runs at this speed [km/h].
        run: only runs with this folder name, a pattern with *.
        words: name on the page; that of the table by default.
        weight: weight of a violation in a search for the smallest change [-].
        source: where the limit comes from.

    Raises:
        ConfigurationError: see `ChosenFigure`; no limit, or two.
    """

    unit: str
    at_most: float | None = None
    at_least: float | None = None
    road: str = ""
    obstacle: str = ""
    signal: str = ""
    speed: float | None = None
    run: str = ""
    words: str = ""
    weight: float = 1.0
    source: str = ""

    def __post_init__(self) -> None:
        ChosenFigure.__post_init__(self)
        if (self.at_most is None) == (self.at_least is None):
            raise ConfigurationError("Target.at_most: set exactly one of at_most and at_least")
        if not (math.isfinite(self.limit) and self.weight > 0.0):
            raise ConfigurationError(
                f"Target.at_most: found limit {self.limit:g} and weight {self.weight:g}; both must be "
                "finite, the weight above 0"
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
        """Return True if a run belongs to the target.

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
