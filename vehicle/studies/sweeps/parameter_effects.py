"""Effects of the single parameters of a car: each is changed alone, down and up, in one sweep.

All cars drive on the same road, so a change has a far smaller error than the comfort values themselves
(`vehicle.studies.sweeps.change_error`).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.parameter_list import parameter_list
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.ranges import is_coordinate
from vehicle.model.parameters.vehicle import Vehicle, load_vehicle
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.settings import with_settings
from vehicle.studies.sweeps.change_error import NO_PERCENTAGE, change_errors, half_width
from vehicle.studies.sweeps.effects import Effect, Effects, effects_evaluation
from vehicle.studies.sweeps.plan import SweepPlan, plan_sweep
from vehicle.studies.sweeps.sweep_inputs import Inputs
from vehicle.studies.sweeps.sweep_ranking import ROUNDING, figure_names
from vehicle.studies.sweeps.sweep_settings import SHARE, SHIFT, EffectSettings, SweepSettings
from vehicle.studies.sweeps.sweep_table import SweepTable

UNITS = ("N/m", "N s/m", "N", "N m/rad", "N/rad", "kg")
"""Units of the parameters that are varied by default: stiffness, damping, friction and mass of a law or a part."""

LEFT_OUT = ("gravity", "smoothing")
"""Last keys of parameters that are never varied by default: they belong to the computation."""


def varied_parameters(vehicle: Vehicle, groups: Sequence[str] = ()) -> dict[str, tuple[float, str]]:
    """Return path to value and unit of the parameters of groups; by default all with a unit of `UNITS`.

    Args:
        groups: paths or parts of paths, for example "front.damper", "viscous" or "tyre".

    Returns:
        Path to value and unit; the forces of a curve are one parameter, whose value is the largest of them.
    """
    numbers: dict[str, tuple[float, str]] = {}
    for each in parameter_list(vehicle, None):
        if _is_curve(each.path, each.value):
            numbers[each.path] = max(map(abs, each.value)), each.unit
        elif isinstance(each.value, int | float) and not isinstance(each.value, bool):
            numbers[each.path] = float(each.value), each.unit
        elif isinstance(each.value, list | tuple) and len(each.value) == len(AXES):
            components = {f"{each.path}.{axis}": part for axis, part in zip(AXES, each.value, strict=True)}
            numbers |= {
                path: (float(part), each.unit) for path, part in components.items() if isinstance(part, int | float)
            }
    # A zero has no share; a coordinate is moved.
    nonzero = {path: pair for path, pair in numbers.items() if pair[0] != 0.0 or is_coordinate(vehicle, path)}
    if not groups:
        return {
            path: pair for path, pair in nonzero.items() if pair[1] in UNITS and path.rpartition(".")[2] not in LEFT_OUT
        }
    chosen: dict[str, tuple[float, str]] = {}
    for group in groups:
        part = f".{group.removeprefix('*.')}."
        members = {path: pair for path, pair in nonzero.items() if part in f".{path}."}
        if not members:
            raise ConfigurationError(
                f"--vary {group}: matches no numeric parameter other than 0; list parameters with `vehicle show "
                f"--search {group}`"
            )
        chosen |= members
    return chosen


def single_changes(
    vehicle: Vehicle, parameters: dict[str, tuple[float, str]], share: float, shift: float = SHIFT
) -> tuple[list[tuple[str, ...]], tuple[str, ...]]:
    """Return the unchanged car and two cars for each parameter with effect, and the parameters without effect.

    Args:
        parameters: see `varied_parameters`.
        share: relative change of each parameter [-].
        shift: change of each coordinate [m].
    """
    if not 0.0 < share < 1.0:
        raise ConfigurationError(f"--each {100.0 * share:g} %: must be above 0 and below 100 %")
    if not 0.0 < shift <= 0.1:
        raise ConfigurationError(f"--each {1e3 * shift:g} mm: must be above 0 and at most 100 mm")
    without = tuple(path for path in parameters if idle_parameters(vehicle, (_scaled(vehicle, path, parameters, 1.0),)))
    changes: list[tuple[str, ...]] = [()]
    for path, (value, _) in parameters.items():
        if path in without:
            continue
        if is_coordinate(vehicle, path):
            changes += [(f"{path}={end!r}",) for end in (value - shift, value + shift)]
        else:
            changes += [(_scaled(vehicle, path, parameters, factor),) for factor in (1.0 - share, 1.0 + share)]
    if len(changes) == 1:
        raise ConfigurationError(f"--vary: no parameter has an effect on this car: {', '.join(without)}")
    return changes, without


def _require_one_figure(settings: SweepSettings) -> None:
    """Check that parameters are ranked by one figure."""
    names = settings.measure
    if isinstance(names, Sequence | Mapping) and not isinstance(names, str) and len(names) > 1:
        raise ConfigurationError(f"parameters are ranked by one figure; found {len(names)}; give one --measure")


def _is_curve(path: str, value: Any) -> bool:
    """Return True for the forces of a curve, for example `damper.force` over `damper.velocity`."""
    return path.rpartition(".")[2] == "force" and isinstance(value, list | tuple)


def _scaled(vehicle: Vehicle, path: str, parameters: Mapping[str, tuple[float, str]], factor: float) -> str:
    """Return the override of a parameter, or of all forces of a curve, times a factor."""
    present = value_at(vehicle.table, path)
    value = [force * factor for force in present] if _is_curve(path, present) else parameters[path][0] * factor
    return f"{path}={value!r}"


@with_settings(EffectSettings)
def parameter_effects(car: Car, inputs: Inputs, settings: EffectSettings) -> Effects:
    """Change each parameter of a car alone, down and up, and rank the parameters by their effect on comfort.

    Call this function below `if __name__ == "__main__":`, like `sweep`.

    Args:
        car: car loaded by `Car.load`.
        inputs: files, names of shipped files, roads, signals; one or several.

    Returns:
        Effects, largest first; printed as a table and as text.

    Raises:
        ConfigurationError: a group without parameters, a share out of range, several figures, and as in `sweep`.
        DataError: the value of the unchanged car is missing or 0, so changes cannot be given in percent.
    """
    _require_one_figure(settings)
    changes, effects = SingleChanges(settings.groups, settings.share, settings.shift).of(car.vehicle)
    return effects(plan_sweep(car, changes, inputs, settings).run())


@dataclass(frozen=True, slots=True)
class SingleChanges:
    """Design of a sweep: each parameter of a car changed alone, down and up, ranked by the effects on comfort."""

    vehicle: ClassVar[str] = ""
    groups: Sequence[str] = ()  # groups, share, shift: see `EffectSettings`
    share: float = SHARE
    shift: float = SHIFT

    def of(self, vehicle: Vehicle) -> tuple[list[tuple[str, ...]], Callable[[SweepTable], Effects]]:
        """Return the changes of a car, and the function that returns the effects in their table."""
        parameters = varied_parameters(vehicle, self.groups)
        changes, without = single_changes(vehicle, parameters, self.share, self.shift)
        return changes, lambda table: effects_of(table, parameters, self.share, without, self.shift)

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Return the checked sweep; see `Design`; errors: as in `parameter_effects`."""
        _require_one_figure(settings)
        changes, effects = self.of(car.vehicle)
        return plan_sweep(
            car, changes, inputs, settings, lambda table, caption: effects_evaluation(effects(table), caption)
        )


