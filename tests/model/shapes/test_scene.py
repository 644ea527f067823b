"""Complete scene: closed, finite, mirrored, and at its hardpoints."""

import numpy as np
import pytest
import trimesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from tests.model.shapes.focus_scene import car_shapes
from vehicle.model.shapes import SHELL, Part, Shape, part_shapes

OPEN = {"body_shell", "body_lining", "body_trim", "body_lamps_front", "body_lamps_rear", "body_plates", "body_glass"}
"""sheets by nature: panels, panes and fields of colour on the paint"""
PARTS_OF_A_SIDE = (
    "a_arm", "knuckle", "tyre", "brake_disc", "caliper", "damper_bottom", "damper_top", "suspension_mount",
    "main_spring", "steering_rod", "stabilizer_half", "stabilizer_rod",
)  # fmt: skip
MAX_STL_BYTES = 1.30e6  # all files of the scene are kept in the repository
STL_HEADER, STL_TRIANGLE = 84, 50


@pytest.fixture(scope="module")
def shapes(points: dict[str, np.ndarray]) -> dict[str, Shape]:
    return car_shapes(points)


@pytest.fixture(scope="module")
def moved(points: dict[str, np.ndarray]) -> tuple[dict[str, np.ndarray], dict[str, Shape]]:
    """Hardpoints away from those of the car by up to 12 mm, and the scene on them."""
    generator = np.random.default_rng(7)
    result = dict(points)
    for name in [name for name in points if name.endswith("_fr")]:
        result[name] = points[name] + generator.uniform(-0.012, 0.012, 3)
        result[name[:-3] + "_fl"] = result[name] * (1, -1, 1)
    # the lower spring seat is a point of the strut axis, as in the shipped car
    bottom, top = result["damper_bottom_fr"], result["strut_top_fr"]
    result["spring_lower_fr"] = bottom + 0.42 * (top - bottom)
    result["spring_lower_fl"] = result["spring_lower_fr"] * (1, -1, 1)
    return result, car_shapes(result)


def volumes(mesh: trimesh.Trimesh) -> np.ndarray:
    """Return the volume of each connected component [m3]."""
    faces, triangles = np.asarray(mesh.faces), np.asarray(mesh.triangles)
    edges = np.vstack([faces[:, :2], faces[:, 1:]])
    graph = coo_matrix((np.ones(len(edges)), edges.T), shape=(len(mesh.vertices),) * 2)
    piece = connected_components(graph)[1][faces[:, 0]]
    a, b, c = (triangles[:, k] - triangles.mean(axis=(0, 1)) for k in range(3))
    result: np.ndarray = np.bincount(piece, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6)[np.unique(piece)]
    return result


def gap(mesh: trimesh.Trimesh, point: np.ndarray) -> float:
    """Return the minimum distance of a point from corners and centres of the triangles [m]."""
    spots = np.vstack([mesh.vertices, mesh.triangles_center])
    return float(np.linalg.norm(spots - point, axis=1).min())


def test_every_shape_is_finite_and_has_a_colour_and_no_empty_triangle(shapes: dict[str, Shape]) -> None:
    assert len(shapes) > 60
    for name, shape in shapes.items():
        assert np.isfinite(shape.mesh.vertices).all(), name
        assert shape.mesh.area_faces.min() > 1e-12, name
        assert len(shape.rgba) == 4, name
        assert all(0 <= value <= 1 for value in shape.rgba), name
        assert name.replace("_", "").isalnum(), name


def test_every_body_is_closed_and_faces_outward(shapes: dict[str, Shape]) -> None:
    for name, shape in shapes.items():
        assert shape.mesh.is_winding_consistent, name
        if name not in OPEN:
            assert shape.mesh.is_watertight, name
            assert (volumes(shape.mesh) > 0).all(), name


