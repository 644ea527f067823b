"""Details of the outer body: lamps, grille, bumper strips, door joints, handles, mirrors, roof rails."""

import numpy as np
import trimesh

from vehicle.arrays import Vector
from vehicle.model.shapes import body_shell, palette
from vehicle.model.shapes.body_outline import DRAWING, Outline, outline, station_at, station_front, station_rear
from vehicle.model.shapes.body_shell import COWL_X, WINDOWS, arch_edge, bonnet, cant_rail, side_patch, waist_curve
from vehicle.model.shapes.shape import Piece, Points, Sizes
from vehicle.model.shapes.solids import block, both, hull, rod, shifted, tube
from vehicle.model.shapes.surface import grid, spline

JOINT_RADIUS = 0.0035  # [m] half width of the dark line drawn for a gap between panels
LIFT = 0.008  # [m] distance of the trim from the paint


def estate_body(points: Points, size: Sizes) -> list[Piece]:
    """Draw lining, painted panels, trim, lamps, number plates and glass of an estate car."""
    body = outline(points, size)
    pillars, glass = body_shell.upper_body(body)
    tail = np.linspace(station_at(4.20), station_rear(0.60), 7)
    return [
        Piece("_lining", body_shell.lining(body, pillars), palette.LINING),
        Piece("_shell", body_shell.sheet_metal(body, pillars), palette.BODY),
        Piece("_painted", painted_parts(body), palette.BODY),
        Piece("_trim", dark_trim(body), palette.TRIM),
        Piece("_rails", roof_rails(body), palette.CHROME),
        Piece("_lamps_front", headlamps(body), palette.HEADLAMP),
        Piece("_lamps_rear", both(field(body, tail, 0.66, 0.975, 5)), palette.TAIL_LAMP),
        Piece("_plates", plates(body), palette.CHROME),
        Piece("_glass", glass, palette.GLASS),
    ]


def field(body: Outline, stations: Vector, low: float | Vector, high: float | Vector, rows: int = 3) -> trimesh.Trimesh:
    """Draw a patch on the right lower body.

    Args:
        body: the outline
        stations: stations of the plan curve, shape (n,)
        low: height H of the lower edge [m], a number or shape (n,)
        high: height H of the upper edge [m], a number or shape (n,)
        rows: number of points from the lower to the upper edge
    """
    share = np.linspace(0, 1, rows)[:, None]
    height = np.broadcast_to((1 - share) * low + share * high, (rows, len(stations)))
    return grid(body.side(np.broadcast_to(stations, height.shape), height, LIFT), flip=True)


def headlamps(body: Outline) -> trimesh.Trimesh:
    """Draw the lamps around the front corners, higher at the outside."""
    stations, share = np.linspace(station_front(0.40), station_at(0.42), 9), np.linspace(0, 1, 9)
    low = 0.565 + 0.055 * share**2
    high = np.minimum(body.waist(stations) - 0.018, 0.60 + 0.30 * share)
    return both(field(body, stations, low, np.maximum(high, low + 0.012), 5))


def plates(body: Outline) -> trimesh.Trimesh:
    """Draw the number plates, front and rear."""
    front, rear = np.linspace(0, station_front(0.25), 3), np.linspace(station_rear(0.25), 1.0, 3)
    return both(field(body, front, 0.375, 0.475, 2), field(body, rear, 0.70, 0.80, 2))


def dark_trim(body: Outline) -> trimesh.Trimesh:
    """Draw grille, air intake, bumper and side strips, arch edges, door joints and pillars between windows."""
    parts = [
        field(body, stations, low, high)
        for stations, low, high in (
            (np.linspace(0, station_front(0.30), 5), 0.575, np.linspace(0.655, 0.640, 5)),
            (np.linspace(0, station_front(0.46), 6), 0.235, np.linspace(0.335, 0.320, 6)),
            (np.linspace(station_front(0.28), station_at(0.44), 10), 0.445, 0.485),
            (np.linspace(station_at(3.93), 1.0, 12), 0.475, 0.525),
            (station_at(np.linspace(1.26, 3.05, 8)), 0.475, 0.52),
        )
    ]
    for axle in (0, 1):
        X, H = arch_edge(body, axle)
        parts.append(tube(body.side(station_at(X), H) - (0, 0.004, 0), 0.009, sides=4))
    pillar = side_patch(body, WINDOWS[0][2:], WINDOWS[1][:2], np.linspace(0.05, 0.94, 4), 2, (1.0, 1.0))
    parts.append(grid(shifted(pillar, 0, 0.003, 0), flip=True))
    for joint in DRAWING["joints"]:
        X, H = spline(joint, 7).T
        parts.append(tube(body.side(station_at(X), H, 0.0005), JOINT_RADIUS, sides=3))
    waist = waist_curve(body, np.linspace(COWL_X + 0.06, 4.28, 14))
    parts.append(tube(shifted(waist, 0, 0.002, 0.01), 0.006, sides=3))
    parts.append(tube(bonnet(body)[1:-1:2, 1] + (0, 0, 0.001), JOINT_RADIUS, sides=3))
    root = mirror_place(body)
    parts.append(rod(shifted(root, 0, -0.02, 0.02), shifted(root, 0.005, 0.1, 0.055), 0.018, sides=8))
    return both(*parts)


def mirror_place(body: Outline) -> Vector:
    """Return the root of the right door mirror on the waist [m], shape (3,)."""
    root: Vector = waist_curve(body, np.array([1.70]))[0]
    return root


def painted_parts(body: Outline) -> trimesh.Trimesh:
    """Draw door mirrors and door handles."""
    centre = shifted(mirror_place(body), 0.0, 0.145, 0.075)
    rows = []
    for x, y, z in ((-0.045, 0.060, 0.035), (0.0, 0.095, 0.062), (0.045, 0.098, 0.066)):  # an octagon each
        for sy in (-1, 1):
            for sz in (-1, 1):
                rows += [(x, sy * y, 0.6 * sz * z), (x, 0.7 * sy * y, sz * z)]
    shell = hull(centre + np.array(rows))
    handles = [body.side(station_at(X), np.asarray(0.80), 0.006) for X in (2.30, 3.16)]
    return both(shell, *(block(handle, (-0.085, -0.010, -0.016), (0.085, 0.014, 0.014)) for handle in handles))


def roof_rails(body: Outline) -> trimesh.Trimesh:
    """Draw the rails along both sides of the roof, on three feet each."""
    X = np.linspace(2.16, 3.98, 10)
    edge = cant_rail(body, X)[2]
    height = 0.034 * np.minimum(1.0, 8 * np.sin(np.pi * np.linspace(0.0, 1, 10)))
    rail = tube(edge + np.column_stack([0 * X, 0 * X, height]), 0.012, sides=5)
    return both(rail, *(block(edge[i], (-0.05, -0.010, -0.02), (0.05, 0.010, 0.034)) for i in (1, 5, 8)))
