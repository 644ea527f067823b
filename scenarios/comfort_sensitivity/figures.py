"""Figures of the comfort study, histories, spectra, relative comfort (4.1 to 4.12 of Bommer 2006), and its tables."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.charts import figure_file
from scenarios.claims import markdown
from scenarios.comfort_runs import Changes, ComfortRuns, Curves, Point, Variation, chosen_engine
from scenarios.comfort_sensitivity.claims import PUBLISHED
from scenarios.comfort_sensitivity.histories import MEASURED_PEAKS, SPECTRUM_WINDOW_S, RoadLevels
from scenarios.signals.exact_road import RATE_HZ, ROAD_EDGE_HZ, ROAD_RMS, velocity_density
from scenarios.study import car_text
from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.drawing.rendering.placed_axes import Margins, placed_axes
from vehicle.model.parameters.paths import value_of
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.spectra import power_spectral_density
from vehicle.signals.excitation.slip_set import sets_text

EXCERPT_S = (27.0, 27.5)
"""Time shown by Bommer 2006 [s]."""

WINDOW_S = 4.0
"""Length of the windows of the spectra [s]."""

MARGINS = Margins(left=1.0, right=0.12, bottom=1.22, top=0.62, across=0.55, down=0.52)
"""Margins of the axes of a variation, with space for a caption of five lines."""

ROAD_COLOURS = {"smooth": COLOURS[0], "rough": COLOURS[3]}

SHOWN = 5
"""Most values of a parameter whose histories and spectra are drawn."""


def draw_variation(
    path: Path,
    comfort: ComfortRuns,
    variation: Variation,
    curves: Curves,
    *,
    base: Changes = (),
    title: str = "",
    beside: Mapping[str, Curves] | None = None,
) -> None:
    """Write the figure of a parameter: seat rail over time, its spectrum, relative comfort; a column for each road."""
    cars = comfort.cars(variation, base)
    step = max(1, -(-len(cars) // SHOWN))
    shown = {value: car for index, (value, car) in enumerate(cars.items()) if index % step == 0}
    nominal = value_of(comfort.runs.car().vehicle, variation.path)
    engine = chosen_engine("auto")
    numbers = f"figures {variation.figures}" if variation.figures else "beyond the source"
    heading = title or f"Comfort against {variation.label} ({numbers})"
    spectra = f"spectra: Welch, Hann windows of {WINDOW_S:g} s, half overlapping, first record"
    caption = (
        f"Roads of {_levels()}, under the {comfort.runs.car().vehicle.wheel_text(comfort.runs.wheel)}. Histories and "
        f"{spectra}, engine {engine}. "
        f"Comfort: RMS of the seat rail, x, y and z, unweighted, {COMFORT_BAND[0]:g} to {COMFORT_BAND[1]:g} Hz, "
        f"relative to the reference on the same records; mean of {comfort.text()}; "
        f"bars: two standard errors over the records"
    )
    with figure_file(path, (10.4, 10.4), heading, caption, placed=True) as figure:
        axes = placed_axes(figure, MARGINS, widths=(1.0, 1.0), heights=(1.0, 1.0, 1.0))
        for (history, spectrum, relative), road in zip(axes.T, ROAD_RMS, strict=True):
            rails = comfort.histories(list(shown.values()), road, engine=engine)
            for value, rail, colour in zip(shown, rails, COLOURS, strict=False):
                look = {
                    "color": colour,
                    "label": f"{value:g}{' (reference)' if value == nominal else ''}",
                    "linewidth": 1.0,
                }
                _history(history, rail, look)
                _spectrum(spectrum, rail, comfort.records.lead, look)
            history.set_title(f"{road} road")
            _legend_above(history)
            _comfort(relative, curves[road], ROAD_COLOURS[road], "this car" if beside else None)
            for (label, others), style in zip((beside or {}).items(), ("--", ":"), strict=False):
                _comfort(relative, others[road], "#555555", label, style)
            ends = {} if base else PUBLISHED.get((variation.name, road), {})
            if ends:
                middle = [0.5 * (low + high) for low, high in ends.values()]
                half = [0.5 * (high - low) for low, high in ends.values()]
                look = {"fmt": "none", "color": COLOURS[1], "linewidth": 4.0, "alpha": 0.6}
                relative.errorbar(list(ends), middle, yerr=half, label="published, interval of the axis", **look)
            if beside or ends:
                # The corner that neither a rising nor a falling curve nor an end of it reaches.
                relative.legend(loc="lower right" if curves[road][-1].relative > 1.0 else "lower left")
            relative.set_xlabel(variation.label)
        axes[0, 0].set_ylabel("seat rail, z [m/s²]")
        axes[1, 0].set_ylabel("PSD of the seat rail, z [(m/s²)²/Hz]")
        axes[2, 0].set_ylabel("relative comfort value [%],\nlower is better")


def draw_wheel(path: Path, comfort: ComfortRuns, levels: Mapping[str, RoadLevels]) -> None:
    """Write the figure of the spectra of the wheel on both roads, with what was measured on asphalt and cobbles."""
    caption = (
        f"Vertical acceleration of the knuckle over the plate, nominal car, {comfort.records.text()}; Welch, Hann "
        f"windows of {SPECTRUM_WINDOW_S:g} s, half overlapping. "
        "Dashed: peaks measured with a car and on roads that are not described"
    )
    title = "Power spectral density of the wheel's vertical acceleration (figure 2.1)"
    with figure_file(path, (7.6, 5.0), title, caption) as figure:
        axis = figure.subplots()
        for (road, level), (surface, measured) in zip(levels.items(), MEASURED_PEAKS.items(), strict=True):
            colour = ROAD_COLOURS[road]
            shown = (level.frequency >= 1.0) & (level.frequency <= 50.0)
            axis.plot(level.frequency[shown], level.wheel[shown], color=colour, label=f"{road} road")
            axis.axvline(measured, color=colour, linestyle="--", linewidth=0.9, label=f"measured on {surface}")
        axis.set(xscale="log", yscale="log", xlim=(1.0, 50.0))
        axis.set(xlabel="frequency [Hz]", ylabel="PSD of the knuckle, z [(m/s²)²/Hz]")
        axis.legend(loc="upper left")


def _history(axis: Any, rail: Vector, look: Mapping[str, Any]) -> None:
    last = min(round(EXCERPT_S[1] * RATE_HZ), rail.size - 1)
    shown = np.arange(last - round((EXCERPT_S[1] - EXCERPT_S[0]) * RATE_HZ), last + 1)
    axis.plot(shown / RATE_HZ, rail[shown], **look)
    axis.set_xlabel("time [s]")


def _legend_above(axis: Any) -> None:
    """Draw a legend above the curves, with the axis extended for it."""
    low, high = axis.get_ylim()
    axis.set_ylim(low, high + 0.3 * (high - low))
    axis.legend(loc="upper center", ncols=3, fontsize=7)


def _spectrum(axis: Any, rail: Vector, lead: float, look: Mapping[str, Any]) -> None:
    record = rail[round(lead * RATE_HZ) + 1 :]
    spectrum = power_spectral_density(1.0 / RATE_HZ, record, window_s=min(WINDOW_S, record.size / RATE_HZ))
    inside = (spectrum.frequency >= COMFORT_BAND[0]) & (spectrum.frequency <= COMFORT_BAND[1])
    axis.plot(spectrum.frequency[inside], spectrum.density[0, inside], **look)
    axis.set(yscale="log", xlim=COMFORT_BAND, xlabel="frequency [Hz]")
    axis.tick_params(which="minor", labelleft=False)


def _comfort(axis: Any, points: Sequence[Point], colour: str, label: str | None, style: str = "-") -> None:
    axis.errorbar(
        [point.value for point in points],
        [100.0 * point.relative for point in points],
        yerr=_two_errors([point.relative_error for point in points]),
        color=colour,
        linestyle=style,
        marker="o",
        markersize=3.5,
        capsize=2.5,
        label=label,
    )


def _two_errors(errors: Sequence[float]) -> list[float]:
    """Return two standard errors [%] of each point; 0 for a single record, which has no error."""
    return [200.0 * float(np.nan_to_num(error)) for error in errors]


def _levels() -> str:
    return " and ".join(f"{1e3 * rms:g} mm RMS ({road})" for road, rms in ROAD_RMS.items())


def setting(comfort: ComfortRuns) -> list[str]:
    """Return the paragraphs on the conditions for `results.md`."""
    slip_velocity = comfort.runs.car().vehicle.damper.slip_velocity
    levels = ", ".join(
        f"{road} {1e3 * rms:g} mm RMS (velocity PSD {velocity_density(rms):.3g} (m/s)²/Hz)"
        for road, rms in ROAD_RMS.items()
    )
    errors = ", ".join(
        f"{road} {100.0 * numbers.comfort_error / numbers.comfort:.2f} % over the records, "
        f"{100.0 * numbers.gaussian_error / numbers.comfort:.2f} % as a Gaussian road"
        for road, numbers in comfort.nominal().items()
    )
    return [
        f"Made with {car_text(comfort.runs)}; engine {comfort.engine}. Roads: {levels}, {ROAD_EDGE_HZ:g} to 50 Hz, "
        f"lines of exact level and random phase, {comfort.records.text()}; every car runs on the same records.",
        f"Standard error of the comfort value of the nominal car: {errors} (1/2 sqrt(int S² df / T) / int S df, which "
        "would hold if the amplitudes of the lines were random too). ± behind a number is one standard error over the "
        "records; that of a ratio is over the ratios of the single records.",
        f"Slip shares: time with the damper over the shaker above {1e3 * slip_velocity:g} mm/s, above 1 mm/s, "
        "and the other one. Lowest load: of the tyre on the shaker.",
        sets_text(),
        "The tyre is a linear spring, as in the source: where its load is negative it pulls.",
    ]


def curve_table(label: str, curves: Curves) -> str:
    """Return the relative comfort of a variation on both roads as a Markdown table."""
    columns = (
        "relative comfort value [%],\nlower is better",
        "comfort value [m/s²]",
        "slip shares [%]",
        "lowest load [N] (time below 0)",
    )

    def cells(point: Point) -> tuple[str, ...]:
        return (
            f"{100.0 * point.relative:.2f} ± {number(100.0 * point.relative_error)}",
            f"{point.comfort:.4f} ± {number(point.comfort_error, 4)}",
            f"{100.0 * point.slip:.1f}, {100.0 * point.saturated:.1f}, {100.0 * point.slip_left:.1f}",
            f"{point.lowest_load:.0f} ({100.0 * point.pulling:.2g} %)",
        )

    head = [f"{road}: {name}" if name == columns[0] else name for road in curves for name in columns]
    rows = zip(*curves.values(), strict=True)
    return markdown(
        [label, *head], [[f"{row[0].value:g}", *(cell for point in row for cell in cells(point))] for row in rows]
    )


def number(value: float, digits: int = 2) -> str:
    """Return a standard error as a text, or a question mark for a single record."""
    return f"{value:.{digits}f}" if np.isfinite(value) else "?"


def plain(curves: Mapping[str, Curves]) -> dict[str, dict[str, list[dict[str, float]]]]:
    """Return all points of variations as plain data for a JSON file."""
    return {
        name: {road: [asdict(point) for point in points] for road, points in by_road.items()}
        for name, by_road in curves.items()
    }
