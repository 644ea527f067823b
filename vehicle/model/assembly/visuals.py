"""Visible shapes on the generated car: meshes without mass and without contact."""

from collections.abc import Iterable, Iterator, Mapping

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.model.parameters.composition import Composition, PlacedSpring
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.model.shapes.roles import ROLES, Part
from vehicle.model.shapes.scene import car_shapes
from vehicle.model.shapes.shape import Shape

SHELL_GROUP = 1
"""Visual group of everything on the trimmed body."""

ELSEWHERE = {"coil_spring": "coil"}
"""Role that replaces the role of a part outside a strut."""

PART_GROUP = 2
"""Visual group of all other parts and of the rig."""


def visible_shapes(vehicle: Vehicle, *, rig: bool = True) -> dict[str, Shape]:
    """Return the shapes of a car and its rig at the design position, by name; parts without a known role are rods."""
    car = vehicle.composition
    points = {name: np.array(point) for name, point in car.points.items()}
    corners = {
        wheel.name: _around(points, f"_{wheel.name}")
        | {"wheel_center": np.array(wheel.center), "tyre_patch": np.array(wheel.patch)}
        for wheel in car.wheels
    }
    blocks = [link for link in car.connections if link.carrier == "world" and link.ground]
    supports = {link.name.rpartition("_")[2]: np.array(link.at) for link in blocks}
    return car_shapes(points, corners, supports, _drawn(vehicle, points, corners), rig=rig)


def _around(points: Mapping[str, Vector], suffix: str) -> dict[str, Vector]:
    """Return the points of a corner or side by names without its suffix; all points for an empty suffix."""
    return {name.removesuffix(suffix): point for name, point in points.items() if name.endswith(suffix)}


def _drawn(
    vehicle: Vehicle, points: Mapping[str, Vector], corners: Mapping[str, Mapping[str, Vector]]
) -> Iterator[Part]:
    """Yield the parts and springs of a car with the points that their roles need, or with the points of the part.

    At a corner the wheel centre and the contact patch have fixed names, independent of the template.
    """
    car = vehicle.composition
    listed = [(part.path, part.name, part.shape, part.points, part.side) for part in car.parts]
    for spring in car.springs:
        ends = dict(zip(("lower", "upper"), spring.at, strict=True))
        listed.append((spring.path, spring.name, spring.shape, ends, float(np.sign(spring.at[0][1]))))
    for path, name, role, local_points, side in listed:
        base = path.rpartition(".")[2]
        suffix = name.removeprefix(base)
        around = corners.get(suffix[1:]) or _around(points, suffix)
        needed = set(ROLES[role][1]) if role in ROLES else {""}
        if needed <= set(around):
            chosen = around
        else:
            role = ELSEWHERE.get(role, role)
            chosen = {
                key: np.array(point)
                for key, point in (local_points if len(local_points) > 1 else _reach(car, name, local_points)).items()
            }
        if role != "none":
            yield Part(name=base, role=role, points=chosen, suffix=name.removeprefix(base), left=side < 0.0)


def _reach(car: Composition, name: str, local_points: Mapping[str, Point]) -> dict[str, Point]:
    """Return the points of a part and of the joints of its children."""
    joints = {joint.name: joint.at for part in car.parts if part.parent == name for joint in part.joints}
    return {**local_points, **joints}


def add_shapes(
    spec: mujoco.MjSpec, shapes: Mapping[str, Shape], origins: Mapping[str, Vector], springs: Iterable[PlacedSpring]
) -> None:
    """Add a visible mesh for every shape to a specification; masses, inertias and joints do not change.

    Body frames are parallel to the vehicle frame in the design position, so a mesh is only shifted: v - origin.

    Args:
        spec: specification of the car on its rig; changed in place.
        shapes: shapes at the design position in the vehicle frame, by name.
        origins: origin of each body frame in the design position [m], by body name.
        springs: springs of the car; a coil between two bodies belongs to the lower body.
    """
    borne = {spring.name: spring.parts[0] for spring in springs}
    for name, shape in shapes.items():
        body = borne.get(shape.part, shape.part)
        vertices = np.asarray(shape.mesh.vertices) - origins[body]
        spec.add_mesh(
            name=name,
            uservert=vertices.ravel(),
            userface=np.asarray(shape.mesh.faces).ravel(),
            # An open surface has no volume, and the mass of a shape is not used anyway.
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
        spec.add_material(name=name, rgba=shape.rgba, specular=0.3, shininess=0.4)
        spec.body(body).add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=name,
            material=name,
            contype=0,
            conaffinity=0,
            mass=0.0,
            group=SHELL_GROUP if body == "body" else PART_GROUP,
        )
