"""Labels of the axes of figures 2.12, 2.13, 2.17 and 2.18, which are all that is left of their curves.

An axis that was scaled automatically ends at the tick beyond the data: the extreme is in the last interval if both
labels are readable, otherwise between the readable label and 0. An axis contains all curves of its panel.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from scenarios.claims import Claim, Interval, interval_claim
from scenarios.lumped.history import History
from scenarios.quarter_car.runs import HIGH, LOW, NO_FRICTION, Runs
from scenarios.quarter_car.sine_claims import START, late
from vehicle.arrays import Vector

START_OPEN = (
    "a stuck strut damps nothing, so the size of its vibration is that of the start, which is not printed: ours starts "
    "from rest"
)


def axis_claims(runs: Runs) -> list[Claim]:
    """Return a row for each readable end of an axis."""
    friction = {amplitude: runs.sine(amplitude) for amplitude in (LOW, HIGH)}
    free = {amplitude: runs.sine(amplitude, NO_FRICTION) for amplitude in (LOW, HIGH)}
    engine = {amplitude: runs.sine(amplitude, engine="linear") for amplitude in (LOW, HIGH)}
    velocity = {amplitude: friction[amplitude].during(START).sliding_velocity() for amplitude in (LOW, HIGH)}
    relative = {
        amplitude: np.stack([late(engine[amplitude], mass) - late(engine[amplitude]) for mass in ("engine", "wheel")])
        for amplitude in (LOW, HIGH)
    }

    def both(pair: Sequence[Mapping[float, History]], amplitude: float, mass: str) -> Vector:
        return np.concatenate([late(histories[amplitude], mass) for histories in pair])

    first, second = (friction, free), (friction, engine)
    rows = [
        _end("2.12", "sine 1 mm: highest body acceleration [m/s2]", both(first, LOW, "body"), (0.0, 0.5), START_OPEN),
        _end("2.12", "sine 1 mm: highest wheel acceleration [m/s2]", both(first, LOW, "wheel"), (0.4, 0.6), START_OPEN),
        _end("2.12", "sine 50 mm: lowest wheel acceleration [m/s2]", both(first, HIGH, "wheel"), (-3.0, -1.0)),
        _end("2.13", "sine 1 mm: highest velocity of the damper [m/s]", velocity[LOW], (0.0, 0.005)),
        _end("2.13", "sine 50 mm: highest velocity of the damper [m/s]", velocity[HIGH], (0.05, 0.1)),
        _end(
            "2.17", "sine 1 mm: highest body acceleration, both cars [m/s2]", both(second, LOW, "body"), (0.0, 0.5),
            START_OPEN,
        ),
        _end(
            "2.17", "sine 1 mm: highest wheel acceleration, both cars [m/s2]", both(second, LOW, "wheel"), (0.6, 0.8),
            START_OPEN,
        ),
        _end(
            "2.17", "sine 50 mm: lowest wheel acceleration, both cars [m/s2]", both(second, HIGH, "wheel"), (-4.0, 0.0)
        ),
        _end(
            "2.18", "sine 1 mm: lowest acceleration relative to the body [m/s2]", relative[LOW], (-0.2, 0.0), START_OPEN
        ),
        _end("2.18", "sine 50 mm: highest acceleration relative to the body [m/s2]", relative[HIGH], (0.0, 3.0)),
    ]  # fmt: skip
    return rows


def _end(figure: str, name: str, values: Vector, interval: Interval, why: str = "") -> Claim:
    """Return the row of the highest value, or of the lowest one where the interval is negative; from 3 to 5 s."""
    extreme = float(np.min(values) if interval[0] < 0.0 else np.max(values))
    reason = "labels of the axis, 3 to 5 s" + (f"; {why}" if why else "")
    picture = f"figure_{figure.replace('.', '_')}.png"
    return interval_claim(name, interval, extreme, reason).at(f"figure {figure}", picture)
