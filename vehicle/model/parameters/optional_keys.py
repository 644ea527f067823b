"""Optional keys of a vehicle file: parameters with a default, further laws, and tables of one side."""

import dataclasses
import typing
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from vehicle.model.parameters.air_spring import AirSpring
from vehicle.model.parameters.body import MAX_MODES, BodyInertia, BodyMode, TrimmedBody
from vehicle.model.parameters.compose import parameter_kinds
from vehicle.model.parameters.driving import Crank, Driving
from vehicle.model.parameters.engine_orders import ENGINE, ORDERS, EngineOrders
from vehicle.model.parameters.force_elements import Bushing, Damper, MainSpring, Tyre
from vehicle.model.parameters.force_table import ForceTable
from vehicle.model.parameters.instance import instances
from vehicle.model.parameters.paths import is_zero_vector
from vehicle.model.parameters.quantity import type_hints
from vehicle.model.parameters.semi_active_damper import SemiActiveDamper
from vehicle.model.parameters.tested_range import TestedRange
from vehicle.model.parameters.wheel_forces import WHEEL_FORCES
from vehicle.names import AXES, SIDE_SIGN

WITH_FILES = (Damper, ForceTable, MainSpring, Bushing)
"""Parameter classes whose numbers may be in a file that `curve` names."""

TABLES = (ForceTable, SemiActiveDamper, TestedRange)
"""Parameter classes of tables inside the table of an element."""


def optional_paths(table: Mapping[str, Any], folder: Path) -> list[str]:
    """Return the paths that a vehicle file does not contain but may contain, those of the sides last.

    Raises:
        ConfigurationError: its templates or their keys are wrong.
    """
    car = instances(table, (folder, folder / "templates"))
    kinds = parameter_kinds(car, table)
    paths = ["shaker_wheel", "shaker_wheel_in_source", "apply_forces", "solver.timestep"]
    paths += [f"crank.{key}" for key in Crank.__dataclass_fields__]
    paths += [f"driving.{key}" for key in _keys(Driving, everything=False)]
    paths += [f"body.{key}" for key in _keys(TrimmedBody, everything=False) if key != "modes"]
    paths += [f"body.inertia.{key}" for key in _keys(BodyInertia, everything=False)]
    # An ideal joint becomes a bushing by numbers.
    bushings = [f"{i.name}.bushings.{link.name}" for i in car.values() for link in i.template.connection]
    ideal = dict.fromkeys((path for path in bushings if path not in kinds), Bushing)
    axles = [i.name for i in car.values() if i.template.wheel is not None]
    turning = {f"{axle}.{name}": kind for axle in axles for name, kind in WHEEL_FORCES.items()}
    new: dict[str, type] = {**ideal, **{path: kind for path, kind in turning.items() if path not in kinds}}
    engines = [i for i in car.values() if ENGINE in i.template.parts]
    new |= {f"{i.name}.{ORDERS}": EngineOrders for i in engines if not i.has(ORDERS)}
    every = {**kinds, **new}
    paths += [f"{path}.{key}" for path, parameters in new.items() for key in _keys(parameters, everything=True)]
    for path, parameters in every.items():
        # A bushing becomes a hydromount by the numbers of its branch.
        paths += [f"{path}.{key}" for key in _keys(parameters, everything=False)]
        if parameters in (Bushing, Tyre):
            paths += [f"{path}.{key}" for key in _keys(AirSpring, everything=True)]
    sides = []
    for i in car.values():
        inside = [path.removeprefix(f"{i.name}.") for path in every if path.startswith(f"{i.name}.")]
        keys = [f"{path}.{key}" for path in inside for key in _keys(every[f"{i.name}.{path}"], everything=True)]
        keys += [f"hardpoints.{name}" for name in i.template.hardpoints]
        sides += [f"{i.name}.{side}.{key}" for side in SIDE_SIGN if i.template.mirrored for key in keys]
    changes = list(_keys(BodyMode, everything=False))
    modes = [f"body.modes.{number}.{key}" for number in range(1, MAX_MODES + 1) for key in changes]
    return list(dict.fromkeys(path for path in (*paths, *sides, *modes) if _missing(table, path)))


def _keys(parameters: type[Any], *, everything: bool) -> Iterator[str]:
    """Yield the keys of a parameter class that have a default, or all keys; inner tables key by key, zeros by axis."""
    hints = type_hints(parameters)  # type: ignore[arg-type]
    if parameters in WITH_FILES:
        yield "curve"
    for entry in dataclasses.fields(parameters):
        needed = entry.default is dataclasses.MISSING and entry.default_factory is dataclasses.MISSING
        inner = next((table_type for table_type in TABLES if table_type in typing.get_args(hints[entry.name])), None)
        if inner is not None:
            yield entry.name
            keys = _keys(inner, everything=everything or inner is ForceTable)
            yield from (f"{entry.name}.{key}" for key in keys)
        elif everything or not needed:
            yield entry.name
            if is_zero_vector(entry.default):
                yield from (f"{entry.name}.{axis}" for axis in AXES)


def _missing(table: Mapping[str, Any], path: str) -> bool:
    inner: Any = table
    for key in path.split("."):
        if not isinstance(inner, Mapping) or key not in inner:
            return True
        inner = inner[key]
    return False
