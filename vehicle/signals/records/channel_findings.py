"""Findings on the channels of a record by themselves, without a car: the same for every command."""

from collections.abc import Collection, Mapping

import numpy as np

from vehicle.arrays import Vector
from vehicle.signals.formats.units import find_unit
from vehicle.signals.records.channel_faults import MOTIONS, faults
from vehicle.signals.records.finding import Finding, FindingError, findings_of
from vehicle.signals.records.gravity import TOLERANCE, gravity_findings


def channel_findings(
    where: object,
    time: Vector,
    values: Mapping[str, Vector],
    units: Mapping[str, str],
    *,
    stated: Collection[str] = (),
    filtered: bool = False,
) -> list[Finding]:
    """Return the findings on channels by themselves: clipping, constant parts, and gravity in accelerations.

    Args:
        where: file, for the error.
        time: sample times [s], (n,).
        values: role to samples in SI units, (n,).
        units: role to unit in the file.
        stated: roles whose unit the user stated.
        filtered: the mean is subtracted afterwards, so that gravity is no finding.

    Raises:
        FindingError: gravity shows a wrong unit or range: the acceleration would be wrong by this factor.
    """
    quantities = {role: unit.quantity for role, text in units.items() if (unit := find_unit(text)) is not None}
    motions = {role: values[role] for role, quantity in quantities.items() if quantity in MOTIONS}
    accelerations = [role for role in motions if quantities[role] == "acceleration"]
    means = {role: _steady_mean(values[role]) for role in accelerations}
    levels = {role: float(np.std(values[role])) for role in accelerations}
    gravity = gravity_findings(means, levels, units, stated)
    if findings_of(gravity, kinds=("unit",)):
        raise FindingError(where, gravity)
    rests = [role for role in motions if quantities[role] == "displacement"]
    return [*(() if filtered else gravity), *faults(motions, time, moving=accelerations, rests=rests)]


def _steady_mean(values: Vector) -> float:
    """Return the mean of samples (n,), or 0 where the means of both halves differ: gravity is constant."""
    first, second = (float(np.mean(half)) for half in np.array_split(values, 2))
    mean = float(np.mean(values))
    return mean if abs(second - first) <= TOLERANCE * abs(mean) else 0.0
