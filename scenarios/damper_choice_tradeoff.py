"""Road holding, comfort and suspension travel against damping on roads of ISO 8608."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.chart import chart
from vehicle.analysis.weighting import weighting
from vehicle.lumped.ride_measures import RideMeasures, ride_measures
from vehicle.lumped.road_spectrum import ROAD_CLASSES, iso_8608_density
from vehicle.parameters.damper_choice import RoadHoldingQuarterCar

Array = npt.NDArray[np.float64]

SPEED = 80.0 / 3.6
"""Speed on the roads of ISO 8608 [m/s], assumed."""

EDGES = np.geomspace(0.1, 50.0, 801)
"""Edges of the intervals of integration [Hz]; twice as many change no measure by more than 0.1 %."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TradeOff:
    """Measures of one car over damping for every road class."""

    damping: Array
    """[N s/m], shape (m,)."""
    measures: dict[str, list[RideMeasures]]
    """Road class -> one for each damping."""
    own: float
    """Damping of the car itself [N s/m]."""

    def best(self, name: str) -> float:
        """Damping of the least value of a measure: the same for every class, for all densities are proportional."""
        return float(self.damping[np.argmin([getattr(one, name) for one in self.measures["A"]])])


def trade_off(car: RoadHoldingQuarterCar, damping: npt.ArrayLike) -> TradeOff:
    """Measures of a quarter car over damping on all classes of ISO 8608.

    Args:
        car: quarter car.
        damping: damper coefficients [N s/m].
    """
    lines = np.asarray(np.sqrt(EDGES[1:] * EDGES[:-1]), dtype=np.float64)
    width = np.diff(EDGES)
    coefficients = np.asarray(damping, dtype=np.float64)
    weight = weighting("Wk").spectrum_factor(lines)
    return TradeOff(
        damping=coefficients,
        measures={
            name: [
                ride_measures(car, c, lines, iso_8608_density(name, SPEED, lines), width, weight)
                for c in coefficients.tolist()
            ]
            for name in ROAD_CLASSES
        },
        own=car.wheel.suspension_damping,
    )


def trade_off_figure(path: Path, found: TradeOff, name: str) -> None:
    """One figure: the three measures over damping, and comfort against road holding."""
    from matplotlib import colormaps

    caption = (
        f"{name} on roads of ISO 8608, classes A to H, {3.6 * SPEED:.0f} km/h, linear model: every class doubles all "
        "values. Ring: the car's own damper; square: least tyre load; triangle: best comfort. Above the dashed line "
        "(1/3 of the static load) the tyre leaves the road now and then and the linear values no longer hold."
    )
    colors = colormaps["viridis"](np.linspace(0.0, 0.9, len(ROAD_CLASSES)))
    quantities = (
        ("tyre_load", 1.0, "RMS tyre force / static load [-]"),
        ("acceleration", 1.0, "RMS body acceleration, Wk [m/s$^2$]"),
        ("travel", 1e3, "RMS suspension travel [mm]"),
    )
    with chart(path, caption, rows=2, columns=2, size=(12.0, 9.0)) as panels:
        for (road, row), color in zip(found.measures.items(), colors, strict=True):
            values = {key: factor * np.array([getattr(one, key) for one in row]) for key, factor, _ in quantities}
            for panel, (key, _, label) in zip(panels, quantities, strict=False):
                panel.semilogy(found.damping, values[key], color=color, linewidth=1.4)
                panel.set_xlabel("damping [N s/m]")
                panel.set_ylabel(label)
                panel.annotate(road, (found.damping[-1], values[key][-1]), fontsize=9, color=color)
            last = panels[3]
            last.loglog(values["acceleration"], values["tyre_load"], color=color, linewidth=1.4)
            for damping, marker in (
                (found.own, "o"),
                (found.best("tyre_load"), "s"),
                (found.best("acceleration"), "^"),
            ):
                x = np.interp(damping, found.damping, values["acceleration"])
                y = np.interp(damping, found.damping, values["tyre_load"])
                ring = marker == "o"  # stays visible where it coincides with a best one
                size, fill = (9, "none") if ring else (4, "full")
                last.plot(x, y, marker, color=color, markersize=size, fillstyle=fill)
            last.annotate(road, (values["acceleration"][-1], values["tyre_load"][-1]), fontsize=9, color=color)
        panels[0].axhline(1.0 / 3.0, color="#888888", linestyle="--", linewidth=0.9)
        panels[3].axhline(1.0 / 3.0, color="#888888", linestyle="--", linewidth=0.9)
        for panel in panels[:3]:
            panel.axvline(found.own, color="#888888", linestyle=":", linewidth=0.9)
        panels[3].set_xlabel("RMS body acceleration, Wk [m/s$^2$]")
        panels[3].set_ylabel("RMS tyre force / static load [-]")
        panels[3].set_title("comfort against road holding, damping along each curve", fontsize=10)
