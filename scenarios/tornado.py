"""Sensitivity of comfort to all parameters, each changed by -20 and +20 %, on both roads in a tornado chart.

python -m scenarios.tornado [--output DIR] [--quick] [--jobs N] [--engine auto|reduced|mujoco] [--records N]
    [--vehicle FILE.toml] [--set PATH=VALUE]
"""

import argparse
import sys
import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.charts import figure_file
from scenarios.claims import DUPLICATE, Claim, Findings, markdown
from scenarios.comfort_runs import ComfortRuns, Point, Variation, comfort_options, records_of
from scenarios.comfort_sensitivity.figures import number, setting
from scenarios.signals.exact_road import ROAD_RMS
from scenarios.study import QUICK_NOTE, car_study
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.ride_comfort import WEIGHTED


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run all cars on both roads, write the chart into the folder, and return the findings."""
    comfort = ComfortRuns(runs, records_of(options), folder / "sweep")
    started = clock.perf_counter()
    bars = all_bars(comfort)
    seconds = clock.perf_counter() - started
    draw_tornado(folder / "tornado.png", comfort, bars)
    notes = [
        *setting(comfort),
        f"{comfort.computed} runs of {comfort.records.duration:g} s, computed in {seconds:.1f} s with --jobs "
        f"{runs.jobs}.",
        bar_table(bars),
    ]
    return Findings(
        title="Comfort against all parameters of the suspension and the stiffness of the body (beyond Bommer 2006)",
        claims=tornado_claims(bars),
        tyres=comfort.tyres,
        notes=[*notes, *([QUICK_NOTE] if options.quick else [])],
        data={
            "bars": [asdict(bar) for bar in bars],
            "engine": comfort.engine,
            "records": asdict(comfort.records),
            "seconds": seconds,
        },
    )


main = car_study("tornado", study, comfort_options)


SHARE = 0.2
"""Change of each parameter, down and up."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """A parameter of the chart."""

    label: str  # with its unit
    path: str  # of the parameter
    ends: tuple[float, float] | None = None  # its two values, where they are not the nominal one -20 and +20 %
    reason: str = ""  # why not
    power: float = 1.0  # the value follows (1 -+ 20 %) to this power


PARAMETERS = (
    Parameter(label="Coulomb friction Fd [N]", path="damper.coulomb_friction"),
    Parameter(label="damper constant D [N s/m]", path="damper.viscous"),
    Parameter(label="suspension mount stiffness, z [N/m]", path="bushings.suspension_mount.stiffness.z"),
    Parameter(
        label="suspension mount damping, z [N s/m]",
        path="bushings.suspension_mount.damping.z",
        ends=(0.0, 500.0),
        reason="nominal 0, so from there to the first step of Bommer 2006",
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
    """Parameter with the comfort values at its two ends."""

    label: str  # with its unit
    nominal: float  # nominal, low, high: values of the parameter
    low: float
    high: float
    reason: str  # reason for ends other than -20 and +20 %
    at_low: Mapping[str, Point]  # at_low, at_high: road to point at each end; the error is NaN for a single record
    at_high: Mapping[str, Point]

    def swing(self, road: str) -> float:
        """Return largest minus smallest relative comfort value, including the nominal car [-]."""
        values = (self.at_low[road].relative, self.at_high[road].relative, 1.0)
        return max(values) - min(values)


def variation(vehicle: Vehicle, parameter: Parameter) -> Variation:
    """Return the two values of a parameter, low end first."""
    nominal, power = value_of(vehicle, parameter.path), parameter.power
    values = parameter.ends or ((1.0 - SHARE) ** power * nominal, (1.0 + SHARE) ** power * nominal)
    return Variation(name=parameter.path, label=parameter.label, path=parameter.path, values=values)


def all_bars(comfort: ComfortRuns) -> list[Bar]:
    """Return the bars of all parameters, sorted by their largest swing on either road."""
    vehicle, bars = comfort.runs.car().vehicle, []
    varied = {parameter: variation(vehicle, parameter) for parameter in PARAMETERS}
    comfort([case for each in varied.values() for case in comfort.all_cases(each)])
    for parameter, each in varied.items():
        curves = comfort.curves(each)
        at_low, at_high = ({road: points[end] for road, points in curves.items()} for end in (0, 1))
        points = {"nominal": value_of(vehicle, parameter.path), "low": each.values[0], "high": each.values[1]}
        bars.append(Bar(label=parameter.label, reason=parameter.reason, at_low=at_low, at_high=at_high, **points))
    return sorted(bars, key=lambda bar: -max(bar.swing(road) for road in ROAD_RMS))


WAYS = (
    ("Coulomb friction", "lower friction, more comfort", True),
    ("suspension mount damping", "more damping, more comfort", False),
    ("suspension mount stiffness", "stiffer mount, more comfort", False),
)
"""Conclusions of section 4.4: parameter, statement, whether the comfort value rises with the parameter."""


def tornado_claims(bars: Sequence[Bar]) -> list[Claim]:
    """Return the rows on the conclusions of section 4.4 at the ends of the bars."""
    claims = []
    for name, statement, rising in WAYS:
        bar = next(bar for bar in bars if bar.label.startswith(name))
        pairs = {road: (bar.at_low[road].relative, bar.at_high[road].relative) for road in ROAD_RMS}
        claims.append(
            DUPLICATE.statement(
                f"comfort and {name}, both roads",
                statement,
                ", ".join(f"{road} {100.0 * low:.1f} to {100.0 * high:.1f} %" for road, (low, high) in pairs.items()),
                all((high > low) == rising for low, high in pairs.values()),
                f"relative comfort value from {bar.low:g} to {bar.high:g}",
            ).at("chapter 4", "tornado.png")
        )
    return claims


def bar_table(bars: Sequence[Bar]) -> str:
    """Return the bars as a Markdown table."""
    head = [
        cell
        for road in ROAD_RMS
        for cell in (f"{road}: comfort value at the low, high end [%]", "swing [points]", f"{WEIGHTED} [%]")
    ]
    rows = []
    for bar in bars:
        row = [bar.label + (f" ({bar.reason})" if bar.reason else ""), f"{bar.nominal:g}", f"{bar.low:g}, {bar.high:g}"]
        for road in ROAD_RMS:
            both = (bar.at_low[road], bar.at_high[road])
            row.append(
                ", ".join(f"{100.0 * point.relative:.2f} ± {number(100.0 * point.relative_error)}" for point in both)
            )
            row.append(f"{100.0 * bar.swing(road):.1f}")
            row.append(", ".join(f"{100.0 * point.relative_weighted:.2f}" for point in both))
        rows.append(row)
    return markdown(["parameter", "nominal", "low, high end", *head], rows)


LOW_COLOUR, HIGH_COLOUR = COLOURS[0], COLOURS[3]


def draw_tornado(path: Path, comfort: ComfortRuns, bars: Sequence[Bar]) -> None:
    """Write the chart: a row for each parameter, a column for each road, the largest swing on top."""
    levels = " and ".join(f"{1e3 * rms:g} mm RMS ({road})" for road, rms in ROAD_RMS.items())
    caption = (
        f"Change of the comfort value (RMS of the seat rail, x, y and z, unweighted, {COMFORT_BAND[0]:g} to "
        f"{COMFORT_BAND[1]:g} Hz) against the nominal car on the same records. Roads of {levels} under the "
        f"{comfort.runs.car().vehicle.wheel_text(comfort.runs.wheel)}, {comfort.text()}. Whiskers: two standard errors "
        "of the ratio over the records. Numbers: values of the parameter, -20 and +20 % of the nominal one but for "
        "mount damping (from its nominal 0) and body stiffness (frequencies with its square root). Order: largest "
        "swing on either road"
    )
    height = np.arange(len(bars))[::-1]
    with figure_file(
        path, (11.0, 1.8 + 0.62 * len(bars)), "Comfort sensitivities of the car (beyond Bommer 2006)", caption
    ) as figure:
        axes = figure.subplots(1, len(ROAD_RMS), sharex=True, sharey=True)
        for axis, road in zip(axes, ROAD_RMS, strict=True):
            for label, colour, shift, points, values in (
                ("low end", LOW_COLOUR, 0.19, [bar.at_low[road] for bar in bars], [bar.low for bar in bars]),
                ("high end", HIGH_COLOUR, -0.19, [bar.at_high[road] for bar in bars], [bar.high for bar in bars]),
            ):
                change = np.array([100.0 * (point.relative - 1.0) for point in points])
                error = 200.0 * np.nan_to_num([point.relative_error for point in points])
                axis.barh(
                    height + shift, change, 0.36, xerr=error, color=colour, label=label, ecolor="#222222", capsize=2
                )
                for y, x, spread, value in zip(height + shift, change, error, values, strict=True):
                    away = 3 if x >= 0.0 else -3
                    axis.annotate(
                        np.format_float_positional(value, precision=4, fractional=False, trim="-"),
                        (x + np.sign(away) * spread, y),
                        xytext=(away, 0),
                        textcoords="offset points",
                        ha="left" if x >= 0.0 else "right",
                        va="center",
                        fontsize=7,
                    )
            axis.axvline(0.0, color="#222222", linewidth=0.8)
            axis.set(title=f"{road} road", xlabel="change of the comfort value [%], lower is better")
            axis.grid(visible=False, axis="y")
            axis.margins(x=0.16)
        axes[0].set_yticks(height, [bar.label for bar in bars])
        axes[1].legend(loc="lower right")


if __name__ == "__main__":
    sys.exit(main())
