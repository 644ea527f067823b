"""Notices of a run without those that hold for every run of its shipped car: the documentation contains the latter."""

from collections.abc import Iterable

from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.output.run_comfort import NO_SEAT
from vehicle.runs.report.differences import shipped_origin


def without_general(notices: Iterable[str], vehicle: Vehicle) -> list[str]:
    """Return notices without those of every run of the shipped car from which a car was made."""
    general = {NO_SEAT}
    origin = shipped_origin(vehicle)
    if origin is not None:
        general.add(rigid_body(origin.body).report)
    return [text for text in notices if text not in general]
