"""The figures of chapter 2 and appendices B to D of source 1, under the numbers they have there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.charts import chart, lines
from scenarios.quarter_car.runs import HIGH, LEVELS, LOW, NO_FRICTION, STEEP, STEP, Runs
from vehicle.analysis.spectra import power_spectral_density
from vehicle.laws.coulomb import SmoothCoulomb
from vehicle.laws.maxwell import Maxwell
from vehicle.linear.response import frequency_response
from vehicle.lumped.history import History
from vehicle.rendering.figure import COLOURS


def figure_2_5(runs: Runs, path: Path) -> None:
    """FRFs of the linear models."""
    frequency = np.geomspace(1.0, 50.0, 800)
    with chart(
        path,
        "Response to the road displacement: damper in slip (2.1) and in stick (2.2).",
        rows=2,
        columns=2,
        size=(9, 7),
    ) as axes:
        for column, damper in enumerate(("slip", "stick")):
            model = runs.model(damper=damper)
            responses = [frequency_response(model, frequency, output) for output in ("body", "wheel")]
            for panel, values, label in (
                (axes[column], [np.abs(r) for r in responses], "|H| [m/m]"),
                (axes[2 + column], [np.degrees(np.angle(r)) for r in responses], "phase [deg]"),
            ):
                curves = [("body", values[0], COLOURS[0], "-"), ("wheel", values[1], COLOURS[1], "--")]
                lines(panel, frequency, curves, xlabel="frequency [Hz]", ylabel=label, title=damper)
                panel.set_xscale("log")
            axes[column].set_yscale("log")


def figure_2_6(runs: Runs, path: Path) -> None:
    """Road displacement and its spectra."""
    road = runs.road_profile(HIGH)
    shape = power_spectral_density(STEP, road)
    inside = (shape.frequency >= 1.0) & (shape.frequency <= 50.0)
    frequency, density = shape.frequency[inside], shape.density[0, inside]
    caption = f"Simulated rough road, RMS {1e3 * HIGH:g} mm, constant velocity PSD from 1/{runs.duration:g} to 100 Hz."
    with chart(path, caption, columns=2) as axes:
        time = STEP * np.arange(road.size)
        lines(axes[0], time, [(None, road, COLOURS[0], "-")], xlabel="time [s]", ylabel="road displacement [m]")
        curves = [
            ("displacement [m2/Hz]", density, COLOURS[0], "-"),
            ("velocity [(m/s)2/Hz]", density * (2 * np.pi * frequency) ** 2, COLOURS[1], "--"),
        ]
        lines(axes[1], frequency, curves, xlabel="frequency [Hz]", ylabel="PSD")
        axes[1].set_xscale("log")
        axes[1].set_yscale("log")


def figure_2_9(runs: Runs, path: Path) -> None:
    """Mass on a damper: both friction models over time."""
    smooth, switched = runs.mass_on_damper("smooth"), runs.mass_on_damper("switch")
    caption = (
        "Mass on a damper with friction under a force of 110 N at 2 Hz: smooth law (eps 1e6 s/m) and switch model "
        "(eta 1e-6 m/s); right: at the start of a slip."
    )
    with chart(path, caption, rows=3, columns=2, size=(9, 8)) as axes:
        for column, (start, end) in enumerate(((0.0, 0.5), (0.03, 0.045))):
            keep = (smooth.time >= start) & (smooth.time <= end)
            for row, label in enumerate(("displacement [m]", "velocity [m/s]", "acceleration [m/s2]")):
                curves = [
                    (name, (h.displacement, h.velocity, h.acceleration)[row]("mass")[keep], color, style)
                    for name, h, color, style in (
                        ("smooth", smooth, COLOURS[0], "-"),
                        ("switch", switched, COLOURS[1], "--"),
                    )
                ]
                lines(axes[2 * row + column], smooth.time[keep], curves, xlabel="time [s]", ylabel=label)


def figure_2_10(runs: Runs, path: Path) -> None:
    """Friction force over velocity for both friction models."""
    smooth, switched = runs.mass_on_damper("smooth"), runs.mass_on_damper("switch")
    with chart(path, "Friction force over velocity, smooth law and switch model; right: near zero.", columns=2) as axes:
        for panel, reach in zip(axes, (5e-3, 5e-5), strict=True):
            for history, label, color, style in (
                (smooth, "smooth", COLOURS[0], "-"),
                (switched, "switch", COLOURS[1], "--"),
            ):
                v, force = history.sliding_velocity(), history.sliding_force[:, 0]
                panel.plot(v, force, color=color, linestyle=style, linewidth=1.2, label=label)
            panel.set_xlim(-reach, reach)
            panel.set_xlabel("velocity [m/s]")
            panel.set_ylabel("friction force [N]")
            panel.legend(fontsize=8)
            panel.ticklabel_format(axis="x", style="sci", scilimits=(0, 0))


def _sines(
    path: Path,
    caption: str,
    quantities: list[tuple[str, Callable[[History], Any]]],
    compared: dict[str, Callable[[float], History]],
) -> None:
    """Low and high sine side by side, from 3 to 5 s."""
    with chart(path, caption, rows=len(quantities), columns=2, size=(9, 3.4 * len(quantities) + 0.6)) as axes:
        for column, amplitude in enumerate((LOW, HIGH)):
            histories = {label: run(amplitude) for label, run in compared.items()}
            for row, (label, values) in enumerate(quantities):
                curves = []
                for (name, history), color, style in zip(histories.items(), COLOURS, ("-", "--", ":"), strict=False):
                    keep = history.time >= 3.0
                    curves.append((name, values(history)[keep], color, style))
                time = next(iter(histories.values())).time
                lines(
                    axes[2 * row + column],
                    time[time >= 3.0],
                    curves,
                    xlabel="time [s]",
                    ylabel=label,
                    title=f"sine of {1e3 * amplitude:g} mm, 1 Hz",
                )


def figure_2_12(runs: Runs, path: Path) -> None:
    """Accelerations under a sine with and without friction."""
    _sines(
        path,
        "Friction model (2.6) with and without friction, from rest; dotted: road begins as a cosine (a step first), so "
        "that the strut slips before it sticks.",
        [
            ("body acceleration [m/s2]", lambda h: h.acceleration("body")),
            ("wheel acceleration [m/s2]", lambda h: h.acceleration("wheel")),
        ],
        {
            "with friction": runs.sine,
            "no friction": lambda a: runs.sine(a, NO_FRICTION),
            "with friction, step first": lambda a: runs.sine(a, phase=0.5 * np.pi),
        },
    )


def figure_2_13(runs: Runs, path: Path) -> None:
    """Relative velocity of the damper under a sine."""
    _sines(
        path,
        "Sliding velocity of the damper with and without friction; dotted: road begins as a cosine.",
        [("damper velocity [m/s]", lambda h: h.sliding_velocity())],
        {
            "with friction": runs.sine,
            "no friction": lambda a: runs.sine(a, NO_FRICTION),
            "with friction, step first": lambda a: runs.sine(a, phase=0.5 * np.pi),
        },
    )


def figure_2_14(runs: Runs, path: Path) -> None:
    """Body acceleration spectra for growing roads."""
    caption = f"Body acceleration of the friction model (2.6), mean over {runs.roads} random roads, five levels."
    with chart(path, caption, size=(9, 6)) as axes:
        for level, color in zip(LEVELS, COLOURS, strict=True):
            frequency, density = runs.spectrum("no engine", level)
            axes[0].loglog(frequency, density, color=color, linewidth=1.3, label=f"{1e3 * level:g} mm")
        axes[0].set_xlabel("frequency [Hz]")
        axes[0].set_ylabel("PSD of the body acceleration [(m/s2)2/Hz]")
        axes[0].legend(fontsize=8, title="road RMS")


def figure_2_15(runs: Runs, path: Path) -> None:
    """Body displacement on a low and a high road."""
    with chart(
        path, "Body displacement: undamped shaking on the low road, damped motion on the high one.", rows=2, size=(9, 6)
    ) as axes:
        for panel, level in zip(axes, (LEVELS[0], LEVELS[-1]), strict=True):
            history = runs.road(level)
            keep = (history.time >= 0.3 * runs.duration) & (history.time <= 0.65 * runs.duration)
            curves = [
                ("body", history.displacement("body")[keep], COLOURS[0], "-"),
                ("road", history.inputs[keep, 0], COLOURS[1], ":"),
            ]
            title = f"road RMS {1e3 * level:g} mm"
            lines(panel, history.time[keep], curves, xlabel="time [s]", ylabel="displacement [m]", title=title)


def figure_2_17(runs: Runs, path: Path) -> None:
    """Accelerations under a sine with and without engine."""
    _sines(
        path,
        "Friction model with the engine on its linear mount (2.7) and without engine (2.6), from rest.",
        [
            ("body acceleration [m/s2]", lambda h: h.acceleration("body")),
            ("wheel acceleration [m/s2]", lambda h: h.acceleration("wheel")),
        ],
        {"with engine": lambda a: runs.sine(a, engine="linear"), "no engine": runs.sine},
    )


def figure_2_18(runs: Runs, path: Path) -> None:
    """Accelerations of engine and wheel relative to the body."""
    with chart(path, "Engine and wheel relative to the body, engine on its linear mount (2.7).", columns=2) as axes:
        for panel, amplitude in zip(axes, (LOW, HIGH), strict=True):
            history = runs.sine(amplitude, engine="linear")
            keep = history.time >= 3.0
            body = history.acceleration("body")
            curves = [
                ("engine - body", (history.acceleration("engine") - body)[keep], COLOURS[0], "-"),
                ("wheel - body", (history.acceleration("wheel") - body)[keep], COLOURS[1], "--"),
            ]
            title = f"sine of {1e3 * amplitude:g} mm, 1 Hz"
            lines(
                panel, history.time[keep], curves, xlabel="time [s]", ylabel="relative acceleration [m/s2]", title=title
            )


def figure_2_20(runs: Runs, path: Path) -> None:
    """Dynamic stiffness of the elastomer."""
    p = runs.car.elastomer
    mount = Maxwell(stiffness=p.stiffness, branch_stiffness=p.branch_stiffness, branch_damping=p.branch_damping)
    frequency = np.geomspace(0.1, 1000.0, 400)
    stiffness = mount.complex_stiffness(2 * np.pi * frequency)
    with chart(path, "Dynamic stiffness of the elastomer (2.12) and its loss angle.", columns=2) as axes:
        for panel, values, label in (
            (axes[0], np.abs(stiffness), "|K| [N/m]"),
            (axes[1], np.degrees(np.angle(stiffness)), "loss angle [deg]"),
        ):
            lines(panel, frequency, [(None, values, COLOURS[0], "-")], xlabel="frequency [Hz]", ylabel=label)
            panel.set_xscale("log")


def _roads(runs: Runs, path: Path, caption: str, compared: dict[str, tuple[str, int]], *, zoom: bool = False) -> None:
    """Body acceleration spectra on the low and the high road side by side; below, the neighbourhood of 20 Hz.

    Args:
        runs: where the spectra come from.
        path: file to write.
        caption: what is compared.
        compared: label -> family and variant.
        zoom: draw the second row.
    """
    caption += f" Mean over {runs.roads} random roads."
    with chart(path, caption, rows=2 if zoom else 1, columns=2, size=(9, 8 if zoom else 5)) as axes:
        for column, level in enumerate((LOW, HIGH)):
            for (label, (family, variant)), color, style in zip(
                compared.items(), COLOURS, ("-", "--", ":"), strict=False
            ):
                frequency, density = runs.spectrum(family, level, variant)
                axes[column].loglog(frequency, density, color=color, linestyle=style, linewidth=1.3, label=label)
                if zoom:
                    near = (frequency >= 17.5) & (frequency <= 22.5)
                    axes[2 + column].semilogy(frequency[near], density[near], color=color, linestyle=style, label=label)
            axes[column].set_title(f"road RMS {1e3 * level:g} mm", fontsize=10)
        for panel in axes:
            panel.set_xlabel("frequency [Hz]")
            panel.set_ylabel("PSD of the body acceleration [(m/s2)2/Hz]", fontsize=8)
            panel.legend(fontsize=8)


def figure_2_21(runs: Runs, path: Path) -> None:
    """Spectra without engine and with both engine mounts."""
    caption = "Friction model with the engine on the elastomer (2.13), on the linear mount (2.7) and without engine."
    _roads(runs, path, caption, {name: (name, 0) for name in ("elastomer", "linear mount", "no engine")})


def figure_b_1(runs: Runs, path: Path) -> None:
    """The smooth law for three steepnesses, with the velocities met in the runs of table B.1."""
    caption = "Smooth friction law for three steepnesses eps; dots: samples of the runs of table B.1 (road RMS 0.5 mm)."
    velocity = np.linspace(-0.015, 0.015, 4001)
    with chart(path, caption, columns=2) as axes:
        for panel, reach in zip(axes, (0.015, 5e-4), strict=True):
            for steepness, color in zip((1e6, 1e5, 1e4), COLOURS, strict=False):
                law = SmoothCoulomb(limit=runs.car.friction.limit, steepness=steepness)
                v = velocity * reach / 0.015
                panel.plot(v, law.force(v), color=color, linewidth=1.2, label=f"eps {steepness:.0e} s/m")
                history = runs.with_small_mass(LEVELS[0], steepness)
                met = history.sliding_velocity()[::50]
                panel.plot(met, law.force(met), ".", color=color, markersize=3)
            panel.set_xlim(-reach, reach)
            panel.set_xlabel("damper velocity [m/s]")
            panel.set_ylabel("friction force [N]")
            panel.legend(fontsize=8)
            panel.ticklabel_format(axis="x", style="sci", scilimits=(0, 0))


def figure_c_2(runs: Runs, path: Path) -> None:
    """Spectra with and without degressive damper."""
    caption = "Elastomer model with the degressive damper (C.2) and with constant damping (2.13), eps 1e6 s/m."
    _roads(runs, path, caption, {name: (name, 0) for name in ("degressive", "constant damping")})


def figure_c_3(runs: Runs, path: Path) -> None:
    """Relative velocity of the damper with and without degressive damper."""
    with chart(path, "Sliding velocity with the degressive damper and with constant damping.", columns=2) as axes:
        for panel, level in zip(axes, (LOW, HIGH), strict=True):
            histories = {
                "degressive": runs.road(level, STEEP, engine="elastomer", degressive=True),
                "constant damping": runs.road(level, STEEP, engine="elastomer"),
            }
            # The larger one first, so that it does not hide the other.
            curves = [
                (label, histories[label].sliding_velocity(), color, "-")
                for label, color in (("constant damping", COLOURS[1]), ("degressive", COLOURS[0]))
            ]
            time = histories["degressive"].time
            title = f"road RMS {1e3 * level:g} mm"
            lines(panel, time, curves, xlabel="time [s]", ylabel="damper velocity [m/s]", title=title)


def figure_d_4(runs: Runs, path: Path) -> None:
    """Spectra for three angles of the strut."""
    caption = "Two-dimensional model (D.28): angle of the strut from the vertical; below: near 20 Hz."
    compared = {f"{angle} deg": ("inclined", variant) for variant, angle in enumerate(("0", "4.2", "8.4"))}
    _roads(runs, path, caption, compared, zoom=True)


def figure_d_5(runs: Runs, path: Path) -> None:
    """Spectra for three longitudinal dampings."""
    caption = "Two-dimensional model at 4.2 deg: longitudinal damping Dh [N s/m]; below: near 20 Hz."
    compared = {f"Dh {damping}": ("inclined", variant) for damping, variant in (("0", 3), ("550", 1), ("1100", 4))}
    _roads(runs, path, caption, compared, zoom=True)


FIGURES: dict[str, Callable[[Runs, Path], None]] = {
    "2.5": figure_2_5,
    "2.6": figure_2_6,
    "2.9": figure_2_9,
    "2.10": figure_2_10,
    "2.12": figure_2_12,
    "2.13": figure_2_13,
    "2.14": figure_2_14,
    "2.15": figure_2_15,
    "2.17": figure_2_17,
    "2.18": figure_2_18,
    "2.20": figure_2_20,
    "2.21": figure_2_21,
    "B.1": figure_b_1,
    "C.2": figure_c_2,
    "C.3": figure_c_3,
    "D.4": figure_d_4,
    "D.5": figure_d_5,
}
"""Figure number of the source -> what draws it."""
