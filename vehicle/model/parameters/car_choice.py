"""Choice of a car: its vehicle file and changed parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True, slots=True)
class CarChoice:
    """Choice of a car.

    Attributes:
        vehicle: vehicle file; by default the car of Bommer 2006.
        overrides: changed parameters, for example "path=value".
    """

    vehicle: Path | None = None
    overrides: tuple[str, ...] = ()

    def load(self) -> Vehicle:
        """Return the parameters of the car, without its body; `vehicle.Car.load` takes the same two values."""
        from vehicle.model.parameters.vehicle import load_vehicle

        return load_vehicle(self.vehicle, self.overrides)

    @property
    def folder(self) -> Path | None:
        """Folder of the vehicle file."""
        return None if self.vehicle is None else self.vehicle.parent

    def require_once(self, option: str, texts: Sequence[str]) -> None:
        """Check that the parameters that an option sets are not changed to another value too.

        Raises:
            ConfigurationError: a change sets one of these parameters.
        """
        for text in texts:
            path = text.partition("=")[0]
            for other in self.overrides:
                key = other.partition("=")[0].strip().removeprefix("*.")
                if other.strip() != text and (path == key or path.endswith(f".{key}")):
                    raise ConfigurationError(
                        f"{option} and --set {other.strip()}: both set {path}; leave one of them out"
                    )

    def with_(self, option: str, *texts: str) -> CarChoice:
        """Return the choice with the parameters "path=value" that an option sets, see `require_once`."""
        self.require_once(option, texts)
        return replace(self, overrides=(*self.overrides, *texts))

    def rolling(self, speed: float | None) -> CarChoice:
        """Return the choice with the tyres rolling at the value of --speed [km/h]; None changes nothing."""
        return self if speed is None else self.with_("--speed", f"driving.speed={speed / 3.6!r}")
