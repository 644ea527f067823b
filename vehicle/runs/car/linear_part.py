"""Linear part of a car on a road of a class: the responses that cars with other force laws of their dampers share.

A car that differs from its base car in further parameters gets a linear part of its own: from its poles, or, by ports,
from the responses of the base car (`vehicle.engines.reduced.line_ports`). Ports take 0.1 s once for the parameters that
change, and then a tenth of the time that new poles take, so they pay in studies of many cars.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.reduced.line_ports import LinePorts
from vehicle.engines.reduced.linear_twin import LinearTwin, linear_twin
from vehicle.engines.reduced.road_expectation import Lines, integral_lines, track_sources
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.paths import meant, value_at
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad
from vehicle.signals.excitation.road_drive import RoadDrive

LINES = 200
"""Lines of the integrals. Against 20 000 lines, weighted comfort and tyre loads of the shipped cars differ by at most
0.003 %, comfort in 2 to 50 Hz by 0.03 %."""

LAW_NUMBERS = (
    *("viscous", "degressive_viscous", "degressive_velocity", "coulomb_friction", "smoothing"),
    *("stribeck_friction", "stribeck_velocity", "stribeck_exponent"),
)
"""Parameters of a damper that change its force over velocity alone, neither preloads nor other elements."""

EXAMPLE = 1.25
"""Factor of a parameter in the example of the directions in which it changes a car; a zero becomes 1."""

UNIT_CLASS = "A"
"""Class whose responses are computed; other classes multiply them by the root of their level."""


class LinearPart(NamedTuple):
    """Linear part of cars that differ in the force laws of their dampers alone, on a road."""

    lines: Lines
    twin: LinearTwin  # channels, then the displacements of the nonlinear laws
    matrices: CarMatrices
    static: StaticTrim


class _Itself:
    """A car as a key of a cache: the object, not its parameters, whose comparison takes longer than an estimate."""

    def __init__(self, car: Any) -> None:
        self.car = car

    def __hash__(self) -> int:
        return id(self.car)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Itself) and other.car is self.car


def linear_part(car: Any, road: RoadDrive, channels: tuple[str, ...], *, by_ports: bool) -> LinearPart:
    """Return the linear part of a car on a road of a class.

    Args:
        car: the car.
        road: class and speed.
        channels: accelerations and tyre forces.
        by_ports: use the responses of the car that `car` was varied from where possible.

    Raises:
        ConfigurationError: the car is unstable.
    """
    # Roads of one class, and cars of equal linear parts, share them; classes differ by a factor.
    of_class = dict[str, Any](seed=1, tagged=False, duration=None, start=None, period=None, chosen="", precision=None)
    unit = _part(*_split(car), replace(road, road=UNIT_CLASS, **of_class), channels, by_ports)
    factor = np.sqrt(CLASSES[str(road.road)] / CLASSES[UNIT_CLASS])
    twin = unit.twin
    return unit._replace(twin=replace(twin, outputs=factor * twin.outputs, slip=factor * twin.slip))


def _split(car: Any) -> tuple[_Itself, tuple[str, ...]]:
    """Return a car, and the changes of parameters that make the linear part of `car` of it."""
    if car._base is None:
        return _Itself(car), ()
    of_dampers = [text for text in car._step if _key_of_damper(text)]
    if not all(_key_of_damper(text) in LAW_NUMBERS for text in of_dampers):
        return _Itself(car._base), car._step  # another law, which is incomplete without its numbers
    return _Itself(car._base), tuple(text for text in car._step if text not in of_dampers)


def _key_of_damper(text: str) -> str:
    """Return the parameter of a damper that "path=value" sets; empty for another path."""
    path = text.partition("=")[0].strip().split(".")
    return path[-1] if path[-2:-1] == ["damper"] else ""


# The cars of a study share a few linear parts if its dampers vary.
@lru_cache(maxsize=32)
def _part(
    base: _Itself, changes: tuple[str, ...], road: RoadDrive, channels: tuple[str, ...], by_ports: bool
) -> LinearPart:
    """Return the linear part of a base car with changes, on a road of the unit class."""
    reference = _reference(base, road.overrides).car
    car = reference.with_(changes) if changes else reference
    lines, plates = _driven(road, tuple(car.vehicle.wheels))
    twin = None
    if changes and by_ports and car._from_terms is not None:
        names = tuple(text.partition("=")[0].strip() for text in changes)
        ports = _ports(_Itself(reference), names, road, channels)
        twin = None if ports is None else ports.twin(car.matrices)
    if twin is None:
        car.check("reduced")
        twin = linear_twin(car.poles, channels, lines.frequency, plates, further=car.poles.law_outputs)
    return LinearPart(lines, twin, car.matrices, car.static)


@lru_cache(maxsize=16)
def _reference(base: _Itself, by_road: tuple[str, ...]) -> _Itself:
    """Return a base car on a road."""
    return _Itself(base.car.with_(by_road)) if by_road else base


@lru_cache(maxsize=16)
def _driven(road: RoadDrive, wheels: tuple[str, ...]) -> tuple[Lines, Any]:
    """Return the lines of a road, and the plates for unit densities of its sources."""
    speed = road.speed / 3.6
    surface = IsoRoad(
        level=CLASSES[str(road.road)],
        seed=road.seed,
        track=road.track,
        coherence=road.coherence,
        patch=road.patch,
        envelope=road.envelope,
    )
    placed = {wheel: (behind, side) for wheel, behind, side in road.wheels}
    lines = integral_lines(surface, speed, road.rate, LINES)
    return lines, track_sources(surface, speed, {wheel: placed[wheel] for wheel in wheels}, lines.frequency)


@lru_cache(maxsize=8)
def _ports(reference: _Itself, names: tuple[str, ...], road: RoadDrive, channels: tuple[str, ...]) -> LinePorts | None:
    """Return the ports of cars that differ from a reference car in named parameters; None without."""
    car = reference.car
    car.check("reduced")
    examples = _examples(car, names)
    if examples is None:
        return None
    lines, plates = _driven(road, tuple(car.vehicle.wheels))
    try:
        return LinePorts(car.poles, channels, lines.frequency, plates, examples)
    except np.linalg.LinAlgError:
        return None


def _examples(car: Any, names: Sequence[str]) -> list[CarMatrices] | None:
    """Return a car for each named parameter with another value; None if one is no number of laws or masses."""
    examples, table = list[CarMatrices](), car.vehicle.table
    for name in names:
        value = value_at(table, meant(table, name, lambda: car._optional)[0])
        if isinstance(value, bool) or not isinstance(value, int | float):
            return None
        try:
            example = car.with_([f"{name}={EXAMPLE * value or 1.0!r}"])
            if example._from_terms is None:
                return None
            examples.append(example.matrices)
        except (ConfigurationError, SimulationError):
            return None
    return examples
