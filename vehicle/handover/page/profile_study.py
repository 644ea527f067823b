"""Vibration of a car over a whole measured profile as a study: printed table and file, for the command `shaker`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.handover.page.shaker_settings import ShakerSettings
from vehicle.names import AXES
from vehicle.runs.output.folder import output_folder, write_text
from vehicle.runs.output.listener import Listener
from vehicle.signals.analysis.ride_comfort import MEANING, SEAT_PREFIX, SEAT_VALUE, UNWEIGHTED, WEIGHTED
from vehicle.signals.excitation.input_settings import DriveInput

if TYPE_CHECKING:
    from vehicle.runs.car.profile_value import ProfileValue

FILE = "profile.json"
"""Name of the file with values, errors and pieces."""


def on_pieces(settings: ShakerSettings) -> bool:
    """Return True for a measured profile of which a precision is asked for."""
    from vehicle.runs.car.road import named_road

    source = settings.source
    if not isinstance(source, DriveInput) or source.settings.precision is None:
        return False
    return isinstance(named_road(str(source.road)), Path)


def profile_study(settings: ShakerSettings, listener: Listener, command: str) -> str:
    """Run pieces of the profile, write the values of the whole, and return the printed lines.

    Raises:
        ConfigurationError: a setting of a single run, or see `over_profile`.
    """
    from vehicle.runs.car.car import Car
    from vehicle.runs.car.profile_value import over_profile
    from vehicle.runs.car.road import road_of
    from vehicle.runs.report.general_notices import without_general

    settings.require_no_others("--precision runs pieces of a measured profile", "engine", "skip")
    assert isinstance(settings.source, DriveInput)
    choice, road = settings.car, road_of(settings.source)
    car = Car.load(choice.vehicle, choice.overrides)
    name = f"profile_{Path(road.road).stem}_{road.speed}"
    protect = tuple(path for path in (road.file, choice.vehicle) if isinstance(path, Path))
    output = settings.destination.folder(Path("runs") / name, protect=protect)
    value = over_profile(car, road, settings.engine, skip=settings.skip)
    listener.accept(value.notices)
    notices = without_general(value.notices, car.vehicle)
    with output_folder(output, force=settings.destination.force, protect=protect) as folder:
        write_text(folder / FILE, json.dumps(_data(value, command), indent=1) + "\n")
    return "\n".join([*_lines(value), *(f"note        {text}" for text in notices), f"files       {output}: {FILE}"])


def _lines(value: ProfileValue) -> list[str]:
    """Return the printed lines."""
    lines = [f"profile     {value.words}"]
    for prefix, point in (("", "seat rail"), (SEAT_PREFIX, "cushion")):
        for name in (UNWEIGHTED, WEIGHTED):
            if f"{prefix}{name}" not in value.values:
                continue
            axes = ", ".join(f"{axis} {value.text(f'{prefix}{name}_{axis}')}" for axis in AXES)
            lines.append(f"comfort     {point} {value.text(f'{prefix}{name}')} {MEANING[name]} ({axes})")
    if SEAT_VALUE in value.values:
        lines.append(f"            SEAT value {value.text(SEAT_VALUE)} (z, Wk)")
    loads = [f"{name.removeprefix('tyre_load_')} {value.text(name)}" for name in value.values if "tyre_" in name]
    return [*lines, f"tyre load   RMS of the dynamic load {', '.join(loads)}"]


def _data(value: ProfileValue, command: str) -> dict[str, object]:
    """Return the content of the file."""
    each = {
        name: {"value": value.values[name], "half_interval": value.half_intervals[name], "unit": unit}
        for name, unit in value.units.items()
    }
    return {
        "command": command,
        "car": value.run.car.vehicle.name,
        "engine": value.run.recording.statistics.engine,
        "road": value.road,
        "evaluated_s": value.length,
        "pieces": value.pieces,
        "parts_s": [list(part) for part in value.parts],
        "run_s": value.run.signal.duration,
        "notices": list(value.notices),
        "values": each,
    }
