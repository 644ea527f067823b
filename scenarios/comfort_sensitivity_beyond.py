"""Beside the comfort study of source 1: degressive damper, body stiffness, and the evidence for road and engine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from scenarios.comfort_observation import Question
from scenarios.comfort_sensitivity_check import check_questions, check_table
from scenarios.comfort_sensitivity_figures import draw_band_edge, draw_variation
from scenarios.comfort_sensitivity_runs import BODY, DEGRESSIVE, RIGID_BODY, SOURCE, ComfortRuns, Curves
from scenarios.comfort_sensitivity_tables import curve_table, edge_table, plain
from scenarios.road_signals import ROAD_EDGE_HZ, ROAD_RMS

EDGES_HZ = (0.015, 0.02, 0.025, ROAD_EDGE_HZ, 0.035, 0.05, 0.1)
"""Band edges at which the slip shares are shown [Hz]."""


def beyond_questions(comfort: ComfortRuns) -> list[Question]:
    """All runs that `beyond_findings` and `rigid_curves` need."""
    more = [
        question
        for base in (DEGRESSIVE, RIGID_BODY)
        for variation in SOURCE
        for question in comfort.all_questions(variation, base)
    ]
    edges = [question for edge in EDGES_HZ for road in ROAD_RMS for question in comfort.questions((), road, edge=edge)]
    return [*more, *comfort.all_questions(BODY), *edges, *check_questions(comfort)]


def rigid_curves(comfort: ComfortRuns) -> dict[str, Curves]:
    """The variations of source 1 without the flexible modes of the body, whose shapes are assumed."""
    return {variation.name: comfort.curves(variation, RIGID_BODY) for variation in SOURCE}


def beyond_findings(
    comfort: ComfortRuns, folder: Path, linear: Mapping[str, Curves]
) -> tuple[list[str], dict[str, Any]]:
    """Draw the figures into the folder; notes and data of the findings.

    Args:
        comfort: what runs the cars.
        folder: where to.
        linear: curves of source 1, with the linear damper.
    """
    against = {road: comfort.point(0.0, DEGRESSIVE, road, ()) for road in ROAD_RMS}
    damper = comfort.runs.car(DEGRESSIVE).vehicle.damper
    ratios = (
        f"{100.0 * one.relative:.1f} ± {100.0 * one.relative_error:.2f} % on the {road} road"
        for road, one in against.items()
    )
    notes = [
        f"Degressive damper ({damper.degressive_viscous:g} N s/m up to {damper.degressive_velocity:g} m/s, "
        f"{damper.viscous:g} N s/m above, as equation C.1): comfort value {', '.join(ratios)} of that with the linear "
        "damper. The same parameters, relative to the car that has it:"
    ]
    degressive: dict[str, Curves] = {}
    for variation in SOURCE:
        found = degressive[variation.name] = comfort.curves(variation, DEGRESSIVE)
        draw_variation(
            folder / f"{variation.name}_degressive.png",
            comfort,
            variation,
            found,
            base=DEGRESSIVE,
            title=f"Degressive damper: comfort against {variation.label} (beyond the source)",
            beside={"with the linear damper": linear[variation.name]},
        )
        notes.append(curve_table(variation.label, found))
    body = comfort.curves(BODY)
    draw_variation(folder / f"{BODY.name}.png", comfort, BODY, body)
    edges = {road: [comfort.point(edge, (), road, (), edge) for edge in EDGES_HZ] for road in ROAD_RMS}
    draw_band_edge(folder / "band_edge.png", comfort, edges)
    notes += ["Body stiffness:", curve_table(BODY.label, body)]
    notes += ["Band edge of the roads, nominal car:", edge_table(edges), check_table(comfort)]
    return notes, {
        "degressive": plain(degressive),
        "degressive_against_linear": {road: asdict(one) for road, one in against.items()},
        **plain({"rigid_body_" + name: curves for name, curves in rigid_curves(comfort).items()}),
        **plain({BODY.name: body, "band_edge": edges}),
    }
