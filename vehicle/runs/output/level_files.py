"""Files of the periodic states of a car over frequency and level: tables, pictures and summary."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import aligned, finite, number
from vehicle.drawing.rendering.level_plot import LevelPicture, plot_level_damping, plot_level_map
from vehicle.names import channel_words, side_of
from vehicle.runs.car.levels import LevelMap
from vehicle.runs.output.folder import output_folder, write_files, write_json
from vehicle.signals.formats.csv_table import table_text

DRAWN = 7
"""Number of levels whose FRFs are drawn."""

AROUND = 1.5
"""Default band of the peak: its frequency at the lowest level over this, and times this."""

SEVERAL = 2
"""Number of dampers from which each axle has one line, of the damper that slips first."""


@dataclass(frozen=True, slots=False)
class LevelReport:
    """Summary of a map: peak and mode of its first channel, and the slip levels of its dampers.

    Attributes:
        states: the map.
        band: band of the peak [Hz]; by default around the peak at the lowest level that falls most.
    """

    states: LevelMap
    band: tuple[float, float] | None = None

    @cached_property
    def near(self) -> float:
        """Return the frequency of the peak, see `LevelMap.falling_peak` [Hz]."""
        return self.states.falling_peak(*(self.band or (0.0, np.inf)))

    @property
    def around(self) -> tuple[float, float]:
        """Return the band of the peak [Hz]."""
        return self.band or (self.near / AROUND, self.near * AROUND)

    @cached_property
    def peaks(self) -> tuple[Vector, Vector]:
        """Return frequency [Hz] and height of the highest FRF value in the band; NaN at its ends; (l,) each."""
        inside = (self.states.frequency >= self.around[0]) & (self.states.frequency <= self.around[1])
        if np.sum(inside) < 3:
            nothing = np.full(len(self.states.level), np.nan)
            return nothing, nothing
        return self.states.peaks(*self.around)

    @cached_property
    def mode(self) -> tuple[Vector, Vector]:
        """Return frequency [Hz] and damping ratio of the mode at each level, NaN for a car without this mode."""
        dampers = self.states.car.vehicle.composition.dampers
        if any(damper.law.friction_law == "presliding" for damper in dampers) or self.unit != "m/s2":
            nothing = np.full(len(self.states.level), np.nan)
            return nothing, nothing
        return self.states.mode(self.near)

    @property
    def unit(self) -> str:
        """Return the unit of the first channel."""
        return self.states.units[self.states.channels[0]]

    @property
    def per_level(self) -> str:
        """Return the unit of the FRF of the first channel."""
        return f"({self.unit})/{in_brackets(self.states.driven.unit)}"

    def words(self, damper: str) -> str:
        """Return a damper by its position: "rear left damper"."""
        position = side_of(damper.removeprefix("damper_"), self.states.car.vehicle.wheels)
        return f"{position} damper" if position != damper else damper

    @cached_property
    def lines(self) -> dict[str, Vector]:
        """Return the shown level at which each damper, or the first of an axle, begins to slip; (f,) each."""
        slips = self.states.driven.shown[0] * self.states.unsticking
        sliding = {name: line for name, line in zip(self.states.dampers, slips, strict=True) if np.isfinite(line).any()}
        if len(slips) <= SEVERAL:
            return {f"{self.words(name)} begins to slip": line for name, line in sliding.items()}
        axles: dict[str, list[Vector]] = {}
        for name, line in sliding.items():
            axles.setdefault(self.words(name).split()[0], []).append(line)
        return {f"{axle}: the first damper begins to slip": np.fmin.reduce(lines) for axle, lines in axles.items()}

    def first_slip(self) -> dict[str, tuple[float, float]]:
        """Return the lowest shown level at which each damper begins to slip, and its frequency [Hz], by damper."""
        slips = {name: line for name, line in zip(self.states.dampers, self.states.unsticking, strict=True)
                 if np.isfinite(line).any()}  # fmt: skip
        factor = self.states.driven.shown[0]
        return {name: (factor * float(np.nanmin(line)), float(self.states.frequency[np.nanargmin(line)]))
                for name, line in slips.items()}  # fmt: skip

    def damping(self) -> dict[str, Vector]:
        """Return the damping constant of the same energy of each damper at the frequency of the peak; (l,) each."""
        return {
            self.words(name): np.array([np.interp(self.near, self.states.frequency, values) for values in each.T])
            for name, each in zip(self.states.dampers, self.states.equivalent, strict=True)
        }

    def picture(self, channel: int) -> LevelPicture:
        """Return the data of the pictures of a channel."""
        states, name = self.states, self.states.channels[channel]
        unit = states.units[name].replace("m/s2", "m/s²")
        per = in_brackets(states.driven.unit).replace("m/s2", "m/s²")
        return LevelPicture(
            frequency=states.frequency,
            level=self.shown_levels,
            amplitude=states.driven.amplitude,
            size=np.abs(states.frf[channel]),
            label=f"{channel_words(name)}, first harmonic / {'force' if states.driven.forces else 'plate'} "
            f"[({unit})/{per}]",
            slipping=self.lines,
            outside=states.outside,
        )

    @property
    def rows(self) -> list[int]:
        """Return the indices of the drawn levels: the last at which all dampers stick, and higher levels."""
        lowest = np.nanmin(self.states.unsticking, initial=np.inf)
        count, first = len(self.states.level), max(0, int(np.searchsorted(self.states.level, lowest)) - 1)
        first = first if first < count - 1 else 0
        return sorted({round(index) for index in np.linspace(first, count - 1, min(DRAWN, count)).tolist()})

    def proof(self) -> str:
        """Return the frequencies at which the state is proven to be the only one, in words."""
        proven, count = int(np.sum(self.states.unique)), len(self.states.frequency)
        where = "at all frequencies" if proven == count else f"at {proven} of {count} frequencies"
        return f"no other periodic state: {f'proven {where}' if proven else 'not proven'}"

    @property
    def shown_levels(self) -> Vector:
        """Return the levels for a reader, in mm where they are displacements; (l,)."""
        return np.asarray(self.states.driven.shown[0] * self.states.level)


def in_brackets(unit: str) -> str:
    """Return a unit as a denominator, in brackets if it is a quotient or a product."""
    return unit if unit.isalpha() else f"({unit})"


def chart_text(states: LevelMap, caption: str) -> str:
    """Return the table of all points as CSV text; points without a result have empty cells."""
    factor, shown = states.driven.shown
    per = in_brackets(states.driven.unit)
    heads = ["frequency [Hz]", f"level [{shown}]", "ended"]
    columns = []
    for index, name in enumerate(states.channels):
        unit = states.units[name]
        heads += [f"{name} FRF [({unit})/{per}]", f"{name} phase [deg]", f"{name} RMS [{unit}]",
                  f"{name} peak [{unit}]", f"{name} distortion [%]"]  # fmt: skip
        columns += [np.abs(states.frf[index]), np.degrees(np.angle(states.frf[index])), states.rms[index],
                    states.peak[index], 100.0 * states.distortion[index]]  # fmt: skip
    for index, name in enumerate(states.dampers):
        heads += [f"{name} slip share [%]", f"{name} energy per cycle [J]", f"{name} damping constant [N s/m]"]
        columns += [100.0 * states.slip[index], states.energy[index], states.equivalent[index]]
    rows = [
        [frequency, factor * level, int(states.ended[at, row]), *(empty_or(column[at, row]) for column in columns)]
        for at, frequency in enumerate(states.frequency.tolist())
        for row, level in enumerate(states.level.tolist())
    ]
    return table_text([heads, *rows], [caption], digits=7)


def empty_or(value: float) -> float | str:
    """Return a number for a table, empty for NaN."""
    return float(value) if np.isfinite(value) else ""


def slip_text(states: LevelMap, caption: str) -> str:
    """Return the table of the levels at which the dampers begin to slip as CSV text."""
    factor, shown = states.driven.shown
    heads = ["frequency [Hz]", *(f"{name} slips from [{shown}]" for name in states.dampers)]
    rows = [[at, *map(empty_or, factor * values)] for at, values in zip(states.frequency.tolist(), states.unsticking.T,
                                                                  strict=True)]  # fmt: skip
    return table_text([heads, *rows], [caption], digits=7)


def cut_name(frequency: float) -> str:
    """Return the name of the file of a cut."""
    return f"cut_{frequency:g}Hz.csv"


def summary_of(report: LevelReport, files: Sequence[str]) -> dict[str, Any]:
    """Return the content of summary.json."""
    states = report.states
    (at, height), (natural, ratio), levels = report.peaks, report.mode, report.shown_levels.tolist()
    return {
        "car": states.car.vehicle.name,
        "overrides": list(states.car.overrides),
        "input": states.driven.words,
        "shares": {name: [share.real, share.imag] for name, share in states.driven.shares.items()},
        "frequency_hz": states.frequency.tolist(),
        "level_unit": states.driven.shown[1],
        "level": levels,
        "channels": list(states.channels),
        "points": int(states.ended.size),
        "without_result": int(np.sum(~states.ended)),
        "iterations": {"mean": float(states.iterations.mean()), "largest": int(states.iterations.max())},
        "only_one_state_proven": states.unique.tolist(),
        "first_slip": {
            name: {"level": level, "frequency_hz": at} for name, (level, at) in report.first_slip().items()
        },
        "band_hz": list(report.around),
        "peak": [
            {"level": level, "frequency_hz": finite(f), "frf": finite(value), "mode_hz": finite(mode),
             "damping_ratio": finite(share)}
            for level, f, value, mode, share in zip(levels, at, height, natural, ratio, strict=True)
        ],
        "notices": states.notices,
        "files": list(files),
    }  # fmt: skip


def write_levels(
    folder: Path,
    report: LevelReport,
    cuts: Mapping[float, LevelMap],
    *,
    force: bool = False,
    figures: bool = True,
    protect: tuple[Path, ...] = (),
) -> list[str]:
    """Write chart.csv, slip.csv, the cuts, the pictures and summary.json, all or none; return their names.

    Args:
        folder: folder of the results.
        report: the map and what is read from it.
        cuts: maps at single frequencies [Hz].
        force: replace the files of an earlier run.
        figures: write pictures.
        protect: input files.
    """
    states = report.states
    title = f"{states.car.vehicle.name}, {states.driven.words}"
    caption = (
        f"periodic states, first harmonic; {int(np.sum(states.ended))} of {states.ended.size} points; {report.proof()}"
    )
    contents: dict[str, Any] = {
        "chart.csv": chart_text(states, f"{title}; {caption}"),
        "slip.csv": slip_text(states, f"{title}; level from which each damper slips, empty outside the levels"),
        **{cut_name(at): chart_text(cut, f"{title}; {caption}") for at, cut in cuts.items()},
    }
    if figures and np.isfinite(states.frf[0]).any():
        for index, name in enumerate(states.channels):
            file = "levels.png" if not index else f"levels_{name}.png"
            contents[file] = partial(
                plot_level_map, data=report.picture(index), rows=report.rows, title=title, caption=caption
            )
        if len(states.level) > 1 and len(states.frequency) > 2:
            contents["damping.png"] = partial(_draw_damping, report=report, title=title)
    files = [*contents, "summary.json"]
    with output_folder(folder, force=force, protect=protect) as work:
        write_files(work, contents)
        write_json(work / "summary.json", summary_of(report, files))
    return files


def _draw_damping(path: Path, report: LevelReport, title: str) -> None:
    """Draw the damping over the level."""
    matrices = report.states.car.matrices
    viscous = dict(zip(map(report.words, report.states.dampers), matrices.viscous.tolist(), strict=True))
    plot_level_damping(
        path, report.picture(0), band=report.around, peaks=report.peaks, mode=report.mode, damping=report.damping(),
        viscous=viscous, distortion=report.states.distortion[0], title=title,
        caption=f"Dampers at {number(report.near)} Hz: viscous ones of the same energy, mean(F v)/mean(v²)",
    )  # fmt: skip


def printed(report: LevelReport, folder: Path | None, files: Sequence[str]) -> str:
    """Return the printed summary."""
    states = report.states
    left, shown = int(np.sum(~states.ended)), states.driven.shown[1]
    lines = [
        f"{states.car.vehicle.name}, {states.driven.words}; {_range('frequencies', states.frequency, 'Hz')}, "
        f"{_range('levels', report.shown_levels, shown)}",
        f"results: {states.ended.size - left} of {states.ended.size} points, {number(states.iterations.mean(), 2)} "
        f"iterations each; {report.proof()}",
    ]
    heads, table = peak_table(report)
    lines += slip_lines(report)
    lines += [f"{channel_words(states.channels[0])}, {number(report.around[0])} to {number(report.around[1])} Hz:"]
    lines += aligned([heads, *table], left=0)
    return "\n".join([*lines, *([f"files: {folder}: {', '.join(files)}"] if folder else [])])


def slip_lines(report: LevelReport) -> list[str]:
    """Return the first slip of each damper in words."""
    return [
        f"{report.words(name)}: slips first at {number(at)} Hz, from {number(level)} {report.states.driven.shown[1]} on"
        for name, (level, at) in report.first_slip().items()
    ]


def peak_table(report: LevelReport) -> tuple[tuple[str, ...], list[list[str]]]:
    """Return heads and rows of the peak and its mode at the drawn levels."""
    (frequency, height), (natural, ratio) = report.peaks, report.mode
    heads = (
        f"level [{report.states.driven.shown[1]}]", f"peak [{report.per_level}]", "at [Hz]", "mode [Hz]", "damping [%]"
    )  # fmt: skip
    rows = [
        [number(report.shown_levels[row]), *(number(finite(value)) for value in
         (height[row], frequency[row], natural[row], 100.0 * ratio[row]))]
        for row in report.rows
    ]  # fmt: skip
    return heads, rows


def _range(name: str, values: Vector, unit: str) -> str:
    """Return the number and the ends of values, or a single value."""
    if len(values) == 1:
        return f"{number(values[0])} {unit}"
    return f"{len(values)} {name} {number(values[0])} to {number(values[-1])} {unit}"


def printed_cut(report: LevelReport, cut: LevelMap) -> str:
    """Return the printed table of a cut at one frequency."""
    unit, name = report.unit, cut.channels[0]
    heads = [f"level [{cut.driven.shown[1]}]", f"FRF [{report.per_level}]", f"RMS [{unit}]", f"peak [{unit}]",
             "distortion [%]", *(f"slip {damper.removeprefix('damper_')} [%]" for damper in cut.dampers)]  # fmt: skip
    table = [
        [number(report.shown_levels[row]), *(number(finite(value)) for value in (
            abs(cut.frf[0, 0, row]), cut.rms[0, 0, row], cut.peak[0, 0, row], 100.0 * cut.distortion[0, 0, row],
            *(100.0 * cut.slip[:, 0, row])))]
        for row in report.rows
    ]  # fmt: skip
    return "\n".join([f"{channel_words(name)} at {cut.frequency[0]:g} Hz:", *aligned([heads, *table], left=0)])
