"""Stated errors of a run with the reduced engine, in words: a warning where comfort, its axes or loads are off."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.validity import REMEDY
from vehicle.names import AXES
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.ride_comfort import RIM, UNWEIGHTED, WEIGHTED
from vehicle.signals.analysis.seat_value import weighted_axes

NAMED_ERROR = 0.02
"""Error of an RMS or a comfort value above which it is named; stated errors up to 2 % are exact within 0.2 points."""

NAMED = 4
"""Maximum number of channels in a message."""

SMALL_AXIS = 0.1
"""Share of the acceleration of a point below which an axis does not count for a warning: it is 0.5 % of the comfort."""

SMALL_FORCE = 1e-3
"""Share of the static tyre load below which the RMS of a force does not count for a warning."""

POINTS = ("seat_rail", RIM)
"""Points with a comfort value, in addition to the cushion of a car with a seat."""

CUSHION = "seat"
"""Point on that cushion."""


def comfort_points(names: Sequence[str], seated: bool) -> dict[str, list[int]]:
    """Return the points with a comfort value whose three axes are among channels, to the indices of these channels.

    Args:
        names: names of the channels.
        seated: True for a car with a seat.
    """
    points = (*POINTS, CUSHION) if seated else POINTS
    axes = {point: [f"{point}_acc_{axis}" for axis in AXES] for point in points}
    return {point: [names.index(name) for name in three] for point, three in axes.items() if {*three} <= {*names}}


def weighted_squares(point: str, acceleration: Vector, interval: float) -> float:
    """Return the sum of the squares of weighted accelerations over axes and samples [m2/s4].

    Args:
        point: point with a comfort value; weighted as by `vehicle.runs.car.Run.comfort`.
        acceleration: along x, y, z [m/s2]; (3, n).
        interval: sampling interval [s].
    """
    contact = "steering_wheel" if point == RIM else "seat"
    weighted = weighted_axes(interval, acceleration, contact=contact)
    return float(np.square(application(contact).comfort_factors) @ np.sum(weighted**2, axis=1))


def comfort_errors(points: Mapping[str, list[int]], squares: Vector, weighted: Vector) -> dict[str, float]:
    """Return the errors of both comfort values of points, by names as "weighted@seat_rail".

    Args:
        points: see `comfort_points`.
        squares: sums of squares of the channels without and with the second order; (2, channels).
        weighted: sums of `weighted_squares` without and with it; (2, points).
    """
    errors = dict[str, float]()
    for number, (point, axes) in enumerate(points.items()):
        for name, sums in ((UNWEIGHTED, squares[:, axes].sum(axis=1)), (WEIGHTED, weighted[:, number])):
            if np.all(sums > 0.0):
                errors[f"{name}@{point}"] = float(np.sqrt(sums[0] / sums[1])) - 1.0
    return errors


def comfort_axes(points: Mapping[str, list[int]], names: Sequence[str], squares: Vector) -> frozenset[str]:
    """Return the axes of comfort with at least `SMALL_AXIS` of the acceleration of their point.

    Args:
        points: see `comfort_points`.
        names: names of the channels.
        squares: sums of their squares; (channels,).
    """
    return frozenset(
        names[axis]
        for axes in points.values()
        for axis in axes
        if squares[axis] >= SMALL_AXIS**2 * np.sum(squares[axes])
    )


def is_main(channel: str) -> bool:
    """Return True for accelerations of seat, body, knuckles and steering wheel, and forces of dampers and tyres."""
    return channel.startswith(("seat", "body", "knuckle", RIM, "tyre_", "damper_")) and not channel.startswith(
        "damper_top"
    )


def misses_main(errors: Mapping[str, float]) -> bool:
    """Return True if a comfort value or the RMS of a main channel is off by more than `NAMED_ERROR`."""
    return any((is_main(name) or "@" in name) and abs(error) > NAMED_ERROR for name, error in errors.items())


def misses_read(errors: Mapping[str, float], read: Collection[str]) -> bool:
    """Return True if comfort, one of its axes, or a force of a damper or tyre is off by more than `NAMED_ERROR`.

    Args:
        errors: stated errors.
        read: axes of comfort (`comfort_axes`), and forces above `SMALL_FORCE`.
    """
    return any(abs(error) > NAMED_ERROR and ("@" in name or name in read) for name, error in errors.items())


def error_sentence(errors: Mapping[str, float]) -> str:
    """Return a message about the channels whose RMS is off by more than `NAMED_ERROR`; empty if all are closer.

    The message ends with the largest error of weighted comfort of all points. Where no channel is off, it names the
    comfort value with the error: weighted comfort before unweighted.
    """
    comfort = [name for name in errors if name.startswith(WEIGHTED)]
    by_size = sorted(errors, key=lambda name: -abs(errors[name]))
    off = [name for name in by_size if abs(errors[name]) > NAMED_ERROR and "@" not in name]
    parts = []
    if off:
        texts = [f"{100.0 * errors[name]:+.0f} % ({name})" for name in off[:NAMED]]
        more = f" and {len(off) - NAMED} more" if len(off) > NAMED else ""
        parts = [f"RMS about {', '.join(texts)}{more}"]
    if not off:
        large = [name for name in by_size if abs(errors[name]) > NAMED_ERROR]
        comfort = [name for name in large if name in comfort] or large
    if comfort:
        worst = max(comfort, key=lambda name: abs(errors[name]))
        size = 100.0 * errors[worst]
        text = "less than 0.1 %" if abs(size) < 0.1 else f"{size:+.1f} %"
        value, _, point = worst.partition("@")
        parts.append(f"{value} comfort ({point.replace('_', ' ')}) {text}")
    return f"errors from the linear geometry of the reduced engine: {', '.join(parts)}" if parts else ""


def messages(errors: Mapping[str, float], read: Collection[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return warnings, one if what is read is off (`misses_read`), and notices, one if only other channels are."""
    sentence = error_sentence(errors)
    if not sentence:
        return (), ()
    if misses_read(errors, read):
        return (f"{sentence}{REMEDY}",), ()
    return (), (f"{sentence}{REMEDY} where these channels matter",)
