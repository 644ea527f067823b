"""Measured mode shapes beside those of the car: MAC, AutoMAC, pairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.engines.linear.car_modes import Mode
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.modal_assurance import mac
from vehicle.signals.records.channel import Measurement
from vehicle.signals.records.geometry import Geometry, ModeShape
from vehicle.signals.records.reader import read_record

Complex = npt.NDArray[np.complex128]
Matrix = npt.NDArray[np.float64]

NEAR = 0.01
"""Distance within which a node of the file is taken for a place of the car [m]."""

LEAST_MAC = 0.5
"""MAC from which on two modes are a pair; from 0.9 on they are usually taken for the same."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Pair:
    """A measured mode and the simulated one that is most like it.

    Attributes:
        measured, simulated: numbers of the modes, from 1.
        mac: of their shapes [-].
        measured_hz, simulated_hz: natural frequencies [Hz].
        measured_damping, simulated_damping: damping ratios [-].
    """

    measured: int
    simulated: int
    mac: float
    measured_hz: float
    simulated_hz: float
    measured_damping: float
    simulated_damping: float

    @property
    def deviation(self) -> float:
        """(simulated - measured) / measured frequency [-]."""
        return self.simulated_hz / self.measured_hz - 1.0 if self.measured_hz > 0.0 else float("nan")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ModeComparison:
    """All modes.

    Attributes:
        points: place of the car to node of the file.
        measured, simulated: the modes.
        mac: (measured, simulated).
        measured_auto, simulated_auto: AutoMAC: off its diagonal it tells which modes these points cannot tell apart.
        pairs: by measured frequency.
    """

    points: Mapping[str, str]
    measured: Sequence[ModeShape]
    simulated: Sequence[Mode]
    mac: Matrix
    measured_auto: Matrix
    simulated_auto: Matrix
    pairs: tuple[Pair, ...]

    def summary(self, file: str) -> dict[str, Any]:
        """Plain numbers, for JSON."""
        return {
            "measured": file,
            "points": dict(self.points),
            "pairs": [
                {
                    "measured": one.measured,
                    "simulated": one.simulated,
                    "description": self.simulated[one.simulated - 1].description,
                    "mac": one.mac,
                    "measured_hz": one.measured_hz,
                    "simulated_hz": one.simulated_hz,
                    "deviation": one.deviation if np.isfinite(one.deviation) else None,
                    "measured_damping": one.measured_damping,
                    "simulated_damping": one.simulated_damping,
                }
                for one in self.pairs
            ],
            "mac": self.mac.tolist(),
            "measured_auto_mac": self.measured_auto.tolist(),
            "simulated_auto_mac": self.simulated_auto.tolist(),
            "measured_hz": [one.frequency for one in self.measured],
            "simulated_hz": [one.frequency for one in self.simulated],
        }

    def text(self, file: str) -> str:
        """The table for the console, worst first."""
        lines = [
            f"modes of {file} at {len(self.points)} points: {', '.join(self.points)}",
            f"{'measured':>10}{'[Hz]':>9}{'simulated':>11}{'[Hz]':>9}{'deviation':>11}{'MAC':>7}{'damping':>9}{'':>9}",
        ]
        for one in sorted(self.pairs, key=lambda pair: pair.mac):
            lines.append(
                f"{one.measured:>10}{one.measured_hz:>9.3f}{one.simulated:>11}{one.simulated_hz:>9.3f}"
                f"{100 * one.deviation:>+9.2f} %{one.mac:>7.3f}{100 * one.measured_damping:>7.2f} %"
                f"{100 * one.simulated_damping:>7.2f} %  {self.simulated[one.simulated - 1].description}"
            )
        alone = sorted(set(range(1, len(self.measured) + 1)) - {one.measured for one in self.pairs})
        if alone:
            shown = ", ".join(f"{self.measured[number - 1].frequency:.4g} Hz" for number in alone[:10])
            lines.append(f"no simulated mode with a MAC of {LEAST_MAC:g} or more: {shown}")
        alike = np.argwhere(np.triu(self.measured_auto, 1) > 0.9)
        if alike.size:
            shown = ", ".join(f"{one + 1} and {other + 1}" for one, other in alike[:6])
            lines.append(f"these points cannot tell measured modes apart (AutoMAC above 0.9): {shown}")
        return "\n".join(lines)


