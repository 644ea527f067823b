"""Notice on the excited mode whose peak is lowered most by the speed of a run-up of the crankshaft."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.digits import number
from vehicle.engines.linear.car_modes import Mode
from vehicle.signals.analysis.order_cut import TURNS
from vehicle.signals.analysis.run_up_peak import run_up_peak

LOW = 0.03
"""Loss of a peak [-] from which a notice mentions it."""

MAIN = 0.1
"""Share of the largest amplitude of a force from which an order counts."""

EXCITED = 0.1
"""Minimum acceleration of a mode in a run-up over the largest of all modes."""

HIGHEST = 60.0
"""Highest mode [Hz]."""


def run_up_notice(car: Any) -> tuple[str, ...]:
    """Return text on the mode whose peak the speed of the run-up lowers most; none without a run-up.

    Modes count that the force excites: their acceleration at some channel, in the run-up, is at least `EXCITED` of the
    largest of all modes.
    """
    run_up = car.vehicle.composition.crank_run_up
    sizes: dict[float, Complex] = {}
    for row, force in enumerate(car.vehicle.composition.forces):
        if force.run_up is not None and force.harmonics:
            largest = max(map(abs, force.harmonics.values()))
            for frequency, size in force.harmonics.items():
                if abs(size) > MAIN * largest:
                    order = round(frequency / force.speed, 9)
                    sizes[order] = sizes.get(order, 0.0) + size * car.matrices.force_rows[row]
    if run_up is None or not sizes:
        return ()
    modes = [mode for mode in car.modes(highest=HIGHEST) if 0.0 < mode.damping_ratio < 1.0]
    # Of a measured speed the mean rate between its extremes.
    slowest, fastest = (run_up.speeds.index(each) for each in (min(run_up.speeds), max(run_up.speeds)))
    low, high = (run_up.speeds[each] / (2.0 * math.pi) for each in (slowest, fastest))
    turn_rate = (high - low) / abs(run_up.times[fastest] - run_up.times[slowest] or math.inf)
    passed = [_Passed(mode, order, order * turn_rate) for order in sorted(sizes) for mode in modes
              if order * low < mode.frequency < order * high]  # fmt: skip
    outputs = np.concatenate(
        [np.atleast_2d(car.matrices.system.output(name)[0]) for name in car.matrices.system.outputs]
    )
    reached = [each.reached(outputs, sizes[each.order]) for each in passed]
    excited = [each for each, size in zip(passed, reached, strict=True) if size >= EXCITED * max(reached)]
    if not excited:
        return ()
    # The peak of a mode is lost with rate over bandwidth squared, and in a window over bandwidth.
    fastest_pass = max(excited, key=lambda each: each.rate / (each.mode.frequency * each.mode.damping_ratio) ** 2)
    mode, order, (read, late) = (
        fastest_pass.mode,
        fastest_pass.order,
        fastest_pass.peak(TURNS * fastest_pass.order / fastest_pass.mode.frequency),
    )
    if read > 1.0 - LOW:
        return ()
    direction = "late" if fastest > slowest else "early"
    return (
        f"the run-up passes the mode at {number(mode.frequency)} Hz ({number(100.0 * mode.damping_ratio, 2)} %, "
        f"{mode.description}) in order {order:g} with {number(fastest_pass.rate, 2)} Hz/s, which is fast: its peak is "
        f"{100.0 * (1.0 - fastest_pass.peak()[0]):.0f} % too low, in an order cut over {TURNS} turns "
        f"{100.0 * (1.0 - read):.0f} %, and {number(late, 2)} Hz {direction}. For full peaks use steady speeds: "
        "python -m vehicle orders --rpm A:B:STEP",
    )


@dataclass(frozen=True, slots=True)
class _Passed:
    """Mode that an order passes at a rate [Hz/s]."""

    mode: Mode
    order: float
    rate: float

    def peak(self, window: float = 0.0) -> tuple[float, float]:
        """Return peak over steady peak and delay [Hz], see `run_up_peak`; `window` in s."""
        return run_up_peak(self.mode.frequency, self.mode.damping_ratio, self.rate, window)

    def reached(self, outputs: Vector, force: Complex) -> float:
        """Return the largest acceleration of the mode in the run-up [m/s2]: |c phi| |f phi| w / (|A| z) times the peak.

        Args:
            outputs: rows of the acceleration channels; (channels, n).
            force: complex generalised force of the order; (n,).
        """
        mode, circular = self.mode, 2.0 * math.pi * self.mode.frequency
        steady = abs(force @ mode.shape) * circular / (abs(mode.modal_a) * mode.damping_ratio)
        return float(np.max(np.abs(outputs @ mode.shape)) * steady * self.peak()[0])
