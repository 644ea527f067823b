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
from vehicle.signals.records.run_summary import ForceSummary, OrderSummary, RunUpSummary

POINTS = ("seat", "seat_rail")
"""Points of the car whose amplitudes are in the summary, and the knuckles with z alone."""


class ForceValues(TypedDict, total=False):
    """Entries of the summary of a run with applied forces."""

    forces: dict[str, ForceSummary]
    orders: list[OrderSummary]
    run_up: list[RunUpSummary]


def force_values(run: Run) -> ForceValues:
    """Return the entries of a run with applied forces; empty without them."""
    acting = [force for force in run.car.vehicle.composition.forces if force.acts]
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
    values: ForceValues = {"forces": forces}
    if any(force.harmonics and force.run_up is None for force in acting):
        values["orders"] = _orders(run)
    if any(force.harmonics and force.run_up for force in acting):
        values["run_up"] = _run_up(run)
    return values


def _channels(run: Run) -> list[str]:
    """Return the accelerations whose amplitudes are in the summary."""
    channels = [f"{point}_acc_{axis}" for point in POINTS for axis in AXES]
    channels += [f"knuckle_{wheel}_acc_z" for wheel in run.car.vehicle.wheels]
    return [name for name in channels if name in run.recording.channels]


def _run_up(run: Run) -> list[RunUpSummary]:
    """Return the largest amplitudes in each order of the crankshaft that acts in a run-up."""
    forces, channels = [force for force in run.car.vehicle.composition.forces if force.run_up], _channels(run)
    orders = sorted({round(frequency / force.speed, 9) for force in forces for frequency in force.harmonics})
    try:
        cut = run.order_cut(channels, orders=orders)
    except DataError:  # too short
        return []
    tops, rpm = np.argmax(np.abs(cut.amplitude), axis=2), 60.0 * cut.turns
    return [
        {
            "order": order,
            "peak": {
                name: float(np.abs(cut.amplitude[row, column, tops[row, column]])) for row, name in enumerate(channels)
            },
            "rpm": {name: float(rpm[tops[row, column]]) for row, name in enumerate(channels)},
        }
        for column, order in enumerate(orders)
    ]


def _orders(run: Run) -> list[OrderSummary]:
    """Return the amplitudes of the main accelerations at each frequency of the forces, the lowest first."""
    channels = _channels(run)
    if not channels:
        return []
    angles: dict[float, tuple[float, str]] = {}
    for force in run.car.vehicle.composition.forces:
        of = {None: "frequency", CRANK: CRANK}.get(force.law.angle, "wheels")
        if force.run_up is None:
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
