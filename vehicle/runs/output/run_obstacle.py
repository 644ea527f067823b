"""Values of a run over an obstacle: peak-to-peak acceleration, dose, settling time, peaks of the knuckles."""

from collections.abc import Sequence

import numpy as np

from vehicle.names import AXES
from vehicle.runs.car import Run
from vehicle.signals.analysis.evaluation import evaluate
from vehicle.signals.analysis.settled import settling_time
from vehicle.signals.records.run_summary import ObstacleSummary

POINTS = ("seat_rail", "seat")


def obstacle_values(run: Run) -> ObstacleSummary | None:
    """Return the values of a run over an obstacle, or None.

    All are of the evaluated span, which begins before the obstacle. Peaks are of the accelerations as recorded, without
    a filter. The settling time is from the last wheel leaving the obstacle to the last acceleration along z above
    10 % of its peak; None if that is the end of the record.
    """
    road = run.road or {}
    times = road.get("obstacle_s")
    if not isinstance(times, Sequence):
        return None
    channels = run.recording.channels
    points = [point for point in POINTS if all(f"{point}_acc_{axis}" in channels for axis in AXES)]
    doses = {
        point: evaluate(
            run.recording.timestep, [run[f"{point}_acc_{axis}"] for axis in AXES], skip=run.skip, from_rest=True,
            highest=run.signal.highest,
        )
        for point in points
    }  # fmt: skip
    time, left = run.time[run.evaluated], float(times[1])
    return {
        "obstacle": str(road["obstacle"]),
        "from_s": float(times[0]),
        "to_s": left,
        "peak_to_peak": {
            point: {axis: float(np.ptp(values)) for axis, values in zip(AXES, run.at(point), strict=True)}
            for point in points
        },
        "vdv": {
            point: {axis: float(doses[point][axis]["vdv"]) for axis in AXES}
            | {"overall": float(doses[point]["vector_sum"]["vdv"])}
            for point in points
        },
        "settling_s": {point: settling_time(time, run.at(point)[2], left) for point in points},
        "knuckle_peak": {
            wheel: float(np.max(np.abs(run[f"knuckle_{wheel}_acc_z"][run.evaluated])))
            for wheel in run.car.vehicle.wheels
            if f"knuckle_{wheel}_acc_z" in channels
        },
    }
