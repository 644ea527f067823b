"""Drawn body of a car: the wireframe of the flexible body, or an outline from wheels, height and class of the car.

The outline is a grid of stations along the car by six columns across it: lower edge, waist and roof of the right side,
then of the left side. Outside the windows the roof is the waist. Lines, rods and sheets of all pictures come from it.
"""

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy

from vehicle.arrays import Indices, Vector
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.signals.analysis.thinned_wireframe import MOST_NODES, thinned


class BodyClass(NamedTuple):
    """Usual proportions of a class of cars. Stations: 0 front, 1 front axle, 2 rear axle, 3 rear."""

    highest: float  # maximum height over wheelbase of the class
    overhangs: tuple[float, float]  # front and rear, over the wheelbase
    windows: tuple[
        float, float, float, float
    ]  # stations: cowl, front and rear edge of the roof, foot of the rear screen
    waist: float  # height of the waist over that of the roof
    sill: float  # height of the sill over that of the roof


CLASSES = {
    "sedan": BodyClass(0.535, (0.30, 0.40), (1.16, 1.50, 1.93, 2.42), 0.66, 0.13),
    "hatchback": BodyClass(0.605, (0.33, 0.28), (1.14, 1.47, 2.30, 2.86), 0.66, 0.13),
    "suv": BodyClass(0.625, (0.33, 0.33), (1.16, 1.45, 2.45, 2.86), 0.66, 0.17),
    "van": BodyClass(np.inf, (0.31, 0.33), (0.75, 1.10, 2.88, 2.96), 0.58, 0.13),
}
"""Classes, lowest first. Assumed, from outer dimensions of common cars: BMW 5 and Passat (0.49 to 0.52 high over
wheelbase), Golf and Fiesta (0.55 to 0.59), Tiguan (0.63), VW T6 and Transit (0.66 to 0.76)."""

COG_HEIGHT = 0.41
"""Height of the centre of gravity of the body over that of the roof. Assumed; the roof is not below the points that the
vehicle file has on it. With it, `new --car-class` small, sedan and van give a hatchback, a sedan and a van."""

OWN_OVERHANG, SHORTEST = (0.2, 0.45), 1.0
"""Range of the front axle behind x = 0, over the wheelbase, in which x = 0 is the front of the car; least wheelbase of
a car with an outline [m]."""

