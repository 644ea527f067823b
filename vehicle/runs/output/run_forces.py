"""Applied forces of a run, and what the car does at their frequencies, for its summary."""

from __future__ import annotations

from typing import TypedDict

import numpy as np

from vehicle.engines.linear.forced_response import forced_response
from vehicle.errors import DataError
from vehicle.model.parameters.applied_force import CRANK
from vehicle.names import AXES
from vehicle.runs.car import Run
from vehicle.signals.analysis.order_lines import order_lines
from vehicle.signals.records.run_summary import ForceSummary, OrderSummary

POINTS = ("seat", "seat_rail")
"""Points of the car whose amplitudes are in the summary, and the knuckles with z alone."""


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
            "on": force.on or force.joint,
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
    angles: dict[float, tuple[float, str]] = {}
    for force in run.car.vehicle.composition.forces:
        of = {None: "frequency", CRANK: CRANK}.get(force.law.angle, "wheels")
        angles |= {frequency: (frequency / force.speed, of) for frequency in force.harmonics}
    dampers = [damper.law for damper in run.car.vehicle.composition.dampers]
    limits = [
        np.abs(forced_response(run.car.matrices, channels, dampers, stuck=stuck)).T.tolist() for stuck in (True, False)
    ]
    orders: list[OrderSummary] = []
    # Matrices list the frequencies in the same order.
    for (frequency, (order, of)), stuck, free in zip(sorted(angles.items()), *limits, strict=True):
        turns = frequency / (2.0 * np.pi * order)
        try:
            lines = order_lines(run.time, np.array([run[name] for name in channels]), turns, [order], begin=run.skip)
        except DataError:  # too short
            continue
        orders.append(
            {
                "order": order,
                "of": of,
                "frequency_hz": frequency / (2.0 * np.pi),
                "amplitude": dict(zip(channels, np.abs(lines.amplitude[:, 0]).tolist(), strict=True)),
                "standard_error": dict(zip(channels, np.nan_to_num(lines.error[:, 0]).tolist(), strict=True)),
                "stuck": dict(zip(channels, stuck, strict=True)),
                "without_friction": dict(zip(channels, free, strict=True)),
            }
        )
    return orders
