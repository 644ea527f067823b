"""Swept tubes against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from vehicle.shapes.curve import helix, length
from vehicle.shapes.tube import frames, rod, tube


def polygon_area(radius: float, sides: int) -> float:
    """Area of a regular polygon [m2]."""
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
    assert (away > -1e-12).all()  # the flat ends contain their point of the path: zero but for rounding
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
