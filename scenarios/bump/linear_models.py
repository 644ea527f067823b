"""The nonlinear car against the two linear cars that its damper switches between (section 3.5 of Bommer 2006)."""

from collections.abc import Mapping

import numpy as np

from scenarios.bump.runs import SHOWN_S, SIZES
from scenarios.bump.seeds import RECORD
from scenarios.car_runs import CarRuns
from scenarios.claims import PREDICTED, Claim
from scenarios.signals.bump import bump
from scenarios.verdict import common

LINEAR = {"stick": ("damper.coulomb_friction=1e5",), "slip": ("damper.coulomb_friction=0",)}
"""Linear models: a damper that never moves, and a damper with its viscous force alone."""

POINT = "seat_rail_acc_z"

UNUSABLE = 0.5
"""A model cannot be used from this RMS of the difference on, over the RMS of the motion [-]."""

Errors = Mapping[str, Mapping[float, list[float]]]
"""Linear model to amplitude A of the bump [m] to its error for every seed of the noise [-]."""


def linear_errors(runs: CarRuns, count: int) -> Errors:
    """Return the RMS of the difference of the seat rail to the nonlinear car over its RMS, 3 s from the bump."""
    errors: dict[str, dict[float, list[float]]] = {name: {size: [] for size in SIZES} for name in LINEAR}
    for size in SIZES:
        for seed in range(count):
            signal = bump(amplitude=size, duration=RECORD.noisy, start=RECORD.start, seed=seed, wheel=runs.wheel)
            run = runs.car().run(signal, engine="reduced", channels=[POINT])
            shown = (run.time >= RECORD.start) & (run.time <= RECORD.start + SHOWN_S)
            motion = run[POINT][shown]
            for name, changes in LINEAR.items():
                linear = runs.car(changes).run(signal, engine="reduced", channels=[POINT])[POINT][shown]
                errors[name][size].append(float(np.std(linear - motion) / np.std(motion)))
    return errors


def linear_claim(errors: Errors) -> Claim:
    """Return the row on the bumps for which neither linear model can be used."""
    low, high = SIZES
    texts = [
        f"{1e3 * size:g} mm: {', '.join(f'{name} {100.0 * np.mean(errors[name][size]):.0f} %' for name in LINEAR)}"
        for size in SIZES
    ]
    wrong = [*errors["slip"][low], *errors["stick"][high]]
    return PREDICTED.statement(
        "one nonlinear against two linear models, seat rail over both bumps",
        "stick model not for the bump that slips, slip model not for the bump that sticks",
        f"difference to the nonlinear car, {'; '.join(texts)} of its RMS",
        common(error > UNUSABLE for error in wrong),
        f"rule: off by more than {100.0 * UNUSABLE:g} % of the RMS in each of {len(errors['slip'][low])} seeds; one "
        "set of parameters. At 7.5 mm the damper sticks again between its slides, so the slip model is off there too: "
        "it needs other parameters for each level, as the source says of its own",
    ).at("section 3.5", "histories_vertical.png")