def test_the_sheets_of_the_shell_face_away_from_the_cabin(shapes: dict[str, Shape]) -> None:
    middle = np.array([2.1, 0.0, 1.2])
    for name in ("body_shell", "body_glass"):
        mesh = shapes[name].mesh
        away = np.einsum("ij,ij->i", mesh.face_normals, mesh.triangles_center - middle)
        # a few narrow facets of the arches' flare and the bonnet's rim lie nearly along the line of sight
        assert (mesh.area_faces[away > 0].sum()) / mesh.area > 0.97, name


def test_every_part_of_the_model_has_a_shape(shapes: dict[str, Shape]) -> None:
    wanted = {"world", "body", "engine", "torque_arm", "plate_fr", "plate_fl"}
    wanted |= {f"{part}_{side}" for part in PARTS_OF_A_SIDE for side in ("fr", "fl")}
    assert {shape.part for shape in shapes.values()} == wanted
    assert set(SHELL) < set(shapes)
    assert {shapes[name].part for name in SHELL} == {"body"}


def test_the_files_stay_small(shapes: dict[str, Shape]) -> None:
    size = sum(STL_HEADER + STL_TRIANGLE * len(shape.mesh.faces) for shape in shapes.values())
    assert size == sum(len(shape.mesh.export(file_type="stl")) for shape in shapes.values())
    assert size < MAX_STL_BYTES


def test_the_left_side_mirrors_the_right(shapes: dict[str, Shape]) -> None:
    names = [name[:-3] for name in shapes if name.endswith("_fr") and f"{name[:-3]}_fl" in shapes]
    names.remove("plate")  # a round table on the shaker, a square plate on the pedestal
    assert len(names) == 21
    for name in names:
        right, left = shapes[f"{name}_fr"], shapes[f"{name}_fl"]
        assert left.mesh.vertices == pytest.approx(right.mesh.vertices * (1, -1, 1), abs=1e-15), name
        assert left.mesh.volume == pytest.approx(right.mesh.volume, rel=1e-12), name
        assert left.rgba == right.rgba


@pytest.mark.parametrize(
    ("shape", "point", "tolerance"),
    [
        # maximum distance of the surface of a ball, eye or socket joint from its hardpoint
        ("a_arm", "lower_ball", 0.027),
        ("a_arm", "arm_front", 0.028),
        ("a_arm", "arm_rear", 0.037),
        ("knuckle", "lower_ball", 0.010),
        ("knuckle", "tie_outer", 0.020),
        ("knuckle", "damper_bottom", 0.045),
        ("steering_rod", "tie_inner", 0.017),
        ("steering_rod", "tie_outer", 0.017),
        ("stabilizer_half", "stab_end", 0.018),
        ("stabilizer_half", "stab_body", 0.030),
        ("stabilizer_rod", "stab_end", 0.014),
        ("stabilizer_rod", "stab_rod_top", 0.014),
        ("damper_bottom", "stab_rod_top", 0.040),
        ("spring_seat_lower", "spring_lower", 0.027),
        ("damper_top", "strut_top", 0.012),
        ("suspension_mount", "strut_top", 0.046),
        ("tyre", "tyre_patch", 0.040),
        # wire and coil radius: the first turn is drawn in, the last is full size and 20 mm below the mount
        ("main_spring", "spring_lower", 0.055),
        ("main_spring", "strut_top", 0.085),
    ],
)
def test_suspension_shapes_reach_their_hardpoints_also_when_moved(
    points: dict[str, np.ndarray],
    shapes: dict[str, Shape],
    moved: tuple[dict[str, np.ndarray], dict[str, Shape]],
    shape: str,
    point: str,
    tolerance: float,
) -> None:
    for hardpoints, result in ((points, shapes), moved):
        for side in ("fr", "fl"):
            assert gap(result[f"{shape}_{side}"].mesh, hardpoints[f"{point}_{side}"]) < tolerance


def test_stabilizer_halves_meet_in_the_middle_plane(shapes: dict[str, Shape]) -> None:
    assert shapes["stabilizer_half_fr"].mesh.bounds[0, 1] == pytest.approx(0, abs=1e-12)
    assert shapes["stabilizer_half_fl"].mesh.bounds[1, 1] == pytest.approx(0, abs=1e-12)


