"""Read columns of any measurement file by name, in SI units: road profiles, spring and damper curves."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.units import allowed_units, find_unit


def named_columns(path: Path, wanted: Mapping[str, str]) -> dict[str, Vector]:
    """Read named columns of a measurement file in SI units.

    Returns:
        Column name to values in SI units, all of equal length.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: a missing or repeated column, another quantity, or a missing value.
    """
    measurement, columns = read_record(path), {}
    for name, si in wanted.items():
        matches = [channel for channel in measurement.channels if channel.name.strip().lower() == name]
        if len(matches) != 1:
            shown = ", ".join(f"{channel.name!r} [{channel.unit}]" for channel in measurement.channels[:12]) or "none"
            raise DataError(f"{path}: has {len(matches)} columns {name!r} instead of one [{si}]; found {shown}")
        unit_entry, needed = find_unit(matches[0].unit), find_unit(si)
        if unit_entry is None or needed is None or unit_entry.quantity != needed.quantity:
            units = allowed_units(needed.quantity if needed is not None else None)
            raise DataError(f"{path}: column {name!r} has the unit {matches[0].unit!r} but must have one of {units}")
        values = np.asarray(matches[0].si_values, dtype=np.float64)
        if not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values))[0]) + 1
            raise DataError(f"{path}: column {name!r}: row {row} is not a number; correct or remove the row")
        columns[name] = values
    if len({channel.size for channel in columns.values()}) > 1:
        sizes = ", ".join(f"{name} {channel.size}" for name, channel in columns.items())
        raise DataError(f"{path}: the columns must have equal lengths ({sizes})")
    return columns
