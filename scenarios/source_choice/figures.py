"""Picture of the joint choice: log-likelihoods of both halves by side."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from scenarios.charts import figure_file
from scenarios.source_choice.candidates import Rig
from scenarios.source_choice.likelihood import Candidate, best
from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS


def side_figure(path: Path, used: Mapping[Rig, Vector], held: Mapping[Rig, Vector], winner: Candidate) -> None:
    """Draw the best log-likelihood of every combination of sides, for the used and the held-out half."""
    body = (winner.rig.ixx, winner.rig.damping, winner.rig.brackets)
    shown = best({rig: candidate for rig, candidate in used.items() if (rig.ixx, rig.damping, rig.brackets) == body})[
        ::-1
    ]
    outside = [float(held[candidate.rig][tuple(_numbers(candidate))]) for _, candidate in shown]
    caption = (
        "Sum over rows of weight times ln of the probability of the printed interval, each combination of sides with "
        f"its own best slip velocity, band edges and noise; seat at -y, {winner.rig.body()}. The held-out half chose "
        "nothing; its sum has other rows, so only differences within a colour say something"
    )
    with figure_file(path, (10.5, 1.6 + 0.36 * len(shown)), "Evidence by side", caption) as figure:
        axis = figure.subplots()
        position = np.arange(len(shown))
        for shift, label, values, colour in (
            (0.2, "half that chose", [value for value, _ in shown], COLOURS[0]),
            (-0.2, "half held out", outside, COLOURS[3]),
        ):
            axis.barh(position + shift, values, 0.38, label=label, color=colour)
        axis.set_yticks(position, [candidate.rig.sides() for _, candidate in shown], fontsize=8)
        axis.set_xlabel("log-likelihood")
        axis.legend(loc="lower left")


def _numbers(candidate: Candidate) -> tuple[int, ...]:
    return candidate.velocity, candidate.shaker, candidate.noise, candidate.level, candidate.road
