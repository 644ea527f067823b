"""Runs of the variants of a fit: the reduced engine without its errors, which no step of a fit reads."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle.runs.car import Car, Run
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.signals.excitation.signal import Signal
from vehicle.threads import one_blas_thread


@one_blas_thread()
def fast_run(car: Car, signal: Signal, channels: Sequence[str]) -> Run:
    """Return a run with the reduced engine; the second order of the car, two thirds of its time, is not computed.

    Args:
        car: variant of the car of the fit.
        signal: displacement of the plates.
        channels: names of the recorded channels.

    Raises:
        VehicleError: see `Car.run`.
    """
    simulated, recording, reason = simulated_run(car, signal, None, "reduced", channels, stated=False)
    return Run(car=simulated, signal=signal, recording=recording, engine_reason=reason)
