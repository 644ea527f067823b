"""The figures of chapter 2 and appendices B to D of the thesis (Bommer 2006), under the numbers they have there."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.charts import chart, lines
from scenarios.lumped.history import History
from scenarios.lumped.quarter_car_network import elastomer
from scenarios.quarter_car.runs import CONSTANT, DEGRESSIVE, HIGH, LEVELS, LOW, NO_FRICTION, STEP, Runs
from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.engines.linear.response import frequency_response
from vehicle.model.laws.coulomb import Coulomb
from vehicle.signals.analysis.spectra import power_spectral_density

Quantity = Callable[[History], Vector]
Run = Callable[[Runs, float], History]
"""From the amplitude of a sine, or the RMS of a road [m]."""

ACCELERATIONS: dict[str, Quantity] = {
    "body acceleration [m/s²]": lambda h: h.acceleration("body"),
    "wheel acceleration [m/s²]": lambda h: h.acceleration("wheel"),
}

FRICTION: dict[str, Run] = {
    "with friction": lambda runs, a: runs.sine(a),
    "no friction": lambda runs, a: runs.sine(a, NO_FRICTION),
    "with friction, step first": lambda runs, a: runs.sine(a, phase=0.5 * np.pi),
}

ENGINE: dict[str, Run] = {
    "with engine": lambda runs, a: runs.sine(a, engine="linear"),
    "no engine": lambda runs, a: runs.sine(a),
}

TOLD = {"slip": (2.0, 12.5), "stick": (4.8, 25.0)}
"""Frequencies at which the text reads figure 2.5 [Hz]."""

CONSTANT_AND_DEGRESSIVE = {"constant damping": CONSTANT, "degressive": DEGRESSIVE}
"""The larger one first, so that it does not hide the other."""


def _curves(
    named: Mapping[str, Any], colours: Sequence[str] = COLOURS, styles: Sequence[str] = ("-", "--", ":")
) -> list[tuple[str | None, Any, str, str]]:
    """Draw curves in the colours and line styles of their order."""
    return [(name, values, c, s) for (name, values), c, s in zip(named.items(), colours, styles, strict=False)]


def _over_time(panel: Any, histories: Mapping[str, History], label: str, of: Quantity, *, title: str = "") -> None:
    """Draw a quantity of several histories over time."""
    time = next(iter(histories.values())).time
    curves = _curves({name: of(history) for name, history in histories.items()})
    lines(panel, time, curves, xlabel="time [s]", ylabel=label, title=title)


def _sines(
    runs: Runs, path: Path, *, caption: str, quantities: Mapping[str, Quantity], compared: Mapping[str, Run]
) -> None:
    """Draw low and high sine in two panels, from 3 to 5 s."""
    with chart(path, caption, rows=len(quantities), columns=2, size=(9, 3.4 * len(quantities) + 0.6)) as axes:
        for column, amplitude in enumerate((LOW, HIGH)):
            histories = {name: run(runs, amplitude).during(3.0) for name, run in compared.items()}
            for row, (label, of) in enumerate(quantities.items()):
                title = f"sine of {1e3 * amplitude:g} mm, 1 Hz"
                _over_time(axes[2 * row + column], histories, label, of, title=title)


def _roads(
    runs: Runs, path: Path, *, caption: str, compared: Mapping[str, tuple[str, int]], zoom: bool = False
) -> None:
    """Draw body acceleration spectra on the low and the high road in two panels; optionally with a zoom about 20 Hz."""
    caption += f" Mean over {runs.roads} random roads."
    with chart(path, caption, rows=2 if zoom else 1, columns=2, size=(9, 8 if zoom else 5)) as axes:
        for column, level in enumerate((LOW, HIGH)):
            for label, (family, variant), color, style in _curves(compared):
                frequency, density = runs.spectrum(family, level, variant)
                axes[column].loglog(frequency, density, color=color, linestyle=style, linewidth=1.3, label=label)
                if zoom:
                    near = (frequency >= 17.5) & (frequency <= 22.5)
                    axes[2 + column].semilogy(frequency[near], density[near], color=color, linestyle=style, label=label)
            axes[column].set_title(f"road RMS {1e3 * level:g} mm", fontsize=10)
        for panel in axes:
            panel.set_xlabel("frequency [Hz]")
            panel.set_ylabel("PSD of the body acceleration [(m/s²)²/Hz]", fontsize=8)
            panel.legend(fontsize=8)


def _force_axes(panel: Any, limit: float, name: str) -> None:
    """Set the axes of a friction force over velocity."""
    panel.set(xlim=(-limit, limit), xlabel=f"{name} [m/s]", ylabel="friction force [N]")
    panel.legend(fontsize=8)
    panel.ticklabel_format(axis="x", style="sci", scilimits=(0, 0))


def figure_2_5(runs: Runs, path: Path) -> None:
    """Draw the FRFs of the linear models."""
    frequency = np.geomspace(1.0, 50.0, 800)
    caption = (
        "Response to the road displacement: damper in slip (2.1) and in stick (2.2). Dotted: the frequencies of the "
        "text, 2 and 12.5 Hz in slip, 4.8 and 25 Hz in stick."
    )
    # From 10 deg down, so that a lag of 180 deg does not jump between both ends of the axis.
    parts: dict[str, Any] = {
        "|H| [m/m]": np.abs,
        "phase [deg]": lambda h: 10.0 - np.mod(10.0 - np.degrees(np.angle(h)), 360),
    }
    with chart(path, caption, rows=2, columns=2, size=(9, 7)) as axes:
        for column, damper in enumerate(("slip", "stick")):
            model = runs.model(damper=damper)
            responses = {output: frequency_response(model, frequency, output) for output in ("body", "wheel")}
            for row, (label, part) in enumerate(parts.items()):
                curves = _curves({output: part(response) for output, response in responses.items()})
                lines(axes[2 * row + column], frequency, curves, xlabel="frequency [Hz]", ylabel=label, title=damper)
                axes[2 * row + column].set_xscale("log")
                for width_label in TOLD[damper]:
                    axes[2 * row + column].axvline(width_label, color="#888888", linestyle=":", linewidth=0.9)
            axes[column].set_yscale("log")


def figure_2_6(runs: Runs, path: Path) -> None:
    """Draw the road displacement and its spectra."""
    road = runs.road_profile(HIGH)
    shape = power_spectral_density(STEP, road)
    inside = (shape.frequency >= 1.0) & (shape.frequency <= 50.0)
    frequency, density = shape.frequency[inside], shape.density[0, inside]
    caption = f"Simulated rough road, RMS {1e3 * HIGH:g} mm, constant velocity PSD from 1/{runs.duration:g} to 100 Hz."
    with chart(path, caption, columns=2) as axes:
        time = STEP * np.arange(road.size)
        lines(axes[0], time, [(None, road, COLOURS[0], "-")], xlabel="time [s]", ylabel="road displacement [m]")
        speed = density * (2 * np.pi * frequency) ** 2
        curves = _curves({"displacement [m²/Hz]": density, "velocity [(m/s)²/Hz]": speed})
        lines(axes[1], frequency, curves, xlabel="frequency [Hz]", ylabel="PSD")
        axes[1].set(xscale="log", yscale="log")


def figure_2_9(runs: Runs, path: Path) -> None:
    """Draw the mass on a damper over time, with both friction models."""
    caption = (
        "Mass on a damper with friction under a force of 110 N at 2 Hz: smooth law (eps 1e6 s/m) and switch model "
        "(eta 1e-6 m/s); right: at the start of a slip."
    )
    quantities: dict[str, Quantity] = {
        "displacement [m]": lambda h: h.displacement("mass"),
        "velocity [m/s]": lambda h: h.velocity("mass"),
        "acceleration [m/s²]": lambda h: h.acceleration("mass"),
    }
    with chart(path, caption, rows=3, columns=2, size=(9, 8)) as axes:
        for column, stretch in enumerate(((0.0, 0.5), (0.03, 0.045))):
            histories = {name: runs.mass_on_damper(name).during(*stretch) for name in ("smooth", "switch")}
            for row, (label, of) in enumerate(quantities.items()):
                _over_time(axes[2 * row + column], histories, label, of)


def figure_2_10(runs: Runs, path: Path) -> None:
    """Draw the friction force over velocity for both friction models."""
    histories = {name: runs.mass_on_damper(name) for name in ("smooth", "switch")}
    with chart(path, "Friction force over velocity, smooth law and switch model; right: near zero.", columns=2) as axes:
        for panel, limit in zip(axes, (5e-3, 5e-5), strict=True):
            for label, history, color, style in _curves(histories):
                v, force = history.sliding_velocity(), history.sliding_force[:, 0]
                panel.plot(v, force, color=color, linestyle=style, linewidth=1.2, label=label)
            _force_axes(panel, limit, "velocity")


def figure_2_14(runs: Runs, path: Path) -> None:
    """Draw body acceleration spectra for increasing road levels."""
    caption = f"Body acceleration of the friction model (2.6), mean over {runs.roads} random roads, five levels."
    with chart(path, caption, size=(9, 6)) as axes:
        for level, color in zip(LEVELS, COLOURS, strict=True):
            frequency, density = runs.spectrum("no engine", level)
            axes[0].loglog(frequency, density, color=color, linewidth=1.3, label=f"{1e3 * level:g} mm")
        axes[0].set(xlabel="frequency [Hz]", ylabel="PSD of the body acceleration [(m/s²)²/Hz]")
        axes[0].legend(fontsize=8, title="road RMS")


def figure_2_15(runs: Runs, path: Path) -> None:
    """Draw the body displacement on a low and a high road."""
    caption = "Body displacement: undamped shaking on the low road, damped motion on the high one."
    with chart(path, caption, rows=2, size=(9, 6)) as axes:
        for panel, level in zip(axes, (LEVELS[0], LEVELS[-1]), strict=True):
            shown = slice(*(round(share * runs.duration / STEP) for share in (0.3, 0.65)))
            body, road = runs.marched("no engine", level).displacement[0], runs.road_profile(level)
            title = f"road RMS {1e3 * level:g} mm"
            curves = _curves({"body": body[shown], "road": road[shown]}, styles=("-", ":"))
            lines(
                panel,
                STEP * np.arange(body.size)[shown],
                curves,
                xlabel="time [s]",
                ylabel="displacement [m]",
                title=title,
            )


def figure_2_18(runs: Runs, path: Path) -> None:
    """Draw the accelerations of engine and wheel relative to the body."""
    with chart(path, "Engine and wheel relative to the body, engine on its linear mount (2.7).", columns=2) as axes:
        for panel, amplitude in zip(axes, (LOW, HIGH), strict=True):
            history = runs.sine(amplitude, engine="linear").during(3.0)
            body = history.acceleration("body")
            relative = {f"{name} - body": history.acceleration(name) - body for name in ("engine", "wheel")}
            title, label = f"sine of {1e3 * amplitude:g} mm, 1 Hz", "relative acceleration [m/s²]"
            lines(panel, history.time, _curves(relative), xlabel="time [s]", ylabel=label, title=title)


def figure_2_20(runs: Runs, path: Path) -> None:
    """Draw the dynamic stiffness of the elastomer."""
    frequency = np.geomspace(0.1, 1000.0, 400)
    stiffness = elastomer(runs.car).complex_stiffness(2 * np.pi * frequency)
    parts = {"|K| [N/m]": np.abs(stiffness), "loss angle [deg]": np.degrees(np.angle(stiffness))}
    with chart(path, "Dynamic stiffness of the elastomer (2.12) and its loss angle.", columns=2) as axes:
        for panel, (label, values) in zip(axes, parts.items(), strict=True):
            lines(panel, frequency, [(None, values, COLOURS[0], "-")], xlabel="frequency [Hz]", ylabel=label)
            panel.set_xscale("log")


def figure_b_1(runs: Runs, path: Path) -> None:
    """Draw the smooth law for three steepnesses, with the velocities in the runs of table B.1."""
    caption = "Smooth friction law for three steepnesses eps; dots: samples of the runs of table B.1 (road RMS 0.5 mm)."
    velocity = np.linspace(-0.015, 0.015, 4001)
    with chart(path, caption, columns=2) as axes:
        for panel, limit in zip(axes, (0.015, 5e-4), strict=True):
            for variant, (steepness, color) in enumerate(zip((1e6, 1e5, 1e4), COLOURS, strict=False)):
                law = Coulomb(friction_limit=runs.car.friction.limit, smoothing=steepness)
                v = velocity * limit / 0.015
                panel.plot(v, law.force(v), color=color, linewidth=1.2, label=f"eps {steepness:.0e} s/m")
                met = runs.marched("small mass", LEVELS[0], variant).sliding_velocity[0, ::50]
                panel.plot(met, law.force(met), ".", color=color, markersize=3)
            _force_axes(panel, limit, "damper velocity")


def figure_c_3(runs: Runs, path: Path) -> None:
    """Draw the relative velocity of the damper with a degressive and a constant damper."""
    with chart(
        path, "Velocity of the damper on one road, degressive and with constant damping (eps 1e6 s/m).", columns=2
    ) as axes:
        for panel, level in zip(axes, (LOW, HIGH), strict=True):
            velocities = {
                name: runs.marched(family, level, variant).sliding_velocity[0]
                for name, (family, variant) in CONSTANT_AND_DEGRESSIVE.items()
            }
            time, title = STEP * np.arange(velocities["degressive"].size), f"road RMS {1e3 * level:g} mm"
            curves = _curves(velocities, COLOURS[1::-1], ("-", "-"))
            lines(panel, time, curves, xlabel="time [s]", ylabel="damper velocity [m/s]", title=title)


FIGURES: dict[str, Callable[[Runs, Path], None]] = {
    "2.5": figure_2_5,
    "2.6": figure_2_6,
    "2.9": figure_2_9,
    "2.10": figure_2_10,
    "2.12": partial(
        _sines,
        caption="Friction model (2.6) with and without friction, from rest; dotted: road begins as a cosine (a step "
        "first), so that the strut slips before it sticks.",
        quantities=ACCELERATIONS,
        compared=FRICTION,
    ),
    "2.13": partial(
        _sines,
        caption="Sliding velocity of the damper with and without friction; dotted: road begins as a cosine.",
        quantities={"damper velocity [m/s]": History.sliding_velocity},
        compared=FRICTION,
    ),
    "2.14": figure_2_14,
    "2.15": figure_2_15,
    "2.17": partial(
        _sines,
        caption="Friction model with the engine on its linear mount (2.7) and without engine (2.6), from rest.",
        quantities=ACCELERATIONS,
        compared=ENGINE,
    ),
    "2.18": figure_2_18,
    "2.20": figure_2_20,
    "2.21": partial(
        _roads,
        caption="Friction model with the engine on the elastomer (2.13), on the linear mount (2.7) and without engine.",
        compared={name: (name, 0) for name in ("elastomer", "linear mount", "no engine")},
    ),
    "B.1": figure_b_1,
    "C.2": partial(
        _roads,
        caption="Elastomer model with the degressive damper (C.2) and with constant damping (2.13), eps 1e6 s/m.",
        compared={"degressive": DEGRESSIVE, "constant damping": CONSTANT},
    ),
    "C.3": figure_c_3,
    "D.4": partial(
        _roads,
        caption="Two-dimensional model (D.28): angle of the strut from the vertical; below: near 20 Hz.",
        compared={"0 deg": DEGRESSIVE, "4.2 deg": ("inclined", 0), "8.4 deg": ("inclined", 1)},
        zoom=True,
    ),
    "D.5": partial(
        _roads,
        caption="Two-dimensional model at 4.2 deg: longitudinal damping Dh [N s/m]; below: near 20 Hz.",
        compared={f"Dh {damping}": ("inclined", variant) for damping, variant in (("0", 2), ("550", 0), ("1100", 3))},
        zoom=True,
    ),
}
"""Figure number of the source -> what draws it."""
