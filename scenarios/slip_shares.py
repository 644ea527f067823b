"""Share of the time in slip at the three levels, over records of the shaker input (table 3.2 of Bommer 2006).

The velocity that counts as slip and the record are not printed. The rows use the slip velocity of the car; their
reasons contain the shares at other velocities.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.claims import Claim, markdown
from scenarios.evidence import SLIP_STEP, slip_error
from scenarios.evidence_claims import evidence_claim
from scenarios.inputs.make_inputs import LEVELS, QUICK_DURATION
from scenarios.signals.random_road import random_road
from vehicle.arrays import Vector
from vehicle.names import across
from vehicle.runs.car import SATURATED_VELOCITY
from vehicle.signals.excitation.band import SHAKER_EDGE_HZ, SHAKER_ROLL_OFF_ORDER

Shares = Mapping[str, Mapping[float, Vector]]
"""Level to velocity that counts as slip [m/s] to the shares of the right and the left damper [-], (records, 2)."""

PUBLISHED_SLIP = {"low": (0.0, 0.0), "mid": (0.039, 0.0), "high": (0.218, 0.0)}
"""Share of the time in slip of the right and the left damper (table 3.2)."""

SIDES = ("right", "left")
"""Words of the thesis for the damper over the shaker and the other one."""

RECORDS = 8
"""Records of the input, seeds 0 to 7; the record of the thesis is unknown."""

LENGTH = 60.0
"""Duration of a record [s], equal to the shipped inputs."""

OTHER_VELOCITIES = (1e-4, SATURATED_VELOCITY, 0.012)
"""Further definitions of slip, velocities [m/s]: 0.1 mm/s is that of the quarter car (10 / eps), 1 mm/s saturates the
friction, 12 mm/s is that of a car chosen earlier."""


def slip_shares(runs: CarRuns, *, quick: bool) -> Shares:
    """Return the slip shares at all levels; runs of the reduced engine, two short records with quick."""
    car, wheel = runs.car(), runs.wheel
    slip_velocity = car.vehicle.damper.slip_velocity
    velocities = (*OTHER_VELOCITIES, slip_velocity, *_ends(slip_velocity))
    channels = [f"damper_{side}_velocity" for side in (wheel, across(wheel))]
    duration = QUICK_DURATION if quick else LENGTH
    shares: dict[str, dict[float, Vector]] = {}
    for level, rms in LEVELS.items():
        signals = [
            random_road(
                rms=rms,
                seed=seed,
                wheel=wheel,
                duration=duration,
                lower_band_edge=SHAKER_EDGE_HZ,
                roll_off_order=SHAKER_ROLL_OFF_ORDER,
            )
            for seed in range(2 if quick else RECORDS)
        ]
        records = [car.run(signal, engine="reduced", channels=channels) for signal in signals]
        shares[level] = {
            velocity: np.array([[run.slip_share(side, velocity) for side in (wheel, across(wheel))] for run in records])
            for velocity in velocities
        }
    return shares


def slip_claims(shares: Shares, shipped: Mapping[str, Sequence[float]], slip_velocity: float) -> list[Claim]:
    """Return the rows on table 3.2.

    Args:
        shares: over the records.
        shipped: level to the shares of both dampers with the shipped input and the engine of the study [-].
        slip_velocity: velocity of the rows [m/s].
    """
    claims = []
    for level, printed in PUBLISHED_SLIP.items():
        for side, (word, share) in enumerate(zip(SIDES, printed, strict=True)):
            why = (
                f"share of the samples above {1e3 * slip_velocity:g} mm/s; the shipped record has "
                f"{100.0 * shipped[level][side]:.2f} %. {_others(shares[level], slip_velocity)}"
            )
            name = f"slip share of the {word} damper, {level} [%]"
            ours, less, more = (
                100.0 * shares[level][velocity][:, side] for velocity in (slip_velocity, *_ends(slip_velocity))
            )
            error = slip_error(less, more)
            claims.append(evidence_claim(f"slip_{word}_{level}", name, ours, why, printed=100.0 * share, error=error))
    return claims


def _ends(slip_velocity: float) -> tuple[float, float]:
    """Return the velocities [m/s] whose shares bound the error of a row, see `slip_error`."""
    return (1.0 - SLIP_STEP) * slip_velocity, (1.0 + SLIP_STEP) * slip_velocity


def _others(shares: Mapping[float, Vector], slip_velocity: float) -> str:
    """Return a text with the shares of both dampers at the other velocities, and at the ends of the error."""
    texts = [
        f"{right:.1f} / {left:.2f} % above {1e3 * velocity:g} mm/s"
        for velocity in OTHER_VELOCITIES
        for right, left in [100.0 * np.mean(shares[velocity], axis=0)]
    ]
    less, more = (100.0 * np.mean(shares[velocity], axis=0) for velocity in _ends(slip_velocity))
    ends = ", ".join(f"{side} {low:.2f} to {high:.2f}" for side, low, high in zip(SIDES, more, less, strict=True))
    return (
        f"Right / left by other definitions: {', '.join(texts)}. Error: half of the change from "
        f"{1e3 * _ends(slip_velocity)[1]:g} to {1e3 * _ends(slip_velocity)[0]:g} mm/s ({ends} %)"
    )


def slip_table(shares: Shares) -> str:
    """Return table 3.2 with our means at all velocities."""
    rows = [
        (
            level,
            f"{1e3 * velocity:g}",
            *(text for pair in zip(printed, means, strict=True) for text in _percents(*pair)),
        )
        for level, printed in PUBLISHED_SLIP.items()
        for velocity in sorted(shares[level])
        for means in [np.mean(shares[level][velocity], axis=0)]
    ]
    columns = ("level", "slip above [mm/s]", "right, published", "right, ours", "left, published", "left, ours")
    return f"Share of the time in slip [%], means over the records:\n\n{markdown(columns, rows)}"


def _percents(published: float, ours: float) -> tuple[str, str]:
    return f"{100.0 * published:g}", f"{100.0 * ours:.2f}"
