"""Which modes of the body make the seat rail loud in a run, in sentences: from the matrices of its car."""

from __future__ import annotations

import numpy as np

from vehicle.engines.linear.mode_participation import participation
from vehicle.runs.report.finished_run import FinishedRun

PLACE, WORDS = "seat_rail_acc_z", "seat rail"
MOST_PEAKS, MOST_PARTS = 3, 3
LEAST = 0.1
"""Share from which a contribution is named."""


def body_modes(run: FinishedRun, state: str) -> list[str]:
    """A sentence for each of the highest resonances at the seat rail; none of a car whose body is rigid.

    Args:
        run: the run, with FRFs to one plate.
        state: of its dampers, "stuck" or "sliding".
    """
    car, peaks = run.car, run.summary["peaks"].get(PLACE)
    on_body = any(one.name == "seat_rail" and one.on == "body" for one in car.vehicle.composition.outputs)
    single = len(run.responses) == 1 and len(run.responses[0].motion) == 1
    if not (peaks and single and on_body and car.vehicle.body.flexible and len(car.model.superelement.frequencies)):
        return []
    highest = sorted(peaks, key=lambda peak: -peak["magnitude"])[:MOST_PEAKS]
    lines = sorted(float(peak["frequency_hz"]) for peak in highest)
    stuck = state == "stuck"
    found = participation(car.model, car.matrices, car.load_rows, PLACE, lines, stuck=stuck, wheel=run.wheel)
    sentences = []
    for at, frequency in enumerate(lines):
        shares = found.shares[:, at]
        order = [int(i) for i in np.argsort(-np.abs(shares)) if abs(shares[i]) >= LEAST][:MOST_PARTS]
        parts = ", ".join(f"{found.names[i]} {_percent(shares[i])}" for i in order)
        text = f"At {frequency:.1f} Hz the vertical acceleration at the {WORDS} is made by {parts}"
        if modes := [i - 6 for i in order if i >= 6]:
            drivers = found.attachment_shares[modes[0], :, at]
            most = [int(i) for i in np.argsort(-np.abs(drivers))[:2]]
            names = ", ".join(f"{found.attachments[i]} {_percent(drivers[i])}" for i in most)
            text += f"; what drives mode {modes[0] + 1} most: {names}"
        sentences.append(f"{text}.")
    about = (
        f"Shares in phase with the sum, of the linear car with dampers {state}: `python -m vehicle body participation`."
    )
    return [*sentences, about]


def _percent(share: float) -> str:
    return f"{100.0 * share:+.0f} %"
