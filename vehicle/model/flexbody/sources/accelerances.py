"""Accelerances of a body from a file: acceleration at points per force at points, with places and directions."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_matrices import BodyNodes
from vehicle.model.flexbody.sources.residual_table import read_point_table
from vehicle.model.parameters.hardpoints import Point
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.units import find_ratio, find_unit

_ORDERS = {"displacement": 2, "velocity": 1, "acceleration": 0}
"""Number of time derivatives from a motion to an acceleration."""

_END = re.compile(r"(?P<point>.+?)[ :_]?(?P<axis>[+-][XYZ])", re.IGNORECASE)
_NAME = re.compile(rf"{_END.pattern} ?/ ?{_END.pattern.replace('point', 'input').replace('axis', 'along')}", re.I)
"""Name of a column: output and input with directions, for example "4+Z/1-X"."""

_UNIT = "write (m/s2)/N into the file, or set --unit '(m/s2)/N'"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Accelerances:
    """Accelerances H [m/s2/N] in the axes of the vehicle.

    Attributes:
        frequency: increasing frequencies [Hz], (m,).
        response: H, (n, m).
        names: output and input, for example "4+Z/1-X", (n,).
        place: positions of output and input [m], (2, n, 3).
        along: unit vectors of output and input, (2, n, 3).
        left_out: channels of the file that are no accelerance between points.
    """

    frequency: Vector
    response: Complex
    names: tuple[str, ...]
    place: Vector
    along: Vector
    left_out: int = 0


class _Named(NamedTuple):
    """Channel with the names of its points and their directions."""

    channel: Channel
    points: tuple[str, str]
    axes: tuple[str, str]

    @property
    def name(self) -> str:
        return "/".join(f"{point}{axis}" for point, axis in zip(self.points, self.axes, strict=True))


def read_accelerances(path: Path, points: Path | None, unit: str | None, axes: str, origin: Point) -> Accelerances:
    """Read the FRFs of a motion to a force at the points of a body.

    Args:
        path: universal file (datasets 58 and 15 or 2411), or a table with columns "4+Z/1-X real [(m/s2)/N]" and imag.
        points: table point,x [m],y [m],z [m] of positions that the file does not contain.
        unit: unit of the FRFs without one in the file.
        axes, origin: see `BodyNodes.frame`.

    Raises:
        ConfigurationError: no such file, or invalid axes.
        DataError: no accelerance, a missing unit, position or direction, or different frequencies.
    """
    measurement = read_record(path)
    complex_channels = [c for c in measurement.channels if c.kind == "frequency" and np.iscomplexobj(c.values)]
    frfs = [named for channel in complex_channels if (named := _named(channel)) is not None]
    if not frfs:
        raise DataError(
            f"{path}: has no FRF between two points with directions; export universal files (dataset 58) with nodes "
            "and directions, or name the columns as 4+Z/1-X: acceleration of point 4 along +z per force at 1 along -x"
        )
    frequency = _frequencies(path, frfs)
    rows = np.array([_accelerance(path, named, unit) for named in frfs])
    defined = np.isfinite(rows).all(axis=0) & (frequency > 0.0)
    positions = _positions(measurement, points, {point for named in frfs for point in named.points})
    # Outputs, then inputs, a node each, so that the change of axes of a body model applies.
    ends = [(named.points[side], named.axes[side]) for side in (0, 1) for named in frfs]
    nodes = BodyNodes(
        nodes=tuple(point for point, _ in ends),
        positions=np.array([positions[point] for point, _ in ends]),
        node=np.arange(len(ends)),
        direction=np.array(["XYZ".index(axis[1]) for _, axis in ends]),
        edges=np.zeros((0, 2), dtype=int),
        source=str(path),
    )
    placed, turned = nodes.frame(axes, origin)
    sign = turned * np.array([-1.0 if axis[0] == "-" else 1.0 for _, axis in ends])
    along = np.eye(3)[placed.direction] * sign[:, None]
    return Accelerances(
        frequency=frequency[defined],
        response=rows[:, defined],
        names=tuple(named.name for named in frfs),
        place=placed.positions.reshape(2, -1, 3),
        along=along.reshape(2, -1, 3),
        left_out=len(measurement.channels) - len(frfs),
    )


def _named(channel: Channel) -> _Named | None:
    """Return a channel with its points and directions, from the file or from its name; None without them."""
    output, reference = channel.place + channel.direction, channel.reference
    match = _NAME.fullmatch(f"{output}/{reference}" if channel.place and reference else channel.name.strip())
    if match is None:
        return None
    return _Named(channel, (match["point"], match["input"]), (match["axis"].upper(), match["along"].upper()))


def _frequencies(path: Path, frfs: Sequence[_Named]) -> Vector:
    """Return the common frequencies of the FRFs [Hz]; (m,)."""
    frequency = frfs[0].channel.axis
    for named in frfs:
        axis = named.channel.axis
        if frequency is None or axis is None or axis.shape != frequency.shape or not np.allclose(axis, frequency):
            raise DataError(
                f"{path}: {named.name} and {frfs[0].name} have different or no frequencies; export all FRFs over the "
                "same frequencies"
            )
    assert frequency is not None
    return frequency


def _accelerance(path: Path, named: _Named, unit: str | None) -> Complex:
    """Return an FRF as acceleration per force [m/s2/N], (m,): a displacement by -w^2, a velocity by j w."""
    channel = named.channel
    text = channel.unit or unit or ""
    ratio = find_ratio(text)
    upper, _, lower = ("" if ratio is None else ratio.quantity).partition("/")
    if ratio is None or upper not in _ORDERS or lower != "force":
        unit_text = f"unit {text!r}" if text else channel.remark or "no unit"
        raise DataError(f"{path}: {named.name} has {unit_text}, but must be a motion per force; {_UNIT}")
    assert channel.axis is not None
    values = np.asarray(channel.values, dtype=np.complex128) * ratio.factor
    return np.asarray(values * (2j * np.pi * channel.axis) ** _ORDERS[upper])


def _positions(measurement: Measurement, table: Path | None, names: set[str]) -> Mapping[str, Sequence[float]]:
    """Return the position of each named point [m], of the table or the file."""
    positions = dict(measurement.geometry.points)
    if table is not None:
        values, units = read_point_table(table, ("m", "mm"), "point,x [m],y [m],z [m]")
        sizes = [entry.factor for unit in units if (entry := find_unit(unit)) is not None]
        for point, row in values.items():
            if not np.isfinite(row).all():
                raise DataError(f"{table}: {point}: found {row}, must be three finite numbers")
            positions[point] = [size * value for size, value in zip(sizes, row, strict=True)]
    if missing := sorted(names - positions.keys()):
        raise DataError(
            f"{measurement.path}: {len(missing)} points have no position: {', '.join(missing[:8])}; export the "
            "geometry (datasets 15, 2411), or give a table point,x [m],y [m],z [m] with --points"
        )
    return positions
