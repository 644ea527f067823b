"""Length of a road class for a wanted precision of the weighted comfort, from short pilot runs.

The error of a run on a road that repeats is what its linear twin leaves (`vehicle.runs.car.run_twin`). It comes from
friction, which the linear car does not predict: closed predictions were 1 to 12 times too small. So a pilot of
`SHORTEST_SPAN_S` with the reduced engine gives half of its own 95 % interval, e(T), which falls with 1/sqrt(T), and
the evaluated span becomes

    T' = T (e(T)/P)^2,

in whole seconds. A pilot of this length confirms it, or gives the next T'.

Source: Kelton and Law, Simulation Modeling and Analysis, section 9.4: relative precision by sequential runs.
"""

import math
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.names import AXES
from vehicle.runs.car.run_twin import damper_channels, twin_comfort
from vehicle.runs.car.simulated_run import simulated_run
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.comfort_error import NORMAL_95
from vehicle.signals.analysis.ride_comfort import ERROR, WEIGHTED, comfort_columns, with_twins
from vehicle.signals.excitation.road_drive import SHORTEST_SPAN_S, RoadDrive
from vehicle.threads import one_blas_thread

Source = TypeVar("Source")

LONGEST_SPAN_S = 600.0
"""Maximum evaluated span that a precision chooses [s]."""

PILOTS = 3
"""Maximum number of pilot runs."""


@one_blas_thread()
def with_duration(car: Any, source: Source) -> Source:
    """Return a road of a class with the duration for its precision; other inputs, and one without, are unchanged.

    Args:
        car: the car, without the changes that the road makes.
        source: drive of the car, evaluated from its `skip` on.

    Raises:
        ConfigurationError: a car without a linear twin, or a measured profile (`vehicle.runs.car.profile_value`).
        SimulationError: a pilot failed.
    """
    if not isinstance(source, RoadDrive) or source.precision is None:
        return source
    if not source.repeats:
        raise ConfigurationError(
            "--precision: of a measured profile, a run of some pieces gives comfort and tyre loads of the whole in the "
            "command shaker and in over_profile; leave it out to run the whole profile"
        )
    wanted, span = source.precision, SHORTEST_SPAN_S
    for pilot in range(1, PILOTS + 1):
        drive = replace(source, precision=None, duration=source.skip + span)
        half = _half_interval(car, drive)
        if half <= wanted or span == LONGEST_SPAN_S or pilot == PILOTS:
            break
        span = min(float(math.ceil(span * (half / wanted) ** 2)), LONGEST_SPAN_S)
    limit = " (the maximum)" if span == LONGEST_SPAN_S and half > wanted else ""
    text = f"--precision {wanted:g}: {span:g} s of {drive.name} evaluated{limit}, the pilot states {number(half, 2)} %"
    return replace(drive, chosen=text)


def _half_interval(car: Any, drive: RoadDrive) -> float:
    """Return half of the 95 % interval of the weighted comfort of a pilot run [%]."""
    driven, signal = car._of_drive(drive.overrides), drive.signal()
    dampers = damper_channels(driven.vehicle)
    if not dampers:
        raise ConfigurationError(
            f"--precision: {driven.vehicle.name} has no damper, whose friction makes the error; set --duration"
        )
    rail = [f"seat_rail_acc_{axis}" for axis in AXES]
    _, recording, _ = simulated_run(driven, signal, None, "reduced", [*rail, *dampers], stated=False)
    step, rows = recording.timestep, np.stack([recording[name] for name in rail])
    columns = comfort_columns(step, rows[None], skip=drive.skip, names=[WEIGHTED])
    twin = twin_comfort(driven, signal, recording, drive.skip, ["seat_rail"], band=COMFORT_BAND, contact="seat")
    # Without a twin, while the road still rises, the error is that of the run alone.
    columns = columns if twin is None else with_twins(columns, twin)
    return 100.0 * NORMAL_95 * float(columns[f"{WEIGHTED}{ERROR}"][0])
