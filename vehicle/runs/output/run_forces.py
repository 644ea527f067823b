"""Applied forces of a run, and what the car does at their frequencies, for its summary."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.forced_response import forced_response
from vehicle.errors import DataError
from vehicle.model.parameters.applied_force import CRANK
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.names import AXES
from vehicle.runs.car import Run
from vehicle.signals.analysis.order_lines import order_lines
from vehicle.signals.records.run_summary import ForceSummary, OrderSummary

POINTS = ("seat", "seat_rail")
"""Points of the car whose amplitudes are in the summary, and the knuckles with z alone."""

WHEELS = "wheels"
"""Angle of an order of any wheel."""


class ForceValues(TypedDict, total=False):
    """Entries of the summary of a run with applied forces."""

    forces: dict[str, ForceSummary]
    orders: list[OrderSummary]


def force_values(run: Run) -> ForceValues:
    """Return the entries of a run with applied forces; empty without them."""
    acting = [force for force in run.car.vehicle.composition.forces if force.harmonics or force.mean]
    if not acting:
        return {}
    forces: dict[str, ForceSummary] = {
        force.name: {
            "on": force.on or force.joint or f"tyre_{force.tyre}",
            "unit": force.unit,
            "against": force.against,
            "at_m": list(force.at),
            "force": list(force.force),
            "moment": list(force.moment),
            "angle": force.law.angle,
            "mean": force.mean,
            "lines": [
                {
                    "order": frequency / force.speed,
                    "frequency_hz": frequency / (2.0 * np.pi),
                    "amplitude": abs(amplitude),
                    "phase_deg": float(np.degrees(np.angle(amplitude))),
                }
                for frequency, amplitude in force.harmonics.items()
            ],
        }
        for force in acting
    }
    return {"forces": forces, "orders": _orders(run)}


def _orders(run: Run) -> list[OrderSummary]:
    """Return the amplitudes of the main accelerations at each frequency of the forces, the lowest first."""
    channels = [f"{point}_acc_{axis}" for point in POINTS for axis in AXES]
    channels += [f"knuckle_{wheel}_acc_z" for wheel in run.car.vehicle.wheels]
    channels = [name for name in channels if name in run.recording.channels]
    if not channels:
        return []
    acting = run.car.vehicle.composition.forces
    angles: dict[float, tuple[float, str]] = {}
    for force in acting:
        of = {None: "frequency", CRANK: CRANK}.get(force.law.angle, WHEELS)
        angles |= {frequency: (frequency / force.speed, of) for frequency in force.harmonics}
    matrices, dampers = run.car.matrices, [damper.law for damper in run.car.vehicle.composition.dampers]
    limits = {
        name: forced_response(matrices, channels, dampers, stuck=name == "stuck")
        for name in ("stuck", "without_friction")
    }
    orders: list[OrderSummary] = []
    for frequency, (order, of) in sorted(angles.items()):
        turns = frequency / (2.0 * np.pi * order)
        try:
            lines = order_lines(run.time, np.array([run[name] for name in channels]), turns, [order], begin=run.skip)
        except DataError:  # too short
            continue
        column = matrices.lines.frequencies.index(frequency)
        sums = {name: np.abs(np.sum(by_force[:, :, column], axis=0)).tolist() for name, by_force in limits.items()}
        summary: OrderSummary = {
            "order": order,
            "of": of,
            "frequency_hz": frequency / (2.0 * np.pi),
            "amplitude": dict(zip(channels, np.abs(lines.amplitude[:, 0]).tolist(), strict=True)),
            "standard_error": dict(zip(channels, np.nan_to_num(lines.error[:, 0]).tolist(), strict=True)),
            "stuck": dict(zip(channels, sums["stuck"], strict=True)),
            "without_friction": dict(zip(channels, sums["without_friction"], strict=True)),
        }
        ranges = {name: phase_ranges(acting, by_force, order) for name, by_force in limits.items()}
        if of == WHEELS and ranges["stuck"]:
            summary["stuck_range"] = dict(zip(channels, ranges["stuck"], strict=True))
            summary["without_friction_range"] = dict(zip(channels, ranges["without_friction"], strict=True))
        orders.append(summary)
    return orders


def phase_ranges(
    forces: Sequence[PlacedForce], amplitudes: npt.NDArray[np.complex128], order: float
) -> list[tuple[float, float]]:
    """Return the least and the largest amplitude of each channel over the phases of the wheels among each other.

    Wheels turn by chance, and those of unequal radii pass through all phases in a beat. With the amplitudes a_w by each
    wheel alone the sum is at most sum |a_w|, and at least 2 max |a_w| - sum |a_w| or 0.

    Args:
        forces: applied forces.
        amplitudes: amplitudes by each force, see `forced_response`; (forces, channels, frequencies).
        order: order of the wheels.

    Returns:
        Pairs for the channels; empty if fewer than two wheels have this order.
    """
    frequencies = sorted({frequency for force in forces for frequency in force.harmonics})
    by_wheel: dict[str, npt.NDArray[np.complex128]] = {}
    for force, of_force in zip(forces, amplitudes, strict=True):
        angle, frequency = force.law.angle, float(round(order)) * force.speed
        if angle not in (None, CRANK) and frequency in force.harmonics:
            by_wheel[angle] = by_wheel.get(angle, 0.0) + of_force[:, frequencies.index(frequency)]
    if len(by_wheel) < 2:
        return []
    sizes = np.abs(list(by_wheel.values()))
    largest = np.sum(sizes, axis=0)
    least = np.maximum(0.0, 2.0 * np.max(sizes, axis=0) - largest)
    return list(zip(least.tolist(), largest.tolist(), strict=True))
