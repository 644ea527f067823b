"""Notices of a run without those that hold for every run of its shipped car: the documentation contains the latter."""

from __future__ import annotations

from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.runs.output.run_comfort import NO_SEAT
from vehicle.runs.report.differences import shipped_origin
from vehicle.runs.report.finished_run import FinishedRun


def notices_of(run: FinishedRun) -> list[str]:
    """Return the notices of a run without those of every run of the shipped car from which its car was made.

    Args:
        run: the run.
    """
    general = {NO_SEAT}
    origin = shipped_origin(run.car.vehicle)
    if origin is not None:
        general.add(rigid_body(origin.body).report)
    return [text for text in run.summary["notices"] if text not in general]
