"""Bodies of revolution, swept tubes, slabs and boxes against closed forms."""

import numpy as np
import pytest

from vehicle.model.shapes.solids import ball, box, drum, frames, lathe, plate, ring, rod, swept, tube
from vehicle.model.shapes.surface import helix


def polygon_share(sections: int) -> float:
    """Return the area of a regular polygon over that of its circle, the volume ratio of a body of revolution."""
    angle = 2 * np.pi / sections
    return float(np.sin(angle) / angle)


def test_a_turned_cylinder_has_the_volume_of_its_prism_exactly() -> None:
    mesh = drum(0.3, -0.2, 0.5, sections=17)
    assert mesh.is_watertight
    # rounding of a few hundred additions of numbers near 0.1
    assert mesh.volume == pytest.approx(np.pi * 0.3**2 * 0.7 * polygon_share(17), rel=1e-12)


def test_a_turned_torus_approaches_pappus() -> None:
    big, small, corners = 0.5, 0.1, 400
    phi = 2 * np.pi * np.arange(corners) / corners
    profile = np.column_stack([big + small * np.cos(phi), small * np.sin(phi)])
    mesh = lathe(profile, sections=90, closed=True)
    assert mesh.is_watertight
    exact = 2 * np.pi**2 * big * small**2
    # the section is a 400-gon: 1 - sin(a)/a = 4e-5; the turn's share is taken out exactly
    assert mesh.volume == pytest.approx(exact * polygon_share(90), rel=5e-5)


def test_volume_converges_with_the_square_of_the_sections() -> None:
    exact = 4 / 3 * np.pi * 0.2**3
    errors = [exact - ball(0.2, sections=n).volume for n in (16, 32, 64)]
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    # second order in both directions of the mesh; the next term is of fourth order and gives 0.02 at 16 sections
    assert orders == pytest.approx([2, 2], abs=0.05)


def test_normals_point_outward_whatever_the_direction_of_the_profile() -> None:
    upward = [(0, 0), (0.2, 0), (0.1, 0.3), (0, 0.3)]
    for profile in (upward, upward[::-1]):
        mesh = lathe(profile, sections=12)
        assert mesh.volume > 0
        away = np.einsum("ij,ij->i", mesh.face_normals, mesh.triangles_center - (0, 0, 0.15))
        assert (away > 0).all()


def test_a_ring_is_the_difference_of_two_drums() -> None:
    outer, inner = drum(0.3, 0, 0.2, sections=20).volume, drum(0.1, 0, 0.2, sections=20).volume
    assert ring(0.1, 0.3, 0, 0.2, sections=20).volume == pytest.approx(outer - inner, rel=1e-12)


def test_a_bevel_takes_the_volume_of_two_turned_triangles() -> None:
    r, bevel, sections = 0.3, 0.05, 24
    removed = 2 * np.pi * bevel**2 * (r - bevel / 3) * polygon_share(sections)  # Pappus: b^2/2 at r - b/3, twice
    plain = drum(r, 0, 0.4, sections=sections).volume
    assert drum(r, 0, 0.4, bevel=bevel, sections=sections).volume == pytest.approx(plain - removed, rel=1e-12)


def test_a_slab_has_area_times_thickness_whatever_its_edges_direction() -> None:
    a = np.column_stack([np.linspace(0, 2, 5), np.zeros(5), np.zeros(5)])
    b, half = a + np.array([0, 0.5, 0]), np.array([0, 0, 0.05])
    for first, second in ((a, b), (b, a)):
        slab = swept(np.stack([first + half, second + half, second - half, first - half], axis=1))
        assert slab.is_watertight
        assert slab.volume == pytest.approx(2 * 0.5 * 0.1, rel=1e-12)


def test_a_bevelled_box_loses_its_edges_and_corners() -> None:
    size, bevel = np.array([0.4, 0.3, 0.2]), 0.03
    inner = size - 2 * bevel
    # core, six slabs on its faces, twelve triangular prisms, eight corner tetrahedra
    exact = np.prod(inner) + 2 * bevel * (inner[0] * inner[1] + inner[1] * inner[2] + inner[2] * inner[0])
    exact += 4 * 0.5 * bevel**2 * inner.sum() + 8 * bevel**3 / 6
    mesh = box(-size / 2, size / 2, bevel)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(exact, rel=1e-12)
    assert box(size / 2, -size / 2).volume == pytest.approx(np.prod(size), rel=1e-12)
    half = plate((1.0, 2.0, 3.0), 1, (-0.1, 0.2), ((0, 0), (0.4, 0), (0, 0.5)))
    assert half.volume == pytest.approx(0.5 * 0.4 * 0.5 * 0.3, rel=1e-12)
    assert half.bounds == pytest.approx(np.array([(1, 1.9, 3), (1.4, 2.2, 3.5)]))


