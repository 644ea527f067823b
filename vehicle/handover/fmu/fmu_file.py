"""FMU of a car: model description, numbers of the car, and the prebuilt libraries of all platforms, in one file."""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.handover.fmu.car_numbers import car_numbers
from vehicle.handover.fmu.model_description import IDENTIFIER, model_description
from vehicle.handover.fmu.variables import Variable, variables
from vehicle.names import FMI_VERSIONS

if TYPE_CHECKING:
    from vehicle.runs.car import Car

FOLDER = Path(__file__).parent
BINARIES = FOLDER / "binaries"
"""Libraries, built by tools/core.py."""

PLATFORMS = {
    "x86_64-linux": ("linux64", ".so"),
    "x86_64-windows": ("win64", ".dll"),
    "x86_64-darwin": ("darwin64", ".dylib"),
    "aarch64-darwin": (None, ".dylib"),
}
"""Platforms by their name in FMI 3.0, with that in FMI 2.0 (None: it has none) and the ending of the library."""

DEFAULT_STEP = 1e-4
"""Internal time step [s]: common communication steps (0.1, 0.2, 0.5, 1, 2, 5, 10 ms) are multiples of it."""

SHORTEST_STEP, LONGEST_STEP = 1e-6, 5e-4
"""Range of the internal time step [s]; above, the instants of sticking and slipping are too coarse."""

EPOCH = (1980, 1, 1, 0, 0, 0)
"""Date of the files: equal cars give equal bytes."""


@dataclass(frozen=True, kw_only=True, slots=True)
class WrittenFmu:
    """Written FMU."""

    path: Path  # the file
    variables: tuple[Variable, ...]  # its variables
    platforms: tuple[str, ...]  # its platforms, by their names in FMI 3.0
    step: float  # internal time step [s]

    def count(self, causality: str) -> int:
        """Return the number of variables of a causality."""
        return sum(variable.causality == causality for variable in self.variables)


def write_fmu(
    car: Car,
    path: Path | str,
    *,
    fmi: str = FMI_VERSIONS[0],
    channels: Sequence[str] | None = None,
    step: float = DEFAULT_STEP,
) -> WrittenFmu:
    """Write a car as an FMU for co-simulation.

    The FMU is the car of the reduced engine at a fixed internal step.

    Args:
        car: the car.
        path: file, with the ending .fmu.
        fmi: version of the standard, "2" or "3".
        channels: names of recorded channels among the outputs, those on request among them; by default all but those.
        step: internal time step [s]; communication steps must be multiples of it.

    Returns:
        Path, variables and platforms of the file.

    Raises:
        ConfigurationError: a value is out of range, a channel does not exist, the car is unstable, or has a
            controller in an FMU.
        MissingPartError: the libraries are not in the package.
    """
    if str(fmi) not in FMI_VERSIONS:
        raise ConfigurationError(f"fmi: must be one of {', '.join(FMI_VERSIONS)}, not {fmi!r}")
    if not SHORTEST_STEP <= step <= LONGEST_STEP:
        raise ConfigurationError(f"step: found {step:g} s, must be {SHORTEST_STEP:g} to {LONGEST_STEP:g} s")
    target = Path(path)
    if target.suffix != ".fmu":
        raise ConfigurationError(f"{target}: the name of an FMU must end in .fmu")
    names = car.vehicle.channels if channels is None else tuple(channels)
    car.vehicle.require_channels(names, (*car.vehicle.channels, *car.vehicle.requested_channels))
    car.check("reduced")
    numbers = car_numbers(car, names, step)
    entries = variables(numbers, [damper.law for damper in car.vehicle.composition.dampers])
    speed = car.vehicle.driving.speed if car.vehicle.driving.rolling else 0.0
    description = (
        f"{car.vehicle.name}, {f'rolling at {3.6 * speed:.4g} km/h' if speed else 'on plates'}; valid for small "
        "rotations (a warning appears beyond). Inputs are values at the END of a communication step: if the master "
        "sets the values at its start, the car responds one step late. Communication steps must be multiples "
        f"of {step:g} s."
    )
    text = model_description(car.vehicle.name, numbers.token, entries, fmi=str(fmi), step=step, description=description)
    files = {"modelDescription.xml": text.encode(), "resources/car.bin": numbers.content}
    libraries = _libraries(str(fmi))
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in (files | libraries).items():
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)
    platforms = tuple(name for name, (second, _) in PLATFORMS.items() if str(fmi) == "3" or second)
    return WrittenFmu(path=target, variables=tuple(entries), platforms=platforms, step=step)


def _libraries(fmi: str) -> dict[str, bytes]:
    """Return the libraries of all platforms by their names in the FMU."""
    entries = {}
    for platform, (second, ending) in PLATFORMS.items():
        folder = second if fmi == "2" else platform
        library = BINARIES / platform / f"{IDENTIFIER}{ending}"
        if folder is None:
            continue
        if not library.is_file():
            raise MissingPartError(
                f"{library} is missing; build it with python tools/core.py fmu, or install the package again"
            )
        entries[f"binaries/{folder}/{library.name}"] = library.read_bytes()
    return entries
