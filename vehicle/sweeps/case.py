"""One run of a sweep: a car with changed parameters on an input."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Protocol

from vehicle.errors import ConfigurationError
from vehicle.excitation.random_road import random_road
from vehicle.excitation.signal import Signal
from vehicle.excitation.signal_file import read_signal


class Input(Protocol):
    """What excites the car in a case: small, picklable, hashable."""

    @property
    def name(self) -> str:
        """Name in tables."""

    def signal(self) -> Signal:
        """Make or read the signal."""

    def identity(self) -> dict[str, object]:
        """Plain data that tell the signal from every other."""

    def __hash__(self) -> int:
        """Equal inputs are made once per process."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SignalFile:
    """A signal file as an input; its path is resolved where the sweep is started."""

    path: Path
    wheel: str = "fr"
    accept_implausible: bool = False

    @property
    def name(self) -> str:
        """Name in tables."""
        return self.path.stem

    def signal(self) -> Signal:
        """Read the file."""
        return read_signal(self.path, wheel=self.wheel, accept_implausible=self.accept_implausible)

    def identity(self) -> dict[str, object]:
        """What the runs depend on: the content of the file."""
        try:
            content = self.path.read_bytes()
        except OSError as error:
            raise ConfigurationError(f"{self.path}: cannot be read: {error.strerror}; give another input") from None
        digest = hashlib.sha256(content).hexdigest()
        return {"sha256": digest, "wheel": self.wheel, "accept_implausible": self.accept_implausible}


@dataclass(frozen=True, kw_only=True, slots=True)
class RandomRoad:
    """A generated road as an input; arguments as of `random_road`."""

    name: str
    rms: float
    seed: int
    duration: float
    lower_band_edge: float
    upper_band_edge: float = 50.0
    roll_off_order: int = 0
    taper_length: float = 0.5
    wheel: str = "fr"

    def signal(self) -> Signal:
        """Generate the road."""
        arguments = asdict(self)
        arguments.pop("name")
        return random_road(**arguments)

    def identity(self) -> dict[str, object]:
        """What the runs depend on."""
        return asdict(self)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class GivenSignal:
    """A signal that exists already as an input; it travels with every case."""

    name: str
    value: Signal

    def signal(self) -> Signal:
        """The signal."""
        return self.value

    def identity(self) -> dict[str, object]:
        """What the runs depend on."""
        digest = hashlib.sha256(self.value.time.tobytes())
        for wheel, values in self.value.displacement.items():
            digest.update(wheel.encode() + values.tobytes())
        return {"sha256": digest.hexdigest()}


# A worker meets the same few inputs in thousands of cases.
@lru_cache(maxsize=8)
def signal_of(source: Input) -> Signal:
    """Signal of an input, made once per process."""
    return source.signal()


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """A run.

    Attributes:
        overrides: parameter path to value text or number, applied in this order.
        source: the input.
        engine: as of `Car.run`.
        vehicle: vehicle file; the car of source 1 by default.
    """

    overrides: tuple[tuple[str, object], ...]
    source: Input
    engine: str = "auto"
    vehicle: Path | None = None

    def texts(self) -> list[str]:
        """Overrides as `Car.load` takes them."""
        return [
            f"{path}={value!r}" if isinstance(value, float) else f"{path}={value}" for path, value in self.overrides
        ]

    @property
    def label(self) -> str:
        """The case in words."""
        return ", ".join([self.source.name, *self.texts()])


def grid(
    variations: Mapping[str, Sequence[object]],
    inputs: Sequence[Input],
    *,
    engine: str = "auto",
    vehicle: Path | None = None,
    fixed: Sequence[tuple[str, object]] = (),
) -> list[Case]:
    """Every combination of parameter values on every input, the last parameter varying fastest.

    Args:
        variations: parameter path to its values.
        inputs: the inputs, varying slowest.
        engine, vehicle: as of `Case`.
        fixed: overrides of every case, before the varied ones.
    """
    values = list(product(*variations.values()))
    return table_cases(list(variations), values, inputs, engine=engine, vehicle=vehicle, fixed=fixed)


def table_cases(
    paths: Sequence[str],
    rows: Sequence[Sequence[object]],
    inputs: Sequence[Input],
    *,
    engine: str = "auto",
    vehicle: Path | None = None,
    fixed: Sequence[tuple[str, object]] = (),
) -> list[Case]:
    """A case for every row of parameter values on every input.

    Args:
        paths: parameter paths, the columns.
        rows: values.
        inputs: the inputs, varying slowest.
        engine, vehicle, fixed: as of `grid`.
    """
    return [
        Case(overrides=(*fixed, *zip(paths, row, strict=True)), source=source, engine=engine, vehicle=vehicle)
        for source in inputs
        for row in rows
    ]


def digest(parts: object) -> str:
    """Short digest of plain data; equal data, equal digest."""
    text = json.dumps(parts, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:20]