BESIDE_WHEEL, ARCH_GAP, EDGE, ARCH = 0.10, 0.05, 0.01, 9
"""Distances [m] of the side from the middle plane of a wheel, of an arch from its tyre, and of its edge from the sill;
points of an arch."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DrawnBody:
    """Body of a car in pictures.

    Attributes:
        points: points in the design position [m], (n, 3).
        lines: pairs of points, (m, 2); empty for a body of which only the points are known.
        shapes: displacement of the points in the modes of the flexible body, (modes, n, 3).
    """

    points: Vector
    lines: Indices
    shapes: Vector


def drawn_body(car: CarModel) -> DrawnBody:
    """Return the wireframe of the flexible body, thinned; the outline of the car for a body without lines."""
    element = car.superelement
    positions, shapes = np.asarray(element.positions), np.asarray(element.shapes)
    if len(element.edges):
        nodes, index = np.unique(thinned(positions, np.asarray(element.edges, dtype=int)), return_inverse=True)
        return DrawnBody(points=positions[nodes], lines=index.reshape(-1, 2), shapes=shapes[:, nodes])
    sheets, lines = body_outline(car.vehicle)
    if not len(lines):
        return DrawnBody(points=positions[:MOST_NODES], lines=lines, shapes=shapes[:, :MOST_NODES])
    # Ends of the roof lie on the waist.
    points, index = np.unique(sheets.reshape(-1, 3)[lines.ravel()], axis=0, return_inverse=True)
    _, nearest = scipy.spatial.cKDTree(positions).query(points)
    return DrawnBody(points=points, lines=index.reshape(-1, 2), shapes=shapes[:, nearest])


def body_class(vehicle: Vehicle, height: float, wheelbase: float) -> str:
    """Return the class that the name of a car contains as a word, else the class of its height over its wheelbase."""
    parts = re.split(r"[^a-z]+", vehicle.name.lower())
    named_classes = [name for name in CLASSES if name in parts]
    return [*named_classes, *(name for name, body in CLASSES.items() if height <= body.highest * wheelbase)][0]


def body_outline(vehicle: Vehicle) -> tuple[Vector, Indices]:
    """Return the grid of the outline [m], (stations, 6, 3), and its lines as pairs of flat indices, (m, 2).

    Wheelbase, track, tyre radius and height are those of the car, and so is the front overhang if x = 0 can be the
    front. The rest is that of its class. Both are empty for a rig without two axles.
    """
    composition = vehicle.composition
    wheels = composition.wheels
    supports = [link.at for link in composition.connections if link.ground and link.moving == "body"]
    along = [point[0] for point in [*(wheel.center for wheel in wheels), *supports]]
    ground, front, rear = min(wheel.patch[2] for wheel in wheels), min(along), max(along)
    wheelbase = rear - front
    if wheelbase < SHORTEST:
        return np.zeros((0, 6, 3)), np.zeros((0, 2), dtype=np.intp)
    roofs = [point[2] - ground for name, point in vehicle.points.items() if name.startswith("roof")]
    height = max([*roofs, (vehicle.body.cog[2] - ground) / COG_HEIGHT])
    body = CLASSES[body_class(vehicle, height, wheelbase)]
    from_origin = OWN_OVERHANG[0] <= front / wheelbase <= OWN_OVERHANG[1]
    ahead = front if from_origin else body.overhangs[0] * wheelbase
    knots = [front - ahead, front, rear, rear + body.overhangs[1] * wheelbase]

    # Stations along the car: ends, edges of bonnet and windows, and the arches from the sill over the tyre to the sill.
    cowl, head, back, foot = body.windows
    door = head + 0.15
    shown = np.interp([0.0, 0.12, cowl, head, door, back, foot, 2.9, 3.0], range(4), knots)
    sill = ground + body.sill * height
    edges = [shown]
    circles = {(w.center[0], w.center[2], w.center[2] - w.patch[2] + ARCH_GAP) for w in wheels}
    for at, _, radius in circles:
        edges += [at + radius * np.cos(np.linspace(0.0, np.pi, ARCH)), at + (radius + EDGE) * np.array([-1.0, 1.0])]
    x = np.unique(np.concatenate(edges))
    station = np.interp(x, knots, range(4))

    # Heights and half widths of the three edges of a side.
    lower = sill + height * np.interp(station, [0.0, 0.3, 2.7, 3.0], [0.04, 0.0, 0.0, 0.06])
    for at, z, radius in circles:
        above = z + np.sqrt(np.maximum(radius**2 - (x - at) ** 2, 0.0))
        lower = np.where(np.abs(x - at) < radius + 0.5 * EDGE, np.maximum(lower, above), lower)
    waist = ground + body.waist * height * np.interp(station, [0.0, 0.12, cowl, 2.9, 3.0], [0.66, 0.8, 1.0, 1.04, 0.85])
    half = BESIDE_WHEEL + max(abs(wheel.center[1]) for wheel in wheels)
    wide = half * np.interp(station, [0.0, 0.12, 0.5, 2.6, 2.9, 3.0], [0.7, 0.86, 1.0, 1.0, 0.92, 0.8])
    ends = np.interp([cowl, foot], station, waist)
    windows = [cowl, head, door, back, foot]
    roof = np.interp(station, windows, [ends[0], *(ground + height * np.array([0.96, 1.0, 0.97])), ends[1]])
    narrow = np.interp(station, windows, [1.0, 0.74, 0.76, 0.74, 1.0])
    edge = np.searchsorted(x, shown)
    outside = np.r_[: edge[2] + 1, edge[6] : len(x)]
    roof[outside], narrow[outside] = waist[outside], 1.0
    right = np.stack([np.stack([x, y, z], axis=1) for y, z in
                      ((0.97 * wide, lower), (wide, waist), (narrow * wide, roof))], axis=1)  # fmt: skip
    sheets = np.concatenate([right, right[:, ::-1] * [1.0, -1.0, 1.0]], axis=1)

    # Lines: along the sides, across at the edges, pillars and edges of the doors.
    every, few, glass = range(len(x)), sorted(set(edge)), edge[2:7]
    joined = [(column, rows) for column, rows in ((0, every), (1, few), (2, glass), (3, glass), (4, few), (5, every))]
    lines = [(6 * i + column, 6 * j + column) for column, rows in joined for i, j in pairwise(rows)]
    lines += [(6 * row + i, 6 * row + j) for row in edge[[0, -1]] for i, j in ((0, 1), (1, 4), (4, 5), (0, 5))]
    lines += [(6 * row + i, 6 * row + 5 - i) for row, i in zip(edge[1:7], (1, 1, 2, 2, 2, 1), strict=True)]
    lines += [(6 * edge[4] + i, 6 * edge[4] + i + 1) for i in (0, 1, 3, 4)]
    return sheets, np.array(lines, dtype=np.intp)
