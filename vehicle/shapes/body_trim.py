"""What makes the body a car: lamps, grille, bumper strips, joints of the doors, handles, mirrors, roof rails."""

from __future__ import annotations

import itertools

import numpy as np
import trimesh

from vehicle.shapes.block import box, hull
from vehicle.shapes.body_outline import COWL_X, Outline, station_at, station_front, station_rear
from vehicle.shapes.body_shell import WINDOWS, arch_edge, bonnet, cant_rail, side_patch, waist_curve
from vehicle.shapes.curve import spline
from vehicle.shapes.patch import grid
from vehicle.shapes.placement import joined, mirrored, shifted
from vehicle.shapes.shape import Array
from vehicle.shapes.tube import rod, tube

JOINT_RADIUS = 0.0035  # [m] half width of the dark line that stands for a gap between panels
LIFT = 0.008  # [m] trim lies this far on the paint


def both(*meshes: trimesh.Trimesh) -> trimesh.Trimesh:
    """Right-hand meshes with their mirror images."""
    return joined([*meshes, *(mirrored(mesh) for mesh in meshes)])


def field(body: Outline, stations: Array, low: Array, high: Array, rows: int = 3) -> trimesh.Trimesh:
    """A patch on the right lower body between two heights H [m], each shape (n,)."""
    share = np.linspace(0, 1, rows)[:, None]
    heights = (1 - share) * low + share * high
    return grid(body.side(np.broadcast_to(stations, heights.shape), heights, LIFT), flip=True)


def headlamps(body: Outline) -> trimesh.Trimesh:
    """Lamps around the front corners, higher at the outside."""
    stations = np.linspace(station_front(0.40), station_at(0.42), 9)
    share = np.linspace(0, 1, 9)
    low = 0.565 + 0.055 * share**2
    high = np.minimum(body.waist(stations) - 0.018, 0.60 + 0.30 * share)
    return both(field(body, stations, low, np.maximum(high, low + 0.012), rows=5))


def tail_lamps(body: Outline) -> trimesh.Trimesh:
    """Upright lamps at the rear corners."""
    stations = np.linspace(station_at(4.20), station_rear(0.60), 7)
    return both(field(body, stations, np.full(7, 0.66), np.full(7, 0.975), rows=5))


def plates(body: Outline) -> trimesh.Trimesh:
    """Number plates, front and rear."""
    front = np.linspace(0, station_front(0.25), 3)
    rear = np.linspace(station_rear(0.25), 1.0, 3)
    return both(
        field(body, front, np.full(3, 0.375), np.full(3, 0.475), rows=2),
        field(body, rear, np.full(3, 0.70), np.full(3, 0.80), rows=2),
    )


def dark_trim(body: Outline) -> trimesh.Trimesh:
    """Grille, air intake, bumper and side strips, edges of the arches, joints of the doors, pillars between windows."""
    grille = np.linspace(0, station_front(0.30), 5)
    intake = np.linspace(0, station_front(0.46), 6)
    front_strip = np.linspace(station_front(0.28), station_at(0.44), 10)
    rear_strip = np.linspace(station_at(3.93), 1.0, 12)
    door_strip = station_at(np.linspace(1.26, 3.05, 8))
    parts = [
        field(body, grille, np.full(5, 0.575), np.linspace(0.655, 0.640, 5)),
        field(body, intake, np.full(6, 0.235), np.linspace(0.335, 0.320, 6)),
        field(body, front_strip, np.full(10, 0.445), np.full(10, 0.485)),
        field(body, rear_strip, np.full(12, 0.475), np.full(12, 0.525)),
        field(body, door_strip, np.full(8, 0.475), np.full(8, 0.52)),
    ]
    parts += [arch_lip(body, axle) for axle in (0, 1)]
    parts += [
        grid(
            shifted(side_patch(body, before[2:], after[:2], np.linspace(0.05, 0.94, 4), 2, (1.0, 1.0)), 0, 0.003, 0),
            flip=True,
        )
        for before, after in itertools.pairwise(WINDOWS[:2])
    ]
    joints = [
        [(1.36, 0.90), (1.31, 0.75), (1.30, 0.45), (1.335, 0.235)],
        [(2.52, 0.945), (2.52, 0.70), (2.50, 0.235)],
        [(3.40, 0.965), (3.40, 0.82), (3.29, 0.64), (3.06, 0.50), (2.98, 0.235)],
        [(1.335, 0.235), (2.2, 0.233), (2.98, 0.235)],
    ]
    for joint in joints:
        X, H = spline(joint, 7).T
        parts.append(tube(body.side(station_at(X), H, 0.0005), JOINT_RADIUS, sides=3))
    waist = waist_curve(body, np.linspace(COWL_X + 0.06, 4.28, 14))
    parts.append(tube(shifted(waist, 0, 0.002, 0.01), 0.006, sides=3))
    parts.append(tube(bonnet(body)[1:-1:2, 1] + (0, 0, 0.001), JOINT_RADIUS, sides=3))
    parts.append(mirror_foot(body))
    return both(*parts)


def arch_lip(body: Outline, axle: int) -> trimesh.Trimesh:
    """Rounded edge along a wheel arch."""
    X, H = arch_edge(body, axle)
    return tube(body.side(station_at(X), H) - (0, 0.004, 0), 0.009, sides=4)


def mirror_place(body: Outline) -> Array:
    """Root of the right door mirror on the waist."""
    place: Array = waist_curve(body, np.array([1.70]))[0]
    return place


def mirror_foot(body: Outline) -> trimesh.Trimesh:
    """Foot of the right door mirror."""
    root = mirror_place(body)
    return rod(shifted(root, 0, -0.02, 0.02), shifted(root, 0.005, 0.1, 0.055), 0.018, sides=8)


def painted_parts(body: Outline) -> trimesh.Trimesh:
    """Door mirrors and door handles."""
    centre = shifted(mirror_place(body), 0.0, 0.145, 0.075)
    rows = []
    for x, y, z in ((-0.045, 0.060, 0.035), (0.0, 0.095, 0.062), (0.045, 0.098, 0.066)):  # an octagon each
        for sy in (-1, 1):
            for sz in (-1, 1):
                rows += [(x, sy * y, 0.6 * sz * z), (x, 0.7 * sy * y, sz * z)]
    shell = hull(centre + np.array(rows))
    handles = []
    for X in (2.30, 3.16):
        place = body.side(station_at(X), np.asarray(0.80), 0.006)
        handles.append(box(place - (0.085, 0.010, 0.016), shifted(place, 0.085, 0.014, 0.014)))
    return both(shell, *handles)


def roof_rails(body: Outline) -> trimesh.Trimesh:
    """Rails along both sides of the roof on three feet."""
    X = np.linspace(2.16, 3.98, 10)
    edge = cant_rail(body, X)[2]
    height = 0.034 * np.minimum(1.0, 8 * np.sin(np.pi * np.linspace(0.0, 1, 10)))
    rail = tube(edge + np.column_stack([0 * X, 0 * X, height]), 0.012, sides=5)
    feet = [box(edge[i] - (0.05, 0.010, 0.02), edge[i] + (0.05, 0.010, 0.034)) for i in (1, 5, 8)]
    return both(rail, *feet)
