"""Notice on the mode whose peak is lowered most by the speed of a run-up of the crankshaft."""

import math
from typing import Any

from vehicle.digits import number
from vehicle.signals.analysis.order_cut import TURNS
from vehicle.signals.analysis.run_up_peak import run_up_peak

LOW = 0.03
"""Loss of a peak [-] from which a notice mentions it."""

MAIN = 0.1
"""Share of the largest amplitude of a force from which an order counts."""

HIGHEST = 60.0
"""Highest mode [Hz]."""


def run_up_notice(car: Any) -> tuple[str, ...]:
    """Return text on the mode whose peak the speed of the run-up lowers most; none without a run-up."""
    run_up = car.vehicle.composition.crank_run_up
    orders = set[float]()
    for force in car.vehicle.composition.forces:
        if force.run_up is not None and force.harmonics:
            largest = max(map(abs, force.harmonics.values()))
            orders |= {
                frequency / force.speed for frequency, size in force.harmonics.items() if abs(size) > MAIN * largest
            }
    if run_up is None or not orders:
        return ()
    modes = [mode for mode in car.modes(highest=HIGHEST) if 0.0 < mode.damping_ratio < 1.0]
    # Of a measured speed the mean rate between its extremes.
    slowest, fastest = (run_up.speeds.index(each) for each in (min(run_up.speeds), max(run_up.speeds)))
    low, high = (run_up.speeds[each] / (2.0 * math.pi) for each in (slowest, fastest))
    turn_rate = (high - low) / abs(run_up.times[fastest] - run_up.times[slowest] or math.inf)
    passed = [
        (mode, order) for order in sorted(orders) for mode in modes if order * low < mode.frequency < order * high
    ]
    if not passed:
        return ()
    # The peak of a mode is lost with rate over bandwidth squared, and in a window over bandwidth.
    mode, order = max(passed, key=lambda each: each[1] * turn_rate / (each[0].frequency * each[0].damping_ratio) ** 2)
    rate = order * turn_rate
    window = TURNS * order / mode.frequency
    amplitude, _ = run_up_peak(mode.frequency, mode.damping_ratio, rate)
    read, late = run_up_peak(mode.frequency, mode.damping_ratio, rate, window)
    if read > 1.0 - LOW:
        return ()
    direction = "late" if fastest > slowest else "early"
    return (
        f"the run-up passes the mode at {number(mode.frequency)} Hz ({number(100.0 * mode.damping_ratio, 2)} %, "
        f"{mode.description}) in order {order:g} with {number(rate, 2)} Hz/s, which is fast: its peak is "
        f"{100.0 * (1.0 - amplitude):.0f} % too low, in an order cut over {TURNS} turns "
        f"{100.0 * (1.0 - read):.0f} %, and {number(late, 2)} Hz {direction}. For full peaks use steady speeds: "
        "python -m vehicle orders --rpm A:B:STEP",
    )
