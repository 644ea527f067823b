"""Sheet metal and glass of the body, built as patches between the curves of the outline."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import trimesh

from vehicle.arrays import Vector
from vehicle.model.shapes.body_outline import CANT_RAIL, DRAWING, SILL, Outline, station_at, station_front, station_rear
from vehicle.model.shapes.solids import both, inverted, joined
from vehicle.model.shapes.surface import bezier, coons, grid, spline

CORNER_Y = 0.58  # [m] reference Y of the front corner of the bonnet
LINING_GAP = 0.014  # [m]
HOUSE_DEPTH = (0.16, 0.22)  # [m] depth of the wheel houses; strut and spring stay visible behind the front one
ARCH_POINTS = 11  # along the half circle of a wheel arch
FAN = 0.075  # [m] distance by which the row over the foot of an arch leans away from the wheel
LEVELS = 7  # rows of the lower body between sill and waist
ROOF_STATIONS = 13
CANT_STEPS = 4
SILL_GLASS, TOP_GLASS = 0.06, 0.93  # share of the height of the side where the glass begins and ends
MIRROR_Y = np.array([1.0, -1.0, 1.0])
ACROSS = 9  # points across the flat of the roof, odd
ROOF_X = (float(CANT_RAIL[0, 0]), float(CANT_RAIL[-1, 0]))
BOW_FRONT, BOW_REAR = 0.085, -0.045  # [m] forward distance of the middle of the roof edges from their ends
COWL_X, TAIL_X, WINDOWS = DRAWING["cowl_x"], DRAWING["tail_x"], DRAWING["windows"]
_ROUNDING = 1 - 0.13 * np.linspace(0, 1, CANT_STEPS)
# lateral positions of the points of a roof edge, 1 at the right rail, -1 at the left rail
SHARES = np.concatenate([_ROUNDING[:-1], np.linspace(_ROUNDING[-1], -_ROUNDING[-1], ACROSS), -_ROUNDING[::-1][1:]])


def lower_loops(body: Outline) -> tuple[Vector, Vector, Vector, Vector]:
    """Return stations and heights of the lower and upper edge of the right lower body, from front to rear middle.

    The lower edge follows bumper, front arch, sill, rear arch, bumper; both edges have the same number of points.

    Returns:
        station and height H of the lower edge, station and height H of the upper edge, each shape (n,)
    """
    (fx, fh), (rx, rh) = arch_edge(body, 0), arch_edge(body, 1)
    # above an arch the upper points are spread evenly and wider than the arch, so that the rows fan out round it
    fan = [np.concatenate([[x[0] - FAN], np.linspace(x[0], x[-1], len(x) - 2), [x[-1] + FAN]]) for x in (fx, rx)]
    front = station_front(np.array([0.0, 0.20, 0.38, 0.50, CORNER_Y]))
    rear = station_rear(np.array([0.60, 0.48, 0.32, 0.16, 0.0]))
    middle = station_at(np.concatenate([[COWL_X], np.linspace(COWL_X, rx[0], 8)[1:-1]]))
    front_side, front_side_top = (station_at(np.linspace(0.115, end, 7))[:-1] for end in (fx[0], fan[0][0]))
    rear_side, rear_side_top = (station_at(np.linspace(start, 4.36, 7))[1:] for start in (rx[-1], fan[1][-1]))
    low = np.concatenate([front, front_side, station_at(fx), middle, station_at(rx), rear_side, rear])
    top = np.concatenate([front, front_side_top, station_at(fan[0]), middle, station_at(fan[1]), rear_side_top, rear])

    def sill(station: Vector) -> Vector:
        return np.asarray(np.interp(station, station_at(SILL[:, 0]), SILL[:, 1]))

    low_heights = np.concatenate([sill(front), sill(front_side), fh, sill(middle), rh, sill(rear_side), sill(rear)])
    return low, low_heights, top, body.waist(top)


def arch_edge(body: Outline, axle: int) -> tuple[Vector, Vector]:
    """Return reference X and H [m] of the edge of a wheel arch: vertical, half circle, vertical to the sill."""
    cx, cz = body.arch_centre(axle)
    phi = np.linspace(np.pi, 0, ARCH_POINTS)
    X = body.along(cx + body.arch_radius * np.cos(phi))
    H = body.height(cz + body.arch_radius * np.sin(phi))
    feet = np.interp(X[[0, -1]], *SILL.T)
    return np.concatenate([X[:1], X, X[-1:]]), np.concatenate([feet[:1], H, feet[1:]])


def lower_grid(body: Outline, lift: float = 0.0) -> Vector:
    """Return points of the right lower body from the lower edge to the waist, shape (levels, n, 3)."""
    low, low_h, top, top_h = lower_loops(body)
    share = np.linspace(0, 1, LEVELS)[:, None]
    return body.side((1 - share) * low + share * top, (1 - share) * low_h + share * top_h, lift)


def waist_curve(body: Outline, X: Vector) -> Vector:
    """Return vehicle points of the waist at reference X [m] of the plan curve, shape (n, 3)."""
    station = station_at(X)
    return body.side(station, body.waist(station))


def cant_rail(body: Outline, X: Vector) -> tuple[Vector, Vector, Vector]:
    """Return lower edge, corner and upper edge of the roof rounding at reference X [m], each of shape (n, 3)."""
    rail = spline(CANT_RAIL, 200)
    low = np.column_stack([X, *(np.interp(X, rail[:, 0], rail[:, k]) for k in (1, 2))])
    return body.place(low), body.place(low + DRAWING["roof_corner_step"]), body.place(low + DRAWING["roof_edge_step"])


def header(body: Outline, X: float, bow: float) -> Vector:
    """Return the edge of the roof over the windscreen or the tailgate, from the right rail to the left rail.

    Args:
        body: the outline
        X: reference X of the ends of the edge [m]
        bow: forward distance of the middle from the ends [m]

    Returns:
        points, shape (ACROSS + 2 * (CANT_STEPS - 1), 3)
    """
    low, corner, edge = (curve[0] for curve in cant_rail(body, np.array([X])))
    rounding = bezier(low, corner, edge, CANT_STEPS)
    flat = np.linspace(1, -1, ACROSS)[:, None]
    roof = edge * (0, 0, 1) + (edge * (1, 0, 0) - (bow, 0, 0) * (1 - flat**2)) + (0, 1, 0) * flat * edge
    roof = roof + (0, 0, DRAWING["roof_crown"]) * (1 - flat**2)
    return np.vstack([rounding[:-1], roof, (rounding * MIRROR_Y)[::-1][1:]])


def roof(body: Outline) -> Vector:
    """Return points of the roof with both rounded rails, from the windscreen to the tailgate, right to left."""
    rows = []
    for share, X in zip(np.linspace(0, 1, ROOF_STATIONS), np.linspace(*ROOF_X, ROOF_STATIONS), strict=True):
        bow = BOW_FRONT * max(0.0, 1 - 6 * share) ** 2 + BOW_REAR * max(0.0, 6 * share - 5) ** 2
        rows.append(header(body, float(X), bow))
    return np.array(rows)


def windscreen_grid(body: Outline) -> Vector:
    """Return points of the windscreen plane with the pillars, from cowl to header, shape (6, n, 3)."""
    bottom, top = cowl(body), header(body, ROOF_X[0], BOW_FRONT)
    left, right = (bottom[k] + np.linspace(0, 1, 6)[:, None] * (top[k] - bottom[k]) for k in (0, -1))
    return coons(bottom, top, left, right)


def cowl(body: Outline) -> Vector:
    """Return the foot of the windscreen, bowed forward, from right to left, spaced like the header above."""
    x, y, z = waist_curve(body, np.array([COWL_X]))[0]
    return np.column_stack([x - 0.215 * (1 - SHARES**2), y * SHARES, z + 0.060 * (1 - SHARES**2)])


def bonnet(body: Outline) -> Vector:
    """Return points of the bonnet between the front edge, both wing edges and the cowl, with additional crown."""
    edge = lower_loops(body)[2]  # shared points with the lower body avoid a gap
    ahead = edge[edge <= station_front(CORNER_Y) + 1e-9]
    half = np.concatenate([ahead[::-1], ahead[1:]])
    wing_stations = edge[(edge >= station_front(CORNER_Y) - 1e-9) & (edge <= station_at(COWL_X) + 1e-9)]
    count, rows = len(half), len(wing_stations)
    shares = np.linspace(1, -1, count)
    rear = np.column_stack([np.interp(-shares, -SHARES, coordinate) for coordinate in cowl(body).T])
    front = body.side(half, body.waist(half))
    front[:, 1] *= np.sign(shares) + (shares == 0)
    wing = body.side(wing_stations, body.waist(wing_stations))
    surface = coons(front, rear, wing, wing * MIRROR_Y)
    u, v = np.linspace(0, 1, count)[None, :], np.linspace(0, 1, rows)[:, None]
    surface[..., 2] += 0.16 * u * (1 - u) * np.sin(np.pi * v) ** 0.8 * (1 - 0.4 * v)
    return surface


def tailgate_grid(body: Outline) -> Vector:
    """Return points of the tailgate from the waist to the header, shape (7, n, 3)."""
    top, steps = header(body, ROOF_X[1], BOW_REAR), np.linspace(0, 1, 7)[:, None]
    station = 1 - (1 - station_at(TAIL_X)) * np.abs(SHARES)
    bottom = body.side(station, body.waist(station))
    bottom[:, 1] *= np.sign(SHARES)
    left = bottom[0] + steps * (top[0] - bottom[0])
    surface = coons(bottom, top, left, left * MIRROR_Y)
    surface[..., 0] += 0.022 * (np.sin(np.pi * steps) * (1 - SHARES**4))
    return surface


def side_columns(body: Outline) -> tuple[list[Vector], list[Vector]]:
    """Return patches of the right side above the waist, sheet metal and glass, each of shape (m, n, 3)."""
    edges = [edge for window in WINDOWS for edge in (window[:2], window[2:])]
    lines = [(COWL_X, ROOF_X[0]), *edges, (TAIL_X, ROOF_X[1])]
    metal: list[Vector] = []
    glass: list[Vector] = []
    for k, (first, last) in enumerate(pairwise(lines)):
        # the bulge fades in the outermost pillars, whose edges are shared with windscreen and tailgate
        fade = (float(k > 0), float(k < len(lines) - 2))
        if k % 2 == 0:
            metal.append(side_patch(body, first, last, np.linspace(0.0, 1.0, 5), 3, fade))
            continue
        levels = ((0.0, SILL_GLASS, 2), (SILL_GLASS, TOP_GLASS, 5), (TOP_GLASS, 1.0, 2))
        low, pane, high = (side_patch(body, first, last, np.linspace(*level), 6, fade) for level in levels)
        metal += [low, high]
        glass.append(pane)
    return metal, glass


def side_patch(
    body: Outline, first: Sequence[float], last: Sequence[float], levels: Vector, count: int, fade: Sequence[float]
) -> Vector:
    """Return points between two slanted lines on the right side above the waist, with the bulge of the side glass.

    Args:
        body: the outline
        first: reference X of the front line at the waist and at the roof rail [m]
        last: reference X of the rear line at the waist and at the roof rail [m]
        levels: shares of the height of the side, shape (m,)
        count: number of points between the lines
        fade: share of the bulge at the front and at the rear line
    """
    share = np.linspace(0, 1, count)
    bottom = waist_curve(body, first[0] + share * (last[0] - first[0]))
    top = cant_rail(body, first[1] + share * (last[1] - first[1]))[0]
    v = levels[:, None, None]
    surface: Vector = (1 - v) * bottom + v * top
    surface[..., 1] += 0.018 * np.sin(np.pi * levels)[:, None] * (fade[0] + share * (fade[1] - fade[0]))
    return surface


def split_pane(surface: Vector, rows: tuple[int, int], flip: bool) -> tuple[list[trimesh.Trimesh], trimesh.Trimesh]:
    """Cut a pane from a grid, between two rows and two columns from either side; return frame and pane."""
    low, high = rows
    inside = surface[low : high + 1]
    frame = [surface[: low + 1], surface[high:], inside[:, :3], inside[:, -3:]]
    return [grid(patch, flip=flip) for patch in frame if len(patch) > 1], grid(inside[:, 2:-2], flip=flip)


def upper_body(body: Outline) -> tuple[trimesh.Trimesh, trimesh.Trimesh]:
    """Build the body between waist and roof: pillars with window frames, and the glass."""
    metal, glass = ([grid(patch, flip=True) for patch in patches] for patches in side_columns(body))
    front_frame, windscreen = split_pane(windscreen_grid(body), (0, 5), flip=False)
    rear_frame, rear_window = split_pane(tailgate_grid(body), (1, 5), flip=True)
    return joined(both(*metal), front_frame, rear_frame), joined(both(*glass), windscreen, rear_window)


def sheet_metal(body: Outline, pillars: trimesh.Trimesh) -> trimesh.Trimesh:
    """Build all painted panels: bumpers, wings, doors and side panels up to the waist, pillars, bonnet and roof."""
    return joined(both(grid(lower_grid(body), flip=True)), pillars, grid(bonnet(body)), grid(roof(body)))


def lining(body: Outline, pillars: trimesh.Trimesh) -> trimesh.Trimesh:
    """Build the inner surface of the sheet metal, offset and facing inward, with fewer triangles."""
    right = grid(lower_grid(body, -LINING_GAP)[[0, 3, LEVELS - 1]])
    inner = inverted(pillars)
    inner.vertices = np.asarray(pillars.vertices) - LINING_GAP * np.asarray(pillars.vertex_normals)
    covers = [grid(surface[::2, ::2] - (0, 0, 1.6 * LINING_GAP), flip=True) for surface in (bonnet(body), roof(body))]
    houses = [wheel_house(body, axle, depth) for axle, depth in enumerate(HOUSE_DEPTH)]
    return joined(both(right), inner, covers, houses)


def wheel_house(body: Outline, axle: int, depth: float) -> trimesh.Trimesh:
    """Build the sheets from the edge of an arch inward, facing the wheel, on both sides of the car."""
    X, H = arch_edge(body, axle)
    edge = body.side(station_at(X), H) - (0, 0.012, 0)
    inner = edge.copy()
    inner[:, 1] = edge[:, 1].mean() - depth
    sheet = grid(np.stack([edge, inner]))
    return both(sheet, inverted(sheet))
