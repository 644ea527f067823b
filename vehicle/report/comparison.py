"""What differs: the car of a run from the shipped one, and several runs among each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.names import side_of
from vehicle.parameters.shipped import VEHICLES
from vehicle.parameters.vehicle import Vehicle, load_vehicle
from vehicle.report.finished_run import FinishedRun

DEFAULT = "focus"
"""The car that others are compared with which have no shipped namesake."""


def flattened(table: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, object]]:
    """Values of a vehicle file by their whole paths."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from flattened(value, f"{path}{key}.")
        else:
            yield path + key, value


def default_of(vehicle: Vehicle) -> Vehicle:
    """The shipped car of the same name, else the default one."""
    name = vehicle.name if (VEHICLES / vehicle.name / "vehicle.toml").is_file() else DEFAULT
    return load_vehicle(VEHICLES / name / "vehicle.toml")


def changed_parameters(vehicles: Sequence[Vehicle]) -> list[tuple[str, str, list[str]]]:
    """Parameters in which cars differ.

    Args:
        vehicles: cars.

    Returns:
        Path, unit, and the value of each car as text ("–" where it has none), in the order of the first
        car that has it.
    """
    tables = [dict(flattened(vehicle.table)) for vehicle in vehicles]
    paths = dict.fromkeys(path for table in tables for path in table)
    found = []
    for path in paths:
        values = [table.get(path) for table in tables]
        if any(value != values[0] for value in values[1:]):
            owner = vehicles[next(i for i, value in enumerate(values) if value is not None)]
            found.append((path, _unit(owner, path), [_text(value) for value in values]))
    return found


def _unit(vehicle: Vehicle, path: str) -> str:
    try:
        return str(vehicle.quantity_of(path).get("unit", ""))
    except (ConfigurationError, KeyError):
        return ""


def _text(value: object) -> str:
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(_text(one) for one in value)}]"
    return str(value)


def key_figures(run: FinishedRun) -> dict[tuple[str, str], float | None]:
    """Numbers in which runs are compared, by name and unit.

    Args:
        run: the run.
    """
    summary = run.summary
    found: dict[tuple[str, str], float | None] = {}
    for place, value in summary["comfort"].items():
        words = place.replace("_", " ")
        found[f"{words}: weighted RMS (ISO 2631-1), all axes", "m/s²"] = value["iso2631"]["vector_sum"]["weighted_rms"]
        found |= {
            (f"{words}: unweighted RMS, 2 to 50 Hz, {axis}", "m/s²"): rms for axis, rms in value["rms_2_50_hz"].items()
        }
    shares = {wheel: share for wheel, share in summary["slip_share"].items() if wheel != "slip_velocity"}
    for wheel, share in shares.items():
        found[f"{side_of(wheel, shares)} damper: time in slip", "%"] = 100.0 * share
        found[f"{side_of(wheel, shares)} damper: first slip", "s"] = summary["first_slip_s"][wheel]
    for channel in (f"knuckle_{run.wheel}_acc_z", "seat_rail_acc_z"):
        peaks = summary["peaks"].get(channel)
        if peaks:
            top = max(peaks, key=lambda peak: peak["magnitude"])
            found[f"{channel}: frequency of the highest resonance", "Hz"] = top["frequency_hz"]
            found[f"{channel}: its height", "m/s² per m"] = top["magnitude"]
    return found


DIFFERENCES = {"s": "s", "%": "percentage points"}
"""Units of which a ratio says nothing, with the unit of their difference: a time at which something happens is counted
from the start of the record, and a share may begin at next to none."""


def difference(first: float | None, other: float | None, unit: str = "") -> str:
    """Change from one number to another: a difference for the units of `DIFFERENCES`, else in percent; or a dash.

    Args:
        first, other: the numbers; None where there is none.
        unit: of both.
    """
    if first is None or other is None:
        return "–"
    if unit in DIFFERENCES:
        return f"{other - first:+.3g} {DIFFERENCES[unit]}"
    if first == 0.0:
        return "–"
    change = 100.0 * (other / first - 1.0)
    return f"{change:+.0f} %" if abs(change) >= 10.0 else f"{change:+.1f} %"