def test_tyres_stand_on_the_plates_and_the_body_on_the_rubber(
    shapes: dict[str, Shape], points: dict[str, np.ndarray]
) -> None:
    for side in ("fr", "fl"):
        assert shapes[f"tyre_{side}"].mesh.bounds[0, 2] == pytest.approx(points[f"tyre_patch_{side}"][2], abs=1e-12)
        assert shapes[f"plate_{side}"].mesh.bounds[1, 2] == pytest.approx(points[f"tyre_patch_{side}"][2], abs=1e-12)
    for side in ("right", "left"):
        top = shapes[f"rubber_block_{side}"].mesh.bounds[1]
        assert top[2] == pytest.approx(points[f"rear_support_{side}"][2], abs=1e-12)
    assert shapes["body_support_shoes"].mesh.bounds[0, 2] == pytest.approx(0.72, abs=1e-12)
    assert min(shape.mesh.bounds[0, 2] for shape in shapes.values()) == pytest.approx(0, abs=1e-12)


def test_the_free_tyre_has_the_size_of_its_marking(shapes: dict[str, Shape]) -> None:
    size = shapes["tyre_fr"].mesh.extents
    assert size[0] == pytest.approx(2 * (0.295 + 0.0125), rel=0.006)  # 30 corners: at most 1 - cos(6 deg) short
    assert size[1] == pytest.approx(0.195, rel=0.055)  # bulges by up to 5 % at the patch


def test_the_body_follows_wheels_roof_and_rear_axle(points: dict[str, np.ndarray]) -> None:
    shell = car_shapes(points)["body_shell"].mesh
    assert shell.bounds[:, 0] == pytest.approx([0.0, 4.45], abs=0.002)
    assert shell.extents[1] == pytest.approx(1.70, abs=0.03)  # flares of the arches stand out by 10 mm
    # the roof's grid has steps of 150 by 130 mm round the point
    assert gap(shell, points["roof_left_rear"]) < 0.09
    longer = dict(points)
    for side in ("right", "left"):
        longer[f"rear_support_{side}"] = points[f"rear_support_{side}"] + (0.2, 0, 0)
    assert car_shapes(longer)["body_shell"].mesh.bounds[1, 0] == pytest.approx(4.65, abs=0.002)
    higher = points | {"roof_left_rear": points["roof_left_rear"] + (0, 0, 0.1)}
    raised = car_shapes(higher)["body_shell"].mesh
    assert raised.bounds[1, 2] - shell.bounds[1, 2] == pytest.approx(0.1, abs=0.01)


def test_wheels_do_not_touch_the_arches(shapes: dict[str, Shape], points: dict[str, np.ndarray]) -> None:
    centre, tyre = points["wheel_center_fr"], shapes["tyre_fr"].mesh
    tyre_radius = np.hypot(*(tyre.vertices - centre)[:, [0, 2]].T).max()
    shell = shapes["body_shell"].mesh
    near = shell.vertices[(shell.vertices[:, 1] > 0.6) & (np.abs(shell.vertices[:, 0] - centre[0]) < 0.5)]
    clearance = np.hypot(*(near - centre)[:, [0, 2]].T).min() - tyre_radius
    # 36 mm in the drawing; facets of the free tyre and of the arch take their share
    assert 0.030 < clearance < 0.040


def test_the_spring_clears_the_tyre(shapes: dict[str, Shape]) -> None:
    spring, tyre = shapes["main_spring_fr"].mesh, shapes["tyre_fr"].mesh
    below = spring.vertices[spring.vertices[:, 2] < tyre.bounds[1, 2]]
    middle = (tyre.bounds[0, 1] + tyre.bounds[1, 1]) / 2
    # the section is 195 mm wide; the lowest turn may come as near as the wall of the tyre, 2 mm for its facets
    assert below[:, 1].max() < middle - 0.195 / 2 + 0.002