def length(points: np.ndarray) -> float:
    """Return the length of a polyline [m]."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def polygon_area(radius: float, sides: int) -> float:
    """Return the area of a regular polygon [m2]."""
    return float(sides / 2 * np.sin(2 * np.pi / sides) * radius**2)


def test_a_straight_rod_has_the_volume_of_its_prism() -> None:
    a, b = np.array([0.1, -0.2, 0.3]), np.array([0.5, 0.4, 0.9])
    mesh = rod(a, b, 0.02, sides=7)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(polygon_area(0.02, 7) * np.linalg.norm(b - a), rel=1e-12)


def test_a_flat_bar_has_the_sides_it_is_given() -> None:
    mesh = tube([(0, 0, 0), (1, 0, 0)], 0.01, sides=4, width=0.03, up=(0, 0, 1))
    assert mesh.extents == pytest.approx([1.0, 0.06, 0.02], abs=1e-12)
    assert mesh.volume == pytest.approx(1.0 * 0.06 * 0.02, rel=1e-12)


def test_a_closed_ring_approaches_pappus() -> None:
    big, small, steps = 0.4, 0.05, 200
    phi = 2 * np.pi * np.arange(steps) / steps
    circle = big * np.column_stack([np.cos(phi), np.sin(phi), 0 * phi])
    mesh = tube(circle, small, sides=8, closed=True)
    assert mesh.is_watertight
    # 200 chords instead of a circle: 1 - sin(a)/a = 1.6e-4
    assert mesh.volume == pytest.approx(2 * np.pi * big * polygon_area(small, 8), rel=2e-4)


def test_normals_of_a_bent_tube_point_away_from_its_path() -> None:
    phi = np.linspace(0, 1.5, 30)
    path = np.column_stack([np.cos(phi), np.sin(phi), 0.3 * phi])
    mesh = tube(path, 0.05, sides=10)
    assert mesh.volume > 0
    nearest = path[np.argmin(np.linalg.norm(mesh.triangles_center[:, None] - path[None], axis=2), axis=1)]
    away = np.einsum("ij,ij->i", mesh.face_normals, mesh.triangles_center - nearest)
    assert (away > -1e-12).all()  # the flat ends contain their point of the path: zero except for round-off
    assert (away > 0.04).sum() == 2 * 10 * 29


def test_helix_has_the_length_of_the_closed_form() -> None:
    r, rise, turns = 0.07, 0.25, 5.5
    exact = np.hypot(2 * np.pi * r * turns, rise)
    errors = [exact - length(helix(r, 0.1, 0.1 + rise, turns, steps=n)) for n in (20, 40, 80)]
    # chords are shorter by a^2/24: second order in the step
    assert np.log2(np.array(errors[:-1]) / np.array(errors[1:])) == pytest.approx([2, 2], abs=0.02)
    assert errors[0] == pytest.approx(exact * (2 * np.pi / 20) ** 2 / 24, rel=0.02)


def test_the_wire_of_a_coil_has_the_length_times_the_section() -> None:
    path = helix(0.07, 0.0, 0.25, 5.0, steps=120)
    mesh = tube(path, 0.006, sides=8)
    assert mesh.is_watertight
    # the ends are cut square to the first chord, not to the helix: parts of 1e-4 of the volume
    assert mesh.volume == pytest.approx(length(path) * polygon_area(0.006, 8), rel=5e-4)


def test_frames_stay_normal_and_turn_against_the_torsion() -> None:
    r, rise, turns = 0.2, 0.4, 2.0
    c = rise / (2 * np.pi * turns)  # rise for each radian
    errors = []
    for steps in (50, 100, 200):
        path = helix(r, 0.0, rise, turns, steps=steps)
        first, second = frames(path, None, closed=False)
        tangents = np.gradient(path, axis=0)
        tangents /= np.linalg.norm(tangents, axis=1)[:, None]
        for normals in (first, second):
            assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(len(path)), abs=1e-12)
            assert np.einsum("ij,ij->i", normals, tangents) == pytest.approx(np.zeros(len(path)), abs=1e-12)
        # a frame without twist turns against the Frenet frame by the torsion: -c phi / sqrt(r^2 + c^2)
        phi = np.linspace(0, 2 * np.pi * turns, len(path))
        principal = -np.column_stack([np.cos(phi), np.sin(phi), 0 * phi])
        binormal = np.cross(tangents, principal)
        angle = np.unwrap(np.arctan2((first * binormal).sum(axis=1), (first * principal).sum(axis=1)))
        # the tangents of both ends are one-sided differences, so the first and the last point are left out
        errors.append(abs(angle[-2] - angle[1] + c * (phi[-2] - phi[1]) / np.hypot(r, c)))
    # double reflection is of fourth order (its paper, section 4.2)
    assert np.log2(np.array(errors[:-1]) / np.array(errors[1:])) == pytest.approx([4, 4], abs=0.1)
