"""Values of a run over an obstacle: peak-to-peak acceleration, dose, settling time, peaks of the knuckles."""

from collections.abc import Sequence

from vehicle.digits import finite
from vehicle.names import AXES
from vehicle.runs.car import Run
from vehicle.runs.figures.run_batch import evaluated
from vehicle.runs.figures.value import shown_figures
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
    channels, runs = run.recording.channels, evaluated(run)
    points = [point for point in POINTS if all(f"{point}_acc_{axis}" in channels for axis in AXES)]

    def value(figure: str) -> float:
        return shown_figures([figure], runs, "obstacle")[0].value

    def settling(point: str) -> float | None:
        return finite(value(f"settling:{point}_acc_z"))

    def doses(point: str) -> dict[str, float]:
        names = [f"{point}_acc_{axis}" for axis in AXES]
        each = {axis: value(f"vdv:{name}:seat") for axis, name in zip(AXES, names, strict=True)}
        return each | {"overall": value(f"vdv:{'+'.join(names)}:seat")}

    return ObstacleSummary(
        obstacle=str(road["obstacle"]),
        from_s=float(times[0]),
        to_s=float(times[1]),
        peak_to_peak={point: {axis: value(f"peak_to_peak:{point}_acc_{axis}") for axis in AXES} for point in points},
        vdv={point: doses(point) for point in points},
        settling_s={point: settling(point) for point in points},
        knuckle_peak={
            wheel: value(f"peak:{knuckle}")
            for wheel in run.car.vehicle.wheels
            if (knuckle := f"knuckle_{wheel}_acc_z") in channels
        },
    )
