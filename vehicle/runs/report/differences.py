"""Differences of a car from the shipped car, and between several runs."""

from collections.abc import Sequence

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.parameter_list import flattened
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.model.parameters.vehicle import Vehicle, load_vehicle
from vehicle.names import point_words, side_of
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import named

MISSING = "–"
"""Text of a parameter or value that a car or run does not have."""

LARGEST_SHARE = 0.5
"""Largest share of other or further parameters in a car that was made from a shipped one: above it a car counts
as a new car. Front ends and bodies are shared by shipped cars, which differ from each other in 0.6 and more."""


def shipped_origin(vehicle: Vehicle) -> Vehicle | None:
    """Return the shipped car of the same name, else the shipped car with the fewest different parameters.

    Returns:
        The shipped car; None if every shipped car differs in more than `LARGEST_SHARE` of the parameters.
    """
    if vehicle.name in CARS:
        return load_vehicle(vehicle_file(vehicle.name))
    parameters, shares = dict(flattened(vehicle.table)), dict[str, float]()
    for name in CARS:
        other = dict(flattened(vehicle_table(vehicle_file(name))))
        paths = {*parameters, *other}
        shares[name] = sum(parameters.get(path) != other.get(path) for path in paths) / len(paths)
    nearest = min(shares, key=lambda name: shares[name])
    return load_vehicle(vehicle_file(nearest)) if shares[nearest] <= LARGEST_SHARE else None


def changed_parameters(vehicles: Sequence[Vehicle]) -> list[tuple[str, str, list[str]]]:
    """Return the parameters in which cars differ.

    Returns:
        Path, unit, and the value of each car as text ("–" for a missing parameter), in the order of the first car.
    """
    tables = [dict(flattened(vehicle.table)) for vehicle in vehicles]
    paths = dict.fromkeys(path for table in tables for path in table)
    changes = []
    for path in paths:
        values = [table.get(path) for table in tables]
        if any(value != values[0] for value in values[1:]):
            owner = vehicles[next(i for i, value in enumerate(values) if value is not None)]
            changes.append((path, _unit(owner, path), [_text(value) for value in values]))
    return changes


def _unit(vehicle: Vehicle, path: str) -> str:
    try:
        return str(vehicle.quantity_of(path).get("unit", ""))
    except (ConfigurationError, KeyError):
        return ""


def _text(value: object) -> str:
    if value is None:
        return MISSING
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(_text(item) for item in value)}]"
    return str(value)


def key_figures(run: FinishedRun) -> dict[tuple[str, str], float | None]:
    """Return the key figures for the comparison of runs, by name and unit."""
    summary = run.summary
    figures: dict[tuple[str, str], float | None] = {}
    for point, value in run.comfort.items():
        label = point_words(point)
        figures[f"{label}: weighted RMS (ISO 2631-1), all axes", "m/s²"] = value.weighted
        figures |= {
            (f"{label}: unweighted RMS, 2 to 50 Hz, {axis}", "m/s²"): rms for axis, rms in value.rms_2_50_hz.items()
        }
    shares, limits = summary.slip_shares, summary.slip_limits
    for wheel, share in shares.items():
        damper, limit = side_of(wheel, shares), 1e3 * limits[wheel]
        figures[f"{damper} damper: time above {limit:g} mm/s", "%"] = 100.0 * share
        figures[f"{damper} damper: first above {limit:g} mm/s", "s"] = summary.first_slip_s[wheel]
    for wheel, plate, resonances in run.peaks:
        for channel in (f"knuckle_{wheel}_acc_z", "seat_rail_acc_z"):
            peaks = resonances.get(channel)
            if not peaks:
                continue
            top = max(peaks, key=lambda peak: peak.magnitude)
            point = point_words(channel.removesuffix("_acc_z")) + (f" to the {plate}" if plate else "")
            figures[f"{point}, z: frequency of the highest resonance", "Hz"] = top.frequency_hz
            figures[f"{point}, z: its height", "m/s² per m"] = top.magnitude
    return figures


GENERAL = ("parts", "bushings", "hardpoints", "points")
"""Tables whose names have no meaning for a reader."""


def parameter_words(path: str) -> str:
    """Return the path of a parameter in words: "front damper Coulomb friction" for front.damper.coulomb_friction."""
    names = [point_words(name) for name in path.split(".") if name not in GENERAL]
    names = [name for name, following in zip(names, [*names[1:], ""], strict=True) if name not in following]
    return " ".join(names).replace("coulomb", "Coulomb")


def parameter_rows(changed: Sequence[tuple[str, str, Sequence[str]]]) -> list[tuple[str, ...]]:
    """Return the rows of a table of `changed_parameters`: words, unit, values."""
    return [(named(path, parameter_words(path)), unit, *values) for path, unit, values in changed]


DIFFERENCES = {"s": "s", "%": "points"}
"""Units compared by a difference instead of a ratio, with the unit of the difference: a time counts from the start of
the record, and a share may be near zero."""


def difference(first: float | None, other: float | None, unit: str = "") -> str:
    """Return the change between two values: a difference for the units of `DIFFERENCES`, else in percent; or a dash.

    Args:
        first, other: values; None if missing.
        unit: unit of both.
    """
    if first is None or other is None:
        return "–"
    if unit in DIFFERENCES:
        return f"{other - first:+.3g} {DIFFERENCES[unit]}"
    if first == 0.0:
        return "–"
    change = 100.0 * (other / first - 1.0)
    return f"{change:+.0f} %" if abs(change) >= 10.0 else f"{change:+.1f} %"
