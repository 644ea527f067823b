"""Runs of the variants of a fit: the reduced engine without its errors, which no step of a fit reads."""

from collections.abc import Sequence

from vehicle.runs.car import Car, Run
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.signals.excitation.signal import Signal
from vehicle.threads import one_blas_thread


@one_blas_thread()
def fast_run(car: Car, signal: Signal, channels: Sequence[str]) -> Run:
    """Return a run, see `Car.run`, of the reduced engine without its second order, two thirds of the time."""
    simulated, recording, reason = simulated_run(car, signal, None, "reduced", channels, stated=False)
    return Run(car=simulated, signal=signal, recording=recording, engine_reason=reason)
