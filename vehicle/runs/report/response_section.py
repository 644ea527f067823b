"""Frequency responses of a run with its resonances; on a road the densities of its accelerations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from vehicle.drawing.rendering.frf_plot import plot_frfs
from vehicle.drawing.rendering.several_runs import plot_densities, shared_channels
from vehicle.engines.linear.car_modes import Mode
from vehicle.runs.report.drawings import drawing
from vehicle.runs.report.findings import main_places, nearest_mode, of_plate
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import Markup, joined, number, table, tag


def responses(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> Markup:
    """FRFs with phase and coherence and the resonances of the main places; on a road the densities."""
    if run.responses:
        return joined(
            [
                drawing(
                    lambda path: plot_frfs(path, run, run.responses, run.caption), f"Frequency responses of {run.name}"
                ),
                tag(
                    "p",
                    "A band around a line is the 95 % region of its random error. Where the coherence is low the car "
                    "does not answer linearly, or the plate drives it too little.",
                ),
                tag("div", *_resonances(run, modes), class_="columns"),
            ]
        )
    channels = shared_channels([run], ROAD_CHANNELS)
    return drawing(
        lambda path: plot_densities(
            path, {run.name: run}, channels, "Densities of the vertical acceleration", run.caption
        ),
        f"Power spectral densities of {run.name}",
    )


def _resonances(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> list[Markup]:
    """Strongest resonances of the main places beside the nearest modes."""
    found, plate = [], of_plate(run).replace(" of", " to motion of", 1)
    for channel, place in main_places(run).items():
        peaks = sorted(run.summary["peaks"].get(channel, ()), key=lambda peak: -peak["magnitude"])[:STRONGEST]
        rows = []
        for peak in sorted(peaks, key=lambda peak: peak["frequency_hz"]):
            state, mode = nearest_mode(run, peak["frequency_hz"], modes)
            near = "" if mode is None else f"{mode.frequency:.2f} Hz, {mode.description}; {state}"
            rows.append((near, f"{peak['frequency_hz']:.2f}", number(peak["magnitude"]), number(peak["coherence"])))
        heads = ("nearest mode", "resonance [Hz]", "m/s² per m", "coherence")
        if rows:
            many = f"the {len(rows)} highest" if len(rows) > 1 else "the only one"
            found.append(table(heads, rows, caption=f"Vertical resonances at the {place}{plate}: {many}"))
    return found


STRONGEST = 6
"""Resonances of a place that are shown with the modes beside them."""

ROAD_CHANNELS = {
    "knuckle_fr_acc_z": "knuckle, front right",
    "engine_acc_z": "engine",
    "seat_rail_acc_z": "seat rail",
}
"""What is shown of a run on a road, and its words."""
