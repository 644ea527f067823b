"""Comparison of measured mode shapes with those of the car: MAC, AutoMAC, pairs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.engines.linear.car_modes import Mode
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.modal_assurance import mac
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.geometry import Geometry, ModeShape
from vehicle.signals.formats.reader import read_record

NEAR = 0.01
"""Maximum distance of a node of the file from its output point of the car [m]."""

LEAST_MAC = 0.5
"""Minimum MAC of a pair of modes; from 0.9 two modes usually count as equal."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Pair:
    """Measured mode and the simulated mode with the highest MAC."""

    measured: int  # measured, simulated: numbers of the modes, from 1
    simulated: int
    mac: float  # of their shapes [-]
    measured_hz: float  # measured_hz, simulated_hz: natural frequencies [Hz]
    simulated_hz: float
    measured_damping: float  # measured_damping, simulated_damping: damping ratios [-]
    simulated_damping: float

    @property
    def deviation(self) -> float:
        """(simulated - measured) / measured frequency [-]."""
        return self.simulated_hz / self.measured_hz - 1.0 if self.measured_hz > 0.0 else float("nan")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ModeComparison:
    """All modes."""

    points: Mapping[str, str]  # output point of the car to node of the file
    measured: Sequence[ModeShape]  # measured, simulated: the modes
    simulated: Sequence[Mode]
    mac: Vector  # (measured, simulated)
    # measured_auto, simulated_auto: AutoMAC; values near 1 off the diagonal: indistinguishable modes
    measured_auto: Vector
    simulated_auto: Vector
    pairs: tuple[Pair, ...]  # by measured frequency

    def summary(self, file: str) -> dict[str, Any]:
        """Return plain numbers for JSON."""
        return {
            "measured": file,
            "points": dict(self.points),
            "pairs": [
                {
                    "measured": pair.measured,
                    "simulated": pair.simulated,
                    "description": self.simulated[pair.simulated - 1].description,
                    "mac": pair.mac,
                    "measured_hz": pair.measured_hz,
                    "simulated_hz": pair.simulated_hz,
                    "deviation": pair.deviation if np.isfinite(pair.deviation) else None,
                    "measured_damping": pair.measured_damping,
                    "simulated_damping": pair.simulated_damping,
                }
                for pair in self.pairs
            ],
            "mac": self.mac.tolist(),
            "measured_auto_mac": self.measured_auto.tolist(),
            "simulated_auto_mac": self.simulated_auto.tolist(),
            "measured_hz": [mode.frequency for mode in self.measured],
            "simulated_hz": [mode.frequency for mode in self.simulated],
        }

    def text(self, file: str) -> str:
        """Return the table for the console, lowest MAC first."""
        lines = [
            f"modes of {file} at {len(self.points)} points: {', '.join(self.points)}",
            f"{'measured':>10}{'[Hz]':>9}{'simulated':>11}{'[Hz]':>9}{'deviation':>11}{'MAC':>7}{'damping':>9}{'':>9}",
        ]
        for pair in sorted(self.pairs, key=lambda pair: pair.mac):
            lines.append(
                f"{pair.measured:>10}{pair.measured_hz:>9.3f}{pair.simulated:>11}{pair.simulated_hz:>9.3f}"
                f"{100 * pair.deviation:>+9.2f} %{pair.mac:>7.3f}{100 * pair.measured_damping:>7.2f} %"
                f"{100 * pair.simulated_damping:>7.2f} %  {self.simulated[pair.simulated - 1].description}"
            )
        unpaired = sorted(set(range(1, len(self.measured) + 1)) - {pair.measured for pair in self.pairs})
        if unpaired:
            shown = ", ".join(f"{self.measured[number - 1].frequency:.4g} Hz" for number in unpaired[:10])
            lines.append(f"no simulated mode matches (MAC below {LEAST_MAC:g}): {shown}")
        alike = np.argwhere(np.triu(self.measured_auto, 1) > 0.9)
        if alike.size:
            shown = ", ".join(f"{first + 1} and {second + 1}" for first, second in alike[:6])
            lines.append(f"measured modes that look alike at these points (AutoMAC above 0.9): {shown}")
        return "\n".join(lines)


