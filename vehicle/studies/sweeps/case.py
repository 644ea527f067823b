"""One run of a sweep: a car with changed parameters on an input."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Protocol

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.driving import Driving, driving_of, tyre_words
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.vehicle import overridden
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal


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
    """Signal file as an input.

    Attributes:
        path: the file, resolved where the sweep is started.
        wheel: driven by a signal that names no wheel; `Vehicle.shaker_wheel` is that of a car.
        accept_implausible: accept levels that no shaker has.
    """

    path: Path
    wheel: str
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


# A worker meets the same few inputs in thousands of cases.
@lru_cache(maxsize=8)
def signal_of(source: Input) -> Signal:
    """Signal of an input, made once per process."""
    return source.signal()


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """A run.

    Attributes:
        source: the input; a `Signal` is one.
        overrides: texts "path=value" as `Car.load` takes them, applied in this order.
        engine: as of `Car.run`.
        vehicle: vehicle file; the car of Bommer 2006 by default.
        shared: how many of the overrides, from the first, the whole study has: its cars are varied from the one with
            these, which is quick where only laws and masses vary. The numbers may move in the ninth digit.
    """

    source: Input
    overrides: tuple[str, ...] = ()
    engine: str = "auto"
    vehicle: Path | None = None
    shared: int = 0

    @property
    def label(self) -> str:
        """The case in words."""
        return ", ".join([self.source.name, *self.overrides])


def table_cases(
    paths: Sequence[str],
    rows: Iterable[Sequence[object]],
    inputs: Sequence[Input],
    *,
    engine: str = "auto",
    vehicle: Path | None = None,
    fixed: Sequence[str] = (),
) -> list[Case]:
    """A case for every row of parameter values on every input.

    Args:
        paths: parameter paths, the columns.
        rows: values.
        inputs: the inputs, varying slowest.
        engine, vehicle: as of `Case`.
        fixed: overrides of every case, before those of its input and the varied ones.
    """
    changes = [tuple(f"{path}={value}" for path, value in zip(paths, row, strict=True)) for row in rows]
    return varied_cases(changes, inputs, engine=engine, vehicle=vehicle, fixed=fixed)


def varied_cases(
    changes: Sequence[tuple[str, ...]],
    inputs: Sequence[Input],
    *,
    engine: str = "auto",
    vehicle: Path | None = None,
    fixed: Sequence[str] = (),
) -> list[Case]:
    """Return a case for every variation on every input.

    Args:
        changes: texts "path=value" of each variation.
        inputs, engine, vehicle, fixed: as in `table_cases`.
    """
    found = []
    for one in inputs:
        shared = (*fixed, *overrides_of(one))
        found += [
            Case(source=one, overrides=(*shared, *each), engine=engine, vehicle=vehicle, shared=len(shared))
            for each in changes
        ]
    return found


def overrides_of(source: Input) -> tuple[str, ...]:
    """What an input asks of the car: tyres that roll at the speed of a road."""
    asked: tuple[str, ...] = getattr(source, "overrides", ())
    return asked


def drivings(cases: Sequence[Case]) -> Mapping[str, tuple[Driving, ...]]:
    """Return how the cars of cases drive, by the names of their inputs; cars that cannot be made are left out."""
    # Thousands of cases share a few speeds; all else in their overrides leaves the speed as it is.
    asked: dict[tuple[str, Path | None, tuple[str, ...]], None] = {}
    for case in cases:
        speeds = tuple(text for text in case.overrides if text.partition("=")[0].strip().endswith("speed"))
        asked[case.source.name, case.vehicle, speeds] = None
    found: dict[str, tuple[Driving, ...]] = {}
    for name, vehicle, speeds in asked:
        try:
            driving = driving_of(overridden(vehicle or FOCUS_FILE, speeds))
        except ConfigurationError:
            continue  # the row of the case says why
        found[name] = (*found.get(name, ()), driving)
    return found


def all_tyre_words(cases: Sequence[Case]) -> str:
    """Return what the tyres do in all cases, see `tyre_words`."""
    return tyre_words(car for cars in drivings(cases).values() for car in cars)


def digest(parts: object) -> str:
    """Short digest of plain data; equal data, equal digest."""
    text = json.dumps(parts, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:20]
