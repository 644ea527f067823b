"""Sentences on the contributions of the body modes to the acceleration of the seat rail, from the car matrices."""

import numpy as np

from vehicle.engines.linear.mode_participation import participation
from vehicle.names import point_words
from vehicle.runs.report.finished_run import FinishedRun

PLACE, WORDS = "seat_rail_acc_z", "seat rail"
MOST_PEAKS, MOST_PARTS = 3, 3
LEAST = 0.1
"""Minimum share of a contribution that the text names."""


def body_modes(run: FinishedRun, state: str) -> list[str]:
    """Return a text for each of the highest resonances at the seat rail; empty for a rigid body.

    Args:
        run: the run, with FRFs to one plate.
        state: state of the dampers, "stuck" or "sliding".
    """
    car, peaks = run.car, run.summary.peaks.get(PLACE)
    on_body = any(output.name == "seat_rail" and output.on == "body" for output in car.vehicle.composition.outputs)
    single = len(run.responses) == 1 and len(run.responses[0].motion) == 1
    if not (peaks and single and on_body and car.vehicle.body.flexible and len(car.model.superelement.frequencies)):
        return []
    highest = sorted(peaks, key=lambda peak: -peak.magnitude)[:MOST_PEAKS]
    lines = sorted(float(peak.frequency_hz) for peak in highest)
    stuck = state == "stuck"
    result = participation(car.model, car.matrices, car.load_rows, PLACE, lines, stuck=stuck, wheel=run.wheel)
    sentences = []
    for at, frequency in enumerate(lines):
        shares = result.shares[:, at]
        order = [int(i) for i in np.argsort(-np.abs(shares)) if abs(shares[i]) >= LEAST][:MOST_PARTS]
        parts = ", ".join(f"{result.names[i]} {_percent(shares[i])}" for i in order)
        text = (
            f"At {frequency:.1f} Hz the largest contributions to the vertical acceleration at the {WORDS} are {parts}"
        )
        if modes := [i - 6 for i in order if i >= 6]:
            drivers = result.attachment_shares[modes[0], :, at]
            largest = [int(i) for i in np.argsort(-np.abs(drivers))[:2]]
            names = ", ".join(f"{point_words(result.attachments[i])} {_percent(drivers[i])}" for i in largest)
            text += f"; the largest excitation of mode {modes[0] + 1} is at {names}"
        sentences.append(f"{text}.")
    return [*sentences, f"Shares: linear car, dampers {state}. More: python -m vehicle body participation."]


def _percent(share: float) -> str:
    return f"{100.0 * share:+.0f} %"
