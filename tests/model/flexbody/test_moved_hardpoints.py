"""Common geometry: a moved hardpoint moves the node of the recomputed body; a rigid body needs no file."""

import dataclasses

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.body_design import read_design
from vehicle.model.flexbody.body_frame import body_frame
from vehicle.model.flexbody.body_model import BODY_DESIGN, TRIMMED_BODY
from vehicle.model.flexbody.node_masses import NodeProperties
from vehicle.model.flexbody.symmetry import parity
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car

ROAD = random_road(rms=1e-3, seed=1, wheel="fr", duration=1.0)


def rms(car, engine, channel="seat_rail_acc_z"):
    return float(np.sqrt(np.mean(car.run(ROAD, engine=engine)[channel] ** 2)))


def squared(changes):
    """Return squared frequencies of the free body [Hz2], the eigenvalues, which stay smooth when two modes approach."""
    return Car.load(None, changes).trimmed_body.frequencies ** 2


def test_the_node_follows_its_hardpoint_on_both_sides():
    changes = ["hardpoints.strut_top.z=1.24", "hardpoints.seat_rail.x=2.06"]
    body, still = Car.load(None, changes).trimmed_body, Car.load().trimmed_body
    moved = {
        name: (body.positions - still.positions)[i].round(12).tolist()
        for i, name in enumerate(body.nodes)
        if not np.array_equal(body.positions[i], still.positions[i])
    }
    up, back = [0.0, 0.0, 0.01], [0.01, 0.0, 0.0]
    # The other rail is the mirror image of the driver's.
    assert moved == {"strut_top_fr": up, "strut_top_fl": up, "seat_rail": back, "seat_rail_right": back}
    assert body.mass == pytest.approx(813.0, rel=1e-12)
    np.testing.assert_allclose(body.cog, still.cog, atol=1e-12)
    np.testing.assert_allclose(body.inertia, still.inertia, atol=1e-8)


@pytest.mark.parametrize("point", ["strut_top.z", "arm_rear.x", "rear_support.y", "hydromount.z", "seat_rail.y"])
def test_modes_change_smoothly(point):
    """Central differences of the eigenvalues with 1 and 2 mm differ by a third derivative, O(h^2) of each other."""
    name, axis = point.split(".")
    points = load_vehicle().points
    label = next(key for key in (f"{name}_fr", f"{name}_right", name) if key in points)
    value = points[label]["xyz".index(axis)]

    def slope(step):
        up, down = (squared([f"hardpoints.{point}={value + sign * step}"]) for sign in (1.0, -1.0))
        return (up - down) / (2.0 * step)

    fine, coarse = slope(1e-3), slope(2e-3)
    largest = np.abs(fine).max()
    assert largest > 1.0  # Hz2/m: something does change, and above the round-off of 1e-9 / 1e-3
    np.testing.assert_allclose(coarse, fine, atol=0.02 * largest)  # the step over the length of a member, squared


def test_a_symmetric_move_leaves_the_body_symmetric():
    """Hardpoints moved on both sides leave modes symmetric or antisymmetric."""
    body, still = Car.load(None, ["hardpoints.strut_top=[0.9, 0.56, 1.25]"]).trimmed_body, Car.load().trimmed_body
    likeness, before = (parity(b.shapes, b.positions, np.asarray(b.node_mass)) for b in (body, still))
    assert np.abs(likeness).min() > 0.95
    np.testing.assert_allclose(np.sign(likeness), np.sign(before))
    for name in ("strut_top", "arm_front"):
        right, left = (np.asarray(body.node_mass)[body.node_index(f"{name}_{wheel}")] for wheel in ("fr", "fl"))
        assert right == pytest.approx(left, rel=0.03)  # the engine mounts are not mirrored


def test_a_body_moved_as_a_whole_has_the_same_modes(tmp_path):
    """A common translation of nodes, centre of gravity and reference point of the inertia does not change the modes."""
    by, vehicle, design = np.array([0.3, 0.0, -0.1]), load_vehicle(), read_design(BODY_DESIGN)

    def shifted(point):
        return tuple(float(a + b) for a, b in zip(point, by, strict=True))

    body = vehicle.body
    old, new = np.array(body.cog), np.array(body.cog) + by

    def moved(i, j):  # parallel axes, term by term: integrals of x_i x_j about the origin
        return body.mass * (new[i] * new[j] - old[i] * old[j])

    inertia = body.inertia
    inertia = dataclasses.replace(
        inertia, ixx=inertia.ixx + moved(1, 1) + moved(2, 2), iyy=inertia.iyy + moved(0, 0) + moved(2, 2),
        izz=inertia.izz + moved(0, 0) + moved(1, 1), izx=inertia.izx + moved(0, 2),
    )  # fmt: skip
    changed = dataclasses.replace(body, cog=tuple(new), inertia=inertia)
    points = {name: shifted(point) for name, point in vehicle.points.items()}
    nodes = {
        name: node if node.place is None else dataclasses.replace(node, place=shifted(node.place))
        for name, node in design.nodes.items()
    }
    original_properties, moved_properties = (NodeProperties.of_body(each, design.least_ixx) for each in (body, changed))
    original = body_frame(design, vehicle.points, original_properties).superelement()
    moved_body = body_frame(dataclasses.replace(design, nodes=nodes), points, moved_properties).superelement()
    np.testing.assert_allclose(
        moved_body.frequencies, original.frequencies, rtol=1e-7
    )  # round-off, as of another library
    np.testing.assert_allclose(np.asarray(moved_body.node_mass), np.asarray(original.node_mass), rtol=1e-8)
    np.testing.assert_allclose(moved_body.shapes, original.shapes, atol=1e-6)