def _near(car: Geometry, nodes: Mapping[str, Sequence[float]]) -> dict[str, str]:
    """Return the node at each output point; output points at one position need as many nodes there, in order."""
    at, labels = np.array(list(nodes.values())).reshape(-1, 3), list(nodes)
    points = np.array(list(car.points.values())).reshape(-1, 3)
    matches = {}
    for name, point in car.points.items():
        near_labels = [labels[n] for n in np.flatnonzero(np.linalg.norm(at - np.array(point), axis=1) <= NEAR)]
        sharing = [
            name for name, other in zip(car.points, points, strict=True) if np.linalg.norm(other - point) <= NEAR
        ]
        if near_labels and len(near_labels) == len(sharing):
            matches[name] = near_labels[sharing.index(name)]
    return matches


def points_of(car: Car) -> Geometry:
    """Return the output points of a car in the design position."""
    return Geometry(points={output.name: tuple(output.at) for output in car.vehicle.composition.outputs})


def shapes_at(car: Car, modes: Sequence[Mode], points: Sequence[str]) -> Complex:
    """Return complex translations of output points in modes, (modes, points, 3)."""
    system = car.matrices.system
    rows = np.array([[system.output(f"{point}_acc_{axis}")[0] for axis in AXES] for point in points])
    # Points p, axes a, coordinates n, modes m.
    return np.asarray(np.einsum("pan,mn->mpa", rows, np.array([mode.shape for mode in modes])), dtype=np.complex128)


def compare_modes(
    car: Car,
    measurement: Measurement | Path | str,
    mapping: Mapping[str, str] | None = None,
    damper: str = "stuck",
) -> ModeComparison:
    """Compare the mode shapes of a file with those of a car at common points.

    Args:
        measurement: file with mode shapes (UFF 55), or what `read_record` read of it.
        mapping: output point of the car to node of the file; by default the nodes at output points of the car, within
            `NEAR`, in its axes (x to the rear, y to the driver's right, z up).
        damper: state of the dampers, stuck or sliding.

    Returns:
        MAC and AutoMAC, and pairs of measured and simulated modes with both frequencies and damping ratios.

    Raises:
        ConfigurationError: the car lacks an output point.
        DataError: the file lacks a node, or there are fewer than three points.
    """
    if not isinstance(measurement, Measurement):
        measurement = read_record(Path(measurement))
    mapping = mapping or {}
    geometry, labels = points_of(car), measurement.geometry.points
    unknown = next((name for name in mapping if name not in geometry.points), None)
    if unknown is not None:
        raise ConfigurationError(
            f"--map POINT=NODE: the car has no output point {unknown!r}; choose from {', '.join(geometry.points)}"
        )
    moved = {point for shape in measurement.shapes for point in shape.points}
    nodes = {name: wanted.lower().removeprefix("dof").strip() for name, wanted in mapping.items()}
    if not nodes:
        nodes = _near(geometry, {label: at for label, at in labels.items() if label in moved})
    missing = next((node for node in nodes.values() if node not in moved), None)
    if missing is not None:
        raise DataError(
            f"{measurement.path}: no mode has a node {missing!r}; choose from {', '.join(sorted(moved)[:20])}"
        )
    if len(nodes) < 3:
        raise DataError(
            f"{measurement.path}: {len(nodes)} nodes lie at output points of the car, but at least three are needed; "
            "set "
            f"--map POINT=NODE for the others (points: {', '.join(geometry.points)})"
        )
    measured = [shape for shape in measurement.shapes if set(nodes.values()) <= set(shape.points)]
    if not measured:
        raise DataError(
            f"{measurement.path}: no mode contains all of the nodes {', '.join(nodes.values())}; set --map "
            "POINT=NODE for the nodes of a mode"
        )
    simulated = car.modes(damper)
    truth = np.array(
        [[shape.shape[shape.points.index(node), :3] for node in nodes.values()] for shape in measured]
    ).reshape(len(measured), -1)
    curve = shapes_at(car, simulated, list(nodes)).reshape(len(simulated), -1)
    table = mac(truth, curve)
    # Pairs with the largest sum of MAC; each mode occurs once.
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
        points=nodes,
        measured=measured,
        simulated=simulated,
        mac=table,
        measured_auto=mac(truth, truth),
        simulated_auto=mac(curve, curve),
        pairs=tuple(sorted(pairs, key=lambda pair: pair.measured_hz)),
    )
