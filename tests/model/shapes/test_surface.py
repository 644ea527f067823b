"""Curves, the surfaces between them, and placements."""

import numpy as np
import pytest

from vehicle.model.shapes.solids import axis_rotation, drum, joined, mirrored, placed
from vehicle.model.shapes.surface import bezier, coons, grid, rounded, spline


def test_a_coons_patch_passes_through_its_four_edges() -> None:
    u, v = np.linspace(0, 1, 9), np.linspace(0, 1, 6)
    bottom = np.column_stack([u, 0 * u, 0.2 * np.sin(np.pi * u)])
    top = np.column_stack([u, 1 + 0 * u, 0.1 * u * (1 - u)])
    left = np.column_stack([-0.2 * np.sin(np.pi * v), v, 0 * v])
    right = np.column_stack([1 + 0 * v, v, 0.3 * np.sin(np.pi * v)])
    surface = coons(bottom, top, left, right)
    for edge, curve in ((surface[0], bottom), (surface[-1], top), (surface[:, 0], left), (surface[:, -1], right)):
        assert edge == pytest.approx(curve, abs=1e-14)


def test_a_coons_patch_of_a_plane_is_the_plane() -> None:
    u = np.linspace(0, 1, 5)

    def plane(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.column_stack([x, y, 0.3 * x - 0.7 * y])

    surface = coons(plane(u, 0 * u), plane(u, 1 + 0 * u), plane(0 * u, u), plane(1 + 0 * u, u))
    assert surface[..., 2] == pytest.approx(0.3 * surface[..., 0] - 0.7 * surface[..., 1], abs=1e-14)
    assert grid(surface).area == pytest.approx(np.sqrt(1 + 0.3**2 + 0.7**2), rel=1e-12)


def test_the_parameter_of_a_spline_is_centripetal() -> None:
    # Distances 1 and 4 have the knots 0, 1, 3: four points evenly spaced in the parameter hold the second one.
    curve = spline([(0.0, 0.0), (1.0, 0.0), (5.0, 0.0)], 4)
    assert curve[[0, 1, 3], 0] == pytest.approx([0.0, 1.0, 5.0], abs=1e-12)


def test_a_grid_drops_triangles_that_shrink_to_a_line() -> None:
    fan = np.zeros((2, 4, 3))
    fan[1] = [(1, 0, 0), (1, 1, 0), (0.5, 1.5, 0), (0, 1.5, 0)]
    mesh = grid(fan)
    assert len(mesh.faces) == 3
    assert mesh.area == pytest.approx(0.5 + 0.5 + 0.375, rel=1e-12)
    assert np.sign(grid(fan, flip=True).face_normals[:, 2]) == pytest.approx(-np.sign(mesh.face_normals[:, 2]))


def test_a_spline_passes_through_its_points_and_keeps_a_straight_line() -> None:
    p = np.array([(0, 0), (1, 2), (3, 1), (4, 4.0)])
    curve = spline(p, 3001)
    # 3001 points over about 7.6 m: the nearest one is within half a step
    assert all(np.linalg.norm(curve - q, axis=1).min() < 2e-3 for q in p)
    line = spline(np.array([(0, 0), (1, 1), (5, 5.0)]), 50)
    assert line[:, 0] == pytest.approx(line[:, 1], abs=1e-13)


def test_a_rounded_corner_leaves_the_legs_straight() -> None:
    path = rounded(np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0.0)]), 0.2, steps=7)
    assert path[0] == pytest.approx((0, 0, 0))
    assert path[-1] == pytest.approx((1, 1, 0))
    assert path[1] == pytest.approx((0.8, 0, 0), abs=1e-14)
    assert path[-2] == pytest.approx((1, 0.2, 0), abs=1e-14)
    assert path[4] == pytest.approx(bezier((0.8, 0, 0), (1, 0, 0), (1, 0.2, 0), 3)[1], abs=1e-14)


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -2), (1, 0, 0), (0.3, -0.5, -0.2)])
def test_the_axis_rotation_turns_z_to_the_direction(direction: tuple[float, float, float]) -> None:
    rotation = axis_rotation(direction)
    assert rotation @ (0, 0, 1) == pytest.approx(np.array(direction) / np.linalg.norm(direction), abs=1e-14)
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(rotation) == pytest.approx(1)


def test_placing_mirroring_and_joining_keep_the_volume() -> None:
    mesh = placed(drum(0.1, 0, 0.5), (1, 2, 3), (1, 1, 0))
    other = mirrored(mesh)
    assert mesh.volume == pytest.approx(drum(0.1, 0, 0.5).volume, rel=1e-12)
    assert other.volume == pytest.approx(mesh.volume, rel=1e-12)
    assert other.bounds[:, 1] == pytest.approx(-mesh.bounds[::-1, 1])
    both = joined(mesh, [other])
    assert both.volume == pytest.approx(2 * mesh.volume, rel=1e-12)
    assert both.is_watertight


def test_a_spline_is_smooth_at_its_points() -> None:
    p = np.array([(0, 0), (1, 2), (3, 1), (4, 4.0)])
    errors = []
    for count in (1001, 2001):
        velocity = np.diff(spline(p, count), axis=0) * (count - 1)
        errors.append(np.abs(np.diff(velocity, axis=0)).max())
    # a kink would keep its jump of velocity as the steps get finer; a smooth curve halves it
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.05)