def test_both_engines_run_a_moved_hardpoint_and_agree():
    car, still = Car.load(None, ["hardpoints.strut_top.z=1.24"]), Car.load()
    mount_position = car.model.model.site("bushing/suspension_mount_fl/carrier").pos + car.model.model.body("body").pos
    np.testing.assert_allclose(mount_position, [0.877, -0.548, 1.24], atol=1e-12)
    levels = {engine: rms(car, engine) for engine in ("mujoco", "reduced")}
    assert levels["reduced"] == pytest.approx(levels["mujoco"], rel=5e-3)  # the geometry that the matrices leave out
    for engine, value in levels.items():
        before = rms(still, engine)
        assert value != before and value == pytest.approx(before, rel=0.02)  # one centimetre


def test_the_same_points_and_masses_give_the_same_bytes_and_one_body():
    design, vehicle = read_design(BODY_DESIGN), load_vehicle()
    properties = NodeProperties.of_body(vehicle.body, design.least_ixx)
    first, second = (body_frame(design, vehicle.points, properties).superelement() for _ in range(2))
    for name in ("positions", "node_mass", "frequencies", "shapes"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()
    loaded = Car.load().trimmed_body
    blind = ["damper.coulomb_friction=60", "body.inertia.ixy=80", "body.frequency_scale=1.1", "body.inertia.ixx=1200"]
    assert Car.load(None, blind).trimmed_body is loaded
    for seen in ("body.mass=812", "body.inertia.ixx=1201", "hardpoints.seat.z=0.86"):
        assert Car.load(None, [seen]).trimmed_body is not loaded


def rigid_file(folder):
    """Write the car of Bommer 2006 without its body file."""
    text = FOCUS_FILE.read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("superelement =")]
    (folder / "car.toml").write_text("\n".join(lines), encoding="utf-8")
    return folder / "car.toml"


def test_a_rigid_body_needs_no_file(tmp_path):
    file = rigid_file(tmp_path)
    with pytest.raises(ConfigurationError, match=r"body\.superelement: missing; a flexible body needs a body design"):
        Car.load(file)
    without = Car.load(file, ["body.flexible=false"])
    assert without.trimmed_body.frequencies.size == 0 and without.model.model.body("body").mass[0] == 813.0
    stiff = ["body.flexible=false", "body.attachment_flexibility=false"]
    for other in (Car.load(None, stiff), Car.load(None, [*stiff, "body.superelement=nothing.toml"])):
        for engine in ("mujoco", "reduced"):
            assert rms(without, engine) == rms(other, engine)
    moved = Car.load(file, ["body.flexible=false", "hardpoints.strut_top.z=1.24"])
    assert rms(moved, "mujoco") != rms(without, "mujoco")


def test_a_rigid_body_takes_its_attachments_from_either_file():
    built, imported = (Car.load(None, ["body.flexible=false", f"body.superelement={file}"]) for file in FILES)
    assert built.model.model.nv == imported.model.model.nv == Car.load().model.model.nv - 9
    for engine in ("mujoco", "reduced"):
        assert rms(built, engine) == rms(imported, engine)
        assert rms(built, engine) != rms(Car.load(None, [*RIGID, "body.attachment_flexibility=false"]), engine)
    with pytest.raises(ConfigurationError, match=r"the file 'nothing\.toml' is neither"):
        _ = Car.load(None, [*RIGID, "body.superelement=nothing.toml"]).model


RIGID = ["body.flexible=false"]
FILES = ("body_design.toml", "trimmed_body.toml")


def test_an_imported_body_says_how_far_its_nodes_may_be(tmp_path):
    strict = ["body.superelement=trimmed_body.toml", "hardpoints.strut_top.z=1.234"]
    with pytest.raises(
        DataError, match=r"'strut_top_fr' at \[0.877, 0.548, 1.23\] m, 4 mm away but must be at most 1 mm"
    ):
        _ = Car.load(None, strict).model
    assert Car.load(None, [*strict, "body.flexible=false"]).model.model.nv > 0  # what is rigid reaches everywhere
    (tmp_path / "car.toml").write_text(FOCUS_FILE.read_text(encoding="utf-8"), encoding="utf-8")
    text = TRIMMED_BODY.read_text(encoding="utf-8")
    assert "hardpoint_tolerance_m = 0.001" in text
    (tmp_path / "mine.toml").write_text(text.replace("tolerance_m = 0.001", "tolerance_m = 0.005"), encoding="utf-8")
    changes = ["body.superelement=mine.toml", "hardpoints.strut_top.z=1.234"]
    car = Car.load(tmp_path / "car.toml", changes)
    assert rms(car, "mujoco") == pytest.approx(rms(Car.load(None, changes[1:]), "mujoco"), rel=1e-3)
    for bad, message in (
        ("0.0", "hardpoint_tolerance: found 0 m, must be above 0"),
        ("[1]", r"hardpoint_tolerance_m: .*\[1\.0\]"),
    ):
        (tmp_path / "mine.toml").write_text(text.replace("tolerance_m = 0.001", f"tolerance_m = {bad}"))
        with pytest.raises(DataError, match=message):
            _ = Car.load(tmp_path / "car.toml", changes).trimmed_body
