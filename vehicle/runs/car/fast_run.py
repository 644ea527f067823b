"""Run of the reduced engine without its stated errors and notices, which a fit and the notes of a sweep do not read."""

from collections.abc import Sequence

from vehicle.runs.car.car import Car
from vehicle.runs.car.run import Run
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.signals.excitation.signal import Signal
from vehicle.threads import one_blas_thread


@one_blas_thread()
def fast_run(car: Car, signal: Signal, channels: Sequence[str]) -> Run:
    """Return a run, see `Car.run`, of the reduced engine without its second order, two thirds of the time."""
    simulated, recording, reason = simulated_run(car, signal, None, "reduced", channels, stated=False)
    return Run(car=simulated, signal=signal, recording=recording, engine_reason=reason)