def _near(car: Geometry, nodes: Mapping[str, Sequence[float]]) -> dict[str, str]:
    """Places to the nodes that lie there; places that share a point only where as many nodes do, in order."""
    at, labels = np.array(list(nodes.values())).reshape(-1, 3), list(nodes)
    points = np.array(list(car.points.values())).reshape(-1, 3)
    found = {}
    for place, point in car.points.items():
        here = [labels[n] for n in np.flatnonzero(np.linalg.norm(at - np.array(point), axis=1) <= NEAR)]
        sharing = [
            name for name, other in zip(car.points, points, strict=True) if np.linalg.norm(other - point) <= NEAR
        ]
        if here and len(here) == len(sharing):
            found[place] = here[sharing.index(place)]
    return found


def points_of(car: Car) -> Geometry:
    """Places of a car in its design position."""
    return Geometry(points={one.name: tuple(one.at) for one in car.vehicle.composition.outputs})


def shapes_at(car: Car, modes: Sequence[Mode], places: Sequence[str]) -> Complex:
    """Complex translations of places in modes, (modes, places, 3)."""
    system = car.matrices.system
    rows = np.array([[system.output(f"{place}_acc_{axis}")[0] for axis in AXES] for place in places])
    return np.asarray(np.einsum("pan,mn->mpa", rows, np.array([one.shape for one in modes])), dtype=np.complex128)


def compare_modes(
    car: Car,
    measurement: Measurement | Path | str,
    mapping: Mapping[str, str] | None = None,
    damper: str = "stuck",
) -> ModeComparison:
    """Compare the mode shapes of a file with those of a car at the points that both have.

    Args:
        car: the car.
        measurement: file with mode shapes (UFF 55), or what `read_record` read of it.
        mapping: place of the car to node of the file; by default the nodes that lie at places of the car, within
            `NEAR`, in its axes (x to the rear, y to the driver's right, z up).
        damper: state of the dampers, stuck or sliding.

    Returns:
        MAC and AutoMAC, and pairs of measured and simulated modes with both frequencies and damping ratios.

    Raises:
        ConfigurationError: a place that the car does not have.
        DataError: a node that the file does not have, or less than three points.
    """
    if not isinstance(measurement, Measurement):
        measurement = read_record(Path(measurement))
    mapping = mapping or {}
    geometry, known = points_of(car), measurement.geometry.points
    unknown = next((place for place in mapping if place not in geometry.points), None)
    if unknown is not None:
        raise ConfigurationError(f"--map {unknown}=...: the car has no such place; it has {', '.join(geometry.points)}")
    moved = {point for one in measurement.shapes for point in one.points}
    found = {place: wanted.lower().removeprefix("dof").strip() for place, wanted in mapping.items()}
    if not found:
        found = _near(geometry, {label: at for label, at in known.items() if label in moved})
    missing = next((node for node in found.values() if node not in moved), None)
    if missing is not None:
        raise DataError(
            f"{measurement.path}: no mode moves a node {missing!r}; there are {', '.join(sorted(moved)[:20])}"
        )
    if len(found) < 3:
        raise DataError(
            f"{measurement.path}: {len(found)} of its nodes lie at places of the car; needed are three or more: give "
            "--map PLACE=NODE for each, with the places "
            f"{', '.join(geometry.points)}"
        )
    measured = [one for one in measurement.shapes if set(found.values()) <= set(one.points)]
    if not measured:
        raise DataError(f"{measurement.path}: no mode holds all of the nodes {', '.join(found.values())}")
    simulated = car.modes(damper)
    truth = np.array([[one.shape[one.points.index(node), :3] for node in found.values()] for one in measured]).reshape(
        len(measured), -1
    )
    curve = shapes_at(car, simulated, list(found)).reshape(len(simulated), -1)
    table = mac(truth, curve)
    rows, columns = scipy.optimize.linear_sum_assignment(table, maximize=True)
    pairs = [
        Pair(
            measured=int(row) + 1,
            simulated=int(column) + 1,
            mac=float(table[row, column]),
            measured_hz=measured[row].frequency,
            simulated_hz=simulated[column].frequency,
            measured_damping=measured[row].damping_ratio,
            simulated_damping=simulated[column].damping_ratio,
        )
        for row, column in zip(rows, columns, strict=True)
        if table[row, column] >= LEAST_MAC
    ]
    return ModeComparison(
        points=found,
        measured=measured,
        simulated=simulated,
        mac=table,
        measured_auto=mac(truth, truth),
        simulated_auto=mac(curve, curve),
        pairs=tuple(sorted(pairs, key=lambda one: one.measured_hz)),
    )
