"""Figures 3.38 and 3.39 of source 1: relative acceleration and damper force with both friction laws."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from scenarios.car_charts import figure_file
from scenarios.car_study import computed_by
from scenarios.relative_acceleration import relative_acceleration
from scenarios.slip_peaks import SlipPhase, extra_peaks
from scenarios.stribeck_claims import law_force
from vehicle.car import Run
from vehicle.excitation.bump import BUMP_START_S
from vehicle.rendering.figure import COLOURS

DETAIL = (-0.01, 0.08)
"""Magnified around the end of stick [s]."""


def peak_figure(path: Path, runs: Mapping[str, Run], phases: Mapping[str, list[SlipPhase]], start: float) -> None:
    """Write the relative acceleration over the bump, and magnified after the first three ends of stick.

    Args:
        path: PNG file.
        runs: law to run.
        phases: law to slips.
        start: of the bump [s].
    """
    shift = BUMP_START_S - start
    note = (
        "A = 7.5 mm; acceleration of the damper top relative to the knuckle along the strut axis; circles: extra "
        "peaks, which stand out by at least half of the largest break-away jump; below: after the ends of stick. Time "
        f"histories, no averages; {computed_by(next(iter(runs.values())))}"
    )
    title = "Relative acceleration damper top - knuckle with both friction laws (figure 3.38)"
    with figure_file(path, (13.0, 7.6), title, note) as figure:
        upper, lower = figure.subfigures(2, 1)
        whole = upper.subplots(1, 1)
        details = lower.subplots(1, 3, sharey=True)
        begins = [phase.start for phase in phases["Coulomb"][:3]]
        for (name, run), colour in zip(runs.items(), COLOURS, strict=False):
            time, values = run.time, relative_acceleration(run)
            peaks = extra_peaks(phases[name])
            for axis, (begin, end) in zip(
                (whole, *details),
                ((start - 0.02, start + 0.7), *((one + DETAIL[0], one + DETAIL[1]) for one in begins)),
                strict=False,
            ):
                keep = (time >= begin) & (time <= end)
                axis.plot(time[keep] + shift, values[keep], color=colour, label=name)
                inside = [peak for peak in peaks if begin <= peak.time <= end]
                axis.plot(
                    [peak.time + shift for peak in inside],
                    [peak.height for peak in inside],
                    "o",
                    color=colour,
                    markerfacecolor="none",
                    markersize=8,
                )
                axis.set_xlim(begin + shift, end + shift)
                axis.set_xlabel("time [s]")
        for axis in (whole, details[0]):
            axis.set_ylabel("relative acceleration [m/s²]")
        whole.legend(loc="upper right")


def force_figure(path: Path, runs: Mapping[str, Run]) -> None:
    """Write the damper force over the velocity: every sample, and the law."""
    note = (
        "A = 7.5 mm; dots: every sample of the run with noise, right damper; line: viscous force and friction of "
        f"equations 3.1 and 3.2. No averages; {computed_by(next(iter(runs.values())))}"
    )
    with figure_file(path, (11.5, 5.0), "Damper force over velocity (figure 3.39)", note) as figure:
        axes = figure.subplots(1, 2, sharex=True, sharey=True)
        speeds = np.concatenate([-np.geomspace(0.1, 1e-6, 400), np.geomspace(1e-6, 0.1, 400)])
        for axis, (name, run), colour in zip(axes, runs.items(), COLOURS, strict=False):
            axis.plot(speeds, law_force(run.car.vehicle.damper, speeds), color="#222222", label="law")
            axis.plot(
                run["damper_fr_velocity"], run["damper_fr_force"], ".", markersize=3, color=colour, label="simulated"
            )
            axis.set(title=name, xlabel="damper velocity [m/s]", xlim=(-0.1, 0.1))
            axis.legend(loc="upper left")
        axes[0].set_ylabel("damper force [N]")
