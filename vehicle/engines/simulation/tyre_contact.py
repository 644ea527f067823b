"""Messages about tyres in a run: linear tyres that pull on their plates, and tyres that left them."""

from collections.abc import Iterable, Mapping

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.parameters.force_elements import LIFTS, PULLS

NO_LOAD = 1e-6
"""Maximum load of a tyre that has left its plate over its static load: round-off in both engines, 1e-10 and 1e-8."""

SMALL_PULL = 0.085
"""Maximum RMS of the pull of linear tyres over the RMS of their dynamic load without a warning. Against tyres that lift
off, 11 runs of shipped and new cars on classes C and D: up to 8.1 % comfort differs by at most 0.7 %, its axes by 1.6 %
and the RMS of tyre loads by 1.7 %; at 9.1 % by 0.4, 1.6 and 2.2 %, at 15 % by 1.2, 2.3 and 5.6 %."""


def pulling_tyres(forces: Mapping[str, Vector], record_rate: float) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return a warning about linear tyres that pull on their plates, or a notice if that hardly matters.

    Args:
        forces: vertical force histories [N] of linear tyres by wheel, (n,) each.
        record_rate: rate of the samples [Hz].
    """
    low = sorted((wheel for wheel in forces if np.min(forces[wheel]) < 0.0), key=lambda wheel: np.min(forces[wheel]))
    if not low:
        return (), ()
    worst, also = forces[low[0]], f"; also {', '.join(low[1:])}" if low[1:] else ""
    start, lowest = int(np.argmax(worst < 0.0)) / record_rate, int(np.argmin(worst))
    # RMS of the part below zero over the standard deviation, the RMS of the dynamic load.
    pull = max(float(np.sqrt(np.mean(np.minimum(forces[wheel], 0.0) ** 2)) / np.std(forces[wheel])) for wheel in low)
    text = (
        f"tyre {low[0]} {LIFTS} at t = {start:.3f} s (lowest load {worst[lowest]:.0f} N at "
        f"{lowest / record_rate:.3f} s{also}); "
    )
    if pull > SMALL_PULL:
        return (f"{text}{PULLS}",), ()
    return (), (
        f"{text}the linear tyre pulls with {100.0 * pull:.1f} % of its dynamic load (RMS), which "
        "changes comfort, its axes and the RMS of tyre loads by less than 2 %",
    )


def lift_off_notices(
    channels: Mapping[str, Vector], one_sided: Iterable[str], tyre_load: Mapping[str, float], record_rate: float
) -> tuple[str, ...]:
    """Return notices about one-sided tyres that left their plates, if their load is recorded.

    Args:
        channels: time histories by channel name.
        one_sided: wheels whose tyres cannot pull.
        tyre_load: static tyre loads [N] by wheel.
        record_rate: rate of the samples [Hz].
    """
    messages = []
    for wheel in one_sided:
        away = channels.get(f"tyre_{wheel}_force_z", np.full(1, np.inf)) <= NO_LOAD * tyre_load[wheel]
        if away.any():
            messages.append(
                f"tyre {wheel} left its plate at t = {int(np.argmax(away)) / record_rate:.3f} s, for "
                f"{np.count_nonzero(away) / record_rate:.3g} s in all"
            )
    return tuple(messages)