def effects_of(
    table: SweepTable,
    parameters: dict[str, tuple[float, str]],
    share: float,
    without: Sequence[str] = (),
    shift: float = SHIFT,
) -> Effects:
    """Return the effects of the parameters of a sweep over `single_changes`, the mean change over all inputs.

    Args:
        parameters: see `varied_parameters`.
        share: relative change of each parameter [-].
        without: parameters without effect, which have no run.
        shift: change of each coordinate [m].
    """
    inputs = len({id(case.source) for case in table.cases})
    name = figure_names(table.units)[0]
    # The inputs vary slowest.
    rows = np.arange(len(table.cases)).reshape(inputs, -1)
    base = table.cases[0]
    vehicle = load_vehicle(base.vehicle, base.overrides[: base.shared])
    values = table.column(name)[rows]
    unchanged = values[:, :1]
    for row, value in zip(rows[:, 0], unchanged[:, 0], strict=True):
        if not np.isfinite(value) or value == 0.0:
            fault = "is 0" if value == 0.0 else f"has no value ({table.results[row].reason or 'it is undefined'})"
            raise DataError(
                f"--each: {name} of the unchanged car on {table.cases[row].source.name} {fault}, so {NO_PERCENTAGE}"
            )
    # Each input counts by its relative change, so that a loud one does not outweigh the others.
    changes = 100.0 * np.mean(np.sign(unchanged) * (values / unchanged - 1.0), axis=0)
    errors, events = change_errors(table.rows(), rows.T.tolist(), name)
    widths = 100.0 * half_width(errors / np.abs(unchanged.T))
    varied = [path for path in parameters if path not in without]
    effects = []
    for index, path in enumerate(varied):
        value, unit = parameters[path]
        low, high = 1 + 2 * index, 2 + 2 * index
        change, step = value * share, f"{number(100.0 * share)} %"
        if is_coordinate(vehicle, path):
            change, step = shift, f"{number(1e3 * shift)} mm"
        effects.append(
            Effect(
                path=path, unit=unit, value=value, low=value - change, high=value + change, step=step,
                change_low=float(changes[low]), change_high=float(changes[high]),
                half_width=float(max(widths[low], widths[high])),
            )
        )  # fmt: skip
    idle = [
        each.path
        for each in effects
        if np.isfinite((each.change_low, each.change_high)).all() and each.largest <= 100.0 * ROUNDING
    ]
    ranked = sorted((each for each in effects if each.path not in idle), key=lambda each: -each.largest)
    return Effects(
        effects=tuple(ranked),
        name=name,
        unit=table.units[name],
        base=float(np.mean(unchanged)),
        without=(*without, *idle),
        inputs=inputs,
        event=bool(events.all()),
    )
