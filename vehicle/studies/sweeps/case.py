"""Case of a sweep: a car with modified parameters on an input."""

import hashlib
import json
from collections.abc import Mapping, Sequence
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
    """Excitation of the car in a case: small, picklable, hashable."""

    @property
    def name(self) -> str:
        """Return the name in tables."""

    def signal(self) -> Signal:
        """Generate or read the signal."""

    def identity(self) -> dict[str, object]:
        """Return plain data that identify the signal."""

    def __hash__(self) -> int:
        """Return a hash; the signals of equal inputs are generated once per process."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SignalFile:
    """Signal file as an input."""

    path: Path  # absolute path of the file
    wheel: str = ""  # driven wheel for a file without wheel names; empty for `Vehicle.shaker_wheel` of the car
    accept_implausible: bool = False  # accept levels above those of any shaker

    @property
    def name(self) -> str:
        """Return the name in tables."""
        return self.path.stem

    def signal(self) -> Signal:
        """Read the file."""
        return read_signal(self.path, wheel=self.wheel, accept_implausible=self.accept_implausible)

    def identity(self) -> dict[str, object]:
        """Return digest of the file, wheel and option: all data that the runs depend on."""
        try:
            content = self.path.read_bytes()
        except OSError as error:
            raise ConfigurationError(f"{self.path}: cannot be read: {error.strerror}; use another input") from None
        digest = hashlib.sha256(content).hexdigest()
        return {"sha256": digest, "wheel": self.wheel, "accept_implausible": self.accept_implausible}


def signal_of(source: Input) -> Signal:
    """Return the signal of an input, cached in the process; a file that has changed is read again."""
    file = getattr(source, "path", getattr(source, "road", None))
    return _signal(source, file.stat().st_mtime_ns if isinstance(file, Path) and file.is_file() else 0)


# Thousands of cases of a worker share a few inputs.
@lru_cache(maxsize=8)
def _signal(source: Input, changed: int) -> Signal:
    return source.signal()


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """Case of a sweep: an input, a car and an engine."""

    source: Input  # the input, for example a `Signal`
    # texts "path=value" of two variations: the first `shared` texts by `Car.load`, the others of that car
    overrides: tuple[str, ...] = ()
    engine: str = "auto"  # simulation engine, see `Car.run`
    vehicle: Path | None = None  # vehicle file; by default the Focus of Bommer 2006
    # number of leading overrides common to the whole study: the car is modified from the car with these overrides,
    # which is fast if only laws and masses vary. Values may change in the ninth digit.
    shared: int = 0

    @property
    def label(self) -> str:
        """Return the name of the input and the overrides."""
        return ", ".join([self.source.name, *self.overrides])


def overrides_of(source: Input) -> tuple[str, ...]:
    """Return the overrides that an input sets in the car: the speed of tyres that roll on a road."""
    overrides: tuple[str, ...] = getattr(source, "overrides", ())
    return overrides


def rates_of(case: Case) -> tuple[str, ...]:
    """Return the overrides of the record rate, on which the size of a run depends."""
    return tuple([text for text in case.overrides if "record_rate" in text])


def drivings(cases: Sequence[Case]) -> Mapping[str, tuple[Driving, ...]]:
    """Return name of the input to the driving states of its cars; invalid cars are left out."""
    # Thousands of cases share a few speeds; no other override changes the speed.
    combinations: dict[tuple[str, Path | None, tuple[str, ...]], None] = {}
    for case in cases:
        speeds = tuple([text for text in case.overrides if "speed" in text])
        combinations[case.source.name, case.vehicle, speeds] = None
    states: dict[str, tuple[Driving, ...]] = {}
    for name, vehicle, speeds in combinations:
        try:
            driving = driving_of(overridden(vehicle or FOCUS_FILE, speeds))
        except ConfigurationError:
            continue  # the row of the case contains the reason
        states[name] = (*states.get(name, ()), driving)
    return states


def all_tyre_words(cases: Sequence[Case]) -> str:
    """Return a description of the state of the tyres in all cases, see `tyre_words`."""
    return tyre_words(car for cars in drivings(cases).values() for car in cars)


def digest(parts: object) -> str:
    """Return a short digest of plain data; equal data have equal digests."""
    text = json.dumps(parts, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:20]


def changes(case: Case) -> dict[str, str]:
    """Return parameter path to value text; the last value of a repeated path."""
    return {path: value for path, _, value in [text.partition("=") for text in case.overrides]}


def parameter_cells(case: Case, paths: Sequence[str]) -> list[str]:
    """Return the value text of each path in a case; empty for a parameter that the case does not modify."""
    changed = changes(case)
    return [changed.get(path, "") for path in paths]
