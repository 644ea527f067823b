"""Measured dynamic stiffness and loss angle of a mount over frequency and amplitude, from a table with units."""

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle.arrays import Complex, Indices, Vector
from vehicle.errors import DataError
from vehicle.signals.formats.table import Header, Table, Wanted, name_and_unit
from vehicle.signals.formats.table_file import read_table

UNITS = {
    "frequency": {"Hz": 1.0},
    "amplitude": {"mm": 1e-3, "um": 1e-6, "m": 1.0},
    "stiffness": {"N/mm": 1e3, "N/m": 1.0, "kN/mm": 1e6},
    "loss_angle": {"deg": np.pi / 180.0, "rad": 1.0, "°": np.pi / 180.0},
}
"""Columns of the table, their units, and the factor of each unit to SI units."""

NEEDED = "frequency [Hz], amplitude [mm] (half of peak to peak), stiffness [N/mm], loss_angle [deg]"
LIMITS = {"frequency": (0.01, 1000.0), "amplitude": (1e-7, 0.02), "stiffness": (3e3, 1e9), "loss_angle": (-0.1, 3.0)}
"""Lowest and highest values in SI units: a mount moves by 0.1 um to 20 mm, and has 3 N/mm (hangers of an exhaust have
5 to 20 N/mm) to 1e6 N/mm: values in N/mm below a header with [N/m] are outside."""

LEAST_ROWS, LEAST_FREQUENCIES = 8, 4
"""Minimum numbers of rows and of different frequencies: the laws have five parameters and more."""

SAME_AMPLITUDE = 0.02
"""Relative difference of amplitudes that belong to one level: the control of a test rig."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredStiffness:
    """Dynamic stiffness of a mount at m points."""

    frequency: Vector  # frequencies [Hz]; (m,)
    amplitude: Vector  # peak amplitudes of the displacement [m]; (m,)
    stiffness: Complex  # complex stiffness |K| exp(i angle) of the first harmonic [N/m]; (m,)

    def levels(self) -> list[tuple[float, Indices]]:
        """Return mean amplitude [m] and indices of the points of each level, sorted by amplitude and frequency."""
        order = np.lexsort((self.frequency, self.amplitude))
        steps = np.flatnonzero(np.diff(np.log(self.amplitude[order])) > SAME_AMPLITUDE) + 1
        groups = [part[np.argsort(self.frequency[part])] for part in np.split(order, steps)]
        return [(float(np.mean(self.amplitude[part])), part) for part in groups]


def read_stiffness(path: Path) -> MeasuredStiffness:
    """Read a table of dynamic stiffness and loss angle with the columns `NEEDED`, in any order and unit of `UNITS`.

    Args:
        path: table with a header line; further columns are ignored.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: a missing or unknown column or unit, a value out of range, equal columns, or too few points.
    """
    table = read_table(path, Wanted(needed=NEEDED, key=_frequency, columns=_columns))
    columns = {name: _column(table, name) for name in UNITS}
    for first, second in itertools.combinations(UNITS, 2):
        values, copy = (table.values[:, _index(table.header, name)] for name in (first, second))
        if np.ptp(values) > 0.0 and np.array_equal(values, copy):
            raise DataError(
                f"{path}: the columns {first!r} and {second!r} contain the same values; correct one of them"
            )
    frequency, amplitude = columns["frequency"], columns["amplitude"]
    rows, lines = len(frequency), len(np.unique(frequency))
    if rows < LEAST_ROWS or lines < LEAST_FREQUENCIES:
        raise DataError(
            f"{path}: has {rows} rows with {lines} frequencies, but at least {LEAST_ROWS} rows and "
            f"{LEAST_FREQUENCIES} frequencies are needed; measure more points"
        )
    stiffness = columns["stiffness"] * np.exp(1j * columns["loss_angle"])
    return MeasuredStiffness(frequency=frequency, amplitude=amplitude, stiffness=stiffness)


def _frequency(header: Header) -> int:
    """Return the index of the frequency column; check that all columns exist once, with a known unit."""
    return _columns(header)[0]


def _columns(header: Header) -> list[int]:
    """Return the indices of the columns of `UNITS`; errors: see `_index`."""
    return [_index(header, name) for name in UNITS]


def _index(header: Header, name: str) -> int:
    """Return the index of a column; raise DataError for a missing column or unit."""
    heads = [name_and_unit(cell) for cell in header.cells]
    columns = [index for index, (head, _) in enumerate(heads) if head.strip().lower().replace(" ", "_") == name]
    if len(columns) != 1:
        raise DataError(
            f"{header.where}: has {len(columns) or 'no'} column{'s' if columns else ''} {name!r} instead of one; "
            f"found {header.found}; the table needs {NEEDED}"
        )
    unit = heads[columns[0]][1]
    if unit not in UNITS[name]:
        cell, options = header.cells[columns[0]], " or ".join(f"{name} [{allowed}]" for allowed in UNITS[name])
        raise DataError(f"{header.where}: column {cell!r}: the unit is missing or unknown; write {options}")
    return columns[0]


def _column(table: Table, name: str) -> Vector:
    """Return a column in SI units; raise DataError for a value out of range."""
    index = _index(table.header, name)
    unit = str(name_and_unit(table.header.cells[index])[1])
    values, (low, high) = UNITS[name][unit] * table.values[:, index], LIMITS[name]
    wrong = np.flatnonzero(~((values >= low) & (values <= high)))
    if wrong.size:
        factor = UNITS[name][unit]
        raise DataError(
            f"{table.place(int(wrong[0]))}: {name}: found {table.values[wrong[0], index]:g} {unit}, must be "
            f"{low / factor:g} to {high / factor:g} {unit}; check the unit in the header"
        )
    return np.asarray(values)
