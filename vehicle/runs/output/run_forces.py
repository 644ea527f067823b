"""Applied forces of a run, and what the car does at their frequencies, for its summary."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from vehicle.arrays import Complex
from vehicle.engines.linear.forced_response import forced_response
from vehicle.errors import DataError
from vehicle.model.parameters.applied_force import CRANK
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.names import AXES
from vehicle.runs.car import Run
from vehicle.runs.car.order_points import ACCURACY
from vehicle.signals.analysis.order_lines import order_lines
from vehicle.signals.records.run_summary import ForceSummary, LineSummary, OrderSummary, RunUpSummary

POINTS = ("seat", "seat_rail")
"""Points of the car whose amplitudes are in the summary, and the knuckles with z alone."""

WHEELS = "wheels"
"""Angle of an order of any wheel."""


def force_values(run: Run) -> dict[str, Any]:
    """Return the entries `forces`, `orders` and `run_up` of a run with applied forces; empty without them."""
    acting = [force for force in run.car.vehicle.composition.forces if force.acts]
    if not acting:
        return {}
    forces = {
        force.name: ForceSummary(
            on=force.on or force.joint or f"tyre_{force.tyre}",
            unit=force.unit,
            against=force.against,
            at_m=list(force.at),
            force=list(force.force),
            moment=list(force.moment),
            angle=force.law.angle,
            mean=force.mean,
            recorded=force.recorded,
            lines=[
                LineSummary(
                    order=frequency / force.speed,
                    frequency_hz=frequency / (2.0 * np.pi),
                    amplitude=abs(amplitude),
                    phase_deg=float(np.degrees(np.angle(amplitude))),
                )
                for frequency, amplitude in force.harmonics.items()
            ],
        )
        for force in acting
    }
    return {
        "forces": forces,
        "orders": _orders(run) if any(force.harmonics and force.run_up is None for force in acting) else None,
        "run_up": _run_up(run) if any(force.harmonics and force.run_up for force in acting) else None,
    }


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
    floor = ACCURACY * float(np.max(np.abs(cut.amplitude), initial=0.0))
    return [
        RunUpSummary(
            order=order,
            peak={
                name: float(np.abs(cut.amplitude[row, column, tops[row, column]])) for row, name in enumerate(channels)
            },
            rpm={name: float(rpm[tops[row, column]]) for row, name in enumerate(channels)},
            floor=floor,
        )
        for column, order in enumerate(orders)
    ]


def _orders(run: Run) -> list[OrderSummary]:
    """Return the amplitudes of the main accelerations at each frequency of the forces, the lowest first."""
    channels = _channels(run)
    if not channels:
        return []
    acting = run.car.vehicle.composition.forces
    angles: dict[float, tuple[float, str]] = {}
    for force in acting:
        of = {None: "frequency", CRANK: CRANK}.get(force.law.angle, WHEELS)
        if force.run_up is None:
            angles |= {frequency: (frequency / force.speed, of) for frequency in force.harmonics}
    matrices, dampers = run.car.matrices, [damper.law for damper in run.car.vehicle.composition.dampers]
    limits = {
        name: forced_response(matrices, channels, dampers, stuck=name == "stuck")
        for name in ("stuck", "without_friction")
    }
    floor = ACCURACY * max(float(np.max(np.abs(each.sum(axis=0)), initial=0.0)) for each in limits.values())
    frictions = "dampers and bushings" if any(law.friction for law in matrices.laws) else "dampers"
    orders: list[OrderSummary] = []

    def by_channel(values: Iterable[Any]) -> dict[str, Any]:
        return dict(zip(channels, values, strict=True))

    for frequency, (order, of) in sorted(angles.items()):
        turns = frequency / (2.0 * np.pi * order)
        try:
            lines = order_lines(run.time, np.array([run[name] for name in channels]), turns, [order], begin=run.skip)
        except DataError:  # too short
            continue
        column = matrices.lines.frequencies.index(frequency)
        stuck, free = (np.abs(np.sum(each[:, :, column], axis=0)).tolist() for each in limits.values())
        ranges = [phase_ranges(acting, each, matrices.lines.frequencies, order) for each in limits.values()]
        stuck_range, free_range = map(by_channel, ranges) if of == WHEELS and ranges[0] else (None, None)
        orders.append(
            OrderSummary(
                order=order,
                of=of,
                frequency_hz=frequency / (2.0 * np.pi),
                amplitude=by_channel(np.abs(lines.amplitude[:, 0]).tolist()),
                standard_error=by_channel(np.nan_to_num(lines.error[:, 0]).tolist()),
                stuck=by_channel(stuck),
                without_friction=by_channel(free),
                frictions=frictions,
                floor=floor,
                stuck_range=stuck_range,
                without_friction_range=free_range,
            )
        )
    return orders


def phase_ranges(
    forces: Sequence[PlacedForce],
    amplitudes: Complex,
    frequencies: Sequence[float],
    order: float,
) -> list[tuple[float, float]]:
    """Return the least and the largest amplitude of each channel over the phases of the wheels among each other.

    Wheels turn by chance, and those of unequal radii pass through all phases in a beat. With the amplitudes a_w by each
    wheel alone the sum is at most sum |a_w|, and at least 2 max |a_w| - sum |a_w| or 0.

    Args:
        amplitudes: amplitudes by each force, see `forced_response`; (forces, channels, frequencies).
        frequencies: the frequencies [rad/s].
        order: order of the wheels.

    Returns:
        Pairs for the channels; empty if fewer than two wheels have this order.
    """
    by_wheel: dict[str, Complex] = {}
    for force, of_force in zip(forces, amplitudes, strict=True):
        angle, frequency = force.law.angle, float(round(order)) * force.speed
        if angle not in (None, CRANK) and frequency in force.harmonics:
            by_wheel[angle] = by_wheel.get(angle, 0.0) + of_force[:, frequencies.index(frequency)]
    if len(by_wheel) < 2:
        return []
    sizes = np.abs(list(by_wheel.values()))
    largest = np.sum(sizes, axis=0)
    smallest = np.maximum(0.0, 2.0 * np.max(sizes, axis=0) - largest)
    return list(zip(smallest.tolist(), largest.tolist(), strict=True))
