"""The complete parameter set of a car on the shaker rig."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.parameters.body import TrimmedBody
from vehicle.parameters.elements import Bushings, Damper, MainSpring, Stabilizer
from vehicle.parameters.hardpoints import Hardpoints
from vehicle.parameters.parts import Part, require_parts
from vehicle.parameters.paths import override
from vehicle.parameters.plausible import require_plausible
from vehicle.parameters.quantity import quantity, validate
from vehicle.parameters.toml_file import build, read_table

FOCUS_FILE = Path(str(resources.files("vehicle.parameters") / "focus.toml"))
"""The Ford-Focus-like car of source 1."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Solver:
    """Numerics of the time simulation."""

    timestep: float = quantity("s", "step of the integration", at_least=1e-6, at_most=0.005)
    record_rate: float = quantity("Hz", "sampling rate of the recorded channels", at_least=125.0, at_most=1e5)

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True, kw_only=True, slots=True)
class Vehicle:
    """Everything that defines a car on its rig; SI units, frame of the hardpoints."""

    name: str = quantity("-", "name of the car")
    gravity: float = quantity(
        "m/s2", "gravity", at_least=0.0, at_most=30.0, why="9.81 on Earth; 0 leaves the weight out"
    )
    hardpoints: Hardpoints
    body: TrimmedBody
    parts: Mapping[str, Part]
    bushings: Bushings
    main_spring: MainSpring
    stabilizer: Stabilizer
    damper: Damper
    solver: Solver

    def __post_init__(self) -> None:
        validate(self)
        require_parts(self.parts, self.hardpoints)
        require_plausible(self)


def load_vehicle(path: Path | None = None, overrides: Iterable[str] = ()) -> Vehicle:
    """Read and validate a vehicle file.

    Args:
        path: TOML file; the Ford-Focus-like car of source 1 by default.
        overrides: texts "path.to.parameter=value".

    Returns:
        The parameter set.

    Raises:
        ConfigurationError: the file, a name or a value is wrong; the message names it.
    """
    file = path or FOCUS_FILE
    try:
        return build(Vehicle, override(read_table(file), overrides))
    except ConfigurationError as error:
        if path is None:
            raise
        text = str(error)
        raise ConfigurationError(text if text.startswith((str(path), "--set")) else f"{path}: {text}") from None
