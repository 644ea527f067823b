"""Files of a diagnosis: its summary, the tables of unknowns and of the road, and the picture of the dampers."""

from __future__ import annotations

import json
from functools import partial

import numpy as np

from vehicle.drawing.rendering.diagnosis_plot import UnknownShape, plot_diagnosis
from vehicle.names import side_of
from vehicle.runs.output.folder import Content
from vehicle.studies.diagnosis.car_diagnosis import INTERVAL, SURE, WORN, CarDiagnosis
from vehicle.studies.diagnosis.drawn_car import STRONGEST, WEAKEST

CLASSES = 38
"""Classes of the histograms: of 2.5 % of the nominal force."""

SUMMARY, TABLE, ROUGHNESS, PICTURE = "diagnosis.json", "diagnosis.csv", "diagnosis_iri.csv", "diagnosis.png"
"""Names of the files."""


def contents(diagnosis: CarDiagnosis, *, figures: bool = True) -> dict[str, Content]:
    """Return the file contents by file name.

    Args:
        diagnosis: result of `diagnose_car`.
        figures: False leaves out the picture.
    """
    files: dict[str, Content] = {
        SUMMARY: json.dumps(diagnosis.summary(), indent=2, allow_nan=False) + "\n",
        TABLE: diagnosis.csv,
    }
    if diagnosis.road_pieces:
        files[ROUGHNESS] = diagnosis.roughness_csv
    if figures:
        shapes = [_shape(diagnosis, wheel) for wheel in diagnosis.wheels]
        caption = f"points: medians; bars: 90 % intervals; dashed: {100.0 * WORN:.0f} % of the nominal force"
        title = f"Dampers of {diagnosis.car} by {diagnosis.record}"
        files[PICTURE] = partial(plot_diagnosis, shapes=shapes, limit=WORN, title=title, caption=caption)
    return files


def _shape(diagnosis: CarDiagnosis, wheel: str) -> UnknownShape:
    """Return the distribution of the damper of a wheel."""
    posterior = diagnosis.damper(wheel)
    edges = np.linspace(WEAKEST, STRONGEST, CLASSES + 1)
    shares, _ = np.histogram(posterior.draws, edges, weights=posterior.weights)
    low, high = (posterior.quantile(end) for end in INTERVAL)
    return UnknownShape(
        label=side_of(wheel, diagnosis.wheels),
        edges=edges,
        shares=shares,
        low=low,
        middle=posterior.quantile(0.5),
        high=high,
        worn=diagnosis.worn(wheel) >= SURE,
    )