def test_sizes_change_what_they_name(points: dict[str, np.ndarray]) -> None:
    hub = {"wheel_center": points["wheel_center_fr"]}
    for sizes, width in (({}, 0.258), ({"brake_disc_radius": 0.15}, 0.30)):
        disc = part_shapes([Part(name="disc", role="brake_disc", points=hub, sizes=sizes)])["disc"]
        assert disc.mesh.extents[0] == pytest.approx(width, abs=1e-3)


def test_the_same_points_give_the_same_bytes(points: dict[str, np.ndarray]) -> None:
    first, second = car_shapes(points), car_shapes(dict(reversed(points.items())))
    assert list(first) == list(second)
    for name in first:
        assert first[name].mesh.export(file_type="stl") == second[name].mesh.export(file_type="stl"), name


@pytest.mark.parametrize(("role", "count"), [("anti_roll_link", 1), ("anti_roll_link", 2), ("lower_arm", 4)])
def test_a_part_without_a_role_or_a_point_of_it_is_rods_between_its_points(role: str, count: int) -> None:
    generator = np.random.default_rng(count)
    points = {f"point_{number}": generator.uniform(0.3, 1.0, 3) for number in range(count)}
    part = Part(name="link", role=role, points=points, suffix="_rl", carrier="rear_subframe", left=True)
    shapes = part_shapes([part])
    assert list(shapes) == ["link_rl"]
    assert shapes["link_rl"].part == "link_rl"
    mesh = shapes["link_rl"].mesh
    assert mesh.is_watertight
    assert (volumes(mesh) > 0).all()
    assert len(volumes(mesh)) == {1: 1, 2: 3, 4: 8}[count]  # a ball at each point, and the rods
    assert all(gap(mesh, point) < 0.016 for point in points.values())


def test_parts_of_one_role_on_one_corner_keep_apart_and_their_bolts_go_with_the_carrier(
    points: dict[str, np.ndarray],
) -> None:
    arm = {name: points[f"{name}_fr"] for name in ("lower_ball", "arm_front", "arm_rear")}
    above = {name: position + np.array([0, 0, 0.3]) for name, position in arm.items()}
    parts = [
        Part(name=name, role="lower_arm", points=where, suffix="_rr", carrier="rear_subframe")
        for name, where in (("lower_wishbone", arm), ("upper_wishbone", above))
    ]
    shapes = part_shapes(parts)
    names = [f"{part}_wishbone{piece}_rr" for part in ("lower", "upper") for piece in ("", "_rubber", "_bolts")]
    assert list(shapes) == names
    assert [shapes[name].part for name in names[:3]] == [names[0], names[0], "rear_subframe"]
    strut = {name: points[f"{name}_fr"] for name in ("damper_bottom", "spring_lower", "strut_top")}
    twin = [Part(name=name, role="damper_tube", points=strut, suffix="_rr") for name in ("main", "helper")]
    assert list(part_shapes(twin)) == ["main_rr", "spring_seat_lower_rr", "helper_rr", "helper_spring_seat_lower_rr"]


def test_a_role_finds_its_points_around_the_part(points: dict[str, np.ndarray]) -> None:
    corner = {name.removesuffix("_fl"): points[name] for name in points if name.endswith("_fl")}
    knuckle_points = {name: corner[name] for name in ("lower_ball", "damper_bottom", "wheel_center")}
    drawn, rods = (
        part_shapes(
            [Part(name="knuckle", role="knuckle", points=knuckle_points, around=around, suffix="_fl", left=True)]
        )
        for around in (corner, {})
    )
    whole = car_shapes(points)["knuckle_fl"].mesh
    assert drawn["knuckle_fl"].mesh.vertices == pytest.approx(np.asarray(whole.vertices), abs=1e-15)
    assert len(volumes(rods["knuckle_fl"].mesh)) == 6


def test_a_part_without_points_or_with_the_role_none_is_not_drawn(points: dict[str, np.ndarray]) -> None:
    parts = [Part(name="thing", role="link", points={}), Part(name="seat", role="none", points=points)]
    assert part_shapes(parts) == {}
