"""Memory that a fit to measurements needs, stated before its first run."""

from collections.abc import Sequence
from pathlib import Path

from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.output.run_size import batch_memory, say_size
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget

TABLES = 3.0
"""Tables of residuals in memory for each parameter: of both sides of a difference, and their derivatives."""


def state_fit_size(vehicle: Vehicle, measurements: Sequence[MeasuredTarget], parameters: int, engine: str) -> None:
    """State the memory of a fit from 1 GB on, and refuse what does not fit; see `run_size.stated_size`.

    The runs are one after the other, so that the longest one counts; the residuals are kept for each parameter:

    memory = `batch_memory` of the longest run + 8 residuals (1 + `TABLES` parameters)

    Args:
        vehicle: parameters of the car.
        parameters: number of fitted parameters.
        engine: engine of the last steps.

    Raises:
        ConfigurationError: more than the memory of the machine.
    """
    longest, residuals, memory = 0.0, 0, 0.0
    for target, signal in ((each.target, each.signal) for each in measurements):
        if signal is None:
            continue
        samples = signal.duration * vehicle.solver.record_rate
        memory = max(memory, batch_memory(samples, len(target.recorded), reduced=engine == "reduced"))
        longest = max(longest, samples)
        if isinstance(target, RecordTarget):
            residuals += target.kept.size * len(target.recorded)
        else:
            residuals += 2 * target.data.response.size  # real and imaginary part
    say_size(
        Path(),
        f"{len(measurements)} measurements of up to {longest:.3g} samples",
        memory + 8.0 * residuals * (1.0 + TABLES * parameters),
        0.0,
        "to reduce it, compare a shorter part or fewer channels, or choose a lower solver.record_rate",
    )
