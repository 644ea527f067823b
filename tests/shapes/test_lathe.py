"""Bodies of revolution against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from vehicle.shapes.lathe import ball, drum, lathe, ring


def polygon_share(sections: int) -> float:
    """Area of a regular polygon over that of its circle: a turned body loses exactly this much volume."""
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
